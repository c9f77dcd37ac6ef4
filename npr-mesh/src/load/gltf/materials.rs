//! Materials, their textures, and the texture coordinates that they use.

use super::document::{self, Document};
use super::extensions::WEBP;
use super::files;
use crate::load::external::shortened;
use crate::load::image_file::{self, Decoded};
use crate::{AlphaMode, LoadError, Material, Model, Texture, Wrap};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{self, Index, material};
use std::borrow::Cow;
use std::collections::HashMap;

/// Materials and images of the file, converted on first use by a primitive.
#[derive(Default)]
pub(super) struct Materials {
    /// With indices into `textures`.
    converted: HashMap<Option<usize>, (Material, UvSource)>,
    textures: Vec<Texture>,
    /// Textures by image and sampler settings.
    slots: HashMap<(usize, [Wrap; 2], bool), u32>,
    /// By image the first texture, or `None` if the image cannot be decoded.
    images: HashMap<usize, Option<u32>>,
    /// The number of texels of all textures so far.
    texels: u64,
    /// The materials and textures of the current mesh: from those of the file to those of its model.
    materials_of_mesh: HashMap<Option<usize>, u32>,
    textures_of_mesh: HashMap<u32, u32>,
}

/// The value of the `gltf` crate for the source of a texture without source. Such textures have images of other
/// formats in extensions.
pub(super) const NO_SOURCE: usize = u32::MAX as usize;

/// The source of a primitive's texture coordinates.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct UvSource {
    /// The `n` of `TEXCOORD_n`.
    pub set: u32,
    /// Whether a texture uses them.
    pub wanted: bool,
    /// The columns of the matrix and the offset of `KHR_texture_transform`.
    transform: Option<[Vec2; 3]>,
}

impl UvSource {
    const DEFAULT: Self = Self { set: 0, wanted: false, transform: None };

    /// The coordinate at which the texture is sampled.
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        match self.transform {
            Some([u, v, offset]) => u * uv.x + v * uv.y + offset,
            None => uv,
        }
    }
}

impl Materials {
    /// Begins another mesh, with a model of its own.
    pub fn begin_mesh(&mut self) {
        // Clearing would take as long as the largest mesh so far needs.
        (self.materials_of_mesh, self.textures_of_mesh) = Default::default();
    }

    /// The index of a material in the model of the current mesh. `None` is the default material of glTF, white and
    /// single-sided (glTF 2.0, 3.9.6 "Default Material").
    ///
    /// # Errors
    /// A number that is not finite, or an image that exceeds a limit.
    pub fn get(
        &mut self,
        document: &Document,
        index: Option<Index<json::Material>>,
        model: &mut Model,
        warnings: &mut Vec<String>,
    ) -> Result<(u32, UvSource), LoadError> {
        let key = index.map(|i| i.value());
        if !self.converted.contains_key(&key) {
            let converted = self.convert(document, index, warnings)?;
            self.converted.insert(key, converted);
        }
        let (material, uv) = &self.converted[&key];
        let slot = *self.materials_of_mesh.entry(key).or_insert_with(|| {
            let place = |texture: u32| {
                *self.textures_of_mesh.entry(texture).or_insert_with(|| {
                    model.textures.push(self.textures[texture as usize].clone());
                    model.textures.len() as u32 - 1
                })
            };
            model.materials.push(material.with_textures(place));
            model.materials.len() as u32 - 1
        });
        Ok((slot, *uv))
    }

