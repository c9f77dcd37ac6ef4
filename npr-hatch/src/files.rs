//! Atomic writing of files, and reading with a size limit.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Writes a file atomically: on failure an existing file is unchanged.
///
/// The bytes are written to a temporary file `.npr-….part` in the same folder, which is then renamed. It is removed on
/// failure, but may remain if the process is killed. Symbolic links are followed and kept. Pipes and devices are written
/// to directly.
///
/// # Errors
/// Errors of the operating system; also if the folder does not exist, or if the path is a folder or a write-protected file.
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
    let mut builder = tempfile::Builder::new();
    builder.prefix(".npr-").suffix(".part");
    // Readable by others as far as the umask allows, like any new file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut part = builder.tempfile_in(folder(&target))?;
    part.as_file_mut().write_all(bytes)?;
    // The permissions of an existing file are kept.
    if let Ok(old) = fs::metadata(&target) {
        part.as_file().set_permissions(old.permissions())?;
    }
    part.persist(&target)?;
    Ok(())
}

/// Checks whether [`write_file`] can write to a path, as far as this is known in advance.
///
/// # Errors
/// Those of [`write_file`] that do not depend on writing.
pub fn check_writable(path: &Path) -> io::Result<()> {
    target(path).map(|_| ())
}

/// Reads a regular file of at most `most_bytes` bytes. Pipes and devices are refused, since they may block or be endless.
///
/// # Errors
/// Errors of the operating system; also if the file is not regular or is longer.
pub fn read_file(path: &Path, most_bytes: u64) -> io::Result<Vec<u8>> {
    // Checked before opening, since opening a pipe may block.
    let found = fs::metadata(path)?;
    if !found.is_file() {
        return Err(io::Error::other("not a regular file"));
    }
    let too_long = || {
        let what = format!("more than the limit of {most_bytes} bytes");
        io::Error::new(io::ErrorKind::FileTooLarge, what)
    };
    if found.len() > most_bytes {
        return Err(too_long());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(found.len()).unwrap_or(0));
    // The file may grow after its length was read.
    File::open(path)?.take(most_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes { Err(too_long()) } else { Ok(bytes) }
}

enum Target {
    Whole(PathBuf),
    Stream,
}

/// The file that a path refers to. Symbolic links are resolved, so that the link itself is not replaced.
fn target(path: &Path) -> io::Result<Target> {
    if path.file_name().is_none() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not the name of a file"));
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
                    let what = format!("{} is not a folder", folder.display());
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

#[cfg(test)]
mod tests {
    use super::*;

    fn temporary_folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a folder can be created")
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort_unstable();
        names
    }

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside() {
        let folder = temporary_folder();
        let path = folder.path().join("a");
        for bytes in [&b"first"[..], b"", b"second"] {
            write_file(&path, bytes).expect("written");
            assert_eq!(fs::read(&path).expect("there"), bytes);
            assert_eq!(names(folder.path()), ["a"]);
        }
    }

    #[test]
    fn what_cannot_be_a_file_is_refused_and_stays() {
        let folder = temporary_folder();
        let old = folder.path().join("old");
        fs::write(&old, b"old").expect("written");
        let mut permissions = fs::metadata(&old).expect("there").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&old, permissions).expect("set");
        fs::create_dir(folder.path().join("folder")).expect("made");
        let long = "n".repeat(400);
        let cases = [
            ("old", io::ErrorKind::PermissionDenied, "write-protected"),
            ("folder", io::ErrorKind::IsADirectory, "a folder"),
            ("none/a", io::ErrorKind::NotFound, "none does not exist"),
            ("old/a", io::ErrorKind::NotADirectory, ""),
            ("folder/..", io::ErrorKind::InvalidInput, "not the name of a file"),
            (&long, io::ErrorKind::InvalidFilename, ""),
        ];
        for (name, kind, said) in cases {
            let path = folder.path().join(name);
            let error = write_file(&path, b"new").expect_err(name);
            assert_eq!(error.kind(), kind, "{name}: {error}");
            assert!(error.to_string().contains(said), "{name}: {error}");
            let checked = check_writable(&path).expect_err(name);
            assert_eq!(checked.to_string(), error.to_string(), "{name}");
        }
        assert_eq!(names(folder.path()), ["folder", "old"]);
        assert_eq!(fs::read(&old).expect("there"), b"old");
    }

    #[test]
    fn only_regular_files_within_the_bound_are_read() {
        let folder = temporary_folder();
        let path = folder.path().join("a");
        fs::write(&path, b"12345").expect("written");
        assert_eq!(read_file(&path, 5).expect("read"), b"12345");
        assert_eq!(read_file(&path, 4).expect_err("too long").kind(), io::ErrorKind::FileTooLarge);
        for (path, said) in [(folder.path(), "regular"), (&*folder.path().join("none"), "")] {
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
        let folder = temporary_folder();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
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
