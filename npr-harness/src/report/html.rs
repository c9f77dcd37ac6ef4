//! Text and pictures in HTML.

use super::PngPicture;
use base64::prelude::{BASE64_STANDARD, Engine};

/// Escapes text for an element or a quoted attribute.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;").replace('\'', "&#39;")
}

/// An embedded picture.
pub fn picture(picture: &PngPicture, alt: &str) -> String {
    let PngPicture { width, height, png } = picture;
    format!(
        "<img src=\"data:image/png;base64,{}\" alt=\"{}\" width=\"{width}\" height=\"{height}\">",
        BASE64_STANDARD.encode(png),
        escaped(alt)
    )
}

/// A number in few digits.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        "–".into()
    } else if value.is_infinite() {
        if value > 0.0 { "∞".into() } else { "−∞".into() }
    } else {
        crate::plot::number(value)
    }
}

/// A whole number with its thousands apart.
pub fn thousands(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (n, digit) in digits.chars().enumerate() {
        if n > 0 && (digits.len() - n).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A column of a table.
pub struct Column {
    /// Its heading.
    pub title: String,
    /// Whether it has numbers, which are at the right and sorted by value.
    pub is_number: bool,
}

impl Column {
    /// A column of text.
    pub fn text(title: &str) -> Self {
        Self { title: title.into(), is_number: false }
    }

    /// A column of numbers.
    pub fn number(title: &str) -> Self {
        Self { title: title.into(), is_number: true }
    }
}

/// A field of a table.
pub struct Field {
    /// What it shows, as HTML.
    pub html: String,
    /// The number that it is sorted by.
    pub value: Option<f64>,
}

impl Field {
    /// Text, escaped.
    pub fn text(text: &str) -> Self {
        Self { html: escaped(text), value: None }
    }

    /// A number in few digits.
    pub fn number(value: f64) -> Self {
        Self::shown(value, &number(value))
    }

    /// A number with its text.
    pub fn shown(value: f64, text: &str) -> Self {
        Self { html: escaped(text), value: Some(value) }
    }
}

/// A row of a table.
pub struct TableRow {
    /// The class of the row; empty for none.
    pub class: &'static str,
    /// Its fields.
    pub fields: Vec<Field>,
}

/// A table in a box that scrolls by itself; its columns can be sorted.
pub fn table(id: &str, caption: &str, columns: &[Column], rows: &[TableRow]) -> String {
    let caption = escaped(caption);
    let mut text = format!(
        "<div class=\"scroll\" role=\"region\" aria-label=\"{caption}\" tabindex=\"0\">\n<table id=\"{id}\" \
         class=\"sortable\">\n<caption>{caption}</caption>\n<thead><tr>"
    );
    for Column { title, is_number } in columns {
        let class = if *is_number { " class=\"number\"" } else { "" };
        text.push_str(&format!("<th scope=\"col\"{class}><button type=\"button\">{}</button></th>", escaped(title)));
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for TableRow { class, fields } in rows {
        text.push_str(&if class.is_empty() { "<tr>".into() } else { format!("<tr class=\"{class}\">") });
        for (n, (Field { html, value }, column)) in fields.iter().zip(columns).enumerate() {
            let class = if column.is_number { " class=\"number\"" } else { "" };
            let value = value.map(|value| format!(" data-value=\"{value}\"")).unwrap_or_default();
            // The first column names the row.
            let (tag, scope) = if n == 0 { ("th", " scope=\"row\"") } else { ("td", "") };
            text.push_str(&format!("<{tag}{scope}{class}{value}>{html}</{tag}>"));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody></table></div>\n");
    text
}
