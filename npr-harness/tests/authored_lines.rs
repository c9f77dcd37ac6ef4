//! Lines that a file draws itself, and edges that it wants drawn, on both executors.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, rendered};
use glam::{DAffine3, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing, Projection};
use npr_harness::executor::Executor;
use npr_harness::inspect::inspect;
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Lines, Style, style, styles};
use npr_harness::truth::lines::{accuracy, darkness, drawn_centreline, true_lines};
use npr_mesh::SideVisibility::{Hard, Hidden, Silhouette};
use npr_mesh::{Model, Object, SideVisibility, embedded};
use npr_outline::LineKind;
use npr_outline::line_style::LineStyle;

const SIZE: (u32, u32) = (64, 64);

fn executors() -> Vec<Executor> {
    [Some(Executor::Cpu { why: None }), device()].into_iter().flatten().collect()
}

/// Black lines on white, of these widths by kind.
fn black(width_px: [f32; 5]) -> Style {
    let base = style("cartoon").expect("a style of the crate");
    let lines = Lines::edges(LineStyle { width_px, ink: [0.0, 0.0, 0.0, 1.0] });
    Style { shade: Shade::Paper, paper: Vec3::ONE, lines, ..base }
}

const AUTHORED: [f32; 5] = [0.0, 0.0, 0.0, 0.0, 2.0];

/// 16 px a unit, looking along -Z at the origin.
fn parallel() -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 4.0, far: 10.0 },
        near: 0.1,
    }
}

/// A square of two units in the plane z = 0, and horizontal lines of three units: in front of it, on it and behind it.
fn square_and_lines() -> Model {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let rows = [(0.5, 0.5), (0.0, 0.0), (-0.5, -0.5)];
    let mut positions = vec![at(-1., -1., 0.), at(1., -1., 0.), at(1., 1., 0.), at(-1., 1., 0.)];
    positions.extend(rows.iter().flat_map(|&(y, z)| [at(-1.5, y, z), at(1.5, y, z)]));
    Model {
        normals: vec![Vec3::Z; positions.len()],
        positions,
        faces: vec![[0, 1, 2], [0, 2, 3]],
        lines: vec![[4, 5], [7, 6], [8, 9]],
        ..Model::default()
    }
}

/// The red of the pixel right below and left of a point in units.
fn red(image: &Image, x: f64, y: f64) -> u8 {
    let (column, row) = ((32.0 + 16.0 * x) as usize, (32.0 - 16.0 * y) as usize);
    image.rgba8[4 * (row * SIZE.0 as usize + column)]
}

/// A row of the picture: '#' where it is black, '.' where it is white, '?' else.
fn row(image: &Image, row: usize) -> String {
    let pixels = &image.rgba8[4 * row * SIZE.0 as usize..4 * (row + 1) * SIZE.0 as usize];
    let name = |pixel: &[u8]| match pixel[0] {
        0 => '#',
        255 => '.',
        _ => '?',
    };
    pixels.chunks(4).map(name).collect()
}

#[test]
fn a_line_is_visible_in_front_of_a_face_and_on_it_and_not_behind_it() {
    let scene = Scene::new(square_and_lines());
    for executor in executors() {
        let image = rendered(&executor, &scene, &black(AUTHORED), &parallel(), SIZE);
        // The square is columns 16..48, the lines are columns 8..56 and two rows each.
        let whole = format!("{}{}{}", ".".repeat(8), "#".repeat(48), ".".repeat(8));
        let hidden = format!("{}{}{}{}{}", ".".repeat(8), "#".repeat(8), ".".repeat(32), "#".repeat(8), ".".repeat(8));
        for (line, expected) in [(24, &whole), (32, &whole), (40, &hidden)] {
            for at in [line - 1, line] {
                // At an end, and where a face begins, the last pixel may be covered in part.
                let found = row(&image, at).replace('?', "#");
                let differing = found.chars().zip(expected.chars()).filter(|(a, b)| a != b).count();
                assert!(differing <= 4, "row {at}\n{found}\n{expected}");
                let middle: String = found.chars().skip(20).take(24).collect();
                assert_eq!(middle, expected[20..44], "row {at}");
                assert_eq!((&found[10..14], &found[50..54]), ("####", "####"), "row {at}");
            }
            for at in [line - 3, line + 2] {
                assert_eq!(row(&image, at), ".".repeat(64), "row {at}");
            }
        }
        let none = rendered(&executor, &scene, &black([2.0, 2.0, 2.0, 2.0, 0.0]), &parallel(), SIZE);
        assert_eq!(red(&none, 0.3, 0.5), 255, "a width of 0 draws none");
        assert_eq!(red(&none, 1.0, 0.3), 0, "and leaves boundaries");
    }
}

