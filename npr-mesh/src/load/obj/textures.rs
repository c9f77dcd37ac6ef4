//! Loads the images of materials, and joins those of colour and of alpha.

use super::joined::Joined;
use super::mtl::MtlMaterial;
use super::texture_map::{Placement, TextureMap};
use crate::load::external::{External, shortened};
use crate::load::image_file::{self, Decoded};
use crate::{AlphaMode, LoadError, Model, Texture, Wrap};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// An image, by the first of the possible names of its file.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    name: PathBuf,
    clamp: bool,
    /// Bits of the scale and offset; zero where they do not change the texture.
    placement: [u32; 4],
}

impl Key {
    fn new(map: &TextureMap, with_placement: bool) -> Self {
        let Placement { scale: [a, b], offset: [c, d] } = map.placement;
        let placement = if with_placement { [a, b, c, d].map(f32::to_bits) } else { [0; 4] };
        Self { name: map.names[0].clone(), clamp: map.wrap == Wrap::Clamp, placement }
    }
}

/// The index of a texture, and the alpha mode of a material that has it; `None` if it cannot be loaded. Joined textures
/// have a placement of their own.
type Loaded = Option<(u32, Option<Placement>, AlphaMode)>;

struct Loader<'a, 'b> {
    external: &'a External<'b>,
    model: &'a mut Model,
    warnings: &'a mut Vec<String>,
    texels: u64,
    known: HashMap<[Option<Key>; 2], Loaded>,
}

/// Moves the materials to the model and loads the textures of those that are `used`, each once. Returns per material of
/// the model how texture coordinates are placed on its texture.
///
/// `map_d` gives alpha: by the alpha channel of its image, else by its luminance. Where all values are 0 or 255 the
/// material is a cut-out, and otherwise blended. Without `map_d` the alpha of `map_Kd` has no effect, unless the
/// material is blended because of its `d`.
///
/// # Errors
/// Only exceeded limits. A missing or invalid texture gives a warning.
pub(super) fn move_materials(
    materials: Vec<MtlMaterial>,
    used: &[bool],
    model: &mut Model,
    warnings: &mut Vec<String>,
    external: &External,
) -> Result<Vec<Placement>, LoadError> {
    let mut placements = vec![Placement::default(); model.materials.len()];
    let mut loader = Loader { external, model, warnings, texels: 0, known: HashMap::new() };
    for (MtlMaterial { mut material, color_map, alpha_map }, used) in materials.into_iter().zip(used) {
        let mut placement = Placement::default();
        if *used && let Some((texture, of_joined, mode)) = loader.load(color_map.as_ref(), alpha_map.as_ref())? {
            material.texture = Some(texture);
            placement = of_joined.or(color_map.or(alpha_map).map(|map| map.placement)).unwrap_or_default();
            if material.alpha_mode == AlphaMode::Opaque {
                material.alpha_mode = mode;
            }
        }
        placements.push(placement);
        loader.model.materials.push(material);
    }
    Ok(placements)
}

impl Loader<'_, '_> {
    fn load(&mut self, color: Option<&TextureMap>, alpha: Option<&TextureMap>) -> Result<Loaded, LoadError> {
        // An image that is not joined with another is the same one for all placements.
        let join = color.is_some() && alpha.is_some();
        let key = [color, alpha].map(|map| map.map(|map| Key::new(map, join)));
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let of_color = color.map_or(Ok(None), |map| self.read(map))?;
        let of_alpha = alpha.map_or(Ok(None), |map| self.read(map))?;
        let loaded = match (color.zip(of_color), alpha.zip(of_alpha)) {
            (None, None) => None,
            (Some((map, (name, image))), None) => {
                Some((texture(name, image, map.wrap), map.placement, AlphaMode::Opaque))
            }
            (None, Some((map, (name, image)))) => {
                let values = alpha_of(&image);
                let rgba8 = values.iter().flat_map(|&alpha| [255, 255, 255, alpha]).collect();
                Some((texture(name, Decoded { rgba8, ..image }, map.wrap), map.placement, mode_of(&values)))
            }
            (Some((color_map, (color_name, color))), Some((map, (name, image)))) => {
                let joined = Joined::new(color_map, map);
                if !joined.is_exact {
                    let what = "map_d repeats unlike map_Kd, which one image cannot hold: it is placed like map_Kd";
                    self.warnings.push(format!("texture \"{}\": {what}", map.written));
                }
                let size = joined.size(&color, &image);
                let texels = u64::from(size.0) * u64::from(size.1);
                let External { model, limits, .. } = self.external;
                image_file::check_texels(texels, &shortened(&color_name), &mut self.texels, model, limits)?;
                let values = alpha_of(&image);
                let mode = mode_of(&values);
                let both = joined.image(&color, &Decoded { rgba8: values, ..image }, size);
                let name = if color_name == name { name } else { format!("{color_name}, {name}") };
                Some((texture(name, both, color_map.wrap), joined.placement(), mode))
            }
        };
        let loaded = loaded.map(|(texture, placement, mode)| {
            self.model.textures.push(texture);
            (self.model.textures.len() as u32 - 1, join.then_some(placement), mode)
        });
        self.known.insert(key, loaded);
        Ok(loaded)
    }

    /// Reads the image of a map, with the name of its file; `None` with a warning if that is not possible.
    fn read(&mut self, map: &TextureMap) -> Result<Option<(String, Decoded)>, LoadError> {
        let found = self.external.find(&map.names);
        match found.and_then(|file| read_image(&file, &mut self.texels, self.external)) {
            Ok(image) => return Ok(Some(image)),
            Err(error @ LoadError::TooLarge { .. }) => return Err(error),
            Err(LoadError::ImageTooLarge { image, what, count, limit, .. }) => {
                let path = self.external.model.to_owned();
                return Err(LoadError::ImageTooLarge { path, image, what, count, limit });
            }
            Err(LoadError::Outside { .. }) => {
                self.warnings.push(format!("texture \"{}\" leads out of the model's folder", map.written));
            }
            Err(error) => self.warnings.push(format!("texture {error}")),
        }
        Ok(None)
    }
}

fn texture(name: String, image: Decoded, wrap: Wrap) -> Texture {
    let Decoded { width, height, rgba8, .. } = image;
    Texture { name, width, height, rgba8: rgba8.into(), wrap: [wrap; 2], smooth: true }
}

fn read_image(file: &Path, texels: &mut u64, external: &External) -> Result<(String, Decoded), LoadError> {
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
    let bytes = external.read(file)?;
    let image = image_file::decode(&image_file::OF_OBJ, &bytes, &shortened(&name), file, external.limits, texels)?;
    Ok((name, image))
}

/// The alpha that an image stands for as `map_d`, one byte per texel: its alpha channel, else its luminance
/// (Rec. ITU-R BT.709, of the encoded values).
fn alpha_of(image: &Decoded) -> Vec<u8> {
    let texels = image.rgba8.as_chunks::<4>().0.iter();
    if image.has_alpha {
        return texels.map(|texel| texel[3]).collect();
    }
    texels
        .map(|&[r, g, b, _]| ((2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b) + 5000) / 10_000) as u8)
        .collect()
}

fn mode_of(alpha: &[u8]) -> AlphaMode {
    if alpha.iter().all(|&alpha| alpha == 255) {
        AlphaMode::Opaque
    } else if alpha.iter().all(|&alpha| alpha == 0 || alpha == 255) {
        AlphaMode::Mask { cutoff: 0.5 }
    } else {
        AlphaMode::Blend
    }
}