    fn convert(
        &mut self,
        document: &Document,
        index: Option<Index<json::Material>>,
        warnings: &mut Vec<String>,
    ) -> Result<(Material, UvSource), LoadError> {
        let mut material = Material { base_color: Vec4::ONE, double_sided: false, ..Material::default() };
        let mut uv = UvSource::DEFAULT;
        let Some(index) = index else { return Ok((material, uv)) };
        let number = index.value();
        let fail = |fault: &str| document.malformed(format!("material {number}: {fault}"));
        let source = &document.root.materials[number];
        material.name = document::name(source.name.as_deref());
        material.alpha_mode = alpha_mode(source).ok_or_else(|| fail("unknown alpha mode"))?;
        material.double_sided = source.double_sided;
        let extensions = source.extensions.as_ref();
        // Readers that support the specular-glossiness model always use it where a material has both.
        let (factor, info) = match extensions.and_then(|extensions| extensions.pbr_specular_glossiness.as_ref()) {
            Some(glossy) => (glossy.diffuse_factor.0, &glossy.diffuse_texture),
            None => {
                let metallic = &source.pbr_metallic_roughness;
                (metallic.base_color_factor.0, &metallic.base_color_texture)
            }
        };
        material.base_color = Vec4::from_array(factor);
        if !material.base_color.is_finite() {
            return Err(fail("its base colour is not finite"));
        }
        let clamped = material.base_color.clamp(Vec4::ZERO, Vec4::ONE);
        if clamped != material.base_color {
            warnings.push(format!("material {number}: its base colour {} is not within 0 to 1", material.base_color));
            material.base_color = clamped;
        }
        if let Some(info) = info {
            uv = uv_source(info).ok_or_else(|| fail("its texture transform is not finite"))?;
            material.texture = self.texture(document, number, info, warnings)?;
        }
        self.emission(document, number, &mut material, &mut uv, warnings)?;
        Ok((material, uv))
    }

