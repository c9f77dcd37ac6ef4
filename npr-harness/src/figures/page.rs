//! The files of `npr figures`: pictures, style files, and a page with the captions.

use super::{Content, Drawn, picture_file};
use crate::error::HarnessError;
use npr_hatch::files::write_file;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Writes a figure's picture and the style files of its panels into `dir`, which exists.
///
/// # Errors
/// [`HarnessError::Write`], [`HarnessError::Image`].
fn write_figure(dir: &Path, drawn: &Drawn) -> Result<PathBuf, HarnessError> {
    let path = picture_file(dir, &drawn.figure);
    drawn.image.save_png(&path)?;
    for (number, panel) in drawn.figure.panels.iter().enumerate() {
        if let Content::Style { toml, .. } = &panel.content {
            text(&dir.join(style_file(drawn.figure.name, number)), toml)?;
        }
    }
    Ok(path)
}

/// Writes all of it: each figure, and `index.html`, which shows them with their captions.
///
/// # Errors
/// [`HarnessError::Write`], [`HarnessError::Image`].
pub fn write(dir: &Path, all: &[Drawn], made_by: &str) -> Result<Vec<PathBuf>, HarnessError> {
    std::fs::create_dir_all(dir).map_err(|source| HarnessError::Write { path: dir.to_owned(), source })?;
    let mut paths = all.iter().map(|drawn| write_figure(dir, drawn)).collect::<Result<Vec<_>, _>>()?;
    let index = dir.join("index.html");
    text(&index, &html(all, made_by))?;
    paths.push(index);
    Ok(paths)
}

fn style_file(figure: &str, panel: usize) -> String {
    format!("{figure}-{}.toml", panel + 1)
}

fn text(path: &Path, text: &str) -> Result<(), HarnessError> {
    write_file(path, text.as_bytes()).map_err(|source| HarnessError::Write { path: path.to_owned(), source })
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn html(all: &[Drawn], made_by: &str) -> String {
    let mut page = String::from(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>npr: figures</title>\n<style>\n\
         body { font: 16px/1.5 sans-serif; max-width: 1500px; margin: 2em auto; padding: 0 1em }\n\
         figure { margin: 0 0 3em } img { max-width: 100% }\n</style>\n<h1>Figures</h1>\n",
    );
    // Writing to a String cannot fail.
    let _ = writeln!(page, "<p>Made on {}.</p>", escaped(made_by));
    for Drawn { figure, why_cpu, .. } in all {
        let _ = writeln!(page, "<figure id=\"{}\">\n<h2>{}</h2>", figure.name, escaped(figure.shows));
        let _ = writeln!(page, "<img src=\"{0}.png\" alt=\"{1}\">", figure.name, escaped(figure.shows));
        let _ = writeln!(page, "<figcaption><p>{}</p>\n<ol>", escaped(figure.caption));
        for (number, panel) in figure.panels.iter().enumerate() {
            let legend = escaped(panel.legend);
            let _ = match &panel.content {
                Content::Style { .. } => {
                    writeln!(page, "<li><a href=\"{}\">{legend}</a></li>", style_file(figure.name, number))
                }
                Content::Difference(_) | Content::Drawn(_) => writeln!(page, "<li>{legend}</li>"),
            };
        }
        let _ = writeln!(page, "</ol>");
        if let Some(why) = why_cpu {
            let _ = writeln!(page, "<p>A panel is by the CPU: {}</p>", escaped(&why.to_string()));
        }
        let _ = writeln!(page, "</figcaption>\n</figure>");
    }
    page.push_str("</html>\n");
    page
}
