//! Tests of the vectors with which the directions of an artist's lines are rotated: that of each pixel, of each vertex,
//! and of the object.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, planned, rendered};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3, Vec4};
use npr_harness::camera::{Camera, Projection};
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::executor::Executor;
use npr_harness::image_lines::{ImageInk, Regions};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Lines, Style, style};
use npr_imagespace::artist::{
    ArtistRotation, LineKind, artist_color, artist_object_distance, ink_artist_direction, ink_artist_index,
};
use npr_imagespace::filter::fused::FusedFilter;
use npr_imagespace::filter::normal::{NORMAL_COS_CARD_MITCHELL, NORMAL_COS_OUTLINING_SKETCH};
use npr_imagespace::format::texel::{ink_texel64_pack, ink_texel64_tap};
use npr_mesh::{Material, Model, Object, Texture, Wrap};

const SIZE: (u32, u32) = (640, 360);

fn executors() -> Vec<Executor> {
    let mut executors = vec![Executor::Cpu { why: None }];
    executors.extend(device());
    executors
}

fn black_on_white(rotation: ArtistRotation, normal_cos: f32) -> Style {
    let filter = FusedFilter { normal_cos: Some(normal_cos), ..FusedFilter::default() };
    let ink = ImageInk { filter, artist: Some(rotation), regions: Regions::One, ..ImageInk::default() };
    let lines = Lines::image(ImageInk { composite: Default::default(), ..ink });
    Style { paper: Vec3::ONE, shade: Shade::Paper, lines, ..style("ink-image").expect("a style of the crate") }
}

/// The G-buffer of a picture.
fn texels(executor: &Executor, scene: &Scene, plan: &Plan) -> Vec<[u32; 2]> {
    match executor {
        Executor::Cpu { .. } => cpu::render(scene, plan, &CpuOptions::default(), &|_| {}).texels,
        #[cfg(feature = "gpu")]
        Executor::Gpu(context) => {
            let renderer = npr_harness::gpu::GpuRenderer::new(context);
            let targets = renderer.targets(&plan.view).expect("a size");
            let uploaded = renderer.upload(scene, plan).expect("room");
            renderer.draw(scene, &uploaded, plan, &targets).expect("a frame");
            renderer.read_texels(&targets).expect("texels").expect("they were asked for")
        }
    }
}

/// The angle between the stored normals of two texels.
fn angle_deg(a: [u32; 2], b: [u32; 2]) -> f64 {
    let [a, b] = [a, b].map(|words| ink_texel64_tap(words).normal.as_dvec3());
    a.angle_between(b).to_degrees()
}

/// The linear vertex colour whose display-referred form means one of the four directions.
fn vertex_color(index: u32) -> Vec4 {
    let color = artist_color(index);
    let linear = color.map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) });
    assert_eq!(ink_artist_index(color), index);
    linear.extend(1.0)
}

