//! The page as one HTML file without scripts, styles, fonts or pictures from elsewhere.

mod sections;

use super::Contents;
use super::html::escaped;
use crate::plot::palette;
use sections::Section;
use std::fmt::Write;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The page. Sections without content are left out.
pub fn page(contents: &Contents) -> String {
    let sections = sections::all(contents);
    let mut page = String::from(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>npr: laboratory report</title>\n\
         <style>\n:root {\n",
    );
    // Writing to a String cannot fail.
    for color in palette() {
        let [light, dark] = [color.light, color.dark].map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        let _ = writeln!(page, "  {}: light-dark({light}, {dark});", color.variable);
    }
    let _ = writeln!(page, "}}\n{STYLE}</style>\n</head>\n<body>");
    page.push_str("<a class=\"skip\" href=\"#content\">Skip to the content</a>\n<header>\n<div>\n");
    let _ = writeln!(page, "<h1>Laboratory report</h1>\n<p class=\"about\">npr {}</p>", env!("CARGO_PKG_VERSION"));
    page.push_str("</div>\n<button type=\"button\" id=\"theme\">Theme: system</button>\n</header>\n");
    page.push_str("<nav aria-label=\"Contents\">\n<ol>\n");
    for section in &sections {
        let _ = write!(page, "<li><a href=\"#{}\">{}</a>", section.id, section.title);
        if !section.parts.is_empty() {
            page.push_str("\n<ol>");
            for (id, title) in &section.parts {
                let _ = write!(page, "<li><a href=\"#{id}\">{}</a></li>", escaped(title));
            }
            page.push_str("</ol>\n");
        }
        page.push_str("</li>\n");
    }
    page.push_str("</ol>\n</nav>\n<main id=\"content\">\n");
    for section in &sections {
        let Section { id, title, html, .. } = section;
        let _ =
            writeln!(page, "<section id=\"{id}\" aria-labelledby=\"{id}-title\">\n<h2 id=\"{id}-title\">{title}</h2>");
        let _ = writeln!(page, "{html}</section>");
    }
    page.push_str("</main>\n<div id=\"tip\" role=\"tooltip\" hidden></div>\n<script>\n");
    page.push_str(SCRIPT);
    page.push_str("</script>\n</body>\n</html>\n");
    page
}
