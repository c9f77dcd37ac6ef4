//! Files that a model refers to.
//!
//! Their names come from untrusted files. On a disk they may only be in the model's own folder or in a folder that the
//! caller allows; otherwise a model could expose other files. For a model in memory, the caller's resolver returns
//! them, and no file is accessed.

mod any_case;

use super::file::read_file;
use crate::{Limits, LoadError, LoadOptions};
use any_case::Listings;
use std::cell::{Cell, OnceCell, RefCell};
use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// The maximum number of files that a model may refer to. Each requires several system calls, whether it exists or
/// not.
const MOST_FILES: u64 = 10_000;

/// Returns the bytes of a file that a model in memory refers to, see [`load_bytes`](crate::load_bytes()).
///
/// The name is relative to the model, with `/` between folders and without `.` and `..`. An error of the kind
/// [`io::ErrorKind::NotFound`] says that there is no such file.
pub type Resolver<'a> = dyn Fn(&str) -> io::Result<Vec<u8>> + 'a;

/// The files that a model may refer to.
pub(super) struct External<'a> {
    /// The file of the model, or the name of a model in memory.
    pub model: &'a Path,
    pub limits: &'a Limits,
    source: Source<'a>,
    asked: Cell<u64>,
    bytes: Cell<u64>,
}

enum Source<'a> {
    Disk {
        asset_root: Option<&'a Path>,
        /// The folders that may contain the files, as given and in canonical form.
        roots: OnceCell<Vec<(PathBuf, PathBuf)>>,
        listings: RefCell<Listings>,
    },
    Resolver {
        resolve: &'a Resolver<'a>,
        /// Files that were found and not read yet.
        found: RefCell<HashMap<PathBuf, Vec<u8>>>,
    },
}

impl<'a> External<'a> {
    /// The files on the disk.
    pub fn new(model: &'a Path, options: &'a LoadOptions) -> Self {
        let asset_root = options.asset_root.as_deref();
        let source = Source::Disk { asset_root, roots: OnceCell::new(), listings: RefCell::default() };
        Self { model, limits: &options.limits, source, asked: Cell::new(0), bytes: Cell::new(0) }
    }

    /// The files that a resolver returns.
    pub fn resolved_by(resolve: &'a Resolver<'a>, model: &'a Path, limits: &'a Limits) -> Self {
        let source = Source::Resolver { resolve, found: RefCell::default() };
        Self { model, limits, source, asked: Cell::new(0), bytes: Cell::new(0) }
    }

