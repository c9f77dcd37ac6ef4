//! Rewrites an OBJ text so that tobj reads it correctly.

use super::lines::{
    Corners, count_words, first_words, line_length, number, plain_face, plain_vertex, trim_end, words_of,
};
use crate::edges::MOST_FACES;
use crate::normals::UNSTATED;
use crate::{Limits, LoadError};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

#[derive(Default)]
pub(super) struct Counts {
    /// The numbers of `v`, `vt` and `vn` lines.
    pub arrays: [u64; 3],
    pub colored: u64,
    pub corners: u64,
    pub triangles: u64,
}

/// A text that tobj reads correctly, and the information that it does not return.
pub(super) struct Prepared {
    pub text: Vec<u8>,
    pub counts: Counts,
    /// The corners without texture coordinate, and without normal, numbered through all faces of the text.
    pub absent: [Runs; 2],
    pub materials_used: BTreeSet<String>,
    /// The operands of the `mtllib` lines.
    pub material_files: Vec<String>,
    /// The corners at which an object or group begins, numbered likewise, in ascending order.
    pub objects: Vec<u64>,
    /// The corners at which a smoothing group begins, numbered likewise, in ascending order, and the group: 0 for none.
    pub smoothing: Vec<(u64, u32)>,
    /// The segments of polylines as indices of `v` lines, from 0.
    pub lines: Vec<[u32; 2]>,
    pub warnings: Vec<String>,
}

/// Ascending ranges of corners that neither touch nor overlap.
pub(super) type Runs = Vec<Range<u64>>;

/// Adds `count` corners from `start`, which is after all existing corners.
fn add_run(runs: &mut Runs, start: u64, count: u64) {
    match runs.last_mut() {
        Some(last) if last.end == start => last.end += count,
        _ => runs.push(start..start + count),
    }
}

/// Removes the corners from `end` on.
fn cut_runs(runs: &mut Runs, end: u64) {
    while let Some(last) = runs.last_mut()
        && last.end > end
    {
        last.end = end;
        if last.is_empty() {
            runs.pop();
        }
    }
}

/// The intersection of the runs with a range.
pub(super) fn runs_within(runs: &Runs, range: &Range<u64>) -> impl Iterator<Item = Range<u64>> {
    let (start, end) = (range.start, range.end);
    runs[runs.partition_point(|run| run.end <= start)..]
        .iter()
        .take_while(move |run| run.start < end)
        .map(move |run| run.start.max(start)..run.end.min(end))
}

/// Keywords of lines that do not affect faces or materials.
const PASSED_OVER: [&[u8]; 27] = [
    b"mg",
    b"vp",
    b"vw",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"maplib",
    b"usemap",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"bsp",
    b"bzp",
    b"cdc",
];

