//! Wavefront OBJ and MTL.
//!
//! tobj parses; what it would misread, choke on or run away with is put right or refused before ([`prepare`]):
//! it takes polylines of three points and more for faces, refuses a file for a comment that is not UTF-8, a
//! byte-order mark or a continued line, gives colours to the wrong vertices where only some have one, replaces an
//! absent normal by the one before, panics on some indices and on a `Kd` of two numbers, and reads material files
//! of any size. Materials are therefore read here ([`read_materials`]); tobj learns their names only.

use super::{Loaded, image_file};
use crate::triangulate::triangulate_into;
use crate::{AlphaMode, Limits, LoadError, Material, Model, Texture, Wrap};
use glam::{Vec2, Vec3, Vec4};
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

/// Reads an OBJ file, the `.mtl` files that it names and their textures.
///
/// - Vertices without a normal have a zero one. Texture coordinates are turned upside down to [`Model::uvs`]'s
///   convention. Normals that are not finite count as absent, such texture coordinates as 0.
/// - `Kd` and vertex colours (`v x y z r g b`) are taken as sRGB-encoded and converted. Materials are double-sided.
/// - Faces without a material, or with one that no file defines, get [`Material::default`] as material 0.
/// - Groups, smoothing groups, points, lines, curves and surfaces are passed over.
/// - A missing or broken material file or texture is a warning.
///
/// # Errors
/// [`LoadError`] for what cannot be read, is no OBJ, refers to vertices that are not there or not finite, or is
/// over a limit. A file without faces is no error here.
pub(super) fn load(path: &Path, limits: &Limits) -> Result<Loaded, LoadError> {
    let bytes = read_file(path, limits)?;
    let mut prepared = prepare(bytes, path, limits)?;
    let mut warnings = std::mem::take(&mut prepared.warnings);
    if prepared.counts.triangles == 0 {
        return Ok(Loaded { model: Model::default(), warnings });
    }

    let library = RefCell::new(Library::default());
    let folder = path.parent().unwrap_or(Path::new(""));
    // Two copies of a large file are one too many: tobj's own arrays come on top.
    let text = prepared.text;
    let options = tobj::LoadOptions { ignore_lines: true, ignore_points: true, ..tobj::LoadOptions::default() };
    let (meshes, _) = tobj::load_obj_buf(&mut text.as_slice(), &options, |name| {
        let names = library.borrow_mut().read(folder, &name.to_string_lossy(), limits);
        let materials =
            names.iter().map(|name| tobj::Material { name: name.clone(), ..tobj::Material::default() }).collect();
        Ok((materials, names.into_iter().enumerate().map(|(i, name)| (name, i)).collect()))
    })
    .map_err(|fault| LoadError::Malformed {
        path: path.to_owned(),
        fault: match fault {
            tobj::LoadError::ReadError => "not UTF-8 text".to_owned(),
            fault => fault.to_string(),
        },
    })?;
    drop(text);

    let mut library = library.into_inner();
    warnings.append(&mut library.warnings);
    warnings.extend(
        prepared
            .materials_used
            .iter()
            .filter(|used| !library.materials.iter().any(|m| m.material.name == **used))
            .map(|used| format!("no material file defines {used:?}: the default material stands for it")),
    );

    let mut model = Model::default();
    let needs_default = library.materials.is_empty()
        || meshes.iter().any(|m| m.mesh.material_id.is_none() && !m.mesh.indices.is_empty());
    if needs_default {
        model.materials.push(Material::default());
    }
    let first_material = model.materials.len();
    load_textures(library.materials, &mut model, &mut warnings, limits);

    let mut builder = Builder { model, path, limits, corners_before: 0, absent: &prepared.absent, repaired: 0 };
    builder.model.faces.reserve(prepared.counts.triangles as usize);
    for mesh in &meshes {
        let material = mesh.mesh.material_id.map_or(0, |id| first_material + id);
        if material >= builder.model.materials.len() {
            return Err(builder.malformed(format!("material {material} is not there")));
        }
        builder.add(&mesh.mesh, material as u32)?;
    }
    if builder.repaired > 0 {
        warnings.push(format!("{} texture coordinates or colours are not finite", builder.repaired));
    }
    let mut model = builder.model;
    // Files say 0..=255 at times.
    if model.colors.iter().any(|c| c.max_element() > 1.0) {
        warnings.push("vertex colours above 1 are taken as 0..=255".to_owned());
        for color in &mut model.colors {
            *color = (color.truncate() / 255.0).extend(1.0);
        }
    }
    for color in &mut model.colors {
        *color = linear_from_srgb(color.truncate()).extend(color.w);
    }
    Ok(Loaded { model, warnings })
}

