//! The output of `npr render`.

use crate::paths::{check_output_file, unusable};
use crate::terminal::{say, tell};
use npr_harness::error::HarnessError;
use npr_harness::picture::{Image, PictureFormat};
use npr_hatch::files::{check_writable, write_file};
use std::io::{self, Write};
use std::path::Path;

/// The destination and format of a picture.
#[derive(Clone, Copy)]
pub enum Destination<'a> {
    /// A file, written atomically.
    File(&'a Path, PictureFormat),
    /// PNG on standard output.
    StandardOutput,
}

impl<'a> Destination<'a> {
    /// Checks that the output can be written and does not overwrite an input, before anything is computed.
    pub fn new(output: &'a Path, size: (u32, u32), inputs: &[&Path]) -> Result<Self, HarnessError> {
        if output == Path::new("-") {
            return Ok(Self::StandardOutput);
        }
        check_output_file(output, inputs)?;
        let format = PictureFormat::of_path(output);
        let format = format.ok_or_else(|| HarnessError::PictureFormat { path: output.to_owned() })?;
        let ((width, height), limit) = (size, format.largest_side());
        if width.max(height) > limit {
            return Err(HarnessError::FormatSize { width, height, format, limit });
        }
        check_writable(output).map_err(unusable(output))?;
        Ok(Self::File(output, format))
    }

    pub fn write(self, image: &Image) -> Result<(), HarnessError> {
        match self {
            Self::File(path, format) => write_file(path, &image.encode(format)?).map_err(unusable(path)),
            Self::StandardOutput => {
                let bytes = image.encode(PictureFormat::Png)?;
                let mut output = io::stdout().lock();
                output.write_all(&bytes).and_then(|()| output.flush()).map_err(unusable(Path::new("-")))
            }
        }
    }

    /// Writes the summary to a stream other than the picture's.
    pub fn summarize(self, summary: &str) -> Result<(), HarnessError> {
        match self {
            Self::File(..) => say(format_args!("{summary}")),
            Self::StandardOutput => {
                tell(summary.trim_end());
                Ok(())
            }
        }
    }
}
