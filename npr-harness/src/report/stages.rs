//! Results of finished stages, kept as files.

use crate::error::HarnessError;
use npr_hatch::files::{read_file, write_file};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// No stage file is larger, bytes.
const MOST_BYTES: u64 = 1 << 30;

/// A folder of results, each a TOML file, which unlike JSON has numbers that are infinite or none.
///
/// A file is written whole or not at all. It holds the key of the run that it comes from: one with another key, one that
/// is damaged and one of another form are made again.
#[derive(Clone, Debug, PartialEq)]
pub struct Stages {
    dir: PathBuf,
    key: String,
}

#[derive(Deserialize)]
struct Kept<T> {
    value: T,
}

#[derive(Deserialize)]
struct Key {
    key: String,
}

#[derive(Serialize)]
struct Keeping<'a, T> {
    key: &'a str,
    value: &'a T,
}

impl Stages {
    /// Stages in a folder, which is created if necessary. `key` states everything that the results depend on: version,
    /// options, models, machine.
    ///
    /// # Errors
    /// [`HarnessError::Write`].
    pub fn new(dir: &Path, key: &str) -> Result<Self, HarnessError> {
        std::fs::create_dir_all(dir).map_err(|source| HarnessError::Write { path: dir.to_owned(), source })?;
        Ok(Self { dir: dir.to_owned(), key: key.to_owned() })
    }

    /// The file of a stage.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(format!("{name}.toml"))
    }

    /// Removes the kept results of these names.
    ///
    /// # Errors
    /// [`HarnessError::Write`] for a file that is there and cannot be removed.
    pub fn forget<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> Result<(), HarnessError> {
        for name in names {
            let path = self.path(name);
            match std::fs::remove_file(&path) {
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                    return Err(HarnessError::Write { path, source });
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The kept result of a stage, if there is a valid one.
    pub fn get<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let bytes = read_file(&self.path(name), MOST_BYTES).ok()?;
        let text = std::str::from_utf8(&bytes).ok()?;
        let key: Key = toml::from_str(text).ok()?;
        if key.key != self.key {
            return None;
        }
        toml::from_str::<Kept<T>>(text).ok().map(|kept| kept.value)
    }

    /// The kept result of a stage; otherwise makes it and keeps it. `name` is that of a file.
    ///
    /// # Errors
    /// Those of `make`, [`HarnessError::StageWrite`] and [`HarnessError::Write`].
    pub fn get_or<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        make: impl FnOnce() -> Result<T, HarnessError>,
    ) -> Result<T, HarnessError> {
        if let Some(kept) = self.get(name) {
            return Ok(kept);
        }
        let value = make()?;
        let text = toml::to_string(&Keeping { key: &self.key, value: &value }).map_err(HarnessError::StageWrite)?;
        let path = self.path(name);
        write_file(&path, text.as_bytes()).map_err(|source| HarnessError::Write { path, source })?;
        Ok(value)
    }
}
