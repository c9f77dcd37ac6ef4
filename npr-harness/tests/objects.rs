//! Tests of scenes with several objects: meshes placed, mirrored, scaled, sheared and moved by transforms.
#![allow(clippy::print_stdout)]

mod common;

use common::planned;
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot, Vec3, Vec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::cpu::{CpuOptions, render};
use npr_harness::error::HarnessError;
use npr_harness::picture::Image;
use npr_harness::scene::{ObjectLines, Scene};
use npr_harness::style::{Style, style};
use npr_mesh::{AlphaMode, Material, Model, Object, embedded};
use npr_outline::line_style::LineStyle;

const SIZE: (u32, u32) = (160, 120);

fn named(name: &str) -> Style {
    style(name).expect("a style of the crate")
}

fn object(name: &str, mesh: usize, world_from_mesh: DAffine3) -> Object {
    Object { name: name.to_owned(), mesh, world_from_mesh }
}

fn turned(yaw: f64, pitch: f64) -> DMat3 {
    DMat3::from_quat(DQuat::from_euler(EulerRot::YXZ, yaw, pitch, 0.3))
}

fn colored(model: Model, color: [f32; 3]) -> Model {
    let material = Material { base_color: Vec3::from(color).extend(1.0), double_sided: false, ..Material::default() };
    embedded::placed(model, glam::Mat4::IDENTITY, material)
}

/// An L three cubes wide, which is not its own mirror image in any plane that does not cut it.
fn letter() -> Model {
    let mut letter = embedded::cube();
    let mut arm = embedded::cube();
    for position in &mut arm.positions {
        *position = *position * Vec3::new(0.8, 0.3, 0.5) + Vec3::new(1.9, -0.7, 0.2);
    }
    letter.append(&arm);
    letter
}

/// Two meshes in five objects: untransformed, rotated and enlarged, mirrored, sheared, flattened to a third.
fn objects() -> Vec<Object> {
    let at = |matrix3: DMat3, x: f64, y: f64, z: f64| DAffine3 { matrix3, translation: DVec3::new(x, y, z) };
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.6, 1.0, 0.2), DVec3::new(0.0, -0.3, 1.0));
    vec![
        object("plain", 0, at(DMat3::IDENTITY, 0.0, 0.0, 0.0)),
        object("larger", 0, at(turned(0.7, 0.2) * 1.4, -5.0, 0.5, -2.0)),
        object("mirrored", 0, at(turned(-0.4, 0.3) * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), 5.0, 0.3, -1.0)),
        object("sheared", 1, at(shear, -2.5, 3.5, -1.0)),
        object("flat", 1, at(turned(1.0, 0.9) * DMat3::from_diagonal(DVec3::new(1.5, 0.5, -1.0)), 2.5, 3.6, 0.0)),
    ]
}

fn meshes() -> Vec<Model> {
    vec![colored(letter(), [0.7, 0.3, 0.2]), colored(embedded::torus(1.0, 0.4, 24, 12), [0.2, 0.4, 0.7])]
}

fn scene() -> Scene {
    Scene::with_objects(meshes(), objects()).expect("good transforms")
}

