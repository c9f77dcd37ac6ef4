//! Finds the line of a fault, which tobj does not report.

use super::lines::{number, words_of};

/// The fault in a prepared text that tobj rejects, and its line.
pub(super) fn explain(text: &[u8], fault: tobj::LoadError) -> String {
    let found = (1u64..).zip(text.split(|b| *b == b'\n')).find_map(|(number, line)| Some((number, fault_in(line)?)));
    match found {
        Some((number, fault)) => format!("line {number}: {fault}"),
        None => fault.to_string(),
    }
}

fn fault_in(line: &[u8]) -> Option<&'static str> {
    if std::str::from_utf8(line).is_err() {
        return Some("not UTF-8");
    }
    let mut words = words_of(line);
    let (count, fault) = match words.next()? {
        b"v" => (3, "a vertex coordinate that is no number"),
        b"vt" => (2, "a texture coordinate that is no number"),
        b"vn" => (3, "a normal that is not three numbers"),
        _ => return None,
    };
    let numbers: Vec<Option<f32>> = words.map(number).collect();
    if numbers.len() < count || numbers[..count].contains(&None) {
        return Some(fault);
    }
    match numbers[count..] {
        [None] if count == 3 => Some("a vertex weight that is no number"),
        [Some(0.0)] if count == 3 => Some("a vertex weight of 0, scaling by which has no end"),
        _ => None,
    }
}

/// A message with the line of a vertex that is not finite.
pub(super) fn not_finite(text: &[u8], vertex: &[f32; 3]) -> String {
    let [x, y, z] = vertex;
    let is_it = |line: &[u8]| {
        let mut words = words_of(line);
        if words.next() != Some(b"v") {
            return false;
        }
        let numbers: Vec<f32> = words.map(|word| number(word).unwrap_or(f32::NAN)).collect();
        let weight = if numbers.len() == 4 { numbers[3] } else { 1.0 };
        let same = |(a, b): (&f32, &f32)| a / weight == *b || (a / weight).is_nan() && b.is_nan();
        numbers.len() >= 3 && numbers.iter().zip(vertex).all(same)
    };
    let fault = format!("vertex ({x}, {y}, {z}) is not finite, and a face uses it");
    match text.split(|b| *b == b'\n').position(is_it) {
        Some(before) => format!("line {}: {fault}", before + 1),
        None => fault,
    }
}
