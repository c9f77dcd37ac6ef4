//! Absolute tones: the picture has the style's colours and no others, whatever the colours of surfaces and lights.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, plain, planned, rendered, waves};
use glam::{Vec2, Vec3, Vec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::lights::StyleLight;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Style, style};
use npr_mesh::{AlphaMode, Material, Wrap, embedded};
use npr_toon::Bands;
use npr_toon::source::Light;
use std::collections::HashSet;

const SIZE: (u32, u32) = (120, 80);

#[test]
fn the_picture_has_the_colours_of_listing_3() {
    let mut model = embedded::sphere(24);
    model.materials =
        vec![Material { texture: Some(0), ..plain(Vec4::new(0.9, 0.4, 0.2, 1.0), AlphaMode::Opaque, false) }];
    model.textures = vec![waves(16, 16, [Wrap::Repeat; 2], true)];
    model.uvs = model.positions.iter().map(|p| Vec2::new(p.x, p.y)).collect();
    let scene = Scene::new(model);
    let camera = Camera::framed(scene.corners(), 1.5, &Framing::default());
    let light = Light { color: Vec3::new(1.0, 0.7, 0.5), ..StyleLight::KEY.light };
    let lights = vec![StyleLight { light, ..StyleLight::KEY }];
    let of = |bands| Style { shade: Shade::Toon(bands), lights: lights.clone(), ..style("toon").expect("a style") };
    // 0.2, 0.6 and (0.9, 0.9, 1) of listing 3, and paper.
    let listing = [[51, 51, 51], [153, 153, 153], [230, 230, 255], [250, 247, 240]];
    let expected: HashSet<[u8; 3]> = listing.into();
    for bands in [Bands::three_diffuse_bands(), Bands::diffuse_and_specular()] {
        let absolute = of(Bands { absolute: true, ..bands.clone() });
        let plan = planned(&scene, &absolute, &camera, SIZE);
        let on_cpu = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {}).image();
        let on_device = device().map(|executor| rendered(&executor, &scene, &absolute, &camera, SIZE));
        for image in [Some(on_cpu), on_device].into_iter().flatten() {
            let colors = image.rgba8.chunks_exact(4).map(|p| [p[0], p[1], p[2]]);
            // 0.9 * 255 lies between two bytes.
            let colors: HashSet<_> = colors.map(|c| if c == [229, 229, 255] { [230, 230, 255] } else { c }).collect();
            assert_eq!(colors, expected);
        }
        // As factors they are tinted by texture, material and light.
        let plan = planned(&scene, &of(bands), &camera, SIZE);
        let image = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {}).image();
        let colors: HashSet<_> = image.rgba8.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect();
        assert!(colors.len() > 100, "{}", colors.len());
    }
}