fn framed(scene: &Scene, fov_y_rad: Option<f64>) -> Camera {
    let framing = Framing { yaw_rad: 0.4, pitch_rad: 0.3, fov_y_rad, ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

fn picture(scene: &Scene, style: &Style, camera: &Camera) -> Image {
    render(scene, &planned(scene, style, camera, SIZE), &CpuOptions::default(), &|_| {}).image()
}

/// The number of pixels that differ by more than rounding.
fn differing(a: &Image, b: &Image) -> usize {
    let far = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    a.rgba8.chunks(4).zip(b.rgba8.chunks(4)).filter(|pair| far(*pair)).count()
}

/// Placed objects look like the same triangles in one model, where f32 rounds the positions.
#[test]
fn placed_meshes_look_like_one_model() {
    let scene = scene();
    let mut all = Model::default();
    for object in objects() {
        all.append(&meshes().swap_remove(object.mesh).transformed(&object.world_from_mesh));
    }
    let one = Scene::new(all);
    for fov_y_rad in [Some(0.6), None] {
        let camera = framed(&one, fov_y_rad);
        for name in ["cartoon", "lines", "gooch", "toon-shadow", "ink-image", "normals", "vertex-light"] {
            let style = named(name);
            let (placed, flat) = (picture(&scene, &style, &camera), picture(&one, &style, &camera));
            let differing = differing(&placed, &flat);
            println!("{name}: {differing} pixels differ");
            // At borders, where 1e-7 of a position matters.
            assert!(differing <= 8, "{name}: {differing} pixels differ");
        }
    }
}

/// The boxes touch no other surface, so that a mirrored object can be compared with a mesh whose corners are mirrored.
#[test]
fn a_mirrored_object_keeps_its_front() {
    let mut mirrored = letter();
    mirrored.positions.iter_mut().chain(&mut mirrored.normals).for_each(|v| v.x = -v.x);
    mirrored.faces.iter_mut().for_each(|face| face.swap(1, 2));
    let by_hand = Scene::new(colored(mirrored, [0.7; 3]));
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let placed =
        Scene::with_objects(vec![colored(letter(), [0.7; 3])], vec![object("", 0, mirror)]).expect("good transforms");
    assert!(placed.objects()[0].is_mirrored() && placed.is_closed());
    let camera = framed(&by_hand, Some(0.6));
    for name in ["cartoon", "toon-shadow", "gooch", "normals", "printed-fins", "ink-image"] {
        let style = named(name);
        assert_eq!(picture(&placed, &style, &camera), picture(&by_hand, &style, &camera), "{name}");
    }
}

#[test]
fn what_is_far_away_keeps_its_digits() {
    let far = DVec3::new(4e8, -3e8, 7e8);
    let near = scene();
    let moved = |object: Object| {
        let translation = object.world_from_mesh.translation + far;
        Object { world_from_mesh: DAffine3 { translation, ..object.world_from_mesh }, ..object }
    };
    let away = Scene::with_objects(meshes(), objects().into_iter().map(moved).collect()).expect("good transforms");
    // The origin is the centre rounded to f32, so the camera is placed again.
    let (from, to) = (near.middle(), away.middle());
    let camera = framed(&near, Some(0.6));
    let there = Camera { eye: camera.eye - from + to, target: camera.target - from + to, ..camera };
    for name in ["cartoon", "toon-shadow", "ink-image"] {
        let style = named(name);
        let differing = differing(&picture(&near, &style, &camera), &picture(&away, &style, &there));
        // The offset itself is rounded to 6e-8, the spacing of f64 at 4e8.
        assert!(differing <= 8, "{name}: {differing} pixels differ");
    }
}

#[test]
fn an_object_that_moves_rebuilds_nothing_of_its_mesh() {
    let mut scene = scene();
    let style = named("cartoon");
    let camera = framed(&scene, Some(0.6));
    let before = planned(&scene, &style, &camera, SIZE);
    let contours = |plan: &npr_harness::plan::Plan| plan.edge_lines.as_ref().expect("lines").contours.clone();
    let of_meshes: Vec<_> = scene.meshes().iter().map(|mesh| std::ptr::from_ref(mesh.rays())).collect();
    let to = DAffine3 { matrix3: turned(1.0, 0.5), translation: DVec3::new(-4.0, 1.0, 1.0) };
    scene.place(1, &to).expect("it has an inverse");
    let after = planned(&scene, &style, &camera, SIZE);
    for (before, after) in contours(&before).iter().zip(&contours(&after)) {
        assert!(std::sync::Arc::ptr_eq(before, after));
    }
    let still: Vec<_> = scene.meshes().iter().map(|mesh| std::ptr::from_ref(mesh.rays())).collect();
    assert_eq!(of_meshes, still);
    let mut there = objects();
    there[1].world_from_mesh = to;
    let made_there = Scene::with_objects(meshes(), there).expect("good transforms");
    assert_eq!(picture(&scene, &style, &camera), picture(&made_there, &style, &camera));
}

/// What is stretched by little and little has the creases of the shape that it has in the end.
#[test]
fn creases_follow_a_slow_change_of_shape() {
    let roof = Model {
        positions: [[-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 1.0]].map(Vec3::from).to_vec(),
        normals: vec![Vec3::Y; 4],
        faces: vec![[0, 3, 1], [1, 3, 2]],
        ..Model::default()
    };
    let mut scene = Scene::new(roof);
    // From above, so that the ridge is no silhouette.
    let framing = Framing { pitch_rad: 1.4, ..Framing::default() };
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing);
    let style = Style { crease_angle_rad: 40f32.to_radians(), ..named("lines") };
    let lines = |scene: &Scene| planned(scene, &style, &camera, SIZE).lines(scene).1[2];
    let before = lines(&scene);
    for step in 0..4000 {
        let scale = DVec3::new(1.0, 1.0 - f64::from(step) * 2e-4, 1.0);
        scene.place(0, &DAffine3::from_scale(scale)).expect("it has an inverse");
        if step % 100 == 0 {
            lines(&scene);
        }
    }
    assert_eq!((before, lines(&scene)), (1, 0));
}

/// Tiles of strokes keep their size when an object moves, and so do the numbers that vertices have for them.
#[test]
fn strokes_keep_their_size_when_an_object_moves() {
    let mut cube = embedded::cube();
    cube.uvs = cube.positions.iter().map(|p| glam::Vec2::new(p.x + p.z, p.y)).collect();
    let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
    let mut scene =
        Scene::with_objects(vec![cube], vec![object("", 0, at(0.0)), object("", 0, at(3.0))]).expect("good transforms");
    let camera = framed(&scene, Some(0.6));
    let strokes =
        |scene: &Scene| planned(scene, &named("hatch-color"), &camera, SIZE).hatch().expect("strokes").clone();
    let before = strokes(&scene);
    scene.place(1, &at(9.0)).expect("it has an inverse");
    let after = strokes(&scene);
    assert_eq!(before.tile, after.tile);
    assert!(std::sync::Arc::ptr_eq(&before.vertices[0], &after.vertices[0]));
}

/// Of surfaces that coincide both executors show those of the later object, also where instances are drawn together.
#[test]
fn of_coincident_objects_the_later_is_seen() {
    let meshes = vec![colored(embedded::cube(), [0.8, 0.1, 0.1]), colored(embedded::cube(), [0.1, 0.1, 0.8])];
    let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
    // Red is later on the left, and blue on the right.
    let placed = vec![object("", 1, at(0.0)), object("", 0, at(0.0)), object("", 0, at(4.0)), object("", 1, at(4.0))];
    let scene = Scene::with_objects(meshes, placed).expect("good transforms");
    let camera = framed(&scene, Some(0.6));
    let drawn = picture(&scene, &named("lambert"), &camera);
    let is_red = |pixel: &[u8]| u16::from(pixel[0]) > 2 * u16::from(pixel[2].max(20));
    let is_blue = |pixel: &[u8]| u16::from(pixel[2]) > 2 * u16::from(pixel[0].max(20));
    let columns = |of: &dyn Fn(&[u8]) -> bool| -> Vec<u32> {
        (0u32..).zip(drawn.rgba8.chunks(4)).filter(|(_, pixel)| of(pixel)).map(|(at, _)| at % SIZE.0).collect()
    };
    let (red, blue) = (columns(&is_red), columns(&is_blue));
    assert!(red.len() > 500 && blue.len() > 500, "{} and {} px", red.len(), blue.len());
    assert!(red.iter().max() < blue.iter().min(), "red is on the left of blue");
}

#[test]
fn lines_of_an_object_are_its_own() {
    let mut scene = scene();
    let camera = framed(&scene, Some(0.6));
    let style = named("lines");
    let all = planned(&scene, &style, &camera, SIZE).lines(&scene).0;
    scene.object_mut(0).lines = ObjectLines::None;
    let red = LineStyle { width_px: [3.0; 5], ink: [1.0, 0.0, 0.0, 1.0] };
    scene.object_mut(3).lines = ObjectLines::Own(red);
    let left = planned(&scene, &style, &camera, SIZE).lines(&scene).0;
    let of = |lines: &[[u32; 2]], object: u32| lines.iter().filter(|line| line[0] == object).count();
    assert!(of(&all, 0) > 0 && of(&left, 0) == 0);
    assert!((1..5).all(|object| of(&left, object) == of(&all, object)));
    let drawn = picture(&scene, &style, &camera);
    let is_red = |pixel: &[u8]| pixel[0] > 200 && pixel[1] < 60;
    assert!(drawn.rgba8.chunks(4).filter(|pixel| is_red(pixel)).count() > 100, "the sheared ring has red lines");
    scene.object_mut(3).lines = ObjectLines::Own(LineStyle { width_px: [f32::NAN; 5], ..red });
    let view = npr_harness::view::View::new(camera, SIZE);
    let plan =
        npr_harness::plan::Plan::new(&scene, &style, &view, &npr_harness::capabilities::Capabilities::RAY_CASTER);
    assert!(matches!(plan, Err(HarnessError::Range { what: "a line's width", .. })));
}

#[test]
fn borders_between_materials_have_lines_where_a_style_gives_them_a_width() {
    let mut model = embedded::cube();
    model.materials.push(Material::default());
    // The triangles of a side have the same material.
    let top: Vec<usize> = (0..model.faces.len())
        .filter(|&face| model.faces[face].iter().all(|&v| model.positions[v as usize].y > 0.5))
        .collect();
    model.fill_face_material();
    for face in top {
        model.face_material[face] = 1;
    }
    let scene = Scene::new(model);
    let camera = framed(&scene, Some(0.6));
    // No edge is a crease.
    let style = |material_border_px| Style {
        crease_angle_rad: 3.0,
        lines: npr_harness::style::Lines::edges(LineStyle {
            width_px: npr_outline::line_style::widths_px(1.0, 1.0, 1.0, material_border_px),
            ink: [0.0, 0.0, 0.0, 1.0],
        }),
        ..named("lines")
    };
    let (without, none) = planned(&scene, &style(0.0), &camera, SIZE).lines(&scene);
    let (with, counts) = planned(&scene, &style(2.0), &camera, SIZE).lines(&scene);
    // Two of the four edges of the top are silhouettes.
    assert_eq!((none[3], counts[3], with.len()), (0, 2, without.len() + 2));
}

#[test]
fn a_material_of_an_objects_own() {
    let mut scene = scene();
    let camera = framed(&scene, Some(0.6));
    let style = named("lambert");
    let green = Material { base_color: Vec4::new(0.0, 0.9, 0.0, 1.0), double_sided: false, ..Material::default() };
    scene.set_material(2, green.clone()).expect("opaque");
    let is_green = |pixel: &[u8]| pixel[1] > 60 && u16::from(pixel[1]) > 2 * u16::from(pixel[0].max(pixel[2]));
    let drawn = picture(&scene, &style, &camera);
    assert!(drawn.rgba8.chunks(4).filter(|pixel| is_green(pixel)).count() > 100);
    let of_mesh = scene.materials()[scene.material_number(0, 0)].base_color;
    assert_eq!(of_mesh, Vec4::new(0.7, 0.3, 0.2, 1.0), "the other objects of the mesh keep theirs");
    let fault = scene.set_material(
        0,
        Material {
            alpha_mode: AlphaMode::Blend,
            name: "glass".into(),
            base_color: green.base_color.with_w(0.5),
            ..green.clone()
        },
    );
    assert!(matches!(fault, Err(HarnessError::ObjectMaterial { object: 0, .. })));
    let fault = scene.set_material(0, Material { texture: Some(7), ..green });
    assert!(matches!(fault, Err(HarnessError::ObjectMaterial { object: 0, .. })));
}

#[test]
fn a_transform_without_inverse() {
    let mut scene = scene();
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    for singular in
        [flat, DAffine3::from_scale(DVec3::new(1.0, 1e-20, 1.0)), DAffine3::from_scale(DVec3::splat(f64::NAN))]
    {
        let fault = scene.place(2, &singular);
        assert!(matches!(fault, Err(HarnessError::ObjectTransform { object: 2, .. })), "{singular}");
    }
    for far in [1e40, 1e300] {
        let fault = scene.place(2, &DAffine3::from_translation(DVec3::splat(far)));
        assert!(matches!(fault, Err(HarnessError::ObjectTransform { object: 2, .. })), "{far}");
    }
    assert_eq!(scene.bounds(), self::scene().bounds(), "what is refused changes nothing");
    let nan = object("", 0, DAffine3::from_translation(DVec3::NAN));
    let fault = Scene::with_objects(meshes(), vec![nan]).err();
    assert!(matches!(fault, Some(HarnessError::ObjectTransform { object: 0, .. })));
    let fault = Scene::with_objects(meshes(), vec![object("", 2, DAffine3::IDENTITY)]).err();
    assert!(matches!(fault, Some(HarnessError::ObjectMesh { object: 0, mesh: 2, meshes: 2 })));
    // Small is not singular.
    scene.place(2, &DAffine3::from_scale(DVec3::splat(1e-200))).expect("it has an inverse");
    // Loaded from a file, it is drawn as a flat object.
    let flat = Scene::with_objects(meshes(), vec![object("flat", 1, flat), object("", 0, DAffine3::IDENTITY)])
        .expect("good transforms");
    let (low, high) = flat.bounds().expect("faces");
    assert!(low.is_finite() && high.is_finite() && flat.meshes().len() == 3);
    let camera = framed(&flat, Some(0.6));
    let hit = flat.closest(camera.eye, DVec3::new(0.9, 0.0, 0.0) - camera.eye, (0.0, 2.0), |hit| hit.object == 0);
    assert!(hit.is_some_and(|hit| (hit.t - 1.0).abs() < 1e-6), "{hit:?}");
    picture(&flat, &named("cartoon"), &camera);
}

/// A thousand objects of one mesh: a ray finds the nearest, and data for planning are computed once.
#[test]
fn a_thousand_instances() {
    let place = |i: u32| {
        let translation = DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)) * 6.0;
        object("", 0, DAffine3 { matrix3: turned(f64::from(i), f64::from(i) * 0.3), translation })
    };
    let scene = Scene::with_objects(vec![colored(letter(), [0.5; 3])], (0..1000).map(place).collect())
        .expect("good transforms");
    assert_eq!((scene.meshes().len(), scene.objects().len(), scene.face_count()), (1, 1000, 24_000));
    let camera = framed(&scene, Some(0.6));
    let plan = planned(&scene, &named("cartoon"), &camera, SIZE);
    let contours = &plan.edge_lines.as_ref().expect("lines").contours;
    assert!(contours.iter().all(|of_object| std::sync::Arc::ptr_eq(of_object, &contours[0])));
    // The nearest hit along some rays, by trying every object.
    let mut hits = 0;
    for (x, y) in (0..20).flat_map(|x| (0..15).map(move |y| (x, y))) {
        let size_px = glam::DVec2::new(SIZE.0.into(), SIZE.1.into());
        let (origin, direction) =
            camera.ray(glam::DVec2::new(f64::from(x) * 8.0 + 4.0, f64::from(y) * 8.0 + 4.0), size_px);
        let range = (camera.near, f64::INFINITY);
        let found = scene.closest(origin, direction, range, |_| true);
        let each = (0..1000u32).filter_map(|number| {
            let object = &scene.objects()[number as usize];
            let mesh_from_scene = object.scene_from_mesh().inverse();
            let origin = mesh_from_scene.transform_point3(origin);
            let direction = mesh_from_scene.transform_vector3(direction);
            let hit = scene.meshes()[0].rays().closest(origin, direction, range, |_| true)?;
            Some((hit.t, number, hit.face))
        });
        let nearest = each.min_by(|a, b| a.0.total_cmp(&b.0));
        let pair = |hit: npr_harness::rays::Hit| (hit.object, hit.face);
        assert_eq!(found.map(pair), nearest.map(|(_, object, face)| (object, face)), "{x} {y}");
        hits += usize::from(found.is_some());
        let all = scene.all(origin, direction, range, |_| true);
        assert_eq!(all.first().copied().map(pair), found.map(pair));
        assert!(all.windows(2).all(|pair| pair[0].t <= pair[1].t));
        assert_eq!(scene.any(origin, direction, range, |_| true), found.is_some());
    }
    assert!(hits > 50, "{hits}");
}

