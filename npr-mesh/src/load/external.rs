//! Files that a model refers to.
//!
//! Their names come from untrusted files, so they may only be in the model's own folder or in a folder that the
//! caller allows. Otherwise a model could expose other files on the disk.

use super::file::read_file;
use crate::{Limits, LoadError, LoadOptions};
use std::cell::{Cell, OnceCell};
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// The maximum number of files that a model may refer to. Each requires several system calls, whether it exists or
/// not.
const MOST_FILES: u64 = 10_000;

/// The folders that may contain the files of a model.
pub(super) struct External<'a> {
    pub model: &'a Path,
    pub limits: &'a Limits,
    asset_root: Option<&'a Path>,
    /// The folders, as given and in canonical form.
    roots: OnceCell<Vec<(PathBuf, PathBuf)>>,
    asked: Cell<u64>,
    bytes: Cell<u64>,
}

impl<'a> External<'a> {
    pub fn new(model: &'a Path, options: &'a LoadOptions) -> Self {
        let asset_root = options.asset_root.as_deref();
        Self {
            model,
            limits: &options.limits,
            asset_root,
            roots: OnceCell::new(),
            asked: Cell::new(0),
            bytes: Cell::new(0),
        }
    }

    /// The first of several names for which there is a file, in the model's folder or else in the asset root.
    ///
    /// Names are relative to one of these folders, or absolute and within one of them. They are first resolved
    /// lexically, so that names outside are rejected without accessing them; then symbolic links are followed, whose
    /// targets must be within the folders as well.
    ///
    /// # Errors
    /// [`LoadError::Outside`], or [`LoadError::Read`] if there is no such file, both with the first name.
    /// [`LoadError::TooLarge`] for more than [`MOST_FILES`] calls.
    pub fn find(&self, names: &[PathBuf]) -> Result<PathBuf, LoadError> {
        self.asked.set(self.asked.get() + 1);
        if self.asked.get() > MOST_FILES {
            return Err(LoadError::TooLarge {
                path: self.model.to_owned(),
                what: "files named in it",
                count: self.asked.get(),
                limit: MOST_FILES,
            });
        }
        let roots = self.roots()?;
        let within = |path: &Path| {
            roots.iter().find_map(|(typed, real)| path.strip_prefix(real).ok().map(|rest| typed.join(rest)))
        };
        let mut outside = false;
        for name in names {
            for (_, base) in roots {
                let Some(path) = folded(&base.join(name)).filter(|path| within(path).is_some()) else {
                    outside = true;
                    continue;
                };
                match fs::canonicalize(&path) {
                    Ok(real) if within(&real).is_some() => return Ok(within(&path).unwrap_or(path)),
                    Ok(_) => outside = true,
                    Err(_) => {}
                }
            }
        }
        let name = shortened(&names.first().map_or(Path::new(""), PathBuf::as_path).to_string_lossy());
        Err(if outside {
            LoadError::Outside { path: self.model.to_owned(), name }
        } else {
            LoadError::Read { path: roots[0].0.join(name), source: io::ErrorKind::NotFound.into() }
        })
    }

    /// The names relative to the folder of another file, followed by the names themselves.
    #[cfg(feature = "obj")]
    pub fn beside(&self, file: &Path, names: Vec<PathBuf>) -> Vec<PathBuf> {
        let own = self.roots().ok().and_then(|roots| roots.first());
        match file
            .parent()
            .map(|folder| if folder == Path::new("") { Path::new(".") } else { folder })
            .map(fs::canonicalize)
        {
            Some(Ok(folder)) if own.is_some_and(|(_, own)| *own != folder) => {
                names.iter().map(|name| folder.join(name)).chain(names.iter().cloned()).collect()
            }
            _ => names,
        }
    }

    fn roots(&self) -> Result<&[(PathBuf, PathBuf)], LoadError> {
        if let Some(roots) = self.roots.get() {
            return Ok(roots);
        }
        let own = self.model.parent().unwrap_or(Path::new(""));
        let mut roots = Vec::with_capacity(2);
        for root in [Some(own), self.asset_root].into_iter().flatten() {
            let asked = if root == Path::new("") { Path::new(".") } else { root };
            let real = fs::canonicalize(asked).map_err(|source| LoadError::Read { path: root.to_owned(), source })?;
            roots.push((root.to_owned(), real));
        }
        Ok(self.roots.get_or_init(|| roots))
    }

    /// Reads a file that was [found](Self::find). The total size of all files is limited by [`Limits::file_bytes`].
    pub fn read(&self, file: &Path) -> Result<Vec<u8>, LoadError> {
        let left = self.limits.file_bytes.saturating_sub(self.bytes.get());
        let bytes = read_file(file, &Limits { file_bytes: left, ..*self.limits })?;
        self.bytes.set(self.bytes.get() + bytes.len() as u64);
        Ok(bytes)
    }
}

/// A path without `.` and `..`; `None` if it leads above its root or is not absolute.
fn folded(path: &Path) -> Option<PathBuf> {
    let mut folded = PathBuf::new();
    for component in path.components() {
        match component {
            Component::Prefix(_) | Component::RootDir => folded.push(component),
            Component::CurDir => {}
            Component::ParentDir if folded.pop() => {}
            Component::ParentDir => return None,
            Component::Normal(part) => folded.push(part),
        }
    }
    folded.is_absolute().then_some(folded)
}

/// The file names that a name in another file may mean.
///
/// A backslash may be a separator. Absolute names usually come from another machine, so their last component alone is
/// tried as well. `None` if the name cannot be that of a file.
pub(super) fn meanings(name: &str) -> Option<Vec<PathBuf>> {
    let slashed = name.replace('\\', "/");
    let is_absolute = slashed.starts_with('/') || slashed.as_bytes().get(1) == Some(&b':');
    let mut meanings = vec![PathBuf::from(name)];
    if name.contains('\\') {
        meanings.push(PathBuf::from(&slashed));
    }
    if is_absolute {
        meanings.push(PathBuf::from(slashed.rsplit(['/', ':']).next().unwrap_or_default()));
    }
    meanings.retain(|path| path.file_name().is_some_and(|name| name != OsStr::new("")));
    (!meanings.is_empty() && !name.contains('\0')).then_some(meanings)
}

/// A name from a file for messages: on one line, and shortened.
pub(super) fn shortened(name: &str) -> String {
    const MOST: usize = 80;
    let mut text: String = name.chars().take(MOST).flat_map(char::escape_debug).collect();
    if name.chars().nth(MOST).is_some() {
        text.push('…');
    }
    text
}
