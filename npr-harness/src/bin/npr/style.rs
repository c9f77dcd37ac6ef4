//! `npr styles`, `npr style`, and the style that a flag names.

use crate::paths;
use crate::terminal::say;
use npr_harness::error::{HarnessError, PathRole};
use npr_harness::style::{Style, style, styles};
use npr_harness::suggest::nearest;
use std::path::Path;

pub fn list() -> Result<bool, HarnessError> {
    for style in styles() {
        say(format_args!("{:<16}{}\n", style.name, style.about))?;
    }
    Ok(true)
}

pub fn print(name: &str) -> Result<bool, HarnessError> {
    say(format_args!("{}", known_style(name)?.to_toml()?))?;
    Ok(true)
}

/// The file that a style's name denotes: a name that ends in `.toml` is a file.
pub fn style_file(name: &str) -> Option<&Path> {
    let path = Path::new(name);
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")).then_some(path)
}

pub fn known_style(name: &str) -> Result<Style, HarnessError> {
    if let Some(path) = style_file(name) {
        paths::check_file(PathRole::Style, path)?;
        return Style::read(path);
    }
    style(name).ok_or_else(|| {
        let known: Vec<String> = styles().into_iter().map(|style| style.name).collect();
        let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
        HarnessError::UnknownStyle { name: name.to_owned(), nearest, known: known.join(", ") }
    })
}
