//! Material files.

use super::texture_map::TextureMap;
use crate::load::color::linear_from_srgb;
use crate::load::external::{External, meanings, shortened};
use crate::{AlphaMode, LoadError, Material};
use glam::{Vec3, Vec4};
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// A material and the names of its textures.
pub(super) struct MtlMaterial {
    pub material: Material,
    pub color_map: Option<TextureMap>,
    pub alpha_map: Option<TextureMap>,
}

#[derive(Default)]
pub(super) struct Library {
    pub materials: Vec<MtlMaterial>,
    read: BTreeSet<PathBuf>,
    pub warnings: Vec<String>,
}

impl Library {
    /// Adds the materials of the files on a `mtllib` line. A file that cannot be read gives a warning.
    ///
    /// # Errors
    /// Only exceeded limits.
    pub fn read(&mut self, external: &External, line: &str) -> Result<(), LoadError> {
        for file in material_files(external, line.trim()) {
            let bytes = file.and_then(|file| {
                // Each file is read once, however many `mtllib` lines name it.
                Ok(if self.read.insert(file.clone()) { Some((external.read(&file)?, file)) } else { None })
            });
            match bytes {
                Ok(None) => {}
                Ok(Some((bytes, file))) => {
                    if std::str::from_utf8(&bytes).is_err() {
                        let name = shortened(&file.file_name().unwrap_or_default().to_string_lossy());
                        self.warnings.push(format!("material file {name}: it is not UTF-8 throughout"));
                    }
                    let text = String::from_utf8_lossy(&bytes);
                    let first = self.materials.len();
                    read_materials(&text, &mut self.materials, &mut self.warnings);
                    for material in &mut self.materials[first..] {
                        for map in [&mut material.color_map, &mut material.alpha_map].into_iter().flatten() {
                            map.names = external.beside(&file, std::mem::take(&mut map.names));
                        }
                    }
                }
                Err(error @ LoadError::TooLarge { .. }) => return Err(error),
                Err(error) => self.warnings.push(format!("material file {}", without_model(external.model, &error))),
            }
        }
        Ok(())
    }
}

/// The files that a `mtllib` line names. It may name several, in quotes or not, names may contain spaces, and a comment
/// may follow.
fn material_files(external: &External, line: &str) -> Vec<Result<PathBuf, LoadError>> {
    if let Ok(whole) = find(external, line) {
        return vec![Ok(whole)];
    }
    let names = line.split_once(" #").map_or(line, |(names, _)| names);
    let of_piece = |piece: &str| match find(external, piece) {
        Err(LoadError::TooLarge { path, what, count, limit }) => {
            vec![Err(LoadError::TooLarge { path, what, count, limit })]
        }
        Err(_) if piece.contains(char::is_whitespace) => {
            piece.split_whitespace().map(|name| find(external, name)).collect()
        }
        found => vec![found],
    };
    pieces(names).into_iter().flat_map(of_piece).collect()
}

/// The names on a line: what is in quotes, and what ends in `.mtl`, spaces included.
fn pieces(line: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    // Every second part is within quotes.
    for (number, part) in line.split('"').enumerate() {
        if number % 2 == 1 {
            pieces.push(part);
            continue;
        }
        let mut start = 0;
        for (at, space) in part.match_indices(char::is_whitespace) {
            let ends_name = part[..at].len() >= start + 4
                && part.is_char_boundary(at - 4)
                && part[at - 4..at].eq_ignore_ascii_case(".mtl");
            if ends_name {
                pieces.push(&part[start..at]);
                start = at + space.len();
            }
        }
        pieces.push(&part[start..]);
    }
    pieces.iter().map(|piece| piece.trim()).filter(|piece| !piece.is_empty()).collect()
}

/// The indices of materials by name; the first of several with one name.
pub(super) struct Names {
    whole: HashMap<String, usize>,
    /// By the name without a trailing comment.
    bare: HashMap<String, usize>,
}

impl Names {
    pub fn new(materials: &[MtlMaterial]) -> Self {
        let mut names = Self { whole: HashMap::new(), bare: HashMap::new() };
        for (number, name) in materials.iter().map(|m| m.material.name.as_str()).enumerate() {
            names.whole.entry(name.to_owned()).or_insert(number);
            names.bare.entry(without_comment(name).to_owned()).or_insert(number);
        }
        names
    }