/// A wide view of a plane whose vertices lie at the centres of pixels, with colours that differ from each to the next.
/// At these pixels the direction is that of the vertex's colour, rotated by the vector from the eye to the vertex,
/// whether it is rotated there or at the pixel. Between them it is interpolated, or that of one colour or another.
#[test]
fn rotated_per_vertex_directions_are_those_of_the_pixels_at_vertices() {
    let eye = DVec3::new(0.3, 0.2, 4.0);
    let [perspective, parallel] = [
        Projection::Perspective { fov_y_rad: 80f64.to_radians() },
        Projection::Orthographic { height: 7.0, far: 20.0 },
    ];
    for projection in [perspective, parallel] {
        let camera = Camera { eye, target: DVec3::new(0.2, 0.0, 0.0), up: DVec3::Y, projection, near: 0.1 };
        let size_px = DVec2::new(SIZE.0.into(), SIZE.1.into());
        // Pixels, and the points of the plane z = 0 at their centres. The outermost are not compared: the plane ends
        // there.
        let columns = [5u32, 60, 190, 321, 466, 580, 634];
        let rows = [4u32, 36, 122, 231, 320, 355];
        let pixels: Vec<(u32, u32)> = rows.iter().flat_map(|&y| columns.iter().map(move |&x| (x, y))).collect();
        let point = |&(x, y): &(u32, u32)| {
            let (origin, direction) = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size_px);
            origin - direction * (origin.z / direction.z)
        };
        let points: Vec<DVec3> = pixels.iter().map(point).collect();
        let index = |number: usize| (number % 4) as u32;
        let width = columns.len() as u32;
        let cells = (0..rows.len() as u32 - 1).flat_map(|row| (0..width - 1).map(move |column| row * width + column));
        let faces: Vec<[u32; 3]> =
            cells.flat_map(|a| [[a, a + width, a + width + 1], [a, a + width + 1, a + 1]]).collect();
        let mut scene = Scene::new(Model {
            positions: points.iter().map(|point| point.as_vec3()).collect(),
            normals: vec![Vec3::Z; points.len()],
            colors: (0..points.len()).map(|number| vertex_color(index(number))).collect(),
            face_material: vec![0; faces.len()],
            faces,
            materials: vec![Material::default()],
            ..Model::default()
        });
        scene.line_kinds = vec![LineKind::VertexColor];
        let axes = DMat3::from_cols_array_2d(&camera.axes().map(|axis| axis.to_array()));
        let expected = |number: usize| {
            let from_eye = match projection {
                Projection::Perspective { .. } => points[number] - eye,
                Projection::Orthographic { .. } => -axes.z_axis,
            };
            axes * ink_artist_direction(index(number), (axes.transpose() * from_eye).as_vec3()).as_dvec3()
        };
        for executor in executors() {
            let [per_pixel, per_vertex] = [ArtistRotation::PerPixel, ArtistRotation::PerVertex].map(|rotation| {
                let plan = planned(&scene, &black_on_white(rotation, 0.8), &camera, SIZE);
                (texels(&executor, &scene, &plan), plan.image.expect("lines in the image").code)
            });
            let is_inner = |&(_, (x, y)): &(usize, &(u32, u32))| (60..=580).contains(x) && (36..=320).contains(y);
            for (number, (x, y)) in pixels.iter().enumerate().filter(is_inner) {
                let at = (y * SIZE.0 + x) as usize;
                let wanted = ink_texel64_pack(expected(number).as_vec3(), 1, 4.0, &per_pixel.1);
                for (what, texels) in [("pixel", &per_pixel.0), ("vertex", &per_vertex.0)] {
                    // A step of the stored normals is up to 0.9°.
                    let angle = angle_deg(texels[at], wanted);
                    assert!(angle < 1.0, "{projection:?}, per {what}, {}, {number}: {angle}°", executor.describe());
                }
            }
            // A quarter along the edge between two vertices: the pixel's direction is that of the nearer vertex's
            // colour, the vertices' one is on its way to the other, by (with 60° between them, over a quarter of the
            // chord) 13.9°.
            let (x, y) = ((3 * columns[2] + columns[3]) / 4, rows[2]);
            let at = (y * SIZE.0 + x) as usize;
            let turned = angle_deg(per_pixel.0[at], per_vertex.0[at]);
            println!("{projection:?}, {}: between vertices {turned:.1}° apart", executor.describe());
            assert!((9.0..22.0).contains(&turned), "{turned}");
        }
    }
}

