//! Tests of image-space lines on scenes with known lines: clipped, intersecting, round and flat surfaces.
#![allow(clippy::print_stdout)]

mod common;

#[cfg(feature = "gpu")]
use common::planned;
use common::{device, rendered, shared_models};
use glam::{DVec2, DVec3, DVec4, Mat4, Vec2, Vec3, Vec4};
use npr_harness::camera::{Camera, Framing, Projection};
use npr_harness::capabilities::Capabilities;
use npr_harness::check::{SIZE, WITHIN_PX};
use npr_harness::error::HarnessError;
use npr_harness::executor::Executor;
use npr_harness::image_lines::{ImageInk, InkScale, Regions};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Lines, Style, style};
use npr_harness::truth::lines::{
    TrueLines, accuracy, are_near, distances_to_lines, true_intersections, true_lines, true_lines_of_steps,
};
use npr_harness::view::View;
use npr_imagespace::artist::{ArtistRotation, LineKind};
use npr_imagespace::filter::fused::{DepthTest, FusedFilter};
use npr_imagespace::morphology::disc::Disc;
use npr_mesh::{AlphaMode, Material, Model, Texture, Wrap, embedded, pn_triangles};

const CREASE_RAD: f64 = std::f64::consts::FRAC_PI_4;

/// The CPU, and a GPU if there is one.
fn executors() -> Vec<Executor> {
    let mut executors = vec![Executor::Cpu { why: None }];
    executors.extend(device());
    executors
}

fn black_on_white(ink: ImageInk) -> Style {
    let lines = Lines::image(ImageInk { composite: Default::default(), ..ink });
    Style { paper: Vec3::ONE, shade: Shade::Paper, lines, ..style("ink-image").expect("a style of the crate") }
}

/// The centres of the pixels that are at least half dark.
fn drawn(executor: &Executor, scene: &Scene, camera: &Camera, ink: ImageInk) -> Vec<DVec2> {
    let style = black_on_white(ink);
    let image = rendered(executor, scene, &style, camera, SIZE);
    let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    pixels
        .filter(|&(x, y)| image.pixel(x, y)[0] < 128)
        .map(|(x, y)| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))
        .collect()
}

fn project(camera: &Camera, point: DVec3) -> DVec2 {
    let size_px = DVec2::new(SIZE.0.into(), SIZE.1.into());
    let clip = camera.clip_from_world(size_px.x / size_px.y) * point.extend(1.0);
    npr_outline::segment::outline_screen(clip, size_px).0
}

/// Points of a circle around `axis`, a unit vector.
fn circle(center: DVec3, axis: DVec3, radius: f64) -> impl Iterator<Item = DVec3> {
    let (u, v) = axis.any_orthonormal_pair();
    (0..720u32).map(move |i| {
        let (sin, cos) = (f64::from(i) / 720.0 * std::f64::consts::TAU).sin_cos();
        center + (u * cos + v * sin) * radius
    })
}

fn share(found: &[bool]) -> f64 {
    found.iter().filter(|&&found| found).count() as f64 / found.len().max(1) as f64
}

fn camera_at(eye: DVec3, target: DVec3, fov_y_deg: f64, near: f64) -> Camera {
    Camera {
        eye,
        target,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: fov_y_deg.to_radians() },
        near,
    }
}

/// Regions make no lines; only depth and normals do.
fn one_region() -> ImageInk {
    ImageInk { regions: Regions::One, ..ImageInk::default() }
}

#[test]
fn a_clip_plane_leaves_a_line_where_it_cuts() {
    let mut scene = Scene::new(embedded::sphere(96));
    // The part below 0.3 is kept.
    scene.clip = Some(DVec4::new(0.0, -1.0, 0.0, 0.3));
    let camera = camera_at(DVec3::new(0.0, 2.6, 5.0), DVec3::ZERO, 28.0, 0.1);
    let sizes = [InkScale::Half, InkScale::One, InkScale::Double];
    for (executor, scale) in executors().iter().flat_map(|executor| sizes.map(|scale| (executor, scale))) {
        let ink = drawn(executor, &scene, &camera, ImageInk { scale, ..one_region() });
        let rim = circle(DVec3::Y * 0.3, DVec3::Y, (1.0f64 - 0.09).sqrt()).map(|point| project(&camera, point));
        let found = share(&are_near(&ink, rim, WITHIN_PX));
        println!("{}, {scale:?}: {found:.4} of the rim has a line", executor.describe());
        assert!(found >= 0.99, "{}, {scale:?}: {found}", executor.describe());
        // No line of the clipped part, whose upper end would be visible here.
        let top = project(&camera, DVec3::new(0.0, 1.0, 0.0)) + DVec2::Y * 4.0;
        assert!(!are_near(&ink, [top].into_iter(), 3.0)[0]);
    }
}