    /// The material that a `usemtl` line names. A comment after the name, in either file, is part of the name only if
    /// that name is found.
    pub fn find(&self, name: &str) -> Option<usize> {
        let bare = without_comment(name);
        self.whole.get(name).or_else(|| self.whole.get(bare)).or_else(|| self.bare.get(bare)).copied()
    }
}

fn without_comment(name: &str) -> &str {
    name.split_once(" # ").map_or(name, |(bare, _)| bare).trim_end()
}

/// An error as a warning, which does not repeat the name of the model.
fn without_model(model: &Path, error: &LoadError) -> String {
    match error {
        LoadError::Outside { path, name } if path == model => format!("\"{name}\" leads out of the model's folder"),
        other => other.to_string(),
    }
}

fn find(external: &External, name: &str) -> Result<PathBuf, LoadError> {
    let name = name.trim().trim_matches('"');
    external.find(&meanings(name).unwrap_or_default())
}

/// The opacity statements of a material.
#[derive(Default)]
struct Opacity {
    /// The last `d`.
    dissolve: Option<f32>,
    /// The last `Tr`.
    transparency: Option<f32>,
}

impl Opacity {
    /// The alpha that a material's statements mean, and why it needs a warning.
    ///
    /// `d` is opacity and `Tr` is 1 - `d`, but some exporters write the opacity for both. So `d` has precedence, wherever
    /// it is, and a material vanishes only if nothing else says otherwise: it is opaque with a `d` of 0 that `Tr`
    /// contradicts, and with a `Tr` of 1 without `d`.
    fn alpha(&self) -> (f32, Option<String>) {
        let range = |x: f32| x.clamp(0.0, 1.0);
        match (self.dissolve, self.transparency) {
            (None, None) => (1.0, None),
            (Some(d), None) => (range(d), None),
            (None, Some(tr)) if tr >= 1.0 => (1.0, Some(format!("Tr {tr} without d is taken as opaque"))),
            (None, Some(tr)) => (1.0 - range(tr), None),
            (Some(d), Some(tr)) if (range(d) - (1.0 - range(tr))).abs() < 0.01 => (range(d), None),
            (Some(d), Some(tr)) => {
                let alpha = if d <= 0.0 { 1.0 } else { range(d) };
                (alpha, Some(format!("d {d} and Tr {tr} contradict each other: its opacity is {alpha}")))
            }
        }
    }
}