#[cfg(feature = "gpu")]
mod on_device {
    use super::*;
    use common::{Folder, device};
    use npr_harness::check;
    use npr_harness::executor::Executor;
    use npr_harness::gpu::GpuRenderer;
    use npr_harness::view::View;

    #[test]
    fn a_device_places_objects_as_the_reference_does() {
        let Some(executor) = device() else { return };
        let mut scene = scene();
        scene.object_mut(1).lines = ObjectLines::Own(LineStyle { width_px: [2.0; 5], ink: [0.8, 0.1, 0.1, 1.0] });
        scene.object_mut(4).lines = ObjectLines::None;
        let green = Material { base_color: Vec4::new(0.1, 0.6, 0.2, 1.0), double_sided: false, ..Material::default() };
        scene.set_material(2, green).expect("opaque");
        let aspect = f64::from(check::SIZE.0) / f64::from(check::SIZE.1);
        let view = |name: &str, yaw_rad, fov_y_rad| {
            let framing = Framing { yaw_rad, pitch_rad: 0.3, fov_y_rad, ..Framing::default() };
            (name.to_owned(), Camera::framed(scene.corners(), aspect, &framing))
        };
        let views = [view("perspective", 0.4, Some(0.6)), view("parallel", 2.4, None)];
        let hits_of = |camera: &Camera| {
            npr_harness::cpu::PrimaryHits::kept(&scene, View::new(*camera, check::SIZE), check::PLACES)
        };
        for (name, camera) in &views {
            let hits = hits_of(camera);
            for style_name in [
                "cartoon",
                "gooch",
                "toon-shadow",
                "hatch",
                "hatch-planes",
                "hatch-shadow",
                "shadow-lines",
                "normals",
                "ink-image",
                "ink-thick",
                "vertex-light",
                "printed-fins",
                "x-toon",
            ] {
                let style = named(style_name);
                let plan = planned(&scene, &style, camera, check::SIZE);
                let shot = check::Shot { hits: &hits, style: &style, plan: &plan };
                let check::Reference { image, exempt, .. } = check::Reference::new(shot).expect("pictures");
                let actual = common::rendered(&executor, &scene, &style, camera, check::SIZE);
                let comparison = npr_harness::compare::compare(&image, &actual, &exempt).expect("one size");
                let of_255 = comparison.worst;
                assert!(check::agrees(&comparison, check::magnitude(&plan)), "{name}, {style_name}: {of_255}");
            }
        }
        let folder = Folder::new();
        let plain = super::scene();
        let report = check::scene(&executor, "objects", &plain, &views, &folder.0).expect("pictures");
        let of_lines = |metric: &&check::Metric| !metric.pass;
        let failed: Vec<_> = report.metrics.iter().filter(of_lines).collect();
        assert!(failed.is_empty(), "{report}");
    }

