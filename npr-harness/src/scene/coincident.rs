//! Coincident faces of different objects.
//!
//! Within a mesh, faces that overlap in one plane are separated when the mesh is prepared. Those of different objects are
//! found when objects are placed: only faces where the boxes of two objects touch are compared. An object with such faces
//! gets a mesh of its own, in scene space, so that equal corners have equal depths; of two objects the later wins, by the
//! rule of [`npr_mesh::coplanar`].

use super::Scene;
use super::mesh::Mesh;
use super::object::{Object, Unseparated};
use glam::{DAffine3, DVec3, Vec2, Vec4};
use npr_mesh::coplanar::{ROUNDING, Separated, separate};
use npr_mesh::weld::rounding_tolerance;
use npr_mesh::{Model, SideVisibility};
use std::collections::HashMap;
use std::sync::Arc;

/// The number of faces near other objects from which on the comparison is left out, since it would take seconds.
const MOST_FACES: usize = 4_000_000;

/// A box in scene space.
type Box3 = (DVec3, DVec3);

impl Scene {
    /// Gives objects with coincident faces meshes of their own. Returns whether any object has one now.
    ///
    /// All objects must have the meshes of the file.
    pub(super) fn separate_objects(&mut self) -> bool {
        let Some((merged, faces)) = self.faces_near_other_objects() else { return false };
        let Some(Separated { model, sources, coincident }) = separate(&merged) else { return false };
        let mut changed = vec![false; self.objects.len()];
        coincident.iter().for_each(|&face| changed[faces[face as usize][0] as usize] = true);
        // Per object, and per face of it, its pieces in the result.
        let mut pieces: Vec<HashMap<u32, Vec<u32>>> = vec![HashMap::new(); self.objects.len()];
        for &[object, face] in &faces {
            pieces[object as usize].insert(face, Vec::new());
        }
        for (piece, &source) in (0u32..).zip(&sources) {
            let [object, face] = faces[source as usize];
            pieces[object as usize].entry(face).or_default().push(piece);
        }
        // Meshes that an object keeps.
        let mut kept = vec![false; self.meshes.len()];
        for (object, _) in self.objects.iter().zip(&changed).filter(|(_, changed)| !**changed) {
            kept[object.mesh] = true;
        }
        for number in (0..self.objects.len()).filter(|&number| changed[number]) {
            let object = &self.objects[number];
            let unseparated = Unseparated { mesh: object.mesh, scene_from_mesh: *object.scene_from_mesh() };
            let own = self.file_meshes[object.mesh].model().clone().transformed(object.scene_from_mesh());
            let own = with_pieces(own, &pieces[number], &model);
            // Rounding in scene space may be coarser than in the mesh's own.
            let of_file = f64::from(self.file_meshes[object.mesh].edges().tolerance) * object.largest_scale();
            let tolerance = (of_file as f32).max(rounding_tolerance(&own.positions, &own.faces));
            let mesh = Arc::new(Mesh::of_separated(own, tolerance));
            // The mesh of the file makes way if no other object has it.
            let at = unseparated.mesh;
            let place = if std::mem::replace(&mut kept[at], true) {
                self.meshes.push(mesh);
                self.first_materials.push(self.first_materials[at]);
                self.meshes.len() - 1
            } else {
                self.meshes[at] = mesh;
                at
            };
            let object = &mut self.objects[number];
            (object.mesh, object.unseparated) = (place, Some(unseparated));
            object.place(DAffine3::IDENTITY);
        }
        changed.contains(&true)
    }

    /// Returns all objects to the meshes of the file. Returns whether any had one of its own.
    pub(super) fn restore_file_meshes(&mut self) -> bool {
        let mut had_own = false;
        for object in &mut self.objects {
            if let Some(Unseparated { mesh, scene_from_mesh }) = object.unseparated.take() {
                object.mesh = mesh;
                object.place(scene_from_mesh);
                had_own = true;
            }
        }
        if had_own {
            self.meshes.clone_from(&self.file_meshes);
            self.first_materials.truncate(self.meshes.len());
        }
        had_own
    }