const ARRAYS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The `v`, `vt`, `vn`, `f` and `usemtl` lines, with their line numbers unchanged, in a form that tobj reads
/// correctly. Everything that tobj does not check is checked here.
pub(super) fn prepare(mut bytes: Vec<u8>, path: &Path, limits: &Limits) -> Result<Prepared, LoadError> {
    let malformed = |line: u64, fault: String| LoadError::Malformed {
        path: path.to_owned(),
        fault: if line == 0 { fault } else { format!("line {line}: {fault}") },
    };
    if bytes.contains(&0) {
        return Err(malformed(0, "not a text file".to_owned()));
    }
    let mut repaired = Repaired::default();
    // Concatenated files may begin with several marks.
    while bytes[3 * repaired.marks as usize..].starts_with(b"\xef\xbb\xbf") {
        bytes[3 * repaired.marks as usize..][..3].fill(b' ');
        repaired.marks += 1;
    }
    // Line ends of classic Mac OS, which also occur in concatenated files.
    let end = if bytes.contains(&b'\r') { bytes.len() } else { 0 };
    for at in 0..end {
        if bytes[at] == b'\r' && bytes.get(at + 1) != Some(&b'\n') {
            bytes[at] = b'\n';
        }
    }

    let mut counts = Counts::default();
    let mut absent = [Runs::new(), Runs::new()];
    let mut materials_used = BTreeSet::new();
    let mut material_files = Vec::new();
    let mut material_files_known = BTreeSet::new();
    let mut objects = Vec::new();
    let mut smoothing: Vec<(u64, u32)> = Vec::new();
    let mut lines: Vec<[u32; 2]> = Vec::new();
    // The highest index of a polyline, and its line.
    let mut highest_of_lines = (0u64, 0u64);
    // Per array the highest index of a face, and the line of that face.
    let mut highest = [(0u64, 0u64); 3];
    let mut edit = Edit { bytes: &bytes, out: Vec::new(), copied: 0 };
    let mut at = 0;
    let mut line_number = 0;
    let mut joined = Vec::new();
    while at < bytes.len() {
        // A fast path for the two most frequent kinds of lines, which need no change.
        if let Some(length) = plain_vertex(&bytes[at..]) {
            line_number += 1;
            at += length;
            counts.arrays[0] += 1;
            continue;
        }
        if let Some(face) = plain_face(&bytes[at..])
            && face.corners <= limits.polygon_corners
        {
            line_number += 1;
            at += face.length;
            for (highest, of_face) in
                highest.iter_mut().zip(face.highest).filter(|(highest, of_face)| *of_face > highest.0)
            {
                *highest = (of_face, line_number);
            }
            for (runs, _) in absent.iter_mut().zip(&face.highest[1..]).filter(|(_, highest)| **highest == 0) {
                add_run(runs, counts.corners, face.corners);
            }
            counts.corners += face.corners;
            counts.triangles += face.corners - 2;
            continue;
        }
        let begin = at;
        line_number += 1;
        let first_line_number = line_number;
        at += line_length(&bytes[at..]);
        let mut line = trim_end(&bytes[begin..at]);
        let mut rewritten = false;
        if line.ends_with(b"\\") && !line.trim_ascii_start().starts_with(b"#") {
            joined.clear();
            while let [start @ .., b'\\'] = line {
                joined.extend_from_slice(start);
                joined.push(b' ');
                line_number += 1;
                let end = at + line_length(&bytes[at..]);
                line = trim_end(&bytes[at..end]);
                at = end;
            }
            joined.extend_from_slice(line);
            line = trim_end(&joined);
            rewritten = true;
            repaired.continued += 1;
        }
        if !line.is_ascii() && std::str::from_utf8(line).is_err() {
            repaired.not_utf8 += 1;
        }
        let bad = |fault: String| malformed(first_line_number, fault);
        let trimmed = line.trim_ascii_start();
        // tobj finds names at fixed columns, so indentation is removed.
        rewritten |= trimmed.len() < line.len();
        line = trimmed;
        let word_length = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        let (keyword, mut rest) = line.split_at(word_length);
        let mut words = 0;
        if matches!(keyword, b"v" | b"vt" | b"vn") {
            let length;
            (words, length) = count_words(rest);
            if length < rest.len() {
                rest = &rest[..length];
                line = trim_end(&line[..word_length + length]);
                rewritten = true;
            }
        }
        match keyword {
            b"v" => {
                counts.arrays[0] += 1;
                match words {
                    0..=2 => return Err(bad(format!("a vertex of {words} coordinates"))),
                    3 | 4 => {}
                    5 => {
                        edit.replace(begin, at, &first_words(line, 4));
                        repaired.vertex_words += 1;
                        continue;
                    }
                    _ => {
                        counts.colored += 1;
                        if words_of(rest).skip(3).take(3).any(|word| number(word).is_none()) {
                            return Err(bad("a vertex colour that is no number".to_owned()));
                        }
                        if words > 6 {
                            edit.replace(begin, at, &first_words(line, 7));
                            repaired.vertex_words += 1;
                            continue;
                        }
                    }
                }
            }
            b"vt" => {
                counts.arrays[1] += 1;
                if words == 1 {
                    edit.replace(begin, at, &[line, b" 0"].concat());
                    continue;
                }
            }
            b"vn" => counts.arrays[2] += 1,
            // `fo` denotes faces in the first version of the format.
            b"f" | b"fo" => {
                let mut corners = 0u64;
                let corners_before = counts.corners;
                let mut outline = Corners { rest };
                while let Some(corner) = outline.next_corner().map_err(|fault| bad(fault.to_owned()))? {
                    for kind in 0..3 {
                        let index = corner[kind];
                        if index > 0 {
                            if index as u64 > highest[kind].0 {
                                highest[kind] = (index as u64, first_line_number);
                            }
                        } else if index == 0 {
                            if kind == 0 {
                                return Err(bad("a face corner without a vertex (they count from 1)".to_owned()));
                            }
                            add_run(&mut absent[kind - 1], corners_before + corners, 1);
                        } else if index.unsigned_abs() > counts.arrays[kind] {
                            let (name, count) = (ARRAYS[kind], counts.arrays[kind]);
                            return Err(bad(format!("a face uses {name} {index}, and there are {count} before it")));
                        }
                    }
                    corners += 1;
                }
                if corners < 3 {
                    repaired.short_faces += 1;
                    absent.iter_mut().for_each(|runs| cut_runs(runs, corners_before));
                    edit.replace(begin, at, b"");
                    continue;
                }
                if corners > limits.polygon_corners {
                    return Err(LoadError::TooLarge {
                        path: path.to_owned(),
                        what: "corners of a polygon",
                        count: corners,
                        limit: limits.polygon_corners,
                    });
                }
                counts.corners += corners;
                counts.triangles += corners - 2;
                if !outline.rest.is_empty() {
                    line = &line[..line.len() - outline.rest.len()];
                    rewritten = true;
                }
                if keyword == b"fo" {
                    edit.replace(begin, at, &[b"f", &line[word_length..]].concat());
                    continue;
                }
            }
            b"mtllib" => {
                let names = String::from_utf8_lossy(rest.trim_ascii());
                repaired.nameless_files += u64::from(names.trim_matches(['"', ' ']).is_empty());
                if !names.is_empty() && material_files_known.insert(names.to_string()) {
                    material_files.push(names.into_owned());
                }
                edit.replace(begin, at, b"");
                continue;
            }
            b"usemtl" => {
                // Names may contain any bytes; tobj accepts only UTF-8 after a single space.
                let name = String::from_utf8_lossy(rest.trim_ascii());
                if name.is_empty() {
                    repaired.nameless += 1;
                    edit.replace(begin, at, b"");
                    continue;
                }
                if !materials_used.contains(name.as_ref()) {
                    materials_used.insert(name.to_string());
                }
                if rewritten || matches!(name, Cow::Owned(_)) || rest[0] != b' ' {
                    edit.replace(begin, at, &[keyword, b" ", name.as_bytes()].concat());
                    continue;
                }
            }
            // tobj would split the file into meshes that share no vertices.
            b"o" | b"g" => {
                if objects.last() != Some(&counts.corners) {
                    objects.push(counts.corners);
                }
                edit.replace(begin, at, b"");
                continue;
            }
            b"s" => {
                match smoothing_group(rest) {
                    Some(group) => match smoothing.last_mut() {
                        Some(last) if last.0 == counts.corners => last.1 = group,
                        _ => smoothing.push((counts.corners, group)),
                    },
                    None => repaired.smoothing += 1,
                }
                edit.replace(begin, at, b"");
                continue;
            }
            // tobj would parse these as faces.
            b"l" => {
                let (mut vertices, mut before) = (0, None);
                let mut polyline = Corners { rest };
                while let Some([index, ..]) = polyline
                    .next_corner()
                    .map_err(|fault| bad(fault.replace("face corner", "line's end").replace("face", "line")))?
                {
                    let count = counts.arrays[0];
                    let vertex = match index {
                        1.. => index as u64 - 1,
                        0 => return Err(bad("a line's end without a vertex (they count from 1)".to_owned())),
                        _ if index.unsigned_abs() > count => {
                            return Err(bad(format!("a line uses vertex {index}, and there are {count} before it")));
                        }
                        _ => count - index.unsigned_abs(),
                    };
                    if vertex >= highest_of_lines.0 {
                        highest_of_lines = (vertex + 1, first_line_number);
                    }
                    match before.replace(vertex as u32) {
                        Some(before) if u64::from(before) != vertex => lines.push([before, vertex as u32]),
                        Some(_) => repaired.short_lines += 1,
                        None => {}
                    }
                    vertices += 1;
                }
                repaired.short_lines += u64::from(vertices < 2);
                edit.replace(begin, at, b"");
                continue;
            }
            // Lines that may not be UTF-8.
            [] => continue,
            [b'#', ..] if line.is_ascii() => continue,
            _ => {
                match keyword {
                    b"p" => repaired.points += 1,
                    b"curv" | b"curv2" | b"surf" => repaired.free_forms += 1,
                    b"call" | b"csh" => repaired.calls += 1,
                    _ if keyword[0] == b'#' || PASSED_OVER.contains(&keyword) => {}
                    _ => repaired.unknown += 1,
                }
                edit.replace(begin, at, b"");
                continue;
            }
        }
        if rewritten {
            edit.replace(begin, at, line);
        }
    }

    for (what, count, limit) in [
        ("vertices", counts.arrays.iter().copied().max().unwrap_or(0), limits.vertices),
        ("faces", counts.triangles, limits.faces.min(MOST_FACES as u64)),
        ("line segments", lines.len() as u64, limits.faces),
    ] {
        if count > limit {
            return Err(LoadError::TooLarge { path: path.to_owned(), what, count, limit });
        }
    }
    for kind in 0..3 {
        let ((index, line), count, name) = (highest[kind], counts.arrays[kind], ARRAYS[kind]);
        if index > count {
            return Err(malformed(line, format!("a face uses {name} {index} of {count}")));
        }
    }
    let (index, line) = highest_of_lines;
    if index > counts.arrays[0] {
        return Err(malformed(line, format!("a line uses vertex {index} of {}", counts.arrays[0])));
    }
    let text = edit.finish();
    let mut text = text.unwrap_or(bytes);
    if counts.colored > 0 && counts.colored < counts.arrays[0] {
        text = color_all(&text);
        repaired.uncolored = counts.arrays[0] - counts.colored;
    }
    let warnings = repaired.warnings();
    Ok(Prepared { text, counts, absent, materials_used, material_files, objects, smoothing, lines, warnings })
}

