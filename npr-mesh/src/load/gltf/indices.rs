//! Checks the indices of a document, those of unused parts as well.

use super::document::Document;
use super::extra::Extra;
use crate::LoadError;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, texture};

/// Checks that every index refers to an element that exists.
///
/// # Errors
/// The first index that does not, with the element and the property that hold it.
pub(super) fn check(document: &Document) -> Result<(), LoadError> {
    let checker = Checker { root: &document.root, extra: &document.extra };
    checker.document().map_err(|fault| document.malformed(fault))
}

struct Checker<'a> {
    root: &'a Root,
    extra: &'a Extra,
}

/// The name of an element in messages.
type Owner<'a> = &'a dyn Fn() -> String;

/// An index of the `gltf` crate or a number as JSON has it.
trait Number {
    fn number(self) -> u64;
}

impl<T> Number for Index<T> {
    fn number(self) -> u64 {
        self.value() as u64
    }
}

impl Number for u32 {
    fn number(self) -> u64 {
        self.into()
    }
}

fn exists(owner: Owner, property: &str, kind: &str, number: u64, count: usize) -> Result<(), String> {
    if number < count as u64 { Ok(()) } else { Err(format!("{}: {property}: {kind} {number} does not exist", owner())) }
}

impl Checker<'_> {
    fn document(&self) -> Result<(), String> {
        let root = self.root;
        if let Some(scene) = root.scene.filter(|scene| scene.value() >= root.scenes.len()) {
            return Err(format!("scene {} does not exist", scene.value()));
        }
        for (number, scene) in root.scenes.iter().enumerate() {
            self.nodes(&|| format!("scene {number}"), "nodes", &scene.nodes)?;
        }
        self.node_properties()?;
        self.meshes()?;
        self.skins()?;
        self.animations()?;
        self.textures()?;
        self.materials()?;
        for (number, accessor) in root.accessors.iter().enumerate() {
            let owner: Owner = &|| format!("accessor {number}");
            self.view(owner, "bufferView", accessor.buffer_view)?;
            if let Some(sparse) = &accessor.sparse {
                self.view(owner, "sparse.indices", Some(sparse.indices.buffer_view))?;
                self.view(owner, "sparse.values", Some(sparse.values.buffer_view))?;
            }
        }
        for (number, view) in root.buffer_views.iter().enumerate() {
            let owner: Owner = &|| format!("buffer view {number}");
            exists(owner, "buffer", "buffer", view.buffer.number(), root.buffers.len())?;
        }
        for (number, image) in root.images.iter().enumerate() {
            self.view(&|| format!("image {number}"), "bufferView", image.buffer_view)?;
        }
        Ok(())
    }

    fn node_properties(&self) -> Result<(), String> {
        let root = self.root;
        for (number, (node, extra)) in root.nodes.iter().zip(&self.extra.nodes).enumerate() {
            let owner: Owner = &|| format!("node {number}");
            self.nodes(owner, "children", node.children.as_deref().unwrap_or(&[]))?;
            for (property, kind, index, count) in [
                ("mesh", "mesh", node.mesh.map(Number::number), root.meshes.len()),
                ("skin", "skin", node.skin.map(Number::number), root.skins.len()),
                ("camera", "camera", node.camera.map(Number::number), self.extra.cameras.len()),
            ] {
                index.map_or(Ok(()), |index| exists(owner, property, kind, index, count))?;
            }
            for (attribute, &accessor) in extra.instancing().into_iter().flatten() {
                self.accessor(owner, attribute, Some(accessor))?;
            }
        }
        Ok(())
    }

    fn meshes(&self) -> Result<(), String> {
        for (number, mesh) in self.root.meshes.iter().enumerate() {
            for (at, primitive) in mesh.primitives.iter().enumerate() {
                let owner: Owner = &|| format!("mesh {number} primitive {at}");
                for (semantic, &accessor) in &primitive.attributes {
                    // The crate does not keep the names of attributes that it does not know.
                    let property = match semantic {
                        Checked::Valid(semantic) => semantic.to_string(),
                        Checked::Invalid => "attributes".to_owned(),
                    };
                    self.accessor(owner, &property, Some(accessor))?;
                }
                self.accessor(owner, "indices", primitive.indices)?;
                let materials = self.root.materials.len();
                primitive.material.map_or(Ok(()), |m| exists(owner, "material", "material", m.number(), materials))?;
                for target in primitive.targets.iter().flatten() {
                    self.accessor(owner, "targets", target.positions)?;
                    self.accessor(owner, "targets", target.normals)?;
                    self.accessor(owner, "targets", target.tangents)?;
                }
            }
        }
        Ok(())
    }

    fn skins(&self) -> Result<(), String> {
        for (number, skin) in self.root.skins.iter().enumerate() {
            let owner: Owner = &|| format!("skin {number}");
            self.nodes(owner, "joints", &skin.joints)?;
            self.nodes(owner, "skeleton", skin.skeleton.as_slice())?;
            self.accessor(owner, "inverseBindMatrices", skin.inverse_bind_matrices)?;
        }
        Ok(())
    }

    fn animations(&self) -> Result<(), String> {
        for (number, animation) in self.extra.animations.iter().enumerate() {
            let owner: Owner = &|| format!("animation {number}");
            for channel in &animation.channels {
                let (node, sampler) = (channel.target.node, channel.sampler);
                node.map_or(Ok(()), |node| exists(owner, "target", "node", node.into(), self.root.nodes.len()))?;
                let samplers = animation.samplers.len();
                sampler.map_or(Ok(()), |sampler| exists(owner, "channel", "sampler", sampler.into(), samplers))?;
            }
            for sampler in &animation.samplers {
                self.accessor(owner, "input", sampler.input)?;
                self.accessor(owner, "output", sampler.output)?;
            }
        }
        Ok(())
    }

    fn textures(&self) -> Result<(), String> {
        let root = self.root;
        for (number, texture) in root.textures.iter().enumerate() {
            let owner: Owner = &|| format!("texture {number}");
            if let Some(sampler) = texture.sampler {
                exists(owner, "sampler", "sampler", sampler.number(), root.samplers.len())?;
            }
            let own = (texture.source.value() != super::materials::NO_SOURCE).then(|| texture.source.number());
            let webp = self.extra.textures.get(number).and_then(|texture| texture.source(super::extensions::WEBP));
            for source in [own, webp].into_iter().flatten() {
                exists(owner, "source", "image", source, root.images.len())?;
            }
        }
        Ok(())
    }

    fn materials(&self) -> Result<(), String> {
        for (number, material) in self.root.materials.iter().enumerate() {
            let owner: Owner = &|| format!("material {number}");
            let pbr = &material.pbr_metallic_roughness;
            let glossy = material.extensions.as_ref().and_then(|e| e.pbr_specular_glossiness.as_ref());
            let of_info = |info: &Option<texture::Info>| info.as_ref().map(|info| info.index);
            for (property, texture) in [
                ("baseColorTexture", of_info(&pbr.base_color_texture)),
                ("metallicRoughnessTexture", of_info(&pbr.metallic_roughness_texture)),
                ("normalTexture", material.normal_texture.as_ref().map(|texture| texture.index)),
                ("occlusionTexture", material.occlusion_texture.as_ref().map(|texture| texture.index)),
                ("emissiveTexture", of_info(&material.emissive_texture)),
                ("diffuseTexture", glossy.and_then(|glossy| of_info(&glossy.diffuse_texture))),
                ("specularGlossinessTexture", glossy.and_then(|glossy| of_info(&glossy.specular_glossiness_texture))),
            ] {
                let textures = self.root.textures.len();
                texture.map_or(Ok(()), |index| exists(owner, property, "texture", index.number(), textures))?;
            }
        }
        Ok(())
    }

    fn nodes<T>(&self, owner: Owner, property: &str, nodes: &[Index<T>]) -> Result<(), String> {
        nodes.iter().try_for_each(|node| exists(owner, property, "node", node.number(), self.root.nodes.len()))
    }

    fn accessor(&self, owner: Owner, property: &str, accessor: Option<impl Number>) -> Result<(), String> {
        let count = self.root.accessors.len();
        accessor.map_or(Ok(()), |accessor| exists(owner, property, "accessor", accessor.number(), count))
    }

    fn view(&self, owner: Owner, property: &str, view: Option<impl Number>) -> Result<(), String> {
        let count = self.root.buffer_views.len();
        view.map_or(Ok(()), |view| exists(owner, property, "buffer view", view.number(), count))
    }
}