/// Where a plane is painted in one colour to one side of an edge, all three rotations have the same line.
#[test]
fn a_border_between_faces_of_two_colours_is_a_line_however_directions_are_rotated() {
    let camera = looking_ahead(40.0);
    let square = |x: f32, index: u32| {
        let corners = [(-1.0, -1.0), (0.0, -1.0), (0.0, 1.0), (-1.0, 1.0)];
        Model {
            positions: corners.map(|(u, v): (f32, f32)| Vec3::new(u + x, v, -6.0)).to_vec(),
            normals: vec![Vec3::Z; 4],
            colors: vec![vertex_color(index); 4],
            faces: vec![[0, 1, 2], [0, 2, 3]],
            face_material: vec![0; 2],
            materials: vec![Material::default()],
            ..Model::default()
        }
    };
    for (left, right) in [(0, 1), (0, 3), (2, 1), (2, 2)] {
        let mut model = square(0.0, left);
        model.append(&square(1.0, right));
        let mut scene = Scene::new(model);
        scene.line_kinds = vec![LineKind::VertexColor; scene.materials().len()];
        for executor in executors() {
            for rotation in [ArtistRotation::PerPixel, ArtistRotation::PerVertex, ArtistRotation::PerObject] {
                let image = rendered(&executor, &scene, &black_on_white(rotation, 0.8), &camera, SIZE);
                let inked: Vec<u32> = (250..390).filter(|&x| image.pixel(x, 180)[0] < 128).collect();
                let expected: &[u32] = if left == right { &[] } else { &[319, 320] };
                assert_eq!(inked, expected, "{rotation:?}, {left} {right}, {}", executor.describe());
            }
        }
    }
}

fn looking_ahead(fov_y_deg: f64) -> Camera {
    Camera {
        eye: DVec3::ZERO,
        target: DVec3::NEG_Z,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: fov_y_deg.to_radians() },
        near: 0.1,
    }
}

/// An object of radius 1 at a distance, in which what the formula is about happens: at the point where its sphere
/// touches the cone of view, a painted square meets one with its own normals, and these are the visible ones that are
/// nearest to the painted direction. The two squares lie in one plane, which faces the viewer. A third square mirrors
/// the painted one at the middle of the object, so that the middle of its box is there.
fn grazing_object(distance: f64, kind: LineKind) -> Scene {
    let (sin, cos) = (1.0 / distance, (1.0 - 1.0 / (distance * distance)).sqrt());
    // Down left of the middle: direction 3, up and right of the view, is farther off the point's view than off the
    // object's.
    let aside = DVec3::new(-1.0, -1.0, 0.0).normalize();
    let view = aside * sin + DVec3::NEG_Z * cos;
    let point = view * (distance * cos) + DVec3::Z * distance;
    assert!((point.length() - 1.0).abs() < 1e-9 && point.dot(view).abs() < 1e-9);
    let direction = ink_artist_direction(3, Vec3::NEG_Z).as_dvec3();
    let nearest = (direction - view * direction.dot(view)).normalize();
    let side = 0.01 * distance;
    let corners = [(-1.0, -1.0), (0.0, -1.0), (0.0, 1.0), (-1.0, 1.0)];
    let square = |number: usize| {
        corners.map(|(u, v)| match number {
            0 => point + DVec3::new(u, v, 0.0) * side,
            1 => point + DVec3::new(u + 1.0, v, 0.0) * side,
            // Mirrored at the middle; a half turn, so that it faces the same way. Both halves.
            _ => -(point + DVec3::new(if u < 0.0 { -1.0 } else { 1.0 }, v, 0.0) * side),
        })
    };
    let materials = ["painted", "own normals", "mirrored"].map(|name| Material {
        name: name.into(),
        texture: (kind == LineKind::Texture && name == "painted").then_some(0),
        ..Material::default()
    });
    // Red and alpha pick direction 3.
    let rgba8 = vec![255, 0, 0, 255].into();
    let texture = Texture { name: "3".into(), width: 1, height: 1, rgba8, wrap: [Wrap::Clamp; 2], smooth: false };
    let model = Model {
        positions: (0..3).flat_map(square).map(|at| at.as_vec3()).collect(),
        normals: [[nearest.as_vec3(); 8].as_slice(), &[Vec3::Z; 4]].concat(),
        uvs: vec![Vec2::splat(0.5); 12],
        colors: vec![vertex_color(3); 12],
        faces: (0..3).flat_map(|n| [[4 * n, 4 * n + 1, 4 * n + 2], [4 * n, 4 * n + 2, 4 * n + 3]]).collect(),
        face_material: vec![0, 0, 1, 1, 2, 2],
        materials: materials.to_vec(),
        textures: vec![texture],
        ..Model::default()
    };
    let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, -distance));
    // Another object, out of view, so that the middle of the scene is elsewhere.
    let objects =
        [at(0.0), at(9.0 * distance)].map(|world_from_mesh| Object { name: String::new(), mesh: 0, world_from_mesh });
    let mut scene = Scene::with_objects(vec![model], objects.to_vec()).expect("good transforms");
    scene.line_kinds = vec![kind, LineKind::Normals, LineKind::Normals];
    scene
}