/// The number of a smoothing group, 0 for none; `None` if it is not understood.
fn smoothing_group(rest: &[u8]) -> Option<u32> {
    match words_of(rest).next()? {
        b"off" | b"null" => Some(0),
        b"on" => Some(1),
        // Numbers beyond are one group.
        word => Some(std::str::from_utf8(word).ok()?.parse::<u64>().ok()?.min(u64::from(UNSTATED) - 1) as u32),
    }
}

#[derive(Default)]
struct Repaired {
    marks: u64,
    continued: u64,
    not_utf8: u64,
    short_faces: u64,
    vertex_words: u64,
    uncolored: u64,
    nameless: u64,
    nameless_files: u64,
    smoothing: u64,
    short_lines: u64,
    points: u64,
    free_forms: u64,
    calls: u64,
    unknown: u64,
}

impl Repaired {
    fn warnings(&self) -> Vec<String> {
        [
            (self.marks, "byte-order marks at the beginning are passed over"),
            (self.continued, "lines go on behind a backslash: they are joined"),
            (self.not_utf8, "lines are not UTF-8: what is not is passed over"),
            (self.short_faces, "faces with fewer than 3 corners are left out"),
            (self.vertex_words, "vertices have 5 numbers or more than 6: what is too much is passed over"),
            (self.uncolored, "vertices have no colour where others have one: they are white"),
            (self.nameless, "usemtl lines without a name are passed over"),
            (self.nameless_files, "mtllib lines without a name are passed over"),
            (self.smoothing, "smoothing groups are not understood: the group before goes on"),
            (self.short_lines, "lines from a vertex to itself are left out"),
            (self.points, "points are left out"),
            (self.free_forms, "curves and surfaces are left out"),
            (self.calls, "calls of other files are not followed"),
            (self.unknown, "lines begin with none of the format's keywords: they are passed over"),
        ]
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect()
    }
}