/// All bytes of a regular file, if they are no more than allowed.
fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, LoadError> {
    let failed = |source| LoadError::Read { path: path.to_owned(), source };
    let too_large =
        |count| LoadError::TooLarge { path: path.to_owned(), what: "bytes", count, limit: limits.file_bytes };
    // Before it is opened: opening a pipe waits, and a device does not end.
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(io::Error::other("not a regular file")));
    }
    if metadata.len() > limits.file_bytes {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize + 1);
    let file = fs::File::open(path).map_err(failed)?;
    // Some files are longer than they say.
    file.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limits.file_bytes {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

// ---- what tobj is given ----

#[derive(Default)]
struct Counts {
    /// `v`, `vt` and `vn` lines.
    arrays: [u64; 3],
    colored: u64,
    corners: u64,
    triangles: u64,
}

/// What tobj can read safely, and what it would lose.
struct Prepared {
    text: Vec<u8>,
    counts: Counts,
    /// Corners without texture coordinate, and without normal, numbered through all faces that
    /// tobj is given; ascending.
    absent: [Vec<u64>; 2],
    materials_used: BTreeSet<String>,
    warnings: Vec<String>,
}

const ARRAYS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The `v`, `vt`, `vn`, `f`, `usemtl` and `mtllib` lines in a form that tobj reads as it is meant, everything
/// checked that it would not check.
fn prepare(mut bytes: Vec<u8>, path: &Path, limits: &Limits) -> Result<Prepared, LoadError> {
    let malformed = |line: u64, fault: String| LoadError::Malformed {
        path: path.to_owned(),
        fault: if line == 0 { fault } else { format!("line {line}: {fault}") },
    };
    if bytes.contains(&0) {
        return Err(malformed(0, "not a text file".to_owned()));
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes[..3].fill(b' ');
    }
    // Lines ended so before 2001.
    if !bytes.contains(&b'\n') {
        bytes.iter_mut().filter(|b| **b == b'\r').for_each(|b| *b = b'\n');
    }

    let mut counts = Counts::default();
    let mut absent = [Vec::new(), Vec::new()];
    let mut materials_used = BTreeSet::new();
    let mut repaired = Repaired::default();
    // Per array the highest number that a face names, and that face's line.
    let mut highest = [(0u64, 0u64); 3];
    let mut edit = Edit { bytes: &bytes, out: Vec::new(), copied: 0 };
    let mut at = 0;
    let mut line_number = 0;
    let mut joined = Vec::new();
    while at < bytes.len() {
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
        }
        let bad = |fault: String| malformed(first_line_number, fault);
        let trimmed = line.trim_ascii_start();
        // tobj takes names from where a line without indentation would have them.
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
            b"f" => {
                let mut corners = 0u64;
                let corners_before = counts.corners;
                let absent_before = [absent[0].len(), absent[1].len()];
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
                            absent[kind - 1].push(corners_before + corners);
                        } else if index.unsigned_abs() > counts.arrays[kind] {
                            let (name, count) = (ARRAYS[kind], counts.arrays[kind]);
                            return Err(bad(format!("a face uses {name} {index}, and there are {count} before it")));
                        }
                    }
                    corners += 1;
                }
                if corners < 3 {
                    repaired.short_faces += 1;
                    absent[0].truncate(absent_before[0]);
                    absent[1].truncate(absent_before[1]);
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
            }
            b"usemtl" | b"mtllib" => {
                // Names can have any bytes; tobj takes UTF-8 only, and a single space before them.
                let name = String::from_utf8_lossy(rest.trim_ascii());
                if name.is_empty() {
                    edit.replace(begin, at, b"");
                    continue;
                }
                if keyword == b"usemtl" && !materials_used.contains(name.as_ref()) {
                    materials_used.insert(name.to_string());
                }
                if rewritten || matches!(name, Cow::Owned(_)) || rest[0] != b' ' {
                    edit.replace(begin, at, &[keyword, b" ", name.as_bytes()].concat());
                    continue;
                }
            }
            // Lines that would be parsed as faces or that part the file into meshes, and what may not be UTF-8.
            [] => continue,
            [b'#', ..] if line.is_ascii() => continue,
            _ => {
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
        ("faces", counts.triangles, limits.faces),
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
    let text = edit.finish();
    let mut text = text.unwrap_or(bytes);
    if counts.colored > 0 && counts.colored < counts.arrays[0] {
        text = color_all(&text);
        repaired.uncolored = counts.arrays[0] - counts.colored;
    }
    Ok(Prepared { text, counts, absent, materials_used, warnings: repaired.warnings() })
}