#[test]
fn a_model_s_own_edges_are_refused_where_a_plane_cuts() {
    let mut scene = Scene::new(embedded::cube());
    scene.clip = Some(DVec4::new(0.0, 1.0, 0.0, 0.0));
    let camera = camera_at(DVec3::new(2.0, 2.0, 6.0), DVec3::ZERO, 30.0, 0.1);
    let view = View::new(camera, SIZE);
    let refused = Plan::new(&scene, &style("cartoon").expect("a style"), &view, &Capabilities::RAY_CASTER);
    assert!(matches!(refused, Err(HarnessError::ClippedEdges { style }) if style == "cartoon"));
}

#[test]
fn the_near_plane_leaves_a_line_where_it_cuts() {
    let scene = Scene::new(embedded::sphere(96));
    // The plane z = 0.6 clips a cap of radius 0.8.
    let camera = camera_at(DVec3::Z * 4.0, DVec3::ZERO, 30.0, 3.4);
    for executor in executors() {
        let ink = drawn(&executor, &scene, &camera, one_region());
        let rim = circle(DVec3::Z * 0.6, DVec3::Z, 0.8).map(|point| project(&camera, point));
        let found = share(&are_near(&ink, rim, WITHIN_PX));
        assert!(found >= 0.99, "{}: {found}", executor.describe());
    }
}

#[test]
fn surfaces_that_pass_through_each_other_meet_in_a_line() {
    let mut model =
        embedded::placed(embedded::sphere(128), Mat4::from_translation(Vec3::X * -0.6), Material::default());
    model.append(&embedded::placed(embedded::sphere(128), Mat4::from_translation(Vec3::X * 0.6), Material::default()));
    let scene = Scene::new(model);
    let camera = camera_at(DVec3::new(0.0, 1.5, 6.0), DVec3::ZERO, 30.0, 0.1);
    // The spheres intersect in the circle of radius 0.8 in the plane x = 0; its back half is hidden.
    let visible = |point: &DVec3| point.dot(camera.eye) > 1.0 - 0.36;
    let seam: Vec<DVec2> =
        circle(DVec3::ZERO, DVec3::X, 0.8).filter(visible).map(|point| project(&camera, point)).collect();
    assert!(seam.len() > 200);
    for executor in executors() {
        let ink = drawn(&executor, &scene, &camera, one_region());
        let found = share(&are_near(&ink, seam.iter().copied(), WITHIN_PX));
        assert!(found >= 0.99, "{}: {found}", executor.describe());
    }
    // The true intersection curves contain the line too, and no hidden one. The spheres' facets lie slightly inside the
    // spheres.
    let meeting = true_intersections(&scene, &camera, SIZE, CREASE_RAD);
    let length: f64 = meeting.segments.iter().map(|s| s.ends_px[0].distance(s.ends_px[1])).sum();
    let expected: f64 = seam.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    assert!((length / expected - 1.0).abs() < 0.05, "{length} px of {expected}");
    let distances = distances_to_lines(&meeting, &seam, 1.0);
    assert!(distances.iter().all(|&distance| distance < 1.0));
}