#[cfg(feature = "gpu")]
#[test]
fn both_ways_of_the_device_draw_the_same_lines() {
    let Some(Executor::Gpu(context)) = device() else { return };
    if !context.capabilities.can_find_lines() {
        return;
    }
    let scene = Scene::new(square_and_lines());
    let image = |method| {
        let view = npr_harness::view::View::new(parallel(), SIZE);
        let style = black([0.0, 2.0, 0.0, 0.0, 3.0]);
        let mut plan = npr_harness::plan::Plan::new(&scene, &style, &view, &context.capabilities).expect("a plan");
        plan.edge_lines.as_mut().expect("edge lines").method = method;
        let renderer = npr_harness::gpu::GpuRenderer::new(&context);
        let targets = renderer.targets(&plan.view).expect("targets");
        let uploaded = renderer.upload(&scene, &plan).expect("an upload");
        renderer.draw(&scene, &uploaded, &plan, &targets).expect("a picture");
        renderer.read(&targets).expect("a picture")
    };
    use npr_harness::edge_lines::EdgeLineMethod::{OnCpu, OnDevice};
    let (records, found) = (image(OnCpu), image(OnDevice));
    assert_eq!(records.rgba8, found.rgba8);
    assert_eq!((red(&found, 0.3, 0.5), red(&found, 0.3, 0.44), red(&found, 1.0, 0.3)), (0, 0, 0));
}

#[test]
fn lines_on_slanted_faces_and_along_edges_are_visible_from_everywhere() {
    // Diagonals of the cube's sides, all its edges, and lines through its middle, which are hidden.
    let mut model = embedded::cube();
    let corner = |bits: u32| Vec3::new((bits & 1) as f32, (bits >> 1 & 1) as f32, (bits >> 2) as f32) * 2.0 - 1.0;
    let first = model.positions.len() as u32;
    model.positions.extend((0..8).map(corner));
    model.normals.resize(model.positions.len(), Vec3::Y);
    for a in 0..8u32 {
        model.lines.extend((a + 1..8).map(|b| [first + a, first + b]));
    }
    let scene = Scene::new(model);
    for (yaw_rad, pitch_rad) in [(0.5, 0.4), (0.05, 0.02), (2.2, -0.9), (0.8, 1.5), (3.9, 0.1)] {
        let framing = Framing { yaw_rad, pitch_rad, fov_y_rad: Some(0.6), ..Framing::default() };
        let size = (160, 160);
        let camera = Camera::framed(scene.corners(), 1.0, &framing);
        let truth = true_lines(&scene, &camera, size, 45f64.to_radians());
        assert!(truth.segments.iter().any(|segment| segment.kind == LineKind::Authored));
        let only = npr_harness::truth::lines::TrueLines {
            segments: truth.segments.into_iter().filter(|segment| segment.kind == LineKind::Authored).collect(),
            size_px: size,
        };
        for executor in executors() {
            let image = rendered(&executor, &scene, &black([0.0, 0.0, 0.0, 0.0, 1.0]), &camera, size);
            let drawn = drawn_centreline(&darkness(&image), image.width, image.height);
            let found = accuracy(&only, &drawn, 1.5);
            assert!(found.precision > 0.99 && found.recall > 0.99, "{yaw_rad} {pitch_rad}: {found:?}");
        }
    }
}