/// The share of the border that is a line.
fn share_of_line(executor: &Executor, distance: f64, kind: LineKind, rotation: ArtistRotation, cos: f32) -> f64 {
    let scene = grazing_object(distance, kind);
    let camera = looking_ahead(40.0);
    let image = rendered(executor, &scene, &black_on_white(rotation, cos), &camera, SIZE);
    let (sin, size_px) = (1.0 / distance, DVec2::new(SIZE.0.into(), SIZE.1.into()));
    let point = (DVec3::new(-1.0, -1.0, 0.0).normalize() * sin + DVec3::NEG_Z * (1.0 - sin * sin).sqrt()) * distance;
    let clip = camera.clip_from_world(size_px.x / size_px.y) * point.extend(1.0);
    let at = npr_outline::segment::outline_screen(clip, size_px).0;
    let rows = at.y as u32 - 2..=at.y as u32 + 2;
    let beside = at.x as u32 - 2..=at.x as u32 + 2;
    let inked = rows.clone().filter(|&y| beside.clone().any(|x| image.pixel(x, y)[0] < 128)).count();
    inked as f64 / rows.count() as f64
}

#[test]
fn rotated_per_object_lines_vanish_nearer_than_the_formula_says_and_not_farther() {
    let cpu = Executor::Cpu { why: None };
    for cos in [NORMAL_COS_OUTLINING_SKETCH, NORMAL_COS_CARD_MITCHELL] {
        let limit = artist_object_distance(f64::from(cos));
        let distances = || (60..160u32).step_by(2).map(|percent| limit * f64::from(percent) / 100.0);
        for kind in [LineKind::Texture, LineKind::VertexColor] {
            let share = |distance: f64, rotation| share_of_line(&cpu, distance, kind, rotation, cos);
            let measured: Vec<(f64, f64)> =
                distances().map(|distance| (distance, share(distance, ArtistRotation::PerObject))).collect();
            let nearest = measured.iter().find(|(_, share)| *share == 1.0).map_or(f64::INFINITY, |(near, _)| *near);
            println!("threshold {cos}, {kind:?}: a line from {nearest:.2} radii on; formula {limit:.2}");
            // Stored normals are off by up to half a degree each.
            for (distance, share) in measured {
                if distance < 0.92 * limit {
                    assert_eq!(share, 0.0, "{kind:?}, {cos} at {distance}");
                } else if distance > 1.08 * limit {
                    assert_eq!(share, 1.0, "{kind:?}, {cos} at {distance}");
                }
            }
            // Per vertex, the directions of textures are rotated per object, as printed; all others are rotated to
            // where they are, and no line vanishes.
            for distance in distances().step_by(5) {
                let per_vertex =
                    if kind == LineKind::Texture { ArtistRotation::PerObject } else { ArtistRotation::PerPixel };
                let [vertex, same] = [ArtistRotation::PerVertex, per_vertex].map(|rotation| share(distance, rotation));
                assert_eq!((vertex, share(distance, ArtistRotation::PerPixel)), (same, 1.0), "{kind:?}, {distance}");
            }
            for executor in executors() {
                for (factor, expected) in [(0.8, 0.0), (1.2, 1.0)] {
                    let found = share_of_line(&executor, factor * limit, kind, ArtistRotation::PerObject, cos);
                    assert_eq!(found, expected, "{kind:?}, {cos}, {factor}: {}", executor.describe());
                    let found = share_of_line(&executor, factor * limit, kind, ArtistRotation::PerPixel, cos);
                    assert_eq!(found, 1.0, "{kind:?}, {cos}, {factor}: {}", executor.describe());
                }
            }
        }
    }
}
