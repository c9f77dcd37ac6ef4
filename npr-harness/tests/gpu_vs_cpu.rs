//! Comparisons of the GPU with the reference on difficult models, and comparisons that must fail.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod common;

use common::{Folder, cards, device, plain, planned, rendered, shared_models, waves};
use glam::{DVec2, Vec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::check::{self, PLACES, Reference, SIZE, Shot, agrees, magnitude};
use npr_harness::compare::compare;
use npr_harness::cpu::PrimaryHits;
use npr_harness::executor::Executor;
use npr_harness::gallery::still_life_camera;
use npr_harness::hull_lines::HullLines;
use npr_harness::image_lines::ImageInk;
use npr_harness::picture::Image;
use npr_harness::printed_fins::PrintedLines;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Lines, Style, style};
use npr_harness::view::View;
use npr_imagespace::filter::fused::FusedFilter;
use npr_imagespace::morphology::disc::Disc;
use npr_mesh::{AlphaMode, Material, Model, Wrap, embedded};
use npr_outline::line_style::LineStyle;

fn framed(scene: &Scene, yaw_deg: f64, pitch_deg: f64, fov_y_rad: Option<f64>) -> Camera {
    let framing =
        Framing { yaw_rad: yaw_deg.to_radians(), pitch_rad: pitch_deg.to_radians(), fov_y_rad, ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

/// Checks a scene in two perspective views and a parallel one, and prints the metrics that fail.
fn check_model(name: &str, model: Model) {
    let Some(executor) = device() else { return };
    let scene = Scene::new(model);
    let views =
        [("20 15", framed(&scene, 20.0, 15.0, Some(0.6))), ("-70 -35", framed(&scene, -70.0, -35.0, Some(1.2)))];
    let parallel = ("parallel 35 30", framed(&scene, 35.0, 30.0, None));
    let views = [views[0], views[1], parallel].map(|(name, camera)| (name.to_owned(), camera));
    let folder = Folder::new();
    let report = check::scene(&executor, name, &scene, &views, &folder.0).expect("pictures");
    let failed: Vec<_> = report.metrics.iter().filter(|metric| !metric.pass).collect();
    assert!(failed.is_empty(), "{report}");
    println!("{name}: {} metrics pass on {}", report.metrics.len(), report.executor);
}

#[test]
fn the_built_in_scene() {
    let Some(executor) = device() else { return };
    let folder = Folder::new();
    let report = check::run(&executor, &[], &Default::default(), &[], &folder.0, &|_| {}, &|_| {}).expect("pictures");
    println!("{report}");
    assert!(report.passed() && report.skipped.is_empty(), "{report}");
    let edges = ["cartoon", "lines", "printed-fins", "gooch", "two-lights", "wash", "wrapped", "vertex-light"];
    let pictures = ["printed-bands", "printed-gooch", "ink-image", "ink-thick", "ink-fine", "artist"];
    for technique in edges.into_iter().chain(pictures).chain(["image lines", "formats", "line finder", "width"]) {
        assert!(report.metrics.iter().any(|metric| metric.technique == technique), "{technique} was not checked");
    }
}

/// There, a plane a few hundredths of a px in front of the lines occludes them, which rounding must not change.
#[test]
fn lines_behind_a_ground_seen_from_below() {
    let Some(executor) = device() else { return };
    let scene = Scene::new(embedded::scene());
    let style = style("lines").expect("a style of the crate");
    for (yaw_deg, pitch_deg, fov_y_rad) in [(10.0, -10.0, Some(0.6)), (280.0, -10.0, None), (120.0, -45.0, Some(0.6))] {
        let camera = framed(&scene, yaw_deg, pitch_deg, fov_y_rad);
        let plan = planned(&scene, &style, &camera, SIZE);
        let hits = PrimaryHits::new(&scene, View::new(camera, SIZE));
        let shot = Shot { hits: &hits, style: &style, plan: &plan };
        let Reference { image, exempt, .. } = Reference::new(shot).expect("pictures");
        let actual = render(&executor, &scene, &style, &camera);
        let comparison = compare(&image, &actual, &exempt).expect("one size");
        let of_255 = magnitude(&plan);
        assert!(agrees(&comparison, of_255), "{yaw_deg} {pitch_deg}: {comparison:?}");
    }
}

#[test]
fn textures_with_mip_levels_and_all_wrap_modes() {
    let wraps = [
        [Wrap::Repeat, Wrap::Mirror],
        [Wrap::Mirror, Wrap::Clamp],
        [Wrap::Clamp, Wrap::Repeat],
        [Wrap::Clamp, Wrap::Mirror],
    ];
    // 61 × 40 texels over a quarter of a card: several levels, sizes that do not halve evenly.
    let mut model = cards(4, 1.7, |n| Material { texture: Some(0), ..plain(Vec4::ONE, AlphaMode::Opaque, n % 2 == 0) });
    model.textures = wraps.map(|wrap| waves(61, 40, wrap, true)).to_vec();
    for (number, material) in model.materials.iter_mut().enumerate() {
        material.texture = Some(number as u32);
        material.base_color = Vec4::new(0.9, 0.8, 1.0, 1.0);
    }
    check_model("wraps", model);
}

#[test]
fn vertex_colours() {
    let mut model = embedded::torus(1.0, 0.4, 48, 24);
    model.colors = model.positions.iter().map(|p| (*p * 0.3 + 0.5).extend(1.0)).collect();
    check_model("vertex colours", model);
}

#[test]
fn masked_and_blended_cards() {
    let modes = [
        AlphaMode::Mask { cutoff: 0.5 },
        AlphaMode::Blend,
        AlphaMode::Opaque,
        AlphaMode::Blend,
        AlphaMode::Mask { cutoff: 0.2 },
    ];
    let mut model = cards(5, 0.6, |n| plain(Vec4::new(0.8, 0.4, 0.2, 0.7), modes[n as usize], true));
    model.textures = vec![waves(64, 64, [Wrap::Repeat; 2], true)];
    for number in [0, 1, 4] {
        model.materials[number].texture = Some(0);
        model.materials[number].base_color = Vec4::ONE;
    }
    check_model("cards", model);
}

#[test]
fn single_sided_and_double_sided() {
    check_model("sides", cards(6, 0.5, |n| plain(Vec4::new(0.3, 0.7, 0.4, 1.0), AlphaMode::Opaque, n % 2 == 0)));
}

#[test]
fn shared_models_from_one_view() {
    let (Some(executor), Some(folder)) = (device(), shared_models()) else { return };
    for (file, yaw_deg, pitch_deg) in
        [("suzanne.obj", 40.0, 15.0), ("Fox.glb", 75.0, 20.0), ("fandisk.obj", 200.0, 30.0)]
    {
        let path = folder.join(file);
        let scene = Scene::from(npr_mesh::load(&path, &Default::default()).expect("a good file"));
        let views = [("one".to_owned(), framed(&scene, yaw_deg, pitch_deg, Some(0.6)))];
        let out = Folder::new();
        let report = check::scene(&executor, file, &scene, &views, &out.0).expect("pictures");
        assert!(report.passed(), "{report}");
    }
}

fn render(executor: &Executor, scene: &Scene, style: &Style, camera: &Camera) -> Image {
    rendered(executor, scene, style, camera, SIZE)
}

/// The picture with its content shifted to the right.
fn shifted(image: &Image) -> Image {
    let mut moved = image.clone();
    for y in 0..image.height {
        for x in 1..image.width {
            moved.set_pixel(x, y, image.pixel(x - 1, y));
        }
    }
    moved
}

#[test]
fn broken_pictures_do_not_pass() {
    let Some(executor) = device() else { return };
    let scene = Scene::new(embedded::scene());
    let camera = still_life_camera();
    let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
    for name in ["cartoon", "lines", "printed-fins", "ink-image", "ink-thick", "ink-fine"] {
        let style = style(name).expect("a style of the crate");
        let plan = planned(&scene, &style, &camera, SIZE);
        let magnitude = magnitude(&plan);
        let shot = Shot { hits: &hits, style: &style, plan: &plan };
        let Reference { image, exempt, .. } = Reference::new(shot).expect("pictures");
        let is_fine = |actual: &Image| agrees(&compare(&image, actual, &exempt).expect("one size"), magnitude);
        let good = render(&executor, &scene, &style, &camera);
        assert!(is_fine(&good), "{name}");
        assert!(!is_fine(&shifted(&good)), "{name}: a picture moved by a pixel passes");
        // A camera shifted by a third of a pixel, and a model enlarged by 1 %.
        let mut aside = camera;
        let px = camera.line_view(DVec2::new(640.0, 360.0)).depth_per_px.x * 13.0;
        aside.eye += camera.axes()[0] * (px / 3.0);
        aside.target += camera.axes()[0] * (px / 3.0);
        assert!(!is_fine(&render(&executor, &scene, &style, &aside)), "{name}: another camera passes");
        for broken in broken_styles(&style) {
            assert!(!is_fine(&render(&executor, &scene, &broken, &camera)), "{name}: {broken:?} passes");
        }
    }
}

/// The style with another light, if it has one, and with other lines.
fn broken_styles(style: &Style) -> Vec<Style> {
    let mut broken = Vec::new();
    if let Shade::Toon(bands) = &style.shade {
        let mut other = bands.clone();
        // A light rotated by about a degree.
        other.thresholds.iter_mut().for_each(|threshold| *threshold += 0.02);
        broken.push(Style { shade: Shade::Toon(other), ..style.clone() });
        let mut other = bands.clone();
        other.tones[0] *= 1.03;
        broken.push(Style { shade: Shade::Toon(other), ..style.clone() });
    }
    let Lines { hull, printed, edges, image } = style.lines;
    let lines = Lines {
        edges: edges.map(|look| LineStyle { width_px: look.width_px.map(|w| w + 0.05), ..look }),
        hull: hull.map(|hull| HullLines { width_px: hull.width_px + 0.25, ..hull }),
        printed: printed.map(|fins| PrintedLines { width_px: fins.width_px + 0.25, ..fins }),
        image: image.map(|ink| ImageInk {
            filter: FusedFilter { normal_cos: Some(0.7), ..ink.filter },
            dilation: ink.dilation.map(|disc| Disc { radius_px: disc.radius_px + 0.1, ..disc }),
            ..ink
        }),
    };
    broken.push(Style { lines, ..style.clone() });
    broken.push(Style { lines: Lines::NONE, ..style.clone() });
    broken
}