    /// The first of several names for which there is a file, in the model's folder or else in the asset root.
    ///
    /// On a disk, names are relative to one of these folders, or absolute and within one of them. They are first
    /// resolved lexically, so that names outside are rejected without accessing them; then symbolic links are followed,
    /// whose targets must be within the folders as well. If there is no file of any of the names, one whose name
    /// differs by upper and lower case is found. A resolver gets relative names only, which do not leave the folder.
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
        match &self.source {
            Source::Disk { listings, .. } => self.find_on_disk(names, listings),
            Source::Resolver { resolve, found } => self.find_by_resolver(names, *resolve, found),
        }
    }

    fn find_on_disk(&self, names: &[PathBuf], listings: &RefCell<Listings>) -> Result<PathBuf, LoadError> {
        let roots = self.roots()?;
        let within = |path: &Path| {
            roots.iter().find_map(|(typed, real)| path.strip_prefix(real).ok().map(|rest| typed.join(rest)))
        };
        let is_within = |path: &Path| fs::canonicalize(path).is_ok_and(|real| within(&real).is_some());
        let mut outside = false;
        let mut absent = Vec::new();
        for name in names {
            for (_, base) in roots {
                let Some(path) = folded(&base.join(name)).filter(|path| within(path).is_some()) else {
                    outside = true;
                    continue;
                };
                match fs::canonicalize(&path) {
                    Ok(real) if within(&real).is_some() => return Ok(within(&path).unwrap_or(path)),
                    Ok(_) => outside = true,
                    Err(_) => absent.push(path),
                }
            }
        }
        for path in absent {
            let root = roots.iter().find(|(_, real)| path.starts_with(real)).map(|(_, real)| real);
            let found = root.and_then(|root| listings.borrow_mut().find(root, &path, &is_within));
            if let Some(found) = found {
                return Ok(within(&found).unwrap_or(found));
            }
        }
        let name = first_name(names);
        Err(if outside {
            LoadError::Outside { path: self.model.to_owned(), name }
        } else {
            LoadError::Read { path: roots[0].0.join(name), source: io::ErrorKind::NotFound.into() }
        })
    }

    fn find_by_resolver(
        &self,
        names: &[PathBuf],
        resolve: &Resolver,
        found: &RefCell<HashMap<PathBuf, Vec<u8>>>,
    ) -> Result<PathBuf, LoadError> {
        let mut outside = false;
        let mut failed = None;
        let mut tried: Vec<String> = Vec::new();
        for name in names {
            let Some(name) = relative(&name.to_string_lossy()) else {
                outside = true;
                continue;
            };
            if tried.contains(&name) {
                continue;
            }
            tried.push(name.clone());
            let path = PathBuf::from(&name);
            if found.borrow().contains_key(&path) {
                return Ok(path);
            }
            match resolve(&name) {
                Ok(bytes) => {
                    let count = self.bytes.get().saturating_add(bytes.len() as u64);
                    let limit = self.limits.file_bytes;
                    if count > limit {
                        let what = "bytes in the file, with those before it";
                        return Err(LoadError::TooLarge { path, what, count, limit });
                    }
                    self.bytes.set(count);
                    found.borrow_mut().insert(path.clone(), bytes);
                    return Ok(path);
                }
                Err(source) if source.kind() == io::ErrorKind::NotFound => {}
                Err(source) => failed = failed.or(Some(LoadError::Read { path, source })),
            }
        }
        let name = first_name(names);
        Err(match failed {
            Some(error) => error,
            None if outside => LoadError::Outside { path: self.model.to_owned(), name },
            None => LoadError::Read { path: name.into(), source: io::ErrorKind::NotFound.into() },
        })
    }

    /// The names relative to the folder of another file, followed by the names themselves.
    #[cfg(feature = "obj")]
    pub fn beside(&self, file: &Path, names: Vec<PathBuf>) -> Vec<PathBuf> {
        let folder = file.parent().unwrap_or(Path::new(""));
        let folder = match &self.source {
            Source::Resolver { .. } => (folder != Path::new("")).then(|| folder.to_owned()),
            Source::Disk { .. } => {
                let own = self.roots().ok().and_then(|roots| roots.first());
                let folder = fs::canonicalize(if folder == Path::new("") { Path::new(".") } else { folder });
                folder.ok().filter(|folder| own.is_some_and(|(_, own)| own != folder))
            }
        };
        match folder {
            Some(folder) => names.iter().map(|name| folder.join(name)).chain(names.iter().cloned()).collect(),
            None => names,
        }
    }

    fn roots(&self) -> Result<&[(PathBuf, PathBuf)], LoadError> {
        let Source::Disk { asset_root, roots: known, .. } = &self.source else { return Ok(&[]) };
        if let Some(roots) = known.get() {
            return Ok(roots);
        }
        let own = self.model.parent().unwrap_or(Path::new(""));
        let mut roots = Vec::with_capacity(2);
        for root in [Some(own), *asset_root].into_iter().flatten() {
            let asked = if root == Path::new("") { Path::new(".") } else { root };
            let real = fs::canonicalize(asked).map_err(|source| LoadError::Read { path: root.to_owned(), source })?;
            roots.push((root.to_owned(), real));
        }
        Ok(known.get_or_init(|| roots))
    }

    /// Reads a file that was [found](Self::find). The total size of all files is limited by [`Limits::file_bytes`].
    pub fn read(&self, file: &Path) -> Result<Vec<u8>, LoadError> {
        if let Source::Resolver { found, .. } = &self.source {
            // Counted when it was found. A file that is read again is asked for again.
            let taken = found.borrow_mut().remove(file);
            return match taken {
                Some(bytes) => Ok(bytes),
                None => {
                    self.find(&[file.to_owned()])?;
                    Ok(found.borrow_mut().remove(file).unwrap_or_default())
                }
            };
        }
        let left = self.limits.file_bytes.saturating_sub(self.bytes.get());
        let bytes = read_file(file, &Limits { file_bytes: left, ..*self.limits })?;
        self.bytes.set(self.bytes.get() + bytes.len() as u64);
        Ok(bytes)
    }
}

fn first_name(names: &[PathBuf]) -> String {
    shortened(&names.first().map_or(Path::new(""), PathBuf::as_path).to_string_lossy())
}

/// A name with `/` between folders and without `.` and `..`; `None` if it is absolute or leads above its folder.
fn relative(name: &str) -> Option<String> {
    let name = name.replace('\\', "/");
    if name.starts_with('/') || name.as_bytes().get(1) == Some(&b':') {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resolver_gets_relative_names() {
        for (name, expected) in [
            ("a.png", Some("a.png")),
            ("./t/./a.png", Some("t/a.png")),
            ("t/../a.png", Some("a.png")),
            ("t\\a.png", Some("t/a.png")),
            ("..", None),
            ("../a.png", None),
            ("t/../../a.png", None),
            ("..\\a.png", None),
            ("/a.png", None),
            ("\\a.png", None),
            ("C:\\a.png", None),
            ("C:a.png", None),
            ("", None),
            (".", None),
        ] {
            assert_eq!(relative(name).as_deref(), expected, "{name}");
        }
    }
}
