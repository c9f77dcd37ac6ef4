//! The files of `npr figures`: pictures, style files, and a page with the captions.

use super::{Content, Drawn, all, picture_file};
use crate::error::HarnessError;
use crate::gallery::Row;
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

/// Writes figures into `dir`, and if they are all there are `index.html`, which shows them with their captions.
///
/// # Errors
/// [`HarnessError::Write`], [`HarnessError::Image`].
pub fn write(dir: &Path, drawn: &[Drawn], made_by: &str) -> Result<Vec<PathBuf>, HarnessError> {
    std::fs::create_dir_all(dir).map_err(|source| HarnessError::Write { path: dir.to_owned(), source })?;
    let mut paths = drawn.iter().map(|drawn| write_figure(dir, drawn)).collect::<Result<Vec<_>, _>>()?;
    if drawn.len() == all().len() {
        let index = dir.join("index.html");
        text(&index, &html(drawn, made_by))?;
        paths.push(index);
    }
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

/// The page of a gallery in `dir`: its pictures, and the figures that lie in `dir/figures`.
///
/// # Errors
/// [`HarnessError::Write`].
pub fn write_gallery(dir: &Path, rows: &[Row], made_by: &str) -> Result<PathBuf, HarnessError> {
    let mut page = head("Gallery", made_by);
    // Writing to a String cannot fail.
    for row in rows {
        let file = row.path.file_name().unwrap_or_default().to_string_lossy();
        let (about, passes) = (escaped(&row.about), escaped(&row.passes.join("; ")));
        let _ = writeln!(page, "<figure>\n<img src=\"{file}\" alt=\"{about}\">");
        let _ = writeln!(page, "<figcaption><p>{}: {about}. {passes}</p></figcaption>\n</figure>", escaped(&file));
    }
    let _ = writeln!(page, "<h1>Figures of the sources</h1>");
    let drawn: Vec<_> =
        all().into_iter().filter(|figure| picture_file(&dir.join("figures"), figure).is_file()).collect();
    for figure in &drawn {
        let shows = escaped(figure.shows);
        let _ = writeln!(page, "<figure>\n<h2>{shows}</h2>\n<img src=\"figures/{}.png\" alt=\"{shows}\">", figure.name);
        let _ = writeln!(page, "<figcaption><p>{}</p></figcaption>\n</figure>", escaped(figure.caption));
    }
    if drawn.is_empty() {
        let _ = writeln!(page, "<p><code>npr figures -o {}/figures</code> draws them.</p>", dir.display());
    }
    page.push_str("</html>\n");
    let path = dir.join("index.html");
    text(&path, &page)?;
    Ok(path)
}

fn head(title: &str, made_by: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>npr: {title}</title>\n<style>\n\
         body {{ font: 16px/1.5 sans-serif; max-width: 1500px; margin: 2em auto; padding: 0 1em }}\n\
         figure {{ margin: 0 0 3em }} img {{ max-width: 100% }}\n</style>\n<h1>{title}</h1>\n<p>Made on {}.</p>\n",
        escaped(made_by)
    )
}

fn html(all: &[Drawn], made_by: &str) -> String {
    let mut page = head("Figures", made_by);
    // Writing to a String cannot fail.
    for Drawn { figure, why_cpu, .. } in all {
        let _ = writeln!(page, "<figure id=\"{}\">\n<h2>{}</h2>", figure.name, escaped(figure.shows));
        let _ = writeln!(page, "<img src=\"{0}.png\" alt=\"{1}\">", figure.name, escaped(figure.shows));
        let _ = writeln!(page, "<figcaption><p>{}</p>\n<ol>", escaped(figure.caption));
        for (number, panel) in figure.panels.iter().enumerate() {
            let legend = escaped(panel.legend);
            let _ = match &panel.content {
                Content::Style { setting, .. } => {
                    let file = style_file(figure.name, number);
                    writeln!(page, "<li><a href=\"{file}\">{legend}</a> ({})</li>", setting.about())
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
