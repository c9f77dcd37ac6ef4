//! Material files and their textures.

use crate::load::external::{External, meanings, shortened};
use crate::load::image_file;
use crate::{AlphaMode, LoadError, Material, Model, Texture, Wrap};
use glam::Vec3;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// A material and the name of its texture.
pub(super) struct MtlMaterial {
    pub material: Material,
    texture: Option<TextureName>,
}

struct TextureName {
    /// The possible file names, and the name as written.
    names: Vec<PathBuf>,
    written: String,
    wrap: Wrap,
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
        let line = line.trim();
        // The line may list several files, file names may contain spaces, and a comment may follow.
        let files = match find(external, line) {
            Ok(whole) => vec![Ok(whole)],
            Err(_) => {
                let names = line.split_once(" #").map_or(line, |(names, _)| names);
                names.split_whitespace().map(|name| find(external, name)).collect()
            }
        };
        for file in files {
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
                    for texture in self.materials[first..].iter_mut().filter_map(|m| m.texture.as_mut()) {
                        texture.names = external.beside(&file, std::mem::take(&mut texture.names));
                    }
                }
                Err(error @ LoadError::TooLarge { .. }) => return Err(error),
                Err(error) => self.warnings.push(format!("material file {}", without_model(external.model, &error))),
            }
        }
        Ok(())
    }
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

/// Adds the materials of an MTL file: `newmtl`, `Kd`, `Ke`, `d`, `Tr` and `map_Kd`. Other statements are ignored.
fn read_materials(text: &str, materials: &mut Vec<MtlMaterial>, warnings: &mut Vec<String>) {
    let first = materials.len();
    // Per material whether it has its own `Kd` and `d`.
    let mut given = Vec::new();
    let mut textured_emission = Vec::new();
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
        let number = materials.len().saturating_sub(1);
        let (Some(MtlMaterial { material, texture }), Some((has_color, has_dissolve))) =
            (materials[first..].last_mut(), given.last_mut())
        else {
            continue;
        };
        let name = shortened(&material.name);
        let shown = shortened(rest);
        let numbers = || rest.split_whitespace().map(|w| w.parse::<f32>().ok().filter(|x| x.is_finite()));
        let mut color = None;
        match keyword {
            "Kd" => match numbers().collect::<Vec<_>>()[..] {
                // A single number is a gray.
                [Some(grey)] => color = Some(Vec3::splat(grey)),
                [Some(r), Some(g), Some(b), ..] => color = Some(Vec3::new(r, g, b)),
                _ => warnings.push(format!("material \"{name}\": Kd \"{shown}\" is not understood")),
            },
            // The number is last; `-halo` may precede it.
            "d" => match numbers().next_back().flatten() {
                Some(alpha) => (material.base_color.w, *has_dissolve) = (alpha.clamp(0.0, 1.0), true),
                None => warnings.push(format!("material \"{name}\": d \"{shown}\" is not understood")),
            },
            // Exporters disagree about `Tr`, so `d` has precedence.
            "Tr" if !*has_dissolve => match numbers().next_back().flatten() {
                Some(clear) => material.base_color.w = (1.0 - clear).clamp(0.0, 1.0),
                None => warnings.push(format!("material \"{name}\": Tr \"{shown}\" is not understood")),
            },
            "map_Kd" => *texture = texture_name(rest),
            "Ke" => match numbers().collect::<Vec<_>>()[..] {
                [Some(grey)] => material.emissive = emission(Vec3::splat(grey)),
                [Some(r), Some(g), Some(b), ..] => material.emissive = emission(Vec3::new(r, g, b)),
                _ => warnings.push(format!("material \"{name}\": Ke \"{shown}\" is not understood")),
            },
            "map_Ke" => {
                warnings.push(format!("material \"{name}\": map_Ke is not supported, and its emission is left out"));
                // Without its texture, the whole surface would be bright.
                textured_emission.push(number);
            }
            "map_d" => warnings.push(format!("material \"{name}\": map_d is not supported")),
            _ => {}
        }
        if let Some(encoded) = color {
            let clamped = encoded.clamp(Vec3::ZERO, Vec3::ONE);
            if clamped != encoded {
                warnings.push(format!("material \"{name}\": Kd \"{shown}\" is not within 0 to 1"));
            }
            (material.base_color, *has_color) = (linear_from_srgb(clamped).extend(material.base_color.w), true);
        }
    }
    textured_emission.into_iter().for_each(|number| materials[number].material.emissive = Vec3::ZERO);
    for (MtlMaterial { material, texture }, (has_color, _)) in materials[first..].iter_mut().zip(given) {
        if texture.is_some() && !has_color {
            material.base_color = Vec3::ONE.extend(material.base_color.w);
        }
        if material.base_color.w < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
    }
}