#[derive(Default)]
struct Repaired {
    short_faces: u64,
    vertex_words: u64,
    uncolored: u64,
}

impl Repaired {
    fn warnings(&self) -> Vec<String> {
        [
            (self.short_faces, "faces with fewer than 3 corners are left out"),
            (self.vertex_words, "vertices have 5 numbers or more than 6: what is too much is passed over"),
            (self.uncolored, "vertices have no colour where others have one: they are white"),
        ]
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect()
    }
}

/// A text in which lines are replaced; nothing is copied until one is.
struct Edit<'a> {
    bytes: &'a [u8],
    out: Vec<u8>,
    /// Up to here `bytes` is in `out`, edited.
    copied: usize,
}

impl Edit<'_> {
    /// The lines from `begin` up to `end`, with their line ends, become one line.
    fn replace(&mut self, begin: usize, end: usize, line: &[u8]) {
        self.out.extend_from_slice(&self.bytes[self.copied..begin]);
        self.out.extend_from_slice(line);
        self.out.push(b'\n');
        self.copied = end;
    }

    fn finish(mut self) -> Option<Vec<u8>> {
        (self.copied > 0).then(|| {
            self.out.extend_from_slice(&self.bytes[self.copied..]);
            self.out
        })
    }
}

/// With the line end.
fn line_length(mut bytes: &[u8]) -> usize {
    bytes.skip_until(b'\n').unwrap_or(0)
}

fn trim_end(line: &[u8]) -> &[u8] {
    line.trim_ascii_end()
}