#[test]
fn a_coarse_sphere_has_a_round_outline_by_pn_triangles() {
    let coarse = embedded::sphere(12);
    let camera = camera_at(DVec3::new(0.0, 0.0, 6.0), DVec3::ZERO, 25.0, 0.1);
    // The contour of the unit sphere from a distance of 6.
    let contour =
        || circle(DVec3::Z / 6.0, DVec3::Z, (1.0f64 - 1.0 / 36.0).sqrt()).map(|point| project(&camera, point));
    let executor = Executor::Cpu { why: None };
    let recall = |model: Model| {
        let ink = drawn(&executor, &Scene::new(model), &camera, one_region());
        share(&are_near(&ink, contour(), WITHIN_PX))
    };
    let (flat, round) = (recall(coarse.clone()), recall(pn_triangles::tessellate(&coarse, 8).expect("8 segments")));
    println!("within 1.5 px of the sphere's contour: {flat:.3} of the coarse mesh, {round:.3} by PN triangles");
    assert!(round > 0.9 && flat < 0.4, "{flat} {round}");
}

/// Two squares in one plane, side by side, of one material.
fn squares_side_by_side() -> Model {
    let square = |x: f32| {
        let corners = [(-1.0, -1.0), (0.0, -1.0), (0.0, 1.0), (-1.0, 1.0)];
        Model {
            positions: corners.map(|(u, v): (f32, f32)| Vec3::new(u + x, v, 0.0)).to_vec(),
            normals: vec![Vec3::Z; 4],
            uvs: corners.map(|(u, v): (f32, f32)| Vec2::new(u + 1.0, 0.5 - 0.5 * v)).to_vec(),
            faces: vec![[0, 1, 2], [0, 2, 3]],
            face_material: vec![0; 2],
            face_polygon: vec![0; 2],
            materials: vec![Material::default()],
            ..Model::default()
        }
    };
    let mut model = square(0.0);
    model.append(&square(1.0));
    model.face_material.fill(0);
    model
}

#[test]
fn regions_part_what_depth_and_normals_do_not() {
    let camera = camera_at(DVec3::new(0.4, 0.3, 5.0), DVec3::ZERO, 30.0, 0.1);
    let middle = |camera: &Camera| {
        (0..100u32).map(|i| project(camera, DVec3::new(0.0, f64::from(i) / 60.0 - 0.8, 0.0))).collect::<Vec<_>>()
    };
    for executor in executors() {
        let scene = Scene::new(squares_side_by_side());
        let has_line = |scene: &Scene, regions| {
            let ink = drawn(&executor, scene, &camera, ImageInk { regions, ..ImageInk::default() });
            share(&are_near(&ink, middle(&camera).into_iter(), WITHIN_PX))
        };
        assert_eq!(has_line(&scene, Regions::One), 0.0);
        assert_eq!(has_line(&scene, Regions::Material), 0.0);
        assert_eq!(has_line(&scene, Regions::Mesh), 1.0);
        // They share a flat edge, so they are one region.
        assert_eq!(has_line(&scene, Regions::Patch), 0.0);
        let mut model = squares_side_by_side();
        model.face_mesh.fill(0);
        assert_eq!(has_line(&Scene::new(model.clone()), Regions::Mesh), 0.0);
        model.materials.push(Material::default());
        model.face_material[2..].fill(1);
        let scene = Scene::new(model);
        assert_eq!(has_line(&scene, Regions::Material), 1.0);
        assert_eq!(has_line(&scene, Regions::Patch), 1.0);
    }
}

/// A round hole in a square.
fn holed() -> Model {
    const SIZE: u32 = 256;
    let mut model = squares_side_by_side();
    let at = |v: u32| (v as f32 + 0.5) / SIZE as f32 - 0.5;
    let alpha = |x: u32, y: u32| if at(x).hypot(at(y)) < 0.3 { 0 } else { 255 };
    let rgba8 = (0..SIZE).flat_map(|y| (0..SIZE).flat_map(move |x| [255, 255, 255, alpha(x, y)])).collect();
    let wrap = [Wrap::Clamp; 2];
    model.textures = vec![Texture { name: "hole".into(), width: SIZE, height: SIZE, rgba8, wrap, smooth: true }];
    model.materials[0] =
        Material { texture: Some(0), alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() };
    model
}