    #[test]
    fn a_kept_upload_follows_objects_that_move() {
        let Some(executor) = device() else { return };
        let Executor::Gpu(context) = &executor else { return };
        let mut moving = scene();
        let camera = framed(&moving, Some(0.6));
        let view = View::new(camera, SIZE);
        for name in ["cartoon", "toon-shadow", "ink-image", "hatch", "hatch-color"] {
            let style = named(name);
            let renderer = GpuRenderer::new(context);
            let targets = renderer.targets(&view).expect("a picture");
            let plan = renderer.plan(&moving, &style, &view).expect("a good style");
            let uploaded = renderer.upload(&moving, &plan).expect("it fits");
            renderer.draw(&moving, &uploaded, &plan, &targets).expect("drawn");
            // Rotated, and mirrored if it was not.
            let to = DAffine3 {
                matrix3: turned(1.0, 0.5) * DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0)),
                translation: DVec3::new(-4.0, 1.0, 1.0),
            };
            moving.place(1, &to).expect("it has an inverse");
            let plan = renderer.plan(&moving, &style, &view).expect("a good style");
            renderer.draw(&moving, &uploaded, &plan, &targets).expect("drawn");
            let kept = renderer.read(&targets).expect("a picture");
            let anew = common::rendered(&executor, &moving, &style, &camera, SIZE);
            assert_eq!(kept, anew, "{name}");
            moving.place(1, &objects()[1].world_from_mesh).expect("it has an inverse");
            moving.set_material(0, Material::default()).expect("opaque");
            let stale = renderer.draw(&moving, &uploaded, &plan, &targets);
            assert!(matches!(stale, Err(HarnessError::StaleUpload)));
        }
    }
}
