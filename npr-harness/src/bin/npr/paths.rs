//! Checks of the paths in a command's arguments, before anything is computed.

use npr_harness::error::{HarnessError, PathRole};
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Checks that a path exists and is not a directory.
pub fn check_file(role: PathRole, path: &Path) -> Result<(), HarnessError> {
    match is_directory(role, path)? {
        Some(false) => Ok(()),
        Some(true) => Err(HarnessError::IsDirectory { role, path: path.to_owned() }),
        None => Err(HarnessError::NoSuchPath { role, path: path.to_owned() }),
    }
}

/// Checks that a path is a directory.
pub fn check_directory(role: PathRole, path: &Path) -> Result<(), HarnessError> {
    match is_directory(role, path)? {
        Some(true) => Ok(()),
        Some(false) => Err(not_a_directory(role, path)),
        None => Err(HarnessError::NoSuchPath { role, path: path.to_owned() }),
    }
}

/// Checks that a path is a directory or does not exist.
pub fn check_output_folder(path: &Path) -> Result<(), HarnessError> {
    match is_directory(PathRole::Output, path)? {
        Some(true) | None => Ok(()),
        Some(false) => Err(not_a_directory(PathRole::Output, path)),
    }
}

/// Checks that an output is not a directory and overwrites no input.
pub fn check_output_file(output: &Path, inputs: &[&Path]) -> Result<(), HarnessError> {
    let real = |path: &Path| fs::canonicalize(path).ok();
    if inputs.iter().any(|input| real(input).is_some_and(|input| Some(input) == real(output))) {
        return Err(HarnessError::Overwrites { path: output.to_owned() });
    }
    if output.is_dir() {
        return Err(HarnessError::IsDirectory { role: PathRole::Output, path: output.to_owned() });
    }
    Ok(())
}

/// The error of an output that cannot be written.
pub fn unusable(path: &Path) -> impl FnOnce(io::Error) -> HarnessError {
    move |source| HarnessError::Unusable { role: PathRole::Output, path: path.to_owned(), source }
}

fn not_a_directory(role: PathRole, path: &Path) -> HarnessError {
    HarnessError::Unusable { role, path: path.to_owned(), source: ErrorKind::NotADirectory.into() }
}

/// `None` if the path does not exist.
fn is_directory(role: PathRole, path: &Path) -> Result<Option<bool>, HarnessError> {
    match fs::metadata(path) {
        Ok(there) => Ok(Some(there.is_dir())),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(source) => Err(HarnessError::Unusable { role, path: path.to_owned(), source }),
    }
}
