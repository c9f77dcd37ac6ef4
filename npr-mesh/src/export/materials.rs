//! Materials, textures, images and samplers of a file.

use super::buffer::Buffer;
use super::error::ExportError;
use crate::{AlphaMode, Material, Model, Texture, Wrap};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde_json::{Map, Value, json};
use std::collections::HashMap;

/// The extension for emission above 1.
pub(super) const STRENGTH: &str = "KHR_materials_emissive_strength";

/// What the meshes of a file share. Equal materials of different meshes are one.
#[derive(Default)]
pub(super) struct Materials {
    materials: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    /// By a material as JSON and the number of those equal to it before it in its mesh.
    known: HashMap<(String, usize), usize>,
    known_textures: HashMap<(usize, usize), usize>,
    known_samplers: HashMap<String, usize>,
    /// By the address of the texels, which the models hold.
    known_images: HashMap<*const u8, usize>,
}

impl Materials {
    /// Adds a model's materials and returns their numbers.
    pub fn add(&mut self, model: &Model, buffer: &mut Buffer) -> Result<Vec<usize>, ExportError> {
        let textures = model.textures.iter().map(|texture| self.texture(texture, buffer));
        let textures = textures.collect::<Result<Vec<_>, _>>()?;
        let mut before: HashMap<String, usize> = HashMap::new();
        let mut number_of = |material: &Material| {
            let value = material_json(material, &textures);
            let equal = before.entry(value.to_string()).or_default();
            let next = self.materials.len();
            let number = *self.known.entry((value.to_string(), *equal)).or_insert(next);
            *equal += 1;
            if number == next {
                self.materials.push(value);
            }
            number
        };
        Ok(model.materials.iter().map(&mut number_of).collect())
    }

    fn texture(&mut self, texture: &Texture, buffer: &mut Buffer) -> Result<usize, ExportError> {
        let image = match self.known_images.get(&texture.rgba8.as_ptr()) {
            Some(&known) => known,
            None => {
                let view = buffer.view(&png(texture)?);
                self.images.push(json!({"bufferView": view, "mimeType": "image/png", "name": texture.name}));
                self.known_images.insert(texture.rgba8.as_ptr(), self.images.len() - 1);
                self.images.len() - 1
            }
        };
        let sampler = sampler_json(texture);
        let next = self.samplers.len();
        let sampler_number = *self.known_samplers.entry(sampler.to_string()).or_insert(next);
        if sampler_number == next {
            self.samplers.push(sampler);
        }
        let next = self.textures.len();
        let number = *self.known_textures.entry((image, sampler_number)).or_insert(next);
        if number == next {
            self.textures.push(json!({"source": image, "sampler": sampler_number}));
        }
        Ok(number)
    }

    /// Whether any material needs [`STRENGTH`].
    pub fn have_strength(&self) -> bool {
        self.materials.iter().any(|material| material.get("extensions").is_some())
    }

    pub fn finish(self, members: &mut Map<String, Value>) {
        let Self { materials, textures, samplers, images, .. } = self;
        let all = [("materials", materials), ("textures", textures), ("samplers", samplers), ("images", images)];
        for (key, values) in all {
            if !values.is_empty() {
                members.insert(key.to_owned(), Value::Array(values));
            }
        }
    }
}

fn png(texture: &Texture) -> Result<Vec<u8>, ExportError> {
    let Texture { name, width, height, rgba8, .. } = texture;
    let failed = |source| ExportError::Texture { name: name.clone(), source };
    if rgba8.len() as u64 != 4 * u64::from(*width) * u64::from(*height) {
        let kind = image::error::ParameterErrorKind::DimensionMismatch;
        return Err(failed(image::ImageError::Parameter(image::error::ParameterError::from_kind(kind))));
    }
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(rgba8, *width, *height, ExtendedColorType::Rgba8).map_err(failed)?;
    Ok(bytes)
}

fn sampler_json(texture: &Texture) -> Value {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    };
    let [u, v] = texture.wrap.map(wrap);
    json!({"wrapS": u, "wrapT": v, "magFilter": if texture.smooth { 9729 } else { 9728 }})
}

fn material_json(material: &Material, textures: &[usize]) -> Value {
    let mut surface = json!({
        "baseColorFactor": material.base_color.to_array().map(f64::from),
        "metallicFactor": 0,
        "roughnessFactor": 1,
    });
    if let Some(texture) = material.texture {
        surface["baseColorTexture"] = json!({"index": textures[texture as usize]});
    }
    let mut value = json!({"pbrMetallicRoughness": surface, "doubleSided": material.double_sided});
    let strength = material.emissive.max_element();
    if strength > 0.0 {
        // A factor is at most 1; what is above is a strength.
        let factor = material.emissive / strength.max(1.0);
        value["emissiveFactor"] = json!(factor.to_array().map(f64::from));
        if strength > 1.0 {
            value["extensions"] = json!({STRENGTH: {"emissiveStrength": f64::from(strength)}});
        }
    }
    if let Some(texture) = material.emissive_texture {
        value["emissiveTexture"] = json!({"index": textures[texture as usize]});
    }
    if !material.name.is_empty() {
        value["name"] = json!(material.name);
    }
    match material.alpha_mode {
        AlphaMode::Opaque => {}
        AlphaMode::Mask { cutoff } => {
            value["alphaMode"] = json!("MASK");
            value["alphaCutoff"] = json!(f64::from(cutoff));
        }
        AlphaMode::Blend => value["alphaMode"] = json!("BLEND"),
    }
    value
}
