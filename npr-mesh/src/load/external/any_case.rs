//! Finds files whose names differ by upper and lower case, since models are exchanged between systems that
//! distinguish the two and systems that do not.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// The maximum number of entries that are looked at in all folders.
const MOST_ENTRIES: usize = 100_000;

/// The entries of folders, each read once.
#[derive(Default)]
pub(super) struct Listings {
    /// By folder: the names of its entries by their lower-case form.
    folders: HashMap<PathBuf, HashMap<String, OsString>>,
    entries: usize,
}

impl Listings {
    /// The path of an existing file that differs from `path` by case at most. Both are in `root`; a folder is read only
    /// if `is_within` says that it is within the allowed folders, with symbolic links followed.
    ///
    /// Of several files that differ by case, the first one in the order of their bytes is returned.
    pub fn find(&mut self, root: &Path, path: &Path, is_within: &dyn Fn(&Path) -> bool) -> Option<PathBuf> {
        let mut at = root.to_owned();
        for component in path.strip_prefix(root).ok()?.components() {
            let wanted = component.as_os_str();
            let exact = at.join(wanted);
            if exact.exists() && is_within(&exact) {
                at = exact;
                continue;
            }
            let name = self.folder(&at)?.get(&wanted.to_str()?.to_lowercase())?;
            at.push(name);
            if !is_within(&at) {
                return None;
            }
        }
        Some(at)
    }

    fn folder(&mut self, folder: &Path) -> Option<&HashMap<String, OsString>> {
        if !self.folders.contains_key(folder) {
            let mut names: HashMap<String, OsString> = HashMap::new();
            for entry in fs::read_dir(folder).ok()?.take(MOST_ENTRIES.saturating_sub(self.entries)) {
                self.entries += 1;
                let name = entry.ok()?.file_name();
                let Some(lower) = name.to_str().map(str::to_lowercase) else { continue };
                let known = names.entry(lower).or_insert_with(|| name.clone());
                if name < *known {
                    *known = name;
                }
            }
            self.folders.insert(folder.to_owned(), names);
        }
        self.folders.get(folder)
    }
}