/// However the picture is shaded and whichever pass the G-buffer is drawn in: the hole has a line around it, what is
/// behind it is seen by the filter, and with the cutoff below all alpha the card has no hole.
#[test]
fn what_alpha_leaves_has_lines_around_it() {
    let camera = camera_at(DVec3::new(-0.5, 0.0, 5.0), DVec3::new(-0.5, 0.0, 0.0), 30.0, 0.1);
    // The left square is 1 wide and 2 high, and so is its texture.
    let hole: Vec<DVec2> =
        circle(DVec3::ZERO, DVec3::Z, 0.3).map(|p| project(&camera, DVec3::new(p.x - 0.5, 2.0 * p.y, 0.0))).collect();
    // A wall close behind, of the card's normal; the filters see it through the hole.
    let mut walled = holed();
    let mut wall = squares_side_by_side();
    wall.positions.iter_mut().for_each(|p| *p = *p * 3.0 - Vec3::Z);
    wall.materials = vec![Material::default()];
    walled.append(&wall);
    // Light of one direction, light of a position, strokes.
    let styles = ["toon", "two-lights", "hatch"].map(|name| style(name).expect("a style of the crate"));
    for executor in executors() {
        for (model, what) in [(holed(), "alone"), (walled.clone(), "before a wall")] {
            let scene = Scene::new(model.clone());
            let mut whole = model;
            whole.materials[0].alpha_mode = AlphaMode::Mask { cutoff: 0.0 };
            let whole = Scene::new(whole);
            for scale in [InkScale::One, InkScale::Double] {
                let what = format!("{what}, {scale:?}, {}", executor.describe());
                let ink = drawn(&executor, &scene, &camera, ImageInk { scale, ..one_region() });
                assert!(share(&are_near(&ink, hole.iter().copied(), WITHIN_PX)) >= 0.99, "{what}");
                let inside = project(&camera, DVec3::new(-0.5, 0.0, 0.0));
                assert!(!are_near(&ink, [inside].into_iter(), 10.0)[0], "{what}");
                let ink = drawn(&executor, &whole, &camera, ImageInk { scale, ..one_region() });
                assert_eq!(share(&are_near(&ink, hole.iter().copied(), WITHIN_PX)), 0.0, "{what}");
            }
            // Beside a shaded picture: what lines add to it is around the hole.
            for style in &styles {
                let lines = Lines::image(ImageInk { composite: Default::default(), ..one_region() });
                let [inked, plain] = [lines, Lines::NONE]
                    .map(|lines| rendered(&executor, &scene, &Style { lines, ..style.clone() }, &camera, SIZE));
                let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
                let added: Vec<DVec2> = pixels
                    .filter(|&(x, y)| inked.pixel(x, y)[1] == 0 && plain.pixel(x, y)[1] > 0)
                    .map(|(x, y)| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))
                    .collect();
                let found = share(&are_near(&added, hole.iter().copied(), WITHIN_PX));
                assert!(found >= 0.99, "{what}, {}, {}: {found}", executor.describe(), style.name);
            }
        }
    }
}

/// Red and green with a border at u = 1/2; unfiltered, because the mixed colour would otherwise be detected elsewhere.
fn two_colored() -> Model {
    let mut model = squares_side_by_side();
    let rgba8 = [[200, 0, 0, 255], [0, 200, 0, 255]].concat();
    let wrap = [Wrap::Repeat, Wrap::Mirror];
    model.textures =
        vec![Texture { name: "halves".into(), width: 2, height: 1, rgba8: rgba8.into(), wrap, smooth: false }];
    model.materials[0].texture = Some(0);
    model.uvs.iter_mut().for_each(|uv| uv.x -= 1.0);
    model.face_mesh.clear();
    model
}