    /// Reads the emissive factor, strength and texture.
    fn emission(
        &mut self,
        document: &Document,
        number: usize,
        material: &mut Material,
        uv: &mut UvSource,
        warnings: &mut Vec<String>,
    ) -> Result<(), LoadError> {
        let fail = |fault: &str| document.malformed(format!("material {number}: {fault}"));
        let source = &document.root.materials[number];
        let stated = Vec3::from_array(source.emissive_factor.0);
        if !stated.is_finite() {
            return Err(fail("its emission is not finite"));
        }
        let factor = stated.clamp(Vec3::ZERO, Vec3::ONE);
        if factor != stated {
            warnings.push(format!("material {number}: its emission {stated} is not within 0 to 1"));
        }
        let strength = source.extensions.as_ref().and_then(|extensions| extensions.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
        if !strength.is_finite() || strength < 0.0 {
            return Err(fail("its emissive strength is negative or not finite"));
        }
        let emissive = factor * strength;
        if emissive == Vec3::ZERO {
            return Ok(());
        }
        if let Some(info) = &source.emissive_texture {
            let own = uv_source(info).ok_or_else(|| fail("its texture transform is not finite"))?;
            if material.texture.is_some() && own != *uv {
                warnings.push(format!(
                    "material {number}: its emission is left out: the texture has other texture coordinates than that \
                     of the colour"
                ));
                return Ok(());
            }
            material.emissive_texture = self.texture(document, number, info, warnings)?;
            if material.emissive_texture.is_none() {
                // Without its texture, the whole surface would be bright.
                return Ok(());
            }
            *uv = own;
        }
        material.emissive = emissive;
        Ok(())
    }

    fn texture(
        &mut self,
        document: &Document,
        material: usize,
        info: &Info,
        warnings: &mut Vec<String>,
    ) -> Result<Option<u32>, LoadError> {
        let number = info.index.value();
        let texture = &document.root.textures[number];
        let sampler = texture.sampler.map(|index| &document.root.samplers[index.value()]);
        let wrap = sampler.map_or([Wrap::Repeat; 2], |s| [wrap(&s.wrap_s), wrap(&s.wrap_t)]);
        let smooth = !sampler.is_some_and(|s| matches!(s.mag_filter, Some(Checked::Valid(MagFilter::Nearest))));
        let extra = document.extra.textures.get(number);
        let webp = extra.and_then(|texture| texture.source(WEBP)).map(|source| source as usize);
        let image = webp.unwrap_or(texture.source.value());
        if image == NO_SOURCE {
            let names = extra.and_then(|texture| texture.extensions.as_ref()).into_iter().flat_map(|of| of.keys());
            let names: Vec<String> = names.map(|name| shortened(name)).collect();
            let why = match &names[..] {
                [] => "it has no image".to_owned(),
                names => format!("its image is in the extension {}, which is not supported", names.join(" or ")),
            };
            warnings.push(format!("material {material}: texture {number} is left out: {why}"));
            return Ok(None);
        }

        let key = (image, wrap, smooth);
        if let Some(&slot) = self.slots.get(&key) {
            return Ok(Some(slot));
        }
        let made = match self.images.get(&image) {
            Some(None) => return Ok(None),
            Some(Some(first)) => {
                let first = &self.textures[*first as usize];
                self.texels += u64::from(first.width) * u64::from(first.height);
                if self.texels > document.limits.texels_in_all {
                    return Err(document.too_large("texels in all images", self.texels, document.limits.texels_in_all));
                }
                Texture { wrap, smooth, ..first.clone() }
            }
            None => match decode(document, image, &mut self.texels) {
                Ok(texture) => Texture { wrap, smooth, ..texture },
                Err(error @ (LoadError::TooLarge { .. } | LoadError::ImageTooLarge { .. })) => return Err(error),
                Err(error) => {
                    let why = match error {
                        // Warnings do not contain the name of the model.
                        LoadError::Malformed { path, fault } if path == document.path => fault,
                        LoadError::Outside { name, .. } => format!("URI \"{name}\" leads out of the model's folder"),
                        other => other.to_string(),
                    };
                    warnings.push(format!("image {image} is left out: {why}"));
                    self.images.insert(image, None);
                    return Ok(None);
                }
            },
        };
        let slot = self.textures.len() as u32;
        self.textures.push(made);
        self.slots.insert(key, slot);
        self.images.entry(image).or_insert(Some(slot));
        Ok(Some(slot))
    }
}

/// Decodes an image from a buffer view, a `data:` URI or a file, with default sampling.
fn decode(document: &Document, number: usize, texels: &mut u64) -> Result<Texture, LoadError> {
    let fail = |fault: String| document.malformed(fault);
    let image = &document.root.images[number];
    let mut name = shortened(image.name.as_deref().unwrap_or_default());
    if name.is_empty() {
        name = format!("#{number}");
    }
    let bytes: Cow<[u8]> = match (image.buffer_view, image.uri.as_deref()) {
        (Some(view), _) => files::view(document, view).map_err(fail)?.0.into(),
        (None, Some(uri)) => match files::data_uri(uri) {
            Some(bytes) => bytes.map_err(fail)?.into(),
            None => {
                let file = document.external.find(&files::names(uri).map_err(fail)?)?;
                name = shortened(uri);
                document.external.read(&file)?.into()
            }
        },
        (None, None) => return Err(fail("neither a buffer view nor a URI".to_owned())),
    };
    let image = image_file::decode(&image_file::OF_GLTF, &bytes, &name, document.path, document.limits, texels)?;
    let Decoded { width, height, rgba8, .. } = image;
    Ok(Texture { name, width, height, rgba8: rgba8.into(), wrap: [Wrap::Repeat; 2], smooth: true })
}

fn alpha_mode(material: &json::Material) -> Option<AlphaMode> {
    Some(match material.alpha_mode {
        Checked::Valid(material::AlphaMode::Opaque) => AlphaMode::Opaque,
        Checked::Valid(material::AlphaMode::Mask) => {
            AlphaMode::Mask { cutoff: material.alpha_cutoff.unwrap_or_default().0 }
        }
        Checked::Valid(material::AlphaMode::Blend) => AlphaMode::Blend,
        Checked::Invalid => return None,
    })
}

fn wrap(mode: &Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        // Unknown modes are treated as absent.
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    }
}

/// `None` if the transform is not finite.
///
/// The extension specifies a counter-clockwise rotation with v downwards, and its example of a quarter turn shows the
/// lower left quadrant: the rotation maps u to -v. The matrix printed there, read as GLSL columns, rotates the other
/// way.
fn uv_source(info: &Info) -> Option<UvSource> {
    let mut source = UvSource { set: info.tex_coord, wanted: true, transform: None };
    if let Some(transform) = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) {
        let (sine, cosine) = transform.rotation.0.sin_cos();
        let [scale_u, scale_v] = transform.scale.0;
        let columns = [
            Vec2::new(cosine, -sine) * scale_u,
            Vec2::new(sine, cosine) * scale_v,
            Vec2::from_array(transform.offset.0),
        ];
        if !columns.iter().all(|c| c.is_finite()) {
            return None;
        }
        source.set = transform.tex_coord.unwrap_or(source.set);
        source.transform = Some(columns);
    }
    Some(source)
}