/// How many words there are before a comment, and where that begins.
fn count_words(line: &[u8]) -> (usize, usize) {
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

fn words_of(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

fn first_words(line: &[u8], count: usize) -> Vec<u8> {
    words_of(line).take(count).collect::<Vec<_>>().join(&b' ')
}

fn number(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The corners of an `f` line that are still to come; a comment in the end.
struct Corners<'a> {
    rest: &'a [u8],
}

impl Corners<'_> {
    /// Numbers of vertex, texture coordinate and normal as in the file, 0 where there is none.
    #[inline]
    fn next_corner(&mut self) -> Result<Option<[i64; 3]>, &'static str> {
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

/// White for the vertices without a colour.
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
                // A weight cannot stand beside a colour. It is 1 wherever this has been met.
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

// ---- materials ----

/// A material, and where its texture should be.
struct MtlMaterial {
    material: Material,
    texture: Option<TextureName>,
}

struct TextureName {
    path: PathBuf,
    wrap: Wrap,
}

#[derive(Default)]
struct Library {
    materials: Vec<MtlMaterial>,
    read: BTreeSet<PathBuf>,
    warnings: Vec<String>,
}

impl Library {
    /// The names of the materials that a `mtllib` line adds.
    fn read(&mut self, folder: &Path, names: &str, limits: &Limits) -> Vec<String> {
        // The line can list several files, and a file's name can have spaces.
        let whole = beside(folder, names);
        let files =
            if whole.is_file() { vec![whole] } else { names.split_whitespace().map(|n| beside(folder, n)).collect() };
        let first = self.materials.len();
        for file in files {
            // An endless file of `mtllib` lines would otherwise read it as often.
            if !self.read.insert(file.clone()) {
                continue;
            }
            match read_file(&file, limits) {
                Ok(bytes) => {
                    let folder = file.parent().unwrap_or(Path::new(""));
                    read_materials(&String::from_utf8_lossy(&bytes), folder, &mut self.materials, &mut self.warnings);
                }
                Err(error) => self.warnings.push(format!("material file {error}")),
            }
        }
        self.materials[first..].iter().map(|m| m.material.name.clone()).collect()
    }
}

/// A file by its name in another file: relative to that one's folder. Of an absolute name, which comes from someone
/// else's machine, only the last part counts.
fn beside(folder: &Path, name: &str) -> PathBuf {
    let name = name.trim().trim_matches('"');
    let is_absolute = name.starts_with(['/', '\\']) || name.as_bytes().get(1) == Some(&b':');
    let direct = folder.join(name.trim_start_matches(['/', '\\']));
    if !is_absolute && (direct.is_file() || !name.contains('\\')) {
        return direct;
    }
    if is_absolute {
        folder.join(name.rsplit(['/', '\\']).next().unwrap_or(name))
    } else {
        folder.join(name.replace('\\', "/"))
    }
}

/// Adds the materials of an MTL file: `newmtl`, `Kd`, `d`, `Tr` and `map_Kd`; the rest is for other light models.
fn read_materials(text: &str, folder: &Path, materials: &mut Vec<MtlMaterial>, warnings: &mut Vec<String>) {
    let first = materials.len();
    // Per material whether it has a `Kd` and a `d` of its own.
    let mut given = Vec::new();
    for line in text.trim_start_matches('\u{feff}').split(['\n', '\r']) {
        let line = line.trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        if keyword == "newmtl" {
            materials.push(MtlMaterial {
                material: Material { name: rest.to_owned(), ..Material::default() },
                texture: None,
            });
            given.push((false, false));
            continue;
        }
        let (Some(MtlMaterial { material, texture }), Some((has_color, has_dissolve))) =
            (materials[first..].last_mut(), given.last_mut())
        else {
            continue;
        };
        let name = &material.name;
        let numbers = || rest.split_whitespace().map(|w| w.parse::<f32>().ok().filter(|x| x.is_finite()));
        match keyword {
            "Kd" => match numbers().collect::<Vec<_>>()[..] {
                // One number stands for all three.
                [Some(grey)] => {
                    (material.base_color, *has_color) =
                        (linear_from_srgb(Vec3::splat(grey)).extend(material.base_color.w), true);
                }
                [Some(r), Some(g), Some(b), ..] => {
                    (material.base_color, *has_color) =
                        (linear_from_srgb(Vec3::new(r, g, b)).extend(material.base_color.w), true);
                }
                _ => warnings.push(format!("material {name:?}: Kd {rest:?} is not understood")),
            },
            // The number comes last; `-halo` may stand before it.
            "d" => match numbers().next_back().flatten() {
                Some(alpha) => (material.base_color.w, *has_dissolve) = (alpha.clamp(0.0, 1.0), true),
                None => warnings.push(format!("material {name:?}: d {rest:?} is not understood")),
            },
            // Exporters disagree about `Tr`: where there is a `d` it is that which counts.
            "Tr" if !*has_dissolve => match numbers().next_back().flatten() {
                Some(clear) => material.base_color.w = (1.0 - clear).clamp(0.0, 1.0),
                None => warnings.push(format!("material {name:?}: Tr {rest:?} is not understood")),
            },
            "map_Kd" => *texture = texture_name(rest, folder),
            "map_d" => warnings.push(format!("material {name:?}: map_d is not supported")),
            _ => {}
        }
    }
    for (MtlMaterial { material, texture }, (has_color, _)) in materials[first..].iter_mut().zip(given) {
        if texture.is_some() && !has_color {
            material.base_color = Vec3::ONE.extend(material.base_color.w);
        }
        if material.base_color.w < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
    }
}

/// The file that a `map_…` line names behind its options.
fn texture_name(line: &str, folder: &Path) -> Option<TextureName> {
    let mut rest = line.trim();
    let mut wrap = Wrap::Repeat;
    while rest.starts_with('-') {
        let (option, after) = rest.split_once(char::is_whitespace)?;
        rest = after.trim_start();
        let (least, most) = match option {
            "-o" | "-s" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-type" | "-texres" | "-boost" | "-bm" => (1, 1),
            // A file's name can begin with a hyphen.
            _ => {
                rest = line[line.len() - after.len() - option.len() - 1..].trim();
                break;
            }
        };
        for argument in 0..most {
            let Some((word, after)) = rest.split_once(char::is_whitespace) else { break };
            if argument >= least && word.parse::<f32>().is_err() {
                break;
            }
            if option == "-clamp" && word == "on" {
                wrap = Wrap::Clamp;
            }
            rest = after.trim_start();
        }
    }
    (!rest.is_empty()).then(|| TextureName { path: beside(folder, rest), wrap })
}

/// Moves the materials over, each texture file read once per way of wrapping.
fn load_textures(materials: Vec<MtlMaterial>, model: &mut Model, warnings: &mut Vec<String>, limits: &Limits) {
    let mut known: HashMap<(PathBuf, bool), Option<u32>> = HashMap::new();
    for MtlMaterial { mut material, texture } in materials {
        if let Some(TextureName { path, wrap }) = texture {
            material.texture = *known.entry((path.clone(), wrap == Wrap::Clamp)).or_insert_with(|| {
                let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
                let decoded =
                    read_file(&path, limits).and_then(|bytes| image_file::decode(&bytes, &name, &path, limits));
                match decoded {
                    Ok((width, height, rgba8)) => {
                        model.textures.push(Texture { name, width, height, rgba8, wrap: [wrap; 2], smooth: true });
                        Some(model.textures.len() as u32 - 1)
                    }
                    Err(error) => {
                        warnings.push(format!("texture {error}"));
                        None
                    }
                }
            });
        }
        model.materials.push(material);
    }
}

fn linear_from_srgb(encoded: Vec3) -> Vec3 {
    let channel = |c: f32| {
        let c = f64::from(c.max(0.0));
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    Vec3::new(channel(encoded.x), channel(encoded.y), channel(encoded.z))
}

// ---- one vertex array ----

const NONE: u32 = u32::MAX;

struct Builder<'a> {
    model: Model,
    path: &'a Path,
    limits: &'a Limits,
    /// Corners of the meshes already added.
    corners_before: u64,
    absent: &'a [Vec<u64>; 2],
    /// Texture coordinates and colours that were replaced.
    repaired: u64,
}

impl Builder<'_> {
    fn malformed(&self, fault: String) -> LoadError {
        LoadError::Malformed { path: self.path.to_owned(), fault }
    }

    /// Adds a mesh as tobj gives it without `single_index`: positions, and one index into each array per corner.
    fn add(&mut self, mesh: &tobj::Mesh, material: u32) -> Result<(), LoadError> {
        let base = self.model.positions.len();
        let positions = mesh.positions.as_chunks::<3>().0;
        let corners = mesh.indices.len();
        for (which, &[x, y, z]) in positions.iter().enumerate() {
            if !(x.is_finite() && y.is_finite() && z.is_finite()) {
                let (first, of) = (which + 1, positions.len());
                return Err(
                    self.malformed(format!("vertex ({x}, {y}, {z}), number {first} of {of} in use, is not finite"))
                );
            }
        }
        if mesh.indices.iter().any(|&i| i as usize >= positions.len()) {
            return Err(self.malformed("a face uses a vertex that is not there".to_owned()));
        }

        let uvs = mesh.texcoords.as_chunks::<2>().0;
        let normals = mesh.normals.as_chunks::<3>().0;
        let range = self.corners_before..self.corners_before + corners as u64;
        let Some(uv_of) = attribute_indices(&mesh.texcoord_indices, uvs.len(), corners, &self.absent[0], range.clone())
        else {
            return Err(self.malformed("a face uses a texture coordinate that is not there".to_owned()));
        };
        let Some(normal_of) =
            attribute_indices(&mesh.normal_indices, normals.len(), corners, &self.absent[1], range.clone())
        else {
            return Err(self.malformed("a face uses a normal that is not there".to_owned()));
        };
        self.corners_before = range.end;

        // Which position, texture coordinate and normal each vertex has, and which vertex each corner is.
        let split = (!uv_of.is_empty() || !normal_of.is_empty())
            .then(|| split_vertices(&mesh.indices, &uv_of, &normal_of, positions.len()));
        let (sources, vertex_of) = match &split {
            None => (None, &mesh.indices),
            Some((sources, vertex_of)) => (Some(sources), vertex_of),
        };
        let vertices = sources.map_or(positions.len(), Vec::len);
        let total = (base + vertices) as u64;
        if total > self.limits.vertices.min(u64::from(u32::MAX)) {
            return Err(LoadError::TooLarge {
                path: self.path.to_owned(),
                what: "vertices",
                count: total,
                limit: self.limits.vertices,
            });
        }

        let model = &mut self.model;
        match sources {
            None => {
                model.positions.extend(positions.iter().map(|p| Vec3::from_array(*p)));
                model.normals.resize(total as usize, Vec3::ZERO);
            }
            Some(sources) => {
                model.positions.extend(sources.iter().map(|s| Vec3::from_array(positions[s[0] as usize])));
                model.normals.extend(sources.iter().map(|s| {
                    let normal = normals.get(s[2] as usize).map_or(Vec3::ZERO, |n| Vec3::from_array(*n));
                    if normal.is_finite() { normal } else { Vec3::ZERO }
                }));
            }
        }
        if !uv_of.is_empty() || !model.uvs.is_empty() {
            model.uvs.resize(base, Vec2::ZERO);
            for source in sources.into_iter().flatten() {
                let [u, v] = uvs.get(source[1] as usize).copied().unwrap_or([0.0, 1.0]);
                let finite = u.is_finite() && v.is_finite();
                self.repaired += u64::from(!finite);
                model.uvs.push(if finite { Vec2::new(u, 1.0 - v) } else { Vec2::ZERO });
            }
            model.uvs.resize(total as usize, Vec2::ZERO);
        }
        let colors = mesh.vertex_color.as_chunks::<3>().0;
        if !colors.is_empty() || !model.colors.is_empty() {
            model.colors.resize(base, Vec4::ONE);
            for vertex in 0..vertices {
                let position = sources.map_or(vertex, |s| s[vertex][0] as usize);
                let color = colors.get(position).map_or(Vec3::ONE, |c| Vec3::from_array(*c));
                self.repaired += u64::from(!color.is_finite());
                model.colors.push(if color.is_finite() { color } else { Vec3::ONE }.extend(1.0));
            }
        }
        self.add_faces(mesh, base as u32, vertex_of, material)
    }

    fn add_faces(&mut self, mesh: &tobj::Mesh, base: u32, vertex_of: &[u32], material: u32) -> Result<(), LoadError> {
        let model = &mut self.model;
        let first_face = model.faces.len();
        if mesh.face_arities.is_empty() {
            let (triangles, rest) = vertex_of.as_chunks::<3>();
            if !rest.is_empty() {
                return Err(self.malformed("a face with fewer than 3 corners".to_owned()));
            }
            model.faces.extend(triangles.iter().map(|t| t.map(|v| base + v)));
            if !model.face_polygon.is_empty() {
                extend_polygons(&mut model.face_polygon, triangles.len());
            }
        } else {
            if model.face_polygon.is_empty() && mesh.face_arities.iter().any(|&n| n > 3) {
                extend_polygons(&mut model.face_polygon, first_face);
            }
            let counts_polygons = !model.face_polygon.is_empty() || mesh.face_arities.iter().any(|&n| n > 3);
            let mut polygon = model.face_polygon.last().map_or(0, |last| last + 1);
            let mut at = 0;
            let mut outline = Vec::new();
            let mut triangles = Vec::new();
            for &arity in &mesh.face_arities {
                let Some(corners) = vertex_of.get(at..at + arity as usize) else {
                    return Err(self.malformed("a face with corners that are not there".to_owned()));
                };
                at += arity as usize;
                if arity == 3 {
                    model.faces.push([base + corners[0], base + corners[1], base + corners[2]]);
                } else {
                    outline.clear();
                    outline.extend(corners.iter().map(|&v| model.positions[(base + v) as usize]));
                    triangulate_into(&outline, &mut triangles);
                    model.faces.extend(triangles.iter().map(|t| t.map(|i| base + corners[i as usize])));
                }
                if counts_polygons {
                    model.face_polygon.resize(model.faces.len(), polygon);
                    polygon += 1;
                }
            }
        }
        model.face_material.resize(model.faces.len(), material);
        Ok(())
    }
}

/// One more polygon for each of `count` triangles.
fn extend_polygons(face_polygon: &mut Vec<u32>, count: usize) {
    let first = face_polygon.last().map_or(0, |last| last + 1);
    face_polygon.extend((0..count as u32).map(|i| first + i));
}

/// Per corner the index into an array, [`NONE`] for the corners in `absent`; nothing at all if no corner has one.
/// `None` if an index is out of range.
fn attribute_indices<'a>(
    indices: &'a [u32],
    count: usize,
    corners: usize,
    absent: &[u64],
    range: std::ops::Range<u64>,
) -> Option<Cow<'a, [u32]>> {
    if indices.is_empty() {
        return Some(Cow::Borrowed(&[]));
    }
    if indices.len() != corners || indices.iter().any(|&i| i as usize >= count) {
        return None;
    }
    let absent = &absent[absent.partition_point(|&c| c < range.start)..absent.partition_point(|&c| c < range.end)];
    if absent.is_empty() {
        return Some(Cow::Borrowed(indices));
    }
    if absent.len() == corners {
        return Some(Cow::Borrowed(&[]));
    }
    // tobj repeats an index that came before.
    let mut indices = indices.to_vec();
    for corner in absent {
        indices[(corner - range.start) as usize] = NONE;
    }
    Some(Cow::Owned(indices))
}

