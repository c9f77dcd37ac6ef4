//! Instances of a node's mesh (`EXT_mesh_gpu_instancing`).

use super::accessor::{Accessor, Integers, Purpose};
use super::document::Document;
use super::extensions::INSTANCING;
use super::scene::trs;
use glam::DAffine3;
use gltf::json::Index;
use std::collections::BTreeMap;

/// The instances of a node: their number, and their transforms by an accessor each.
pub(super) struct Instances<'d> {
    pub count: u64,
    translation: Option<Accessor<'d>>,
    rotation: Option<Accessor<'d>>,
    scale: Option<Accessor<'d>>,
}

impl<'d> Instances<'d> {
    /// The instances of a node, or `None` if it has only its own place.
    ///
    /// # Errors
    /// An invalid accessor, accessors of different lengths, or none.
    pub fn of_node(document: &'d Document, node: usize) -> Result<Option<Self>, String> {
        let Some(attributes) = document.extra.nodes[node].instancing() else { return Ok(None) };
        Self::new(document, attributes).map(Some).map_err(|fault| format!("{INSTANCING}: {fault}"))
    }

    fn new(document: &'d Document, attributes: &BTreeMap<String, u32>) -> Result<Self, String> {
        let count_of = |accessor: u32| document.root.accessors[accessor as usize].count.0;
        let mut counts = attributes.iter().map(|(name, &accessor)| (name, count_of(accessor)));
        let (first, count) = counts.next().ok_or("no attribute")?;
        if let Some((other, more)) = counts.find(|(_, other)| *other != count) {
            return Err(format!("{count} elements of {first}, {more} of {other}"));
        }
        let open = |name: &str, purpose| match attributes.get(name) {
            Some(&accessor) => Accessor::new(document, Index::new(accessor), purpose)
                .map(Some)
                .map_err(|fault| format!("{name}: {fault}")),
            None => Ok(None),
        };
        Ok(Self {
            count,
            translation: open("TRANSLATION", Purpose::Matrices)?,
            rotation: open("ROTATION", Purpose::Rotation)?,
            scale: open("SCALE", Purpose::Matrices)?,
        })
    }

    /// The transforms from the mesh to the space of the node. Their number must have been limited before.
    ///
    /// # Errors
    /// Another number of components, or a rotation without a length.
    pub fn transforms(&self) -> Result<Vec<DAffine3>, String> {
        let read = |name: &str, fault: String| format!("{INSTANCING}: {name}: {fault}");
        let vectors = |name: &str, of: &Option<Accessor>| match of {
            Some(accessor) => accessor.floats::<3>(Integers::AsStated).map(Some).map_err(|fault| read(name, fault)),
            None => Ok(None),
        };
        let (translations, scales) = (vectors("TRANSLATION", &self.translation)?, vectors("SCALE", &self.scale)?);
        let rotations = match &self.rotation {
            Some(accessor) => Some(accessor.floats::<4>(Integers::AsStated).map_err(|fault| read("ROTATION", fault))?),
            None => None,
        };
        let transform = |instance: usize| {
            let vector = |of: &Option<Vec<[f32; 3]>>| of.as_ref().map(|values| values[instance].map(f64::from));
            let rotation = rotations.as_ref().map(|values| values[instance].map(f64::from));
            let matrix = trs(vector(&translations).as_ref(), rotation.as_ref(), vector(&scales).as_ref());
            matrix
                .map(DAffine3::from_mat4)
                .ok_or_else(|| format!("{INSTANCING}: the rotation of instance {instance} has no length"))
        };
        (0..self.count as usize).map(transform).collect()
    }
}
