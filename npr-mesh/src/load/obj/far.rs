//! Moves the vertices of an OBJ text, in f64.

use super::lines::words_of;
use crate::load::far::Written;
use glam::DVec3;
use std::io::Write;

/// The text with an offset subtracted from its vertices before they are rounded to f32, and what its numbers tell. Lines
/// keep their numbers. A vertex that is not made of numbers stays.
pub(super) fn moved(text: &[u8], offset: DVec3) -> (Vec<u8>, Written) {
    let mut out = Vec::with_capacity(text.len());
    let mut written = Written::default();
    for line in text.split_inclusive(|b| *b == b'\n') {
        match position(line) {
            None => out.extend_from_slice(line),
            Some(position) => {
                written.add(position);
                let [x, y, z] = (position - offset).as_vec3().to_array();
                write!(out, "v {x:e} {y:e} {z:e}").expect("memory takes everything");
                if words_of(line).nth(6).is_some() {
                    for word in words_of(line).skip(4) {
                        out.push(b' ');
                        out.extend_from_slice(word);
                    }
                }
                out.push(b'\n');
            }
        }
    }
    (out, written)
}

/// The position that a `v` line states, divided by its weight; `None` for other lines and for what is no number.
pub(super) fn position(line: &[u8]) -> Option<DVec3> {
    let [b'v', space, rest @ ..] = line else { return None };
    if !space.is_ascii_whitespace() {
        return None;
    }
    let mut words = words_of(rest);
    let mut number = || std::str::from_utf8(words.next()?).ok()?.parse::<f64>().ok();
    let position = DVec3::new(number()?, number()?, number()?);
    let weight = number();
    // With a colour there is no weight.
    match weight {
        Some(weight) if words.next().is_none() => Some(position / weight),
        _ => Some(position),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn vertices_are_moved_and_nothing_else() {
        let text = b"v 100.25 0 -1\nvt 1 2\n\nv 202 2 2 2\nv 100 0 0 0.5 0.25 1\nf 1 2 3\nv x 0 0\nv\t101 0 0";
        let (moved, _) = moved(text, dvec3(100.0, 0.0, 1.0));
        let expected =
            "v 2.5e-1 0e0 -2e0\nvt 1 2\n\nv 1e0 1e0 0e0\nv 0e0 0e0 -1e0 0.5 0.25 1\nf 1 2 3\nv x 0 0\nv 1e0 0e0 -1e0\n";
        assert_eq!(String::from_utf8_lossy(&moved), expected);
    }
}