#[test]
fn artists_lines_are_where_they_are_painted_and_nowhere_else() {
    let camera = camera_at(DVec3::new(-0.5, 0.0, 5.0), DVec3::new(-0.5, 0.0, 0.0), 30.0, 0.1);
    let upright = |x: f64| (0..100u32).map(move |i| DVec3::new(x, f64::from(i) / 60.0 - 0.8, 0.0));
    let seen = |x: f64| upright(x).map(|point| project(&camera, point)).collect::<Vec<_>>();
    let rotations = [ArtistRotation::PerPixel, ArtistRotation::PerVertex, ArtistRotation::PerObject];
    for (executor, rotation) in executors().iter().flat_map(|executor| rotations.map(|rotation| (executor, rotation))) {
        let artist = ImageInk { artist: Some(rotation), regions: Regions::Material, ..ImageInk::default() };
        let mut scene = Scene::new(two_colored());
        let has_line = |scene: &Scene, x: f64, ink: ImageInk| {
            share(&are_near(&drawn(executor, scene, &camera, ink), seen(x).into_iter(), WITHIN_PX))
        };
        // The red channel alone distinguishes green from red; alpha is 1 in both.
        for (kind, lines) in
            [(LineKind::Regions, 1.0), (LineKind::Texture, 1.0), (LineKind::Normals, 0.0), (LineKind::None, 0.0)]
        {
            scene.line_kinds = vec![kind];
            assert_eq!(has_line(&scene, -0.5, artist), lines, "{kind:?} on {}", executor.describe());
            assert_eq!(has_line(&scene, -0.2, artist), 0.0, "{kind:?} on {}", executor.describe());
            // Styles that do not use artist-controlled lines do not get them.
            assert_eq!(has_line(&scene, -0.5, ImageInk { artist: None, ..artist }), 0.0, "{kind:?}");
        }
    }
    assert!(matches!(
        Scene::new(two_colored()).set_line_kind("wood", LineKind::None),
        Err(HarnessError::UnknownMaterial { .. })
    ));
}

#[test]
fn vertex_colour_lines_survive_a_full_turn() {
    // A sphere with two colours, with their border at x = 0, which rotates with it.
    let round = embedded::sphere(96);
    let mut model =
        Model { face_material: round.face_material.clone(), materials: round.materials.clone(), ..Model::default() };
    for face in &round.faces {
        let corners = face.map(|v| round.positions[v as usize]);
        let first = model.positions.len() as u32;
        model.faces.push([first, first + 1, first + 2]);
        model.positions.extend(corners);
        model.normals.extend(face.map(|v| round.normals[v as usize]));
        let index = u32::from(corners.iter().sum::<Vec3>().x > 0.0);
        let [r, g, b] = npr_imagespace::artist::artist_color(index).to_array();
        model.colors.extend([Vec4::new(r * r, g * g, b * b, 1.0); 3]);
    }
    let mut scene = Scene::new(model);
    scene.line_kinds = vec![LineKind::VertexColor];
    let executor = Executor::Cpu { why: None };
    let rotations = [ArtistRotation::PerPixel, ArtistRotation::PerVertex];
    for (step, rotation) in (0..12u32).flat_map(|step| rotations.map(|rotation| (step, rotation))) {
        let yaw = f64::from(step) * 30f64.to_radians() + 0.1;
        let eye = DVec3::new(yaw.sin() * 5.0, 1.2, yaw.cos() * 5.0);
        let camera = camera_at(eye, DVec3::ZERO, 28.0, 0.1);
        let ink = drawn(
            &executor,
            &scene,
            &camera,
            ImageInk { artist: Some(rotation), regions: Regions::Material, ..ImageInk::default() },
        );
        // At least a tenth of the radius away from the contour.
        let seam = circle(DVec3::ZERO, DVec3::X, 1.0).filter(|p| p.dot(eye) > 1.0 + 0.1 * eye.length());
        let seam: Vec<DVec2> = seam.map(|point| project(&camera, point)).collect();
        let found = share(&are_near(&ink, seam.iter().copied(), WITHIN_PX));
        assert!(seam.is_empty() || found >= 0.99, "{step}, {rotation:?}: {found}");
        // No other line than the seam and the contour.
        let inner = ink.iter().filter(|&&point| project(&camera, DVec3::ZERO).distance(point) < 110.0);
        let stray = inner.filter(|&&point| !are_near(&seam, [point].into_iter(), 2.5)[0]).count();
        assert!(stray < 8, "{step}, {rotation:?}: {stray} px of line where there is none");
    }
}

