//! What a file holds.

use super::far;
use super::options::CREASE_ANGLE_RAD;
use crate::weld::Weld;
use crate::{AlphaMode, Material, Model, Object, Texture, Warning, Wrap, normals};
use glam::{BVec3, DAffine3, DVec3, Vec3};
use std::collections::HashMap;

/// What a file holds: meshes, each once, and the objects that place them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loaded {
    /// Each in its own space, with faces or lines or both, and with the materials and textures that it uses. All normals
    /// are present.
    pub meshes: Vec<Model>,
    /// In the order of the file's nodes, depth first. At least one.
    pub objects: Vec<Object>,
    /// Distinct warnings in the order of their first occurrence.
    pub warnings: Vec<Warning>,
    /// Which vertices are to be one vertex for edges, as [`LoadOptions::weld`](crate::LoadOptions::weld).
    pub weld: Weld,
}

impl Loaded {
    /// All objects in one model in world space; a single object at the origin is not copied.
    ///
    /// Objects are appended in their order, [transformed](Model::transformed). If there are several,
    /// [`Model::face_mesh`] is the index of the object, and equal materials and textures of different meshes are one.
    /// A singular transform destroys normals; they are made from the transformed faces.
    ///
    /// Positions are f32 in world space, so digits are lost where objects are far from the origin.
    /// [`Loaded::into_model_near`] keeps them.
    ///
    /// # Panics
    /// If an object has a mesh that does not exist. The loader makes no such object.
    pub fn into_model(self) -> Model {
        let Self { mut meshes, objects, .. } = self;
        if let [object] = &objects[..] {
            return placed(meshes.swap_remove(object.mesh), &object.world_from_mesh);
        }
        let mut uses = vec![0u32; meshes.len()];
        objects.iter().for_each(|object| uses[object.mesh] += 1);
        if meshes.iter().any(|mesh| !mesh.face_material.is_empty()) {
            meshes.iter_mut().for_each(Model::fill_face_material);
        }
        let mut model = Model::default();
        let mut merge = Merge::default();
        meshes.iter_mut().zip(&uses).filter(|(_, uses)| **uses > 0).for_each(|(mesh, _)| merge.mesh(&mut model, mesh));
        for (number, object) in objects.iter().enumerate() {
            uses[object.mesh] -= 1;
            let mesh = &mut meshes[object.mesh];
            let mesh = if uses[object.mesh] == 0 { std::mem::take(mesh) } else { mesh.clone() };
            let mesh = placed(mesh, &object.world_from_mesh);
            model.append_geometry(&mesh);
            model.face_material.extend_from_slice(&mesh.face_material);
            model.face_mesh.resize(model.faces.len(), number as u32);
        }
        model
    }

    /// All objects in one model, as by [`Loaded::into_model`], with an origin that was subtracted from the positions in
    /// f64. It is 0, or the middle of the box around all objects, rounded to f32, where that is at least four times as far
    /// from 0 as the box is large. Positions far from 0 keep their digits then.
    ///
    /// # Panics
    /// As [`Loaded::into_model`].
    pub fn into_model_near(mut self) -> (Model, DVec3) {
        let origin = self.far_middle().unwrap_or_default();
        self.objects.iter_mut().for_each(|object| object.world_from_mesh.translation -= origin);
        (self.into_model(), origin)
    }

    /// The middle of the box around all objects, if it is far from 0.
    fn far_middle(&self) -> Option<DVec3> {
        let boxes: Vec<_> = self.meshes.iter().map(Model::bounds).collect();
        let corners = self.objects.iter().filter_map(|object| Some((object, boxes[object.mesh]?)));
        let corners = corners.flat_map(|(object, (low, high))| {
            let corner = move |i: u32| Vec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), low, high);
            (0..8).map(move |i| object.world_from_mesh.transform_point3(corner(i).as_dvec3()))
        });
        let (low, high) = corners.map(|corner| (corner, corner)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        far::offset(low, high)
    }
}

fn placed(mesh: Model, world_from_mesh: &DAffine3) -> Model {
    if *world_from_mesh == DAffine3::IDENTITY {
        return mesh;
    }
    let mut model = mesh.transformed(world_from_mesh);
    if model.normals.contains(&Vec3::ZERO) {
        normals::fill_missing(&mut model, CREASE_ANGLE_RAD);
    }
    model
}

/// Merges the materials and textures of meshes.
#[derive(Default)]
struct Merge {
    textures: HashMap<TextureKey, u32>,
    /// By material and the number of materials before it in its mesh that are equal, since equal materials of one
    /// mesh remain distinct.
    materials: HashMap<(MaterialKey, u32), u32>,
}

type TextureKey = (*const u8, [Wrap; 2], bool);
type MaterialKey = (String, [u32; 4], [u32; 3], [Option<u32>; 2], (bool, Option<u32>), bool);

impl Merge {
    /// Moves the materials and textures of a mesh to the model.
    fn mesh(&mut self, model: &mut Model, mesh: &mut Model) {
        let add_texture = |texture: Texture| {
            let key = (texture.rgba8.as_ptr(), texture.wrap, texture.smooth);
            *self.textures.entry(key).or_insert_with(|| {
                model.textures.push(texture);
                model.textures.len() as u32 - 1
            })
        };
        let textures: Vec<u32> = mesh.textures.drain(..).map(add_texture).collect();
        let mut equal: HashMap<MaterialKey, u32> = HashMap::new();
        let add_material = |material: Material| {
            let material = material.with_textures(|texture| textures[texture as usize]);
            let before = equal.entry(key(&material)).or_default();
            *before += 1;
            *self.materials.entry((key(&material), *before)).or_insert_with(|| {
                model.materials.push(material);
                model.materials.len() as u32 - 1
            })
        };
        let materials: Vec<u32> = mesh.materials.drain(..).map(add_material).collect();
        mesh.face_material.iter_mut().for_each(|material| *material = materials[*material as usize]);
    }
}

fn key(material: &Material) -> MaterialKey {
    let alpha = match material.alpha_mode {
        AlphaMode::Opaque => (false, None),
        AlphaMode::Mask { cutoff } => (false, Some(cutoff.to_bits())),
        AlphaMode::Blend => (true, None),
    };
    let color = material.base_color.to_array().map(f32::to_bits);
    let emissive = material.emissive.to_array().map(f32::to_bits);
    let textures = [material.texture, material.emissive_texture];
    (material.name.clone(), color, emissive, textures, alpha, material.double_sided)
}