/// Beyond so many vertices at one position a hash table finds them.
const WALKED_PER_POSITION: u32 = 16;

/// One vertex for each combination of position, texture coordinate and normal ([`NONE`] for none) in order of first
/// use, and per corner its vertex. Either of the last two arrays may be empty.
fn split_vertices(
    position_of: &[u32],
    uv_of: &[u32],
    normal_of: &[u32],
    positions: usize,
) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut sources: Vec<[u32; 3]> = Vec::with_capacity(positions);
    let mut vertex_of = Vec::with_capacity(position_of.len());
    // The vertices of one position are chained.
    let mut first = vec![NONE; positions];
    let mut next: Vec<u32> = Vec::with_capacity(positions);
    let mut crowded: HashMap<[u32; 3], u32> = HashMap::new();
    for (corner, &position) in position_of.iter().enumerate() {
        let key =
            [position, uv_of.get(corner).copied().unwrap_or(NONE), normal_of.get(corner).copied().unwrap_or(NONE)];
        let mut vertex = first[position as usize];
        let mut last = NONE;
        let mut walked = 0;
        while vertex != NONE && sources[vertex as usize] != key && walked < WALKED_PER_POSITION {
            last = vertex;
            vertex = next[vertex as usize];
            walked += 1;
        }
        let fresh = sources.len() as u32;
        if walked == WALKED_PER_POSITION {
            vertex = *crowded.entry(key).or_insert(fresh);
        } else if vertex == NONE {
            vertex = fresh;
            match last {
                NONE => first[position as usize] = fresh,
                last => next[last as usize] = fresh,
            }
        }
        if vertex == fresh {
            sources.push(key);
            next.push(NONE);
        }
        vertex_of.push(vertex);
    }
    (sources, vertex_of)
}
