//! Files that a model names.
//!
//! They are read on the model's word alone, so they may only lie in its own folder, or in one that the caller allows:
//! a picture of a stranger's model must not show what else is on the disk.

use super::read_file;
use crate::{Limits, LoadError, LoadOptions};
use std::cell::{Cell, OnceCell};
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// As many files a model may name. Each costs a few questions to the system, whether it is there or not.
const MOST_FILES: u64 = 10_000;

/// Where the files that one model names may be.
pub(super) struct External<'a> {
    pub model: &'a Path,
    pub limits: &'a Limits,
    asset_root: Option<&'a Path>,
    /// The folders: as typed, and where that is.
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

    /// The first of some names under which there is a file, in the model's folder before the asset root.
    ///
    /// Names are relative to either, or absolute, and then within one of them. They are resolved without a look at the
    /// disk, so that one that leads elsewhere is refused before anything there is touched; then symbolic links are
    /// followed, and must end within too.
    ///
    /// # Errors
    /// [`LoadError::Outside`], or [`LoadError::Read`] where there is nothing, both about the first name.
    /// [`LoadError::TooLarge`] after more than [`MOST_FILES`] questions.
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

    /// The same names where they are relative to the folder of another file that was found, and as they are.
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

    /// The bytes of a file that was [found](Self::find). All files together may have [`Limits::file_bytes`].
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

/// The names under which a file could be meant by its name in another file.
///
/// A backslash may be a separator. Of an absolute name, which comes from someone else's machine as a rule, the last part
/// alone may do. `None` for what names no file.
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

/// A name from a file, for messages: on one line, and no longer than that.
pub(super) fn shortened(name: &str) -> String {
    const MOST: usize = 80;
    let mut text: String = name.chars().take(MOST).flat_map(char::escape_debug).collect();
    if name.chars().nth(MOST).is_some() {
        text.push('…');
    }
    text
}
