//! Styles as TOML: `npr style NAME` prints one, `--style FILE.toml` reads one.
//!
//! What is left out has its default; a key that is not known is an error that names it. Colours are `[r, g, b]`, 0 to 1,
//! or `"#rrggbb"`. Images are PNG files, named relative to the style's file.

use super::Style;
use super::form::StyleForm;
use crate::compare::ImageError;
use npr_hatch::files::read_file;
use std::io;
use std::path::{Path, PathBuf};

/// Longer files are no styles.
const MOST_BYTES: u64 = 1 << 20;

/// Why a style could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StyleFileError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It is not TOML, or has keys or values that a style does not have.
    #[error("{}:{line}:{column}: {message}", path.display())]
    Toml {
        /// Which file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// In the parser's words.
        message: String,
    },
    /// It is TOML, but says something twice or not at all.
    #[error("{}: {what}", path.display())]
    Form {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A rule of the shade or the lights is broken.
    #[error("{}: {source}", path.display())]
    Rule {
        /// Which file.
        path: PathBuf,
        /// Which rule.
        source: Box<crate::error::HarnessError>,
    },
    /// A ramp's image.
    #[error("a ramp's image: {0}")]
    Image(#[from] ImageError),
    /// A style that has no TOML form.
    #[error("a style could not be written: {0}")]
    Write(#[from] toml::ser::Error),
}

impl Style {
    /// Reads a style and checks it. Without a name it is called what the file is.
    ///
    /// # Errors
    /// [`StyleFileError`].
    pub fn read(path: &Path) -> Result<Self, StyleFileError> {
        let text = read_text(path).map_err(|source| StyleFileError::Read { path: path.to_owned(), source })?;
        Self::from_toml(&text, path)
    }

    /// A style from the text of a file that stands, or would stand, at `path`.
    ///
    /// # Errors
    /// [`StyleFileError`], but for [`StyleFileError::Read`].
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, StyleFileError> {
        let form: StyleForm = toml::from_str(text).map_err(|error| {
            let before = &text[..error.span().map_or(0, |span| span.start.min(text.len()))];
            let line = before.rsplit('\n').next().unwrap_or("");
            StyleFileError::Toml {
                path: path.to_owned(),
                line: before.matches('\n').count() + 1,
                column: line.chars().count() + 1,
                message: error.message().trim().replace('\n', ", "),
            }
        })?;
        let style = form.style(path)?;
        style.validate().map_err(|source| StyleFileError::Rule { path: path.to_owned(), source: Box::new(source) })?;
        Ok(style)
    }

    /// The style as the text of a file. Images are written as texels.
    ///
    /// # Errors
    /// [`StyleFileError::Write`].
    pub fn to_toml(&self) -> Result<String, StyleFileError> {
        Ok(toml::to_string(&StyleForm::new(self))?)
    }
}

fn read_text(path: &Path) -> io::Result<String> {
    let text = String::from_utf8(read_file(path, MOST_BYTES)?);
    text.map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is no UTF-8 text"))
}