    /// The faces in the boxes where objects touch, in scene space, each a polygon of its own; and of each its object and
    /// number. `None` if no boxes touch, or too many faces are there.
    fn faces_near_other_objects(&self) -> Option<(Model, Vec<[u32; 2]>)> {
        let places = self.touching_boxes();
        if places.iter().all(Vec::is_empty) {
            return None;
        }
        let mut merged = Model { materials: self.materials.clone(), ..Model::default() };
        let mut faces = Vec::new();
        for (number, places) in (0u32..).zip(&places).filter(|(_, places)| !places.is_empty()) {
            let (object, mesh) = self.placed(number);
            let model = mesh.model();
            let mut vertex_of: HashMap<u32, u32> = HashMap::new();
            for (face, &corners) in (0u32..).zip(&model.faces) {
                let at = corners.map(|vertex| object.point(model.positions[vertex as usize]));
                let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
                let touches = |&(from, to): &Box3| !(low.cmpgt(to).any() || high.cmplt(from).any());
                if !places.iter().any(touches) {
                    continue;
                }
                let mut add = |vertex: u32| {
                    *vertex_of.entry(vertex).or_insert_with(|| {
                        let at = vertex as usize;
                        merged.positions.push(object.point(model.positions[at]).as_vec3());
                        merged.normals.push(object.normal(model.normals[at]).as_vec3());
                        merged.uvs.push(model.uvs.get(at).copied().unwrap_or(Vec2::ZERO));
                        merged.colors.push(model.colors.get(at).copied().unwrap_or(Vec4::ONE));
                        merged.positions.len() as u32 - 1
                    })
                };
                let [a, b, c] = corners.map(&mut add);
                merged.faces.push(if object.is_mirrored() { [a, c, b] } else { [a, b, c] });
                merged.face_material.push(self.material_number(number, face) as u32);
                merged.one_sided.push(model.is_one_sided(face));
                let [p, q, r] = model.side_visibility.get(face as usize).copied().unwrap_or_default();
                merged.side_visibility.push(if object.is_mirrored() { [r, q, p] } else { [p, q, r] });
                faces.push([number, face]);
                if faces.len() > MOST_FACES {
                    return None;
                }
            }
        }
        Some((merged, faces))
    }

    /// Per object the boxes that it has in common with other objects' boxes.
    fn touching_boxes(&self) -> Vec<Vec<Box3>> {
        let mut places = vec![Vec::new(); self.objects.len()];
        let around =
            |(number, (object, mesh)): (usize, (&Object, &Mesh))| Some((number, object.box_around(mesh.bounds()?)));
        let mut boxes: Vec<(usize, Box3)> = self.placed_objects().enumerate().filter_map(around).collect();
        let largest = boxes.iter().map(|(_, (low, high))| low.abs().max(high.abs()).max_element()).fold(0.0, f64::max);
        let slack = 2.0 * ROUNDING * largest;
        boxes.sort_by(|(_, a), (_, b)| a.0.x.total_cmp(&b.0.x));
        // Those whose range along x is not over yet.
        let mut open: Vec<(usize, Box3)> = Vec::new();
        for (number, (low, high)) in boxes {
            open.retain(|(_, (_, other_high))| other_high.x + slack >= low.x);
            for &(other, (other_low, other_high)) in &open {
                let (from, to) = (low.max(other_low) - slack, high.min(other_high) + slack);
                if from.cmple(to).all() {
                    places[number].push((from, to));
                    places[other].push((from, to));
                }
            }
            open.push((number, (low, high)));
        }
        places
    }
}

