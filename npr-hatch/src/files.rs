//! Files that are written as a whole or not at all, and read within bounds.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes all of a file, or leaves what is there as it is.
///
/// The bytes go to another file in the same folder, `.npr-PROCESS-NUMBER.part`, which is then renamed: whoever looks sees
/// the old file or the new one. Where that fails, the other file is removed; a process that is killed meanwhile may leave
/// it. A link is followed, and stays. Pipes and devices are written to as they are.
///
/// # Errors
/// What the system says; a folder that does not exist, a folder or a write-protected file where the file should be.
///
/// ```
/// let folder = std::env::temp_dir().join(format!("npr-write-{}", std::process::id()));
/// let path = folder.join("a.txt");
/// assert!(npr_hatch::files::write_file(&path, b"whole").is_err()); // there is no such folder
/// std::fs::create_dir_all(&folder)?;
/// npr_hatch::files::write_file(&path, b"whole")?;
/// assert_eq!(std::fs::read(&path)?, b"whole");
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = match target(path)? {
        Target::Whole(target) => target,
        Target::Stream => return OpenOptions::new().write(true).open(path)?.write_all(bytes),
    };
    let (part, mut file) = part_beside(&target)?;
    let written = file.write_all(bytes).and_then(|()| {
        // What others may do with the file stays as it was.
        if let Ok(old) = fs::metadata(&target) {
            fs::set_permissions(&part, old.permissions())?;
        }
        drop(file);
        fs::rename(&part, &target)
    });
    if written.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&part);
    }
    written
}

/// Whether [`write_file`] has a place to write to, as far as can be told before.
///
/// # Errors
/// Those of [`write_file`], but for what only writing can tell.
pub fn check_place(path: &Path) -> io::Result<()> {
    target(path).map(|_| ())
}

/// All of a regular file of at most so many bytes: no pipe, which may have no end or keep one waiting, and no device.
///
/// # Errors
/// What the system says; a file that is not regular, or longer.
pub fn read_file(path: &Path, most_bytes: u64) -> io::Result<Vec<u8>> {
    // Asked before opening: to open a pipe may wait for ever.
    let found = fs::metadata(path)?;
    if !found.is_file() {
        return Err(io::Error::other("not a regular file"));
    }
    let too_long = || {
        let what = format!("more than the {most_bytes} bytes that such a file may have");
        io::Error::new(io::ErrorKind::FileTooLarge, what)
    };
    if found.len() > most_bytes {
        return Err(too_long());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(found.len()).unwrap_or(0));
    // A file may grow between the question and the reading.
    File::open(path)?.take(most_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes { Err(too_long()) } else { Ok(bytes) }
}

enum Target {
    Whole(PathBuf),
    Stream,
}

/// What a path means: its links followed, so that not they are replaced.
fn target(path: &Path) -> io::Result<Target> {
    if path.file_name().is_none() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no file's name"));
    }
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder")),
        Ok(there) if !there.is_file() => Ok(Target::Stream),
        Ok(there) if there.permissions().readonly() => {
            Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is write-protected"))
        }
        Ok(_) => fs::canonicalize(path).map(Target::Whole),
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        Err(_) => {
            let folder = folder(path);
            match fs::metadata(folder) {
                Ok(there) if there.is_dir() => Ok(Target::Whole(path.to_owned())),
                Ok(_) => {
                    let what = format!("{} is no folder", folder.display());
                    Err(io::Error::new(io::ErrorKind::NotADirectory, what))
                }
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    let what = format!("the folder {} does not exist", folder.display());
                    Err(io::Error::new(io::ErrorKind::NotFound, what))
                }
                Err(error) => Err(error),
            }
        }
    }
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A new file in a file's folder. Its name is short whatever the file's, so that it is never too long.
fn part_beside(target: &Path) -> io::Result<(PathBuf, File)> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    loop {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let part = folder(target).join(format!(".npr-{}-{number}.part", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&part) {
            Ok(file) => return Ok((part, file)),
            // Left by a process that had this number.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that goes when the test is over.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("npr-write-file-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).expect("a folder can be made");
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).expect("a folder");
            let mut names: Vec<_> =
                entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
            names.sort_unstable();
            names
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside() {
        let folder = Folder::new("replaced");
        let path = folder.0.join("a");
        for bytes in [&b"first"[..], b"", b"second"] {
            write_file(&path, bytes).expect("written");
            assert_eq!(fs::read(&path).expect("there"), bytes);
            assert_eq!(folder.names(), ["a"]);
        }
    }

    #[test]
    fn what_cannot_be_a_file_is_refused_and_stays() {
        let folder = Folder::new("refused");
        let old = folder.0.join("old");
        fs::write(&old, b"old").expect("written");
        let mut permissions = fs::metadata(&old).expect("there").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&old, permissions).expect("set");
        fs::create_dir(folder.0.join("folder")).expect("made");
        let long = "n".repeat(400);
        let cases = [
            ("old", io::ErrorKind::PermissionDenied, "write-protected"),
            ("folder", io::ErrorKind::IsADirectory, "a folder"),
            ("none/a", io::ErrorKind::NotFound, "none does not exist"),
            ("old/a", io::ErrorKind::NotADirectory, ""),
            ("folder/..", io::ErrorKind::InvalidInput, "no file's name"),
            (&long, io::ErrorKind::InvalidFilename, ""),
        ];
        for (name, kind, said) in cases {
            let path = folder.0.join(name);
            let error = write_file(&path, b"new").expect_err(name);
            assert_eq!(error.kind(), kind, "{name}: {error}");
            assert!(error.to_string().contains(said), "{name}: {error}");
            let checked = check_place(&path).expect_err(name);
            assert_eq!(checked.to_string(), error.to_string(), "{name}");
        }
        assert_eq!(folder.names(), ["folder", "old"]);
        assert_eq!(fs::read(&old).expect("there"), b"old");
    }

    #[test]
    fn only_regular_files_within_the_bound_are_read() {
        let folder = Folder::new("read");
        let path = folder.0.join("a");
        fs::write(&path, b"12345").expect("written");
        assert_eq!(read_file(&path, 5).expect("read"), b"12345");
        assert_eq!(read_file(&path, 4).expect_err("too long").kind(), io::ErrorKind::FileTooLarge);
        for (path, said) in [(&folder.0, "regular"), (&folder.0.join("none"), "")] {
            assert!(read_file(path, 5).expect_err("no file").to_string().contains(said));
        }
        #[cfg(unix)]
        for endless in ["/dev/zero", "/dev/tty"] {
            read_file(Path::new(endless), u64::MAX).expect_err(endless);
        }
        // What says that it has no bytes, and has some.
        #[cfg(target_os = "linux")]
        assert!(read_file(Path::new("/proc/self/status"), 9).is_err_and(|e| e.kind() == io::ErrorKind::FileTooLarge));
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_and_lead_to_the_new_file() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = Folder::new("links");
        let (file, link) = (folder.0.join("file"), folder.0.join("link"));
        fs::write(&file, b"old").expect("written");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("set");
        symlink("file", &link).expect("a link");
        write_file(&link, b"new").expect("written");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read(&file).expect("there"), b"new");
        assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o640);
        write_file(Path::new("/dev/null"), b"new").expect("a device takes anything");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_the_system_refuses_is_an_error() {
        let full = Path::new("/dev/full");
        if full.exists() {
            assert!(write_file(full, b"new").is_err(), "a full device");
        }
        // Nothing can be made in the kernel's own folder.
        assert!(write_file(Path::new("/proc/npr-no-such-file"), b"new").is_err());
    }
}