/// Adds the materials of an MTL file: `newmtl`, `Kd`, `Ke`, `d`, `Tr`, `map_Kd` and `map_d`. Other statements are
/// ignored.
fn read_materials(text: &str, materials: &mut Vec<MtlMaterial>, warnings: &mut Vec<String>) {
    let first = materials.len();
    // Per material whether it has its own `Kd` and `map_Ke`, and its opacity.
    let mut given: Vec<(bool, bool, Opacity)> = Vec::new();
    for line in text.trim_start_matches('\u{feff}').split(['\n', '\r']) {
        let line = line.trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        if keyword == "newmtl" {
            materials.push(MtlMaterial {
                material: Material { name: rest.to_owned(), ..Material::default() },
                color_map: None,
                alpha_map: None,
            });
            given.push((false, false, Opacity::default()));
            continue;
        }
        let (Some(MtlMaterial { material, color_map, alpha_map }), Some((has_color, has_emission_map, opacity))) =
            (materials[first..].last_mut(), given.last_mut())
        else {
            continue;
        };
        let name = shortened(&material.name);
        let shown = shortened(rest);
        let numbers = || rest.split_whitespace().map(|w| w.parse::<f32>().ok().filter(|x| x.is_finite()));
        let mut not_understood =
            || warnings.push(format!("material \"{name}\": {keyword} \"{shown}\" is not understood"));
        let mut color = None;
        match keyword {
            "Kd" => match numbers().collect::<Vec<_>>()[..] {
                // A single number is a gray.
                [Some(grey)] => color = Some(Vec3::splat(grey)),
                [Some(r), Some(g), Some(b), ..] => color = Some(Vec3::new(r, g, b)),
                _ => not_understood(),
            },
            // The number is last; `-halo` may precede it.
            "d" => match numbers().next_back().flatten() {
                Some(alpha) => opacity.dissolve = Some(alpha),
                None => not_understood(),
            },
            "Tr" => match numbers().next_back().flatten() {
                Some(clear) => opacity.transparency = Some(clear),
                None => not_understood(),
            },
            "map_Kd" | "map_d" => {
                let map = if keyword == "map_Kd" { color_map } else { alpha_map };
                let (read, ignored) = TextureMap::read(rest);
                warnings.extend(ignored.iter().map(|option| format!("the texture option {option} is ignored")));
                if read.is_none() {
                    warnings.push(format!("material \"{name}\": {keyword} names no file"));
                }
                *map = read;
            }
            "Ke" => match numbers().collect::<Vec<_>>()[..] {
                [Some(grey)] => material.emissive = emission(Vec3::splat(grey)),
                [Some(r), Some(g), Some(b), ..] => material.emissive = emission(Vec3::new(r, g, b)),
                _ => not_understood(),
            },
            "map_Ke" => {
                warnings.push(format!("material \"{name}\": map_Ke is not supported, and its emission is left out"));
                *has_emission_map = true;
            }
            _ => {}
        }
        if let Some(encoded) = color {
            let clamped = encoded.clamp(Vec3::ZERO, Vec3::ONE);
            if clamped != encoded {
                warnings.push(format!("material \"{name}\": Kd \"{shown}\" is not within 0 to 1"));
            }
            (material.base_color, *has_color) = (linear_from_srgb(clamped).extend(1.0), true);
        }
    }
    for (MtlMaterial { material, color_map, .. }, (has_color, has_emission_map, opacity)) in
        materials[first..].iter_mut().zip(given)
    {
        if color_map.is_some() && !has_color {
            material.base_color = Vec4::ONE;
        }
        if has_emission_map {
            // Without its texture, the whole surface would be bright.
            material.emissive = Vec3::ZERO;
        }
        let (alpha, contradiction) = opacity.alpha();
        material.base_color.w = alpha;
        if let Some(what) = contradiction {
            warnings.push(format!("material \"{}\": {what}", shortened(&material.name)));
        }
        if alpha < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
    }
}

/// The linear colour of `Ke`, which is encoded like `Kd`.
fn emission(encoded: Vec3) -> Vec3 {
    linear_from_srgb(encoded.clamp(Vec3::ZERO, Vec3::ONE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_on_a_mtllib_line() {
        for (line, names) in [
            ("a.mtl", &["a.mtl"][..]),
            ("a.mtl  b.MTL", &["a.mtl", "b.MTL"]),
            ("my own.mtl other one.mtl", &["my own.mtl", "other one.mtl"]),
            ("\"my own.mtl\" b.mtl", &["my own.mtl", "b.mtl"]),
            ("\"my own\" \"b\"", &["my own", "b"]),
            ("a b", &["a b"]),
            ("é.mtl ü", &["é.mtl", "ü"]),
            ("\"\"", &[]),
            ("", &[]),
        ] {
            assert_eq!(pieces(line), names, "{line}");
        }
    }

    #[test]
    fn opacity_of_every_combination() {
        for (dissolve, transparency, alpha, warned) in [
            (None, None, 1.0, false),
            (Some(0.25), None, 0.25, false),
            (Some(0.0), None, 0.0, false),
            (None, Some(0.25), 0.75, false),
            (None, Some(1.0), 1.0, true),
            (Some(1.0), Some(0.0), 1.0, false),
            (Some(0.25), Some(0.75), 0.25, false),
            (Some(1.0), Some(1.0), 1.0, true),
            (Some(0.0), Some(0.0), 1.0, true),
            (Some(0.0), Some(1.0), 0.0, false),
            (Some(0.25), Some(0.25), 0.25, true),
        ] {
            let (found, warning) = Opacity { dissolve, transparency }.alpha();
            assert_eq!((found, warning.is_some()), (alpha, warned), "{dissolve:?} {transparency:?}");
        }
    }
}
