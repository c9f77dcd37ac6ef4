//! Suggestions for misspelt names.

/// Longer names get no suggestion: no known name is so long, and the work grows with the product of the lengths.
const LONGEST: usize = 64;

/// The known name with the least edit distance to a name, the first among equals. At most one edit (insertion,
/// deletion, substitution, or transposition of neighbours) per three characters is allowed; case is ignored.
///
/// ```
/// use npr_harness::suggest::nearest;
/// assert_eq!(nearest("cartoom", ["lines", "cartoon"]), Some("cartoon"));
/// assert_eq!(nearest("watercolour", ["lines", "cartoon"]), None);
/// ```
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = name.chars().count();
    if length > LONGEST {
        return None;
    }
    let name = name.to_lowercase();
    known
        .into_iter()
        .filter(|known| known.len() <= 4 * LONGEST)
        .map(|known| (strsim::damerau_levenshtein(&name, &known.to_lowercase()), known))
        .filter(|(distance, _)| *distance <= length / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_a_few_edits_away_are_found_and_others_are_not() {
        let known = ["toon", "cartoon", "lines", "ink-thin", "ink-thick"];
        for (name, expected) in [
            ("cartoom", Some("cartoon")),
            ("CARTOON", Some("cartoon")),
            ("catroon", Some("cartoon")),
            ("ton", Some("toon")),
            ("tone", None),
            ("line", Some("lines")),
            ("ink-thik", Some("ink-thin")),
            ("ink-thikc", Some("ink-thick")),
            ("ink_thin", Some("ink-thin")),
            ("", None),
            ("xy", None),
            ("watercolour", None),
        ] {
            assert_eq!(nearest(name, known), expected, "{name}");
        }
        assert_eq!(nearest(&"cartoon".repeat(100_000), known), None);
        assert_eq!(nearest("toon", []), None);
    }
}