/// Replaces lines of a text. Nothing is copied before the first replacement.
struct Edit<'a> {
    bytes: &'a [u8],
    out: Vec<u8>,
    /// The position in `bytes` up to which `out` is complete.
    copied: usize,
}

impl Edit<'_> {
    /// Replaces the lines from `begin` to `end`, including their line ends, by one line. Empty lines are added to
    /// keep the numbers of the following lines.
    fn replace(&mut self, begin: usize, end: usize, line: &[u8]) {
        self.out.extend_from_slice(&self.bytes[self.copied..begin]);
        self.out.extend_from_slice(line);
        let lines = self.bytes[begin..end].iter().filter(|b| **b == b'\n').count();
        self.out.resize(self.out.len() + lines.max(1), b'\n');
        self.copied = end;
    }

    fn finish(mut self) -> Option<Vec<u8>> {
        (self.copied > 0).then(|| {
            self.out.extend_from_slice(&self.bytes[self.copied..]);
            self.out
        })
    }
}

/// Adds white to vertices without a colour.
fn color_all(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len() * 2);
    for line in text.split(|b| *b == b'\n') {
        let line = trim_end(line);
        out.extend_from_slice(line);
        if let [b'v', space, rest @ ..] = line
            && space.is_ascii_whitespace()
        {
            let (words, _) = count_words(rest);
            if words == 4 {
                // A colour excludes a weight. The weight is removed; in known files it is 1.
                let end = line.iter().rposition(u8::is_ascii_whitespace).unwrap_or(line.len());
                out.truncate(out.len() - (line.len() - end));
            }
            if words < 6 {
                out.extend_from_slice(b" 1 1 1");
            }
        }
        out.push(b'\n');
    }
    out
}
