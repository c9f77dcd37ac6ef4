//! Material files and their textures.

use crate::load::{image_file, read_file};
use crate::{AlphaMode, Limits, Material, Model, Texture, Wrap};
use glam::Vec3;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// A material, and where its texture should be.
pub(super) struct MtlMaterial {
    pub material: Material,
    texture: Option<TextureName>,
}

struct TextureName {
    path: PathBuf,
    wrap: Wrap,
}

#[derive(Default)]
pub(super) struct Library {
    pub materials: Vec<MtlMaterial>,
    read: BTreeSet<PathBuf>,
    pub warnings: Vec<String>,
}

impl Library {
    /// The names of the materials that a `mtllib` line adds.
    pub fn read(&mut self, folder: &Path, names: &str, limits: &Limits) -> Vec<String> {
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
pub(super) fn load_textures(
    materials: Vec<MtlMaterial>,
    model: &mut Model,
    warnings: &mut Vec<String>,
    limits: &Limits,
) {
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

pub(super) fn linear_from_srgb(encoded: Vec3) -> Vec3 {
    let channel = |c: f32| {
        let c = f64::from(c.max(0.0));
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    Vec3::new(channel(encoded.x), channel(encoded.y), channel(encoded.z))
}