/// A model in scene space in which faces are replaced by pieces of another.
fn with_pieces(mut own: Model, pieces: &HashMap<u32, Vec<u32>>, from: &Model) -> Model {
    let has_polygons = !own.face_polygon.is_empty();
    let faces = std::mem::take(&mut own.faces);
    let [materials, meshes, polygons] =
        [&mut own.face_material, &mut own.face_mesh, &mut own.face_polygon].map(std::mem::take);
    let one_sided = std::mem::take(&mut own.one_sided);
    let sides = std::mem::take(&mut own.side_visibility);
    let mut vertex_of: HashMap<u32, u32> = HashMap::new();
    for (face, corners) in (0u32..).zip(faces) {
        let number = face as usize;
        let add = |own: &mut Model, corners: [u32; 3], one_sided: bool, of_sides: &[[SideVisibility; 3]], at: usize| {
            own.faces.push(corners);
            own.side_visibility.extend(of_sides.get(at).filter(|_| !sides.is_empty()));
            own.face_material.push(materials[number]);
            own.face_mesh.extend(meshes.get(number));
            own.face_polygon.push(if has_polygons { polygons[number] } else { face });
            own.one_sided.push(one_sided);
        };
        let Some(pieces) = pieces.get(&face) else {
            add(&mut own, corners, one_sided.get(number) == Some(&true), &sides, number);
            continue;
        };
        for &piece in pieces {
            let corners = from.faces[piece as usize].map(|vertex| {
                *vertex_of.entry(vertex).or_insert_with(|| {
                    let at = vertex as usize;
                    own.positions.push(from.positions[at]);
                    own.normals.push(from.normals[at]);
                    if !own.uvs.is_empty() {
                        own.uvs.push(from.uvs[at]);
                    }
                    if !own.colors.is_empty() {
                        own.colors.push(from.colors[at]);
                    }
                    own.positions.len() as u32 - 1
                })
            });
            let one_sided = from.is_one_sided(piece);
            add(&mut own, corners, one_sided, &from.side_visibility, piece as usize);
        }
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rays::Hit;
    use glam::Vec3;
    use npr_mesh::{Material, embedded};

    /// Squares in the plane z = 0, each an object with a material of its own: half side, position and turn about z.
    fn squares(of: &[(f32, Vec3, bool)]) -> Scene {
        let square = |&(half, _, _): &(f32, Vec3, bool)| Model {
            positions: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| Vec3::new(x, y, 0.0) * half)
                .to_vec(),
            normals: vec![Vec3::Z; 4],
            faces: vec![[0, 1, 2], [0, 2, 3]],
            face_material: vec![0, 0],
            materials: vec![Material::default()],
            ..Model::default()
        };
        let object = |(mesh, &(_, at, turned)): (usize, &(f32, Vec3, bool))| npr_mesh::Object {
            name: mesh.to_string(),
            mesh,
            world_from_mesh: DAffine3::from_translation(at.as_dvec3())
                * if turned { DAffine3::from_rotation_y(std::f64::consts::PI) } else { DAffine3::IDENTITY },
        };
        let objects = of.iter().enumerate().map(object).collect();
        Scene::with_objects(of.iter().map(square).collect(), objects).expect("they can be placed")
    }

    /// The objects that a ray along z meets and that show it a face, near to far.
    fn seen(scene: &Scene, x: f64, y: f64, from: f64) -> Vec<u32> {
        let shown = |hit: &Hit| hit.front || scene.shows_back(hit.object, hit.face);
        let hits = scene.all(DVec3::new(x, y, from), DVec3::new(0.0, 0.0, -from), (0.0, 2.0), shown);
        hits.iter().map(|hit| hit.object).collect()
    }

    #[test]
    fn of_objects_in_one_plane_the_later_is_seen_and_the_other_around_it() {
        let scene = squares(&[(1.0, Vec3::ZERO, false), (0.5, Vec3::new(0.1, 0.0, 0.0), false)]);
        for from in [3.0, -3.0] {
            assert_eq!(seen(&scene, 0.2, 0.1, from), [1]);
            assert_eq!(seen(&scene, -0.8, 0.3, from), [0]);
        }
        let other_order = squares(&[(0.5, Vec3::new(0.1, 0.0, 0.0), false), (1.0, Vec3::ZERO, false)]);
        assert_eq!(seen(&other_order, 0.2, 0.1, 3.0), [1], "the sheet is later and hides the mark");
    }

    #[test]
    fn of_opposite_objects_the_one_turned_to_the_eye_is_seen() {
        let scene = squares(&[(1.0, Vec3::ZERO, false), (0.5, Vec3::ZERO, true)]);
        assert_eq!((seen(&scene, 0.2, 0.1, 3.0), seen(&scene, 0.2, 0.1, -3.0)), (vec![0], vec![1]));
        assert_eq!((seen(&scene, 0.7, 0.1, 3.0), seen(&scene, 0.7, 0.1, -3.0)), (vec![0], vec![0]));
    }

    #[test]
    fn an_object_that_moves_away_leaves_the_other_whole() {
        let mut scene = squares(&[(1.0, Vec3::ZERO, false), (0.5, Vec3::ZERO, false)]);
        let version = scene.materials_version;
        assert_eq!(scene.meshes().len(), 2, "own meshes take the places of those of the file");
        scene.place(1, &DAffine3::from_translation(DVec3::new(0.0, 0.0, 0.5))).expect("it has an inverse");
        assert_eq!(seen(&scene, 0.2, 0.1, 3.0), [1, 0]);
        assert_ne!(scene.materials_version, version, "an upload is out of date");
        let version = scene.materials_version;
        scene.place(1, &DAffine3::from_translation(DVec3::new(0.0, 0.0, 0.7))).expect("it has an inverse");
        assert_eq!(scene.materials_version, version, "nothing coincided before or after");
        scene.place(1, &DAffine3::IDENTITY).expect("it has an inverse");
        assert_eq!(seen(&scene, 0.2, 0.1, 3.0), [1]);
        assert_eq!(*scene.objects()[1].scene_from_mesh(), DAffine3::IDENTITY);
    }

    #[test]
    fn objects_that_do_not_coincide_share_their_mesh() {
        let cube = embedded::cube();
        let at = |x: f64| npr_mesh::Object {
            name: String::new(),
            mesh: 0,
            world_from_mesh: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
        };
        let apart = Scene::with_objects(vec![cube.clone()], vec![at(0.0), at(5.0), at(9.0)]).expect("placed");
        assert_eq!(apart.meshes().len(), 1);
        // Two of three cubes at one place: the third keeps the mesh of the file.
        let twice = Scene::with_objects(vec![cube], vec![at(5.0), at(0.0), at(5.0)]).expect("placed");
        assert_eq!(twice.meshes().len(), 3);
        assert_eq!(twice.objects()[1].mesh(), 0);
        assert!(twice.mesh_of(&twice.objects()[0]).model().faces.is_empty(), "the later cube hides the whole of it");
    }
}