#[test]
fn a_ground_at_a_grazing_angle_stays_clean() {
    let mut model = embedded::placed(embedded::ground(30.0), Mat4::IDENTITY, Material::default());
    for (solid, x, z) in
        [(embedded::sphere(96), -1.6, 0.0), (embedded::cube(), 1.5, 1.0), (embedded::cone(96), 0.0, -4.0)]
    {
        model.append(&embedded::placed(solid, Mat4::from_translation(Vec3::new(x, 1.2, z)), Material::default()));
    }
    let scene = Scene::new(model);
    let filter = |depth: DepthTest| ImageInk {
        filter: FusedFilter { depth: Some(depth), ..FusedFilter::default() },
        ..one_region()
    };
    println!("grazing, executor: recall, false px of the bends; of the plain steps");
    for grazing_deg in [0.5f64, 1.0, 2.0, 5.0, 10.0] {
        let (sin, cos) = grazing_deg.to_radians().sin_cos();
        let camera = camera_at(DVec3::new(0.0, 14.0 * sin, 14.0 * cos), DVec3::ZERO, 25.0, 0.05);
        // All lines count as true for precision; for recall, only those with a depth step.
        let all = true_lines(&scene, &camera, SIZE, CREASE_RAD);
        let asked = true_lines_of_steps(&scene, &camera, SIZE, CREASE_RAD, 0.01 * 2.0 * 3.0);
        for executor in executors() {
            let judge = |depth: DepthTest| {
                let ink = drawn(&executor, &scene, &camera, filter(depth));
                let stray = distances_to_lines(&all, &ink, 2.0).iter().filter(|d| !d.is_finite()).count();
                (accuracy(&asked, &ink, WITHIN_PX).recall, stray)
            };
            let (recall, stray) = judge(DepthTest::default());
            let (plain_recall, plain_stray) = judge(DepthTest { plain: true, ..DepthTest::default() });
            println!("{grazing_deg}°, {}: {recall:.4}, {stray}; {plain_recall:.4}, {plain_stray}", executor.describe());
            assert!(recall >= 0.98, "{grazing_deg}°: {recall}");
            assert_eq!(stray, 0, "{grazing_deg}°");
            assert!(plain_stray > 1000, "{grazing_deg}°: the plain test is no longer worse");
        }
    }
}

#[test]
fn larger_and_smaller_ink_are_as_wide_as_they_should_be() {
    // A vertical border between two depths: two pixels of ink wide.
    let mut model = squares_side_by_side();
    model.positions[4..].iter_mut().for_each(|p| p.z -= 1.0);
    let scene = Scene::new(model);
    let camera = camera_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 30.0, 0.1);
    let row = |executor: &Executor, ink: ImageInk| {
        let style = black_on_white(ink);
        let image = rendered(executor, &scene, &style, &camera, SIZE);
        (300..340).map(|x| 1.0 - f64::from(image.pixel(x, 180)[0]) / 255.0).sum::<f64>()
    };
    for executor in executors() {
        let width = |ink| row(&executor, ink);
        let scaled = |scale| ImageInk { scale, ..one_region() };
        assert!((width(scaled(InkScale::One)) - 2.0).abs() < 0.1);
        assert!((width(scaled(InkScale::Half)) - 4.0).abs() < 0.1);
        assert!((width(scaled(InkScale::Double)) - 1.0).abs() < 0.1);
        for radius_px in [0.0, 1.0, 2.5] {
            let dilation = Some(Disc { radius_px, antialias: true });
            let wide = width(ImageInk { dilation, ..one_region() });
            assert!((wide - 2.0 - 2.0 * f64::from(radius_px)).abs() < 0.1, "{radius_px}: {wide}");
            let fine = width(ImageInk { dilation, scale: InkScale::Double, ..one_region() });
            assert!((fine - 1.0 - f64::from(radius_px)).abs() < 0.1, "{radius_px}: {fine}");
        }
    }
}

