//! `npr` without a command.

use crate::paths;
use crate::terminal::{announce, progress_bar, say};
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor};
use npr_harness::figures::write_gallery;
use npr_harness::gallery;
use std::path::Path;

/// All styles on the built-in scene.
pub fn run() -> Result<bool, HarnessError> {
    let folder = Path::new("npr-out");
    paths::check_output_folder(folder)?;
    let backend = Backend::Auto;
    let mut executor = Executor::choose_for(backend, &gallery::work())?;
    announce(&executor);
    say(format_args!("on {}\n", executor.describe()))?;
    let bar = progress_bar("gallery");
    let tell = |share| bar.set_position((share * 1000.0) as u64);
    let rows = gallery::render(&mut executor, backend, folder, &tell)?;
    bar.finish_and_clear();
    say(format_args!("{}", gallery::table(&rows)))?;
    let page = write_gallery(folder, &rows, &executor.describe().to_string())?;
    say(format_args!("{}\n", page.display()))?;
    Ok(true)
}
