//! Parses lines of an OBJ file as bytes.

use std::io::BufRead;

/// The length, including the line end, of a line that consists of `v` and three numbers, or `None`.
pub(super) fn plain_vertex(bytes: &[u8]) -> Option<usize> {
    const OTHER: u8 = 0;
    const IN_NUMBER: u8 = 1;
    const SPACE: u8 = 2;
    const END: u8 = 3;
    const CLASS: [u8; 256] = {
        let mut class = [OTHER; 256];
        let mut i = 0;
        while i < 256 {
            class[i] = match i as u8 {
                b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E' => IN_NUMBER,
                b' ' | b'\t' | b'\r' => SPACE,
                b'\n' => END,
                _ => OTHER,
            };
            i += 1;
        }
        class
    };
    let mut words = 0;
    let mut before = SPACE;
    for (at, &byte) in bytes.strip_prefix(b"v ")?.iter().enumerate() {
        let class = CLASS[byte as usize];
        if class == END || class == OTHER {
            return (class == END && words == 3).then_some(at + 3);
        }
        words += u32::from(class < before);
        before = class;
    }
    None
}

/// A line of `f` with three or more corners that have the same kinds of positive indices, and nothing else.
pub(super) struct PlainFace {
    /// The length of the line including its end.
    pub length: usize,
    pub corners: u64,
    /// The highest index of vertex, texture coordinate and normal; 0 if the face has none.
    pub highest: [u64; 3],
}

#[inline]
pub(super) fn plain_face(bytes: &[u8]) -> Option<PlainFace> {
    let mut rest = bytes.strip_prefix(b"f ")?;
    let mut highest = [0u64; 3];
    let mut corners = 0;
    loop {
        while let [b' ', after @ ..] = rest {
            rest = after;
        }
        if let [b'\n', after @ ..] | [b'\r', b'\n', after @ ..] = rest {
            return (corners >= 3).then_some(PlainFace { length: bytes.len() - after.len(), corners, highest });
        }
        let mut kind = 0;
        loop {
            let mut value = 0u64;
            let mut digits = 0;
            // Ten digits may overflow.
            while let [digit @ b'0'..=b'9', after @ ..] = rest
                && digits < 10
            {
                value = value * 10 + u64::from(digit - b'0');
                digits += 1;
                rest = after;
            }
            let may_be_absent = kind == 1 && digits == 0;
            if (value == 0 && !may_be_absent) || digits > 9 || (corners > 0 && (highest[kind] == 0) != (value == 0)) {
                return None;
            }
            highest[kind] = highest[kind].max(value);
            match rest {
                [b'/', after @ ..] if kind < 2 => {
                    kind += 1;
                    rest = after;
                }
                [b' ' | b'\n' | b'\r', ..] => break,
                _ => return None,
            }
        }
        // The first corner determines the kinds of indices.
        if highest[kind + 1..].iter().any(|&highest| highest > 0) {
            return None;
        }
        corners += 1;
    }
}

/// The length of a line including its end.
pub(super) fn line_length(mut bytes: &[u8]) -> usize {
    bytes.skip_until(b'\n').unwrap_or(0)
}

pub(super) fn trim_end(line: &[u8]) -> &[u8] {
    line.trim_ascii_end()
}

/// The number of words before a comment, and the start of the comment.
pub(super) fn count_words(line: &[u8]) -> (usize, usize) {
    let mut words = 0;
    let mut in_space = true;
    for (i, &b) in line.iter().enumerate() {
        if b == b'#' {
            return (words, i);
        }
        let is_space = b <= b' ';
        words += usize::from(in_space && !is_space);
        in_space = is_space;
    }
    (words, line.len())
}

pub(super) fn words_of(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

pub(super) fn first_words(line: &[u8], count: usize) -> Vec<u8> {
    words_of(line).take(count).collect::<Vec<_>>().join(&b' ')
}

pub(super) fn number(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The remaining corners of an `f` line, possibly followed by a comment.
pub(super) struct Corners<'a> {
    pub rest: &'a [u8],
}

impl Corners<'_> {
    /// The indices of vertex, texture coordinate and normal as in the file, 0 if missing.
    #[inline]
    pub fn next_corner(&mut self) -> Result<Option<[i64; 3]>, &'static str> {
        let mut bytes = self.rest;
        while let [b' ' | b'\t' | b'\r' | 12, after @ ..] = bytes {
            bytes = after;
        }
        if matches!(bytes, [] | [b'#', ..]) {
            self.rest = bytes;
            return Ok(None);
        }
        let mut corner = [0i64; 3];
        let mut kind = 0;
        loop {
            let negative = bytes.first() == Some(&b'-');
            let signed = negative || bytes.first() == Some(&b'+');
            if signed {
                bytes = &bytes[1..];
            }
            let mut value = 0i64;
            let mut digits = 0;
            while let [digit @ b'0'..=b'9', after @ ..] = bytes {
                value = value * 10 + i64::from(digit - b'0');
                digits += 1;
                bytes = after;
                if value > i64::from(u32::MAX) {
                    return Err("a face with a number that is too large");
                }
            }
            if signed && digits == 0 {
                return Err("a face corner that is no number");
            }
            corner[kind] = if negative { -value } else { value };
            match bytes {
                [] | [b' ' | b'\t' | b'\r' | 12 | b'#', ..] => break,
                [b'/', after @ ..] if kind < 2 => {
                    kind += 1;
                    bytes = after;
                }
                _ => return Err("a face corner that is no number"),
            }
        }
        self.rest = bytes;
        Ok(Some(corner))
    }
}