#[test]
fn the_fused_filter_finds_the_lines_of_real_models() {
    let Some(folder) = shared_models() else { return };
    let executor = Executor::Cpu { why: None };
    let views = [(30.0f64, 20.0f64), (150.0, -10.0), (270.0, 50.0)];
    let models = [
        "stanford-bunny.obj",
        "fandisk.obj",
        "rocker-arm.obj",
        "teapot.obj",
        "2CylinderEngine.glb",
        "CesiumMilkTruck.glb",
    ];
    for file in models {
        let scene = Scene::from(npr_mesh::load(&folder.join(file), &Default::default()).expect("a good file"));
        let flat = scene.flattened();
        for (yaw, pitch) in views {
            let framing = Framing { yaw_rad: yaw.to_radians(), pitch_rad: pitch.to_radians(), ..Framing::default() };
            let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing);
            // Depth steps of 1 % of the model's size, and intersection curves.
            let of_edges = true_lines_of_steps(&flat, &camera, SIZE, CREASE_RAD, 0.02 * scene.radius());
            let meetings = true_intersections(&flat, &camera, SIZE, CREASE_RAD);
            let segments = [of_edges.segments, meetings.segments].concat();
            let truth = TrueLines { segments, ..of_edges };
            let found = accuracy(&truth, &drawn(&executor, &scene, &camera, ImageInk::default()), WITHIN_PX);
            println!("{file} {yaw} {pitch}: F1 {:.4}", found.f1);
            assert!(found.f1 >= 0.95, "{file} {yaw} {pitch}: {found:?}");
        }
    }
}

/// Normals agree within a step of their encoding, regions exactly, depths within some steps, except where another
/// surface is visible.
#[cfg(feature = "gpu")]
#[test]
fn the_device_packs_what_the_reference_packs() {
    use npr_harness::cpu::{self, CpuOptions};
    use npr_harness::gallery::{painted_camera, painted_scene, still_life_camera};
    use npr_harness::gpu::GpuRenderer;
    use npr_imagespace::format::texel::{TexelLayout, ink_texel32_tap, ink_texel64_tap};

    let Some(Executor::Gpu(context)) = device() else { return };
    let renderer = GpuRenderer::new(&context);
    let scenes = [(painted_scene(), painted_camera()), (Scene::new(embedded::scene()), still_life_camera())];
    let parallel = Camera { projection: Projection::Orthographic { height: 7.0, far: 40.0 }, ..painted_camera() };
    let cases = [(&scenes[0].0, scenes[0].1), (&scenes[1].0, scenes[1].1), (&scenes[0].0, parallel)];
    for (scene, camera) in cases {
        let [narrow, wide] = [TexelLayout::Bits32, TexelLayout::Bits64];
        let [pixel, vertex, object] =
            [ArtistRotation::PerPixel, ArtistRotation::PerVertex, ArtistRotation::PerObject].map(Some);
        let cases = [
            (narrow, InkScale::One, pixel),
            (wide, InkScale::One, pixel),
            (wide, InkScale::One, vertex),
            (wide, InkScale::One, object),
            (wide, InkScale::Half, pixel),
            (wide, InkScale::Double, pixel),
        ];
        for (layout, scale, artist) in cases {
            let style = black_on_white(ImageInk { artist, layout, scale, ..ImageInk::default() });
            let plan = planned(scene, &style, &camera, SIZE);
            let expected = cpu::render(scene, &plan, &CpuOptions::default(), &|_| {}).texels;
            let targets = renderer.targets(&plan.view).expect("a size");
            let uploaded = renderer.upload(scene, &plan).expect("room");
            renderer.draw(scene, &uploaded, &plan, &targets).expect("a frame");
            let actual = renderer.read_texels(&targets).expect("texels").expect("they were asked for");
            let tap = |words: [u32; 2]| match layout {
                TexelLayout::Bits32 => ink_texel32_tap(words[0]),
                TexelLayout::Bits64 => ink_texel64_tap(words),
            };
            let apart = |(a, b): &(&[u32; 2], &[u32; 2])| {
                let (a, b) = (tap(**a), tap(**b));
                let steps = (a.normal - b.normal).abs().max_element();
                // A rasteriser interpolates depth as f32, with 18 or more of 24 bits correct.
                let codes = layout.depth_max() / (1 << 18);
                a.region != b.region || steps > 2 || a.depth.abs_diff(b.depth) > codes.max(2)
            };
            let share = expected.iter().zip(&actual).filter(apart).count() as f64 / expected.len() as f64;
            println!("{layout:?}, {scale:?}, {artist:?}: {share:.5} of the texels differ");
            // Differences lie at contours, which are a larger fraction of a smaller picture.
            let limit = 1e-4 * f64::from(SIZE.0) / f64::from(scale.size(SIZE).0);
            assert!(expected.len() == actual.len() && share < limit, "{layout:?}, {scale:?}, {artist:?}: {share}");
        }
    }
}
