//! `npr` without a command.

use crate::terminal::{announce, progress_bar};
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor};
use npr_harness::gallery;
use std::path::Path;

/// All styles on the built-in scene.
pub fn run() -> Result<bool, HarnessError> {
    let executor = Executor::choose(Backend::Auto)?;
    announce(&executor);
    println!("on {}", executor.describe());
    let bar = progress_bar("gallery");
    let rows = gallery::render(&executor, Path::new("npr-out"), &|share| bar.set_position((share * 1000.0) as u64))?;
    bar.finish_and_clear();
    print!("{}", gallery::table(&rows));
    Ok(true)
}