/// All twelve edges of a cube as lines, without a face.
fn wire() -> Model {
    let corner = |bits: u32| Vec3::new((bits & 1) as f32, (bits >> 1 & 1) as f32, (bits >> 2) as f32) * 2.0 - 1.0;
    let is_edge = |&(a, b): &(u32, u32)| (a ^ b).is_power_of_two() && a < b;
    let lines = (0..8).flat_map(|a| (0..8).map(move |b| (a, b))).filter(is_edge).map(|(a, b)| [a, b]).collect();
    Model { positions: (0..8).map(corner).collect(), normals: vec![Vec3::Y; 8], lines, ..Model::default() }
}

#[test]
fn a_scene_of_lines_alone_is_drawn_in_every_style_and_on_both_executors() {
    let objects = [0.0, 4.0].map(|x| Object {
        name: String::new(),
        mesh: 0,
        world_from_mesh: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
    });
    let scenes = [Scene::new(wire()), Scene::with_objects(vec![wire()], objects.to_vec()).expect("good transforms")];
    for (scene, length) in scenes.iter().zip([8.0, 16.0]) {
        let camera =
            Camera::framed(scene.corners(), 1.0, &Framing { yaw_rad: 0.5, pitch_rad: 0.4, ..Framing::default() });
        assert!(scene.radius() > 1.0 && camera.eye.is_finite());
        for executor in executors() {
            for style in styles() {
                let image = rendered(&executor, scene, &style, &camera, SIZE);
                let [r, g, b] = style.paper.to_array().map(|channel| (channel * 255.0).round() as u8);
                let is_inked = |pixel: &&[u8]| pixel[..3].iter().zip([r, g, b]).any(|(a, b)| a.abs_diff(b) > 60);
                let inked = image.rgba8.chunks(4).filter(is_inked).count();
                let draws = style.lines != Lines::NONE;
                assert_eq!(inked as f64 > length * 8.0, draws, "{}: {inked} px of lines", style.name);
            }
            let image = rendered(&executor, scene, &black([0.0, 0.0, 0.0, 0.0, 1.0]), &camera, (160, 160));
            let truth = true_lines(&scene.flattened(), &camera, (160, 160), 1.0);
            let drawn = drawn_centreline(&darkness(&image), 160, 160);
            let found = accuracy(&truth, &drawn, 1.5);
            assert!(found.precision > 0.99 && found.recall > 0.99, "{found:?}");
        }
    }
    let inspection = inspect("wire", &wire(), Vec::new());
    assert_eq!((inspection.lines, inspection.faces, inspection.extent), (12, 0, [2.0; 3]));
    assert!(inspection.to_string().contains("lines of the file"));
}

/// A cube as a file without polygons has it, with a class for all sides.
fn classed(class: SideVisibility) -> Model {
    let mut cube = embedded::cube();
    cube.face_polygon.clear();
    cube.side_visibility = vec![[class; 3]; cube.faces.len()];
    cube
}

/// The kinds of the lines drawn.
fn counts(model: Model, style: &Style) -> [usize; 5] {
    let scene = Scene::new(model);
    let camera = Camera::framed(scene.corners(), 1.0, &Framing { yaw_rad: 0.5, pitch_rad: 0.4, ..Framing::default() });
    common::planned(&scene, style, &camera, SIZE).lines(&scene).1
}