/// The linear colour of `Ke`, which is encoded like `Kd`.
fn emission(encoded: Vec3) -> Vec3 {
    linear_from_srgb(encoded.clamp(Vec3::ZERO, Vec3::ONE))
}

/// The file that a `map_…` line names after its options.
fn texture_name(line: &str) -> Option<TextureName> {
    let mut rest = line.trim();
    let mut wrap = Wrap::Repeat;
    while rest.starts_with('-') {
        let (option, after) = rest.split_once(char::is_whitespace)?;
        rest = after.trim_start();
        let (least, most) = match option {
            "-o" | "-s" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-type" | "-texres" | "-boost" | "-bm" => (1, 1),
            // The name of a file may begin with a hyphen.
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
    let name = rest.trim_matches('"');
    meanings(name).map(|names| TextureName { names, written: shortened(name), wrap })
}

/// Moves the materials to the model and loads the textures of those that are `used`, each file once per wrap mode.
///
/// # Errors
/// Only exceeded limits. A missing or invalid texture gives a warning.
pub(super) fn move_materials(
    materials: Vec<MtlMaterial>,
    used: &[bool],
    model: &mut Model,
    warnings: &mut Vec<String>,
    external: &External,
) -> Result<(), LoadError> {
    let mut known: HashMap<(String, bool), Option<u32>> = HashMap::new();
    let mut texels = 0;
    for (MtlMaterial { mut material, texture }, used) in materials.into_iter().zip(used) {
        if let Some(TextureName { names, written, wrap }) = texture.filter(|_| *used) {
            let key = (names[0].to_string_lossy().into_owned(), wrap == Wrap::Clamp);
            material.texture = match known.get(&key) {
                Some(&known) => known,
                None => {
                    let texture =
                        external.find(&names).and_then(|file| read_texture(&file, wrap, &mut texels, external));
                    let texture = match texture {
                        Ok(texture) => {
                            model.textures.push(texture);
                            Some(model.textures.len() as u32 - 1)
                        }
                        Err(error @ LoadError::TooLarge { .. }) => return Err(error),
                        Err(LoadError::ImageTooLarge { image, what, count, limit, .. }) => {
                            let path = external.model.to_owned();
                            return Err(LoadError::ImageTooLarge { path, image, what, count, limit });
                        }
                        Err(LoadError::Outside { .. }) => {
                            warnings.push(format!("texture \"{written}\" leads out of the model's folder"));
                            None
                        }
                        Err(error) => {
                            warnings.push(format!("texture {error}"));
                            None
                        }
                    };
                    known.insert(key, texture);
                    texture
                }
            };
        }
        model.materials.push(material);
    }
    Ok(())
}

fn read_texture(file: &Path, wrap: Wrap, texels: &mut u64, external: &External) -> Result<Texture, LoadError> {
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
    let bytes = external.read(file)?;
    let (width, height, rgba8) = image_file::decode(&bytes, &shortened(&name), file, external.limits, texels)?;
    Ok(Texture { name, width, height, rgba8: rgba8.into(), wrap: [wrap; 2], smooth: true })
}

pub(super) fn linear_from_srgb(encoded: Vec3) -> Vec3 {
    let channel = |c: f32| {
        let c = f64::from(c.max(0.0));
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    Vec3::new(channel(encoded.x), channel(encoded.y), channel(encoded.z))
}
