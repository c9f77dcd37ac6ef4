//! Styles as TOML: `npr style NAME` prints one, `--style FILE.toml` reads one.
//!
//! Omitted keys have defaults; an unknown key is an error that names it. Colours are `[r, g, b]`, 0 to 1, or
//! `"#rrggbb"`. Images are PNG files, whose paths are relative to the style's file.

use super::Style;
use super::schema::StyleTable;
use crate::error::HarnessError;
use crate::suggest::nearest;
use npr_hatch::files::read_file;
use std::io;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// The largest file that is read, bytes.
const MOST_BYTES: u64 = 1 << 20;

impl Style {
    /// Reads and validates a style. A style without a name gets the name of its file.
    ///
    /// # Errors
    /// [`HarnessError::Read`], and those of [`Style::from_toml`].
    pub fn read(path: &Path) -> Result<Self, HarnessError> {
        let text = read_text(path).map_err(|source| HarnessError::Read { path: path.to_owned(), source })?;
        Self::from_toml(&text, path)
    }

    /// Parses a style from the text of a file at `path`, which need not exist.
    ///
    /// # Errors
    /// [`HarnessError::StyleToml`], [`HarnessError::TwoKinds`], [`HarnessError::StyleTable`],
    /// [`HarnessError::StyleRule`], [`HarnessError::RampImage`].
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, HarnessError> {
        let failed = |error: toml::de::Error| {
            let (line, column) = position(text, error.span().map_or(0, |span| span.start));
            let message = with_suggestion(error.message().trim()).replace('\n', ", ");
            HarnessError::StyleToml { path: path.to_owned(), line, column, message }
        };
        let document = DeTable::parse(text).map_err(failed)?;
        for (table, what) in ONE_KIND {
            let Some([(_, first), (start, second)]) = two_kinds(document.get_ref(), table) else { continue };
            let (line, column) = position(text, start);
            return Err(HarnessError::TwoKinds { path: path.to_owned(), line, column, what, table, first, second });
        }
        let table: StyleTable = toml::from_str(text).map_err(failed)?;
        let style = table.style(path)?;
        style
            .validate()
            .map_err(|source| HarnessError::StyleRule { path: path.to_owned(), source: Box::new(source) })?;
        Ok(style)
    }

    /// Writes the style as TOML. Images are written as texels.
    ///
    /// # Errors
    /// [`HarnessError::StyleWrite`].
    pub fn to_toml(&self) -> Result<String, HarnessError> {
        Ok(toml::to_string(&StyleTable::new(self))?)
    }
}

/// Tables that contain exactly one table, whose key selects a variant.
const ONE_KIND: [(&str, &str); 4] = [
    ("shade", "shade"),
    ("lines.image.shadows", "lines around shadows"),
    ("lines.image.shadows.separate.composite", "composite of lines around shadows"),
    ("lines.image.composite", "composite of lines"),
];

/// The first two keys of a table with their offsets, if it has more than one key.
fn two_kinds(document: &DeTable<'_>, table: &str) -> Option<[(usize, String); 2]> {
    let table = table.split('.').try_fold(document, |outer, key| match outer.get(key)?.get_ref() {
        DeValue::Table(inner) => Some(inner),
        _ => None,
    })?;
    let mut keys: Vec<_> = table.keys().map(|key| (key.span().start, key.get_ref().to_string())).collect();
    keys.sort_unstable();
    keys.truncate(2);
    keys.try_into().ok()
}

/// Line and column, both from 1, of an offset.
fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..offset.min(text.len())];
    let line = before.rsplit('\n').next().unwrap_or("");
    (before.matches('\n').count() + 1, line.chars().count() + 1)
}

/// Adds a suggestion to an error if the parser lists the known names: "unknown field `a`, expected one of `b`, `c`".
fn with_suggestion(message: &str) -> String {
    // serde's message for an empty table that should select a variant.
    if message.starts_with("wanted exactly 1 element, found 0") {
        return "the table is empty: it holds one table, whose name says of which kind it is".to_owned();
    }
    // serde's message for the name of a kind that has a table, and the reverse.
    if message.contains("unit variant, expected") {
        return "this kind has a table of its own: write it as a table, such as [shade.toon]".to_owned();
    }
    let unknown = ["unknown field `", "unknown variant `"].iter().find_map(|&start| {
        let (name, known) = message.strip_prefix(start)?.split_once("`, expected ")?;
        Some((start, name, known))
    });
    let suggested = unknown.and_then(|(start, name, known)| {
        let nearest = nearest(name, known.split('`').skip(1).step_by(2))?;
        Some(format!("{start}{name}` (did you mean `{nearest}`?), expected {known}"))
    });
    suggested.unwrap_or_else(|| message.to_owned())
}

fn read_text(path: &Path) -> io::Result<String> {
    let text = String::from_utf8(read_file(path, MOST_BYTES)?);
    text.map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is no UTF-8 text"))
}
