//! What several tests need.
#![allow(dead_code, clippy::print_stdout)]

use npr_harness::executor::{Backend, Executor};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// The device executor, or `None`, saying so, where `NPR_GPU` allows that there is none.
///
/// # Panics
/// If `NPR_GPU=required` and there is no adapter.
pub fn device() -> Option<Executor> {
    let executor = Executor::choose(Backend::Auto).unwrap_or_else(|error| panic!("{error}"));
    if let Executor::Cpu { why } = &executor {
        println!("skipped: {}", why.as_deref().unwrap_or("no device"));
        return None;
    }
    Some(executor)
}

/// A fresh folder that goes when the test is over.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let name = format!("npr-test-{}-{}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("a folder can be made");
        Self(path)
    }

    pub fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Models that are not part of this repository, if they are there.
pub fn shared_models() -> Option<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    if !folder.is_dir() {
        println!("skipped: no models at {}", folder.display());
        return None;
    }
    Some(folder.to_owned())
}
