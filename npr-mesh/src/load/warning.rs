//! Warnings, counted.

use std::collections::HashMap;
use std::fmt;

/// The maximum number of different warnings.
const MOST: usize = 100;

/// Something that was repaired or skipped, and the number of occurrences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// A single line without the name of the model.
    pub text: String,
    /// At least 1.
    pub count: u64,
}

impl Warning {
    /// Counts equal lines. If there are more than [`MOST`] different lines, the last one states how many were
    /// omitted.
    pub(super) fn counted(lines: Vec<String>) -> Vec<Self> {
        let mut index_of = HashMap::new();
        let mut warnings: Vec<Self> = Vec::new();
        for line in lines {
            let index = *index_of.entry(line).or_insert_with_key(|line| {
                warnings.push(Self { text: escaped(line), count: 0 });
                warnings.len() - 1
            });
            warnings[index].count += 1;
        }
        let more = warnings.len().saturating_sub(MOST);
        if more > 1 {
            warnings.truncate(MOST);
            warnings.push(format!("and {more} more").into());
        }
        warnings
    }
}

/// Names in files may contain control characters; a warning must remain a single line.
fn escaped(line: &str) -> String {
    if !line.chars().any(char::is_control) {
        return line.to_owned();
    }
    line.chars().flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] }).collect()
}

impl From<String> for Warning {
    fn from(text: String) -> Self {
        Self { text, count: 1 }
    }
}

/// The text, followed by the count if it is above 1.
impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { text, count } = self;
        if *count == 1 { write!(f, "{text}") } else { write!(f, "{text} ({count} times)") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(lines: &[&str]) -> Vec<String> {
        Warning::counted(lines.iter().map(|&line| line.to_owned()).collect()).iter().map(Warning::to_string).collect()
    }

    #[test]
    fn equal_lines_are_one_with_their_number_where_the_first_was() {
        assert_eq!(counted(&["b", "a", "b", "c", "b", "a"]), ["b (3 times)", "a (2 times)", "c"]);
        assert_eq!(counted(&[]), [""; 0]);
        assert_eq!(counted(&["a\nb\u{1b}[31m"]), ["a\\nb\\u{1b}[31m"]);
    }

    #[test]
    fn a_repeated_line_does_not_displace_another() {
        let lines = (0..300).map(|number| if number < 200 { "often".to_owned() } else { number.to_string() });
        let warnings = Warning::counted(lines.collect());
        assert_eq!((warnings.len(), warnings[0].to_string()), (101, "often (200 times)".to_owned()));
        assert_eq!(warnings[100].text, "299", "a single further warning is listed instead of counted");
        let many = Warning::counted((0..1000).map(|number| number.to_string()).collect());
        assert_eq!((many.len(), many[100].text.as_str()), (101, "and 900 more"));
    }
}