#[test]
fn the_classes_of_a_file_decide_what_is_a_line_unless_the_style_has_its_own_rules() {
    let style = black([1.0; 5]);
    let own = Style { file_edges: false, ..style.clone() };
    for (class, expected) in [(Hidden, [0; 5]), (Silhouette, [6, 0, 0, 0, 0]), (Hard, [6, 0, 6, 0, 0])] {
        assert_eq!(counts(classed(class), &style), expected, "{class:?}");
        assert_eq!(counts(classed(class), &own), [6, 0, 3, 0, 0], "{class:?}");
        // In pictures too, and in truth.
        let scene = Scene::new(classed(class));
        let camera =
            Camera::framed(scene.corners(), 1.0, &Framing { yaw_rad: 0.5, pitch_rad: 0.4, ..Framing::default() });
        let truth = true_lines(&scene, &camera, (160, 160), 45f64.to_radians());
        assert_eq!(truth.segments.is_empty(), class == Hidden);
        for executor in executors() {
            let image = rendered(&executor, &scene, &style, &camera, (160, 160));
            let found = accuracy(&truth, &drawn_centreline(&darkness(&image), 160, 160), 1.5);
            assert!(found.precision > 0.99 && found.recall > 0.99, "{class:?}: {found:?}");
        }
    }
}

#[test]
fn a_scene_without_lines_of_its_own_pays_nothing_for_them() {
    let camera = parallel();
    let bare = Scene::new(Model { lines: Vec::new(), ..square_and_lines() });
    let plan = |scene: &Scene, width_px| common::planned(scene, &black(width_px), &camera, SIZE);
    let bytes = |width_px| {
        let plan = plan(&bare, width_px);
        let capabilities = npr_harness::capabilities::Capabilities::RAY_CASTER;
        let resources = plan.resources(&bare, &capabilities).expect("they are known");
        let contours = &plan.edge_lines.as_ref().expect("edge lines").contours[0];
        let bytes = npr_harness::plan::resources::total_bytes(&resources);
        (bytes, contours.planes.len(), contours.edges.len(), contours.always, plan.left_out.len())
    };
    assert_eq!(bytes([2.0, 2.0, 2.0, 0.0, 2.0]), bytes([2.0, 2.0, 2.0, 0.0, 0.0]));
    // Where there are lines, a plan says why they are not drawn.
    let scene = Scene::new(square_and_lines());
    let why = |style: &Style| {
        let plan = common::planned(&scene, style, &camera, SIZE);
        plan.left_out.into_iter().find(|reason| reason.pass == "lines of the file").map(|reason| reason.why)
    };
    assert_eq!(why(&black(AUTHORED)), None);
    assert_eq!(why(&black([1.0, 1.0, 1.0, 1.0, 0.0])).as_deref(), Some("the style gives them no width"));
    assert_eq!(why(&Style { lines: Lines::NONE, ..black(AUTHORED) }).as_deref(), Some("the style draws no lines"));
    let image = styles().into_iter().find(|style| style.lines.image.is_some() && style.lines.edges.is_none());
    assert_eq!(why(&image.expect("a style of lines in the image")), None);
}

#[test]
fn a_style_file_says_how_wide_lines_of_the_file_are() {
    let read = |text: &str| Style::from_toml(text, std::path::Path::new("style.toml")).expect("a good style");
    let width = |text: &str| read(text).lines.edges.expect("edge lines").width_px[LineKind::Authored as usize];
    assert_eq!(width("[lines.edges]\n"), 1.3);
    assert_eq!(width("[lines.edges]\ncrease-px = 3\n"), 3.0);
    assert_eq!(width("[lines.edges]\ncrease-px = 0\nboundary-px = 2.5\n"), 2.5);
    assert_eq!(width("[lines.edges]\nauthored-px = 0\n"), 0.0);
    assert_eq!(width("[lines.edges]\nauthored-px = 7\ncrease-px = 3\n"), 7.0);
    assert!(read("").file_edges && !read("file-edges = false\n").file_edges);
    let own = read("file-edges = false\n[lines.edges]\nauthored-px = 7\n");
    assert_eq!(read(&own.to_toml().expect("it can be written")), own);
}
