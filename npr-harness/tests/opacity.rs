//! What hides, casts and is outlined goes by alpha, whatever says it, and on both executors.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, rendered};
use glam::{Mat4, Vec2, Vec3, Vec4};
use npr_harness::camera::{Camera, Projection};
use npr_harness::executor::Executor;
use npr_harness::image_lines::ImageInk;
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::shadow::{ShadowMethod, ShadowStyle, ShadowTechnique};
use npr_harness::style::{Lines, Style, style};
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Material, Model, Texture, Wrap, embedded};
use npr_outline::line_style::{LineStyle, widths_px};
use npr_toon::source::Light;

const SIZE: (u32, u32) = (120, 120);

fn executors() -> Vec<Executor> {
    device().into_iter().chain([Executor::Cpu { why: None }]).collect()
}

/// 10 units of the plane z = 0 fill the picture: a unit is 12 px, and y points up.
fn front() -> Camera {
    let projection = Projection::Orthographic { height: 10.0, far: 40.0 };
    Camera {
        eye: glam::DVec3::new(0.0, 0.0, 20.0),
        target: glam::DVec3::ZERO,
        up: glam::DVec3::Y,
        projection,
        near: 1.0,
    }
}

/// A rectangle in a plane of constant z that faces the eye, with texture coordinates from 0 to 1.
fn sheet(low: [f32; 2], high: [f32; 2], z: f32, material: Material) -> Model {
    let corners = [[low[0], low[1]], [high[0], low[1]], high, [low[0], high[1]]];
    Model {
        positions: corners.map(|[x, y]| Vec3::new(x, y, z)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(Vec2::from).to_vec(),
        faces: vec![[0, 1, 2], [0, 2, 3]],
        face_material: vec![0; 2],
        face_polygon: vec![0; 2],
        materials: vec![material],
        ..Model::default()
    }
}

fn together(models: impl IntoIterator<Item = Model>) -> Scene {
    let mut all = Model::default();
    models.into_iter().for_each(|model| all.append(&model));
    Scene::new(all)
}

/// Black edge lines 3 px wide, on white paper.
fn edges() -> Style {
    let lines = Lines::edges(LineStyle { width_px: widths_px(3.0, 3.0, 3.0, 0.0), ink: [0.0, 0.0, 0.0, 1.0] });
    Style { paper: Vec3::ONE, shade: Shade::Paper, shadow: None, lines, ..style("lines").expect("a style") }
}

fn gray(image: &Image, x: u32, y: u32) -> u8 {
    image.rgba8[4 * (y * image.width + x) as usize]
}

/// Where a material's alpha comes from.
#[derive(Clone, Copy, Debug)]
enum By {
    Factor,
    Texture,
    VertexColor,
}

/// A blended sheet with an alpha.
fn pane(by: By, alpha: f32, low: [f32; 2], high: [f32; 2], z: f32) -> Model {
    let white = Material { alpha_mode: AlphaMode::Blend, base_color: Vec4::ONE, ..Material::default() };
    let mut pane = sheet(low, high, z, white);
    match by {
        By::Factor => pane.materials[0].base_color.w = alpha,
        By::VertexColor => pane.colors = vec![Vec4::new(1.0, 1.0, 1.0, alpha); 4],
        By::Texture => {
            pane.materials[0].texture = Some(0);
            let byte = (alpha * 255.0).round() as u8;
            pane.textures = vec![texture(2, 2, |_, _| byte)];
        }
    }
    pane
}

/// A white texture.
fn texture(width: u32, height: u32, alpha: impl Fn(u32, u32) -> u8) -> Texture {
    let alpha = &alpha;
    let texels = (0..height).flat_map(|y| (0..width).flat_map(move |x| [255, 255, 255, alpha(x, y)]));
    Texture {
        name: "alpha".into(),
        width,
        height,
        rgba8: texels.collect::<Vec<u8>>().into(),
        wrap: [Wrap::Clamp; 2],
        smooth: true,
    }
}

/// A line behind a pane is as dark as the pane lets it through, and hidden from 0.5 on.
#[test]
fn a_pane_dims_lines_behind_it_by_its_alpha_and_hides_them_from_a_half_on() {
    // The lower side of the wall is at y = 0: row 60. The pane hides its right half.
    let wall = || sheet([-4.0, 0.0], [4.0, 6.0], 0.0, Material::default());
    for executor in executors() {
        for by in [By::Factor, By::Texture, By::VertexColor] {
            for alpha in [0.0f32, 0.3, 0.49, 0.5, 0.7, 1.0] {
                let scene = together([wall(), pane(by, alpha, [0.0, -3.0], [6.0, 7.0], 2.0)]);
                let image = rendered(&executor, &scene, &edges(), &front(), SIZE);
                let case = format!("{} {by:?} {alpha}", executor.describe());
                // Alpha 0.49 as a byte is 125 / 255, 0.5 is 128 / 255.
                let shown = if alpha < 0.5 { 1.0 - alpha } else { 0.0 };
                let expected = 255.0 * (1.0 - shown);
                assert!(gray(&image, 36, 60) < 3, "{case}: beside the pane");
                let behind = f32::from(gray(&image, 84, 60));
                assert!((behind - expected).abs() <= 2.0, "{case}: {behind} where {expected} is expected");
                // The pane's own lower side, whatever its alpha.
                assert!(gray(&image, 84, 96) < 3, "{case}: its own line");
            }
        }
    }
}

/// What is before a pane is not dimmed, and each of several panes dims.
#[test]
fn only_panes_in_front_of_a_line_dim_it() {
    let wall = |z| sheet([-4.0, 0.0], [4.0, 6.0], z, Material::default());
    for executor in executors() {
        for (z, expected) in [(3.0, 0.0), (1.0, 0.2), (-1.0, 0.36), (-3.0, 0.488)] {
            let panes = [2.0, 0.0, -2.0].map(|z| pane(By::Factor, 0.2, [-4.8, -3.0], [4.8, 4.8], z));
            let scene = together([wall(z)].into_iter().chain(panes));
            let image = rendered(&executor, &scene, &edges(), &front(), SIZE);
            let found = f64::from(gray(&image, 84, 60)) / 255.0;
            assert!((found - expected).abs() < 0.012, "{}: {found} at {z}, not {expected}", executor.describe());
        }
    }
}

/// The alpha of a texture decides pixel by pixel.
#[test]
fn a_texture_hides_where_its_alpha_is_a_half() {
    for executor in executors() {
        let mut pane = pane(By::Texture, 1.0, [-5.0, -3.0], [5.0, 7.0], 2.0);
        pane.textures = vec![texture(2, 1, |x, _| if x == 0 { 51 } else { 204 })];
        let wall = sheet([-4.0, 0.0], [4.0, 6.0], 0.0, Material::default());
        let image = rendered(&executor, &together([wall, pane]), &edges(), &front(), SIZE);
        let [left, right] = [20, 100].map(|x| gray(&image, x, 60));
        assert!(left.abs_diff(51) <= 2, "{}: {left}", executor.describe());
        assert_eq!(right, 255, "{}", executor.describe());
    }
}

/// A blended material with alpha 1 makes the very picture of an opaque one, in every kind of lines.
#[test]
fn blended_with_alpha_1_is_opaque() {
    let ball = |alpha_mode| {
        let material = Material { alpha_mode, base_color: Vec4::new(0.7, 0.3, 0.2, 1.0), ..Material::default() };
        let ball = embedded::placed(embedded::sphere(24), Mat4::from_scale(Vec3::splat(3.0)), material);
        together([ball, sheet([-4.0, -4.0], [4.0, 4.0], -4.0, Material::default())])
    };
    for executor in executors() {
        for name in ["cartoon", "ink-image", "toon-shadow", "hull", "lines"] {
            let Some(style) = style(name) else { continue };
            let [blended, opaque] = [AlphaMode::Blend, AlphaMode::Opaque]
                .map(|mode| rendered(&executor, &ball(mode), &style, &front(), SIZE));
            assert!(blended.rgba8 == opaque.rgba8, "{}: {name}", executor.describe());
        }
    }
}

/// Image-space lines have what is in the G-buffer: surfaces from alpha 0.5 on.
#[test]
fn image_space_lines_outline_a_pane_from_a_half_on() {
    let ink = Style { paper: Vec3::ONE, shade: Shade::Paper, lines: Lines::image(ImageInk::default()), ..edges() };
    for executor in executors() {
        for by in [By::Factor, By::Texture, By::VertexColor] {
            for (alpha, is_outlined) in
                [(0.0, false), (0.3, false), (0.49, false), (0.51, true), (0.7, true), (1.0, true)]
            {
                let scene = together([pane(by, alpha, [-3.0, -3.0], [3.0, 3.0], 0.0)]);
                let image = rendered(&executor, &scene, &ink, &front(), SIZE);
                // The lower side is at row 96.
                let darkest = (92..100).map(|y| gray(&image, 60, y)).min().unwrap();
                assert_eq!(darkest < 100, is_outlined, "{} {by:?} {alpha}: {darkest}", executor.describe());
            }
        }
    }
}

/// Light straight from above the eye's side, onto a wall with something before it.
fn shadowed(method: ShadowMethod) -> Style {
    let light = StyleLight { light: Light::directional(Vec3::new(0.0, 1.0, 1.0)), frame: LightFrame::World };
    let shadow = Some(ShadowStyle { method, terminator: 0.0 });
    Style { lights: vec![light], shadow, lines: Lines::NONE, ..style("toon-shadow").expect("a style") }
}

/// The colours of the wall in the light, and where what is before it could cast a shadow: at its middle.
fn lit_and_shadowed(executor: &Executor, before: Model, style: &Style) -> [[u8; 3]; 2] {
    let white = Material { base_color: Vec4::ONE, ..Material::default() };
    let wall = sheet([-5.0, -5.0], [5.0, 5.0], 0.0, white);
    let image = rendered(executor, &together([wall, before]), style, &front(), SIZE);
    // What is at z = 3 and |y| <= 1 casts onto y = -3: 96 px from above.
    [30, 60].map(|x| {
        let at = 4 * (96 * image.width + x) as usize;
        [image.rgba8[at], image.rgba8[at + 1], image.rgba8[at + 2]]
    })
}

#[test]
fn a_pane_casts_a_shadow_from_a_half_on() {
    for executor in executors() {
        for method in [ShadowMethod::Volumes, ShadowMethod::Map { side: 512 }] {
            for by in [By::Factor, By::Texture, By::VertexColor] {
                for (alpha, casts) in
                    [(0.0, false), (0.3, false), (0.49, false), (0.51, true), (0.7, true), (1.0, true)]
                {
                    let pane = pane(by, alpha, [-1.0, -1.0], [1.0, 1.0], 3.0);
                    let [lit, shadow] = lit_and_shadowed(&executor, pane, &shadowed(method));
                    assert_eq!(shadow != lit, casts, "{} {method:?} {by:?} {alpha}", executor.describe());
                }
            }
        }
    }
}

/// A square whose middle is cut out.
fn frame(z: f32, half: f32) -> Model {
    let material = Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, texture: Some(0), ..Material::default() };
    let mut frame = sheet([-half, -half], [half, half], z, material);
    frame.textures = vec![texture(32, 32, |x, y| if (8..24).contains(&x) && (8..24).contains(&y) { 0 } else { 255 })];
    frame
}

#[test]
fn a_cut_out_casts_the_shadow_of_what_is_left() {
    let white = Material { base_color: Vec4::ONE, ..Material::default() };
    let wall = || sheet([-5.0, -5.0], [5.0, 5.0], 0.0, white.clone());
    let style = shadowed(ShadowMethod::Volumes);
    for executor in executors() {
        let scene = together([wall(), frame(3.0, 2.0)]);
        let image = rendered(&executor, &scene, &style, &front(), SIZE);
        // The shadow's middle is 3 units lower: at row 96, its border from x = 36 to 84, the hole in it from 48 to 72.
        let row: Vec<u8> = [20, 42, 60, 78, 100].map(|x| gray(&image, x, 96)).to_vec();
        assert!(row[0] == row[2] && row[2] == row[4], "{}: {row:?}", executor.describe());
        assert!(row[1] < row[0] && row[3] < row[0], "{}: {row:?}", executor.describe());
        let plan = Plan::new(&scene, &style, &View::new(front(), SIZE), &executor.capabilities()).expect("a plan");
        let shadow = plan.shadow.expect("a shadow");
        if executor.capabilities().is_adapter() {
            assert!(matches!(shadow.technique, ShadowTechnique::Map { alpha_test: true, .. }));
            assert!(plan.passes.iter().any(|pass| pass.pass == "shadow map" && pass.why.contains("alpha")));
        }
        // A cutoff that leaves all of it makes no map necessary.
        let mut whole = frame(3.0, 2.0);
        whole.materials[0].alpha_mode = AlphaMode::Mask { cutoff: 0.0 };
        let plan = Plan::new(&together([whole]), &style, &View::new(front(), SIZE), &executor.capabilities());
        let technique = plan.expect("a plan").shadow.expect("a shadow").technique;
        assert!(matches!(technique, ShadowTechnique::Volumes { .. } | ShadowTechnique::Rays));
    }
}

/// Edge lines follow the cut, on what is left.
#[test]
fn a_line_runs_along_the_cut() {
    for smooth in [true, false] {
        let mut model = frame(0.0, 4.0);
        model.textures[0].smooth = smooth;
        let scene = together([model]);
        // The hole is 4 units wide. Its sides lie between texels, where the interpolated alpha is a half.
        let cuts = scene.meshes()[0].cut_lines();
        let length: f32 = (cuts.edges.iter())
            .map(|edge| {
                let [a, b] = edge.ends.map(|v| scene.meshes()[0].model().positions[v as usize]);
                a.distance(b)
            })
            .sum();
        assert!((length - 16.0).abs() < 0.3, "{length}");
        for executor in executors() {
            let image = rendered(&executor, &scene, &edges(), &front(), SIZE);
            let dark = |x: u32, y: u32| gray(&image, x, y) < 60;
            let case = format!("{} {smooth}", executor.describe());
            // All four sides, at 36 and 84 px, without a gap.
            for along in 40..80 {
                for (x, y) in [(36, along), (84, along), (along, 36), (along, 84)] {
                    let beside = [[0, 0], [1, 0], [0, 1]].into_iter().any(|[dx, dy]| dark(x - dx, y - dy));
                    assert!(beside, "{case}: at {x} {y}");
                }
            }
            assert_eq!(gray(&image, 60, 60), 255, "{case}: in the hole");
            assert_eq!(gray(&image, 24, 60), 255, "{case}: on what is left");
        }
    }
}

/// A vertex colour cuts a face along a straight line; a turned face has it at the same place.
#[test]
fn cuts_by_vertex_colours_are_straight_lines() {
    let material = Material { alpha_mode: AlphaMode::Mask { cutoff: 0.25 }, ..Material::default() };
    for faces in [vec![[0, 1, 2], [0, 2, 3]], vec![[1, 2, 3], [1, 3, 0]], vec![[2, 0, 1], [3, 0, 2]]] {
        let mut model = sheet([-4.0, -4.0], [4.0, 4.0], 0.0, material.clone());
        model.faces = faces;
        // From 0 on the left to 1 on the right: the cut is at x = -2, 36 px.
        model.colors = [0.0, 1.0, 1.0, 0.0].map(|alpha| Vec4::new(1.0, 1.0, 1.0, alpha)).to_vec();
        let scene = together([model]);
        assert_eq!(scene.meshes()[0].cut_lines().edges.len(), 2);
        for executor in executors() {
            let image = rendered(&executor, &scene, &edges(), &front(), SIZE);
            assert!((20..100).all(|y| gray(&image, 36, y) < 60 || gray(&image, 35, y) < 60), "{}", executor.describe());
            assert_eq!(gray(&image, 20, 60), 255);
            assert_eq!(gray(&image, 14, 60), 255, "the border of what is cut away has no line");
        }
    }
}

/// The back faces of see-through solids are part of the picture.
#[test]
fn a_closed_see_through_solid_shows_its_back_faces() {
    let style = Style { lines: Lines::NONE, ..style("toon").expect("a style") };
    for mode in [AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.5 }] {
        let material = Material {
            alpha_mode: mode,
            base_color: Vec4::new(0.1, 0.8, 0.1, if mode == AlphaMode::Blend { 0.4 } else { 1.0 }),
            ..Material::default()
        };
        let mut cube =
            embedded::placed(embedded::cube(), Mat4::from_rotation_y(0.6) * Mat4::from_rotation_x(0.5), material);
        if mode != AlphaMode::Blend {
            cube.colors = (0..cube.positions.len()).map(|i| Vec4::new(1.0, 1.0, 1.0, (i % 3) as f32 * 0.5)).collect();
        }
        let scene = Scene::new(cube);
        assert!(scene.is_closed());
        let camera = Camera { projection: Projection::Orthographic { height: 4.0, far: 40.0 }, ..front() };
        let pictures: Vec<Image> =
            executors().iter().map(|executor| rendered(executor, &scene, &style, &camera, SIZE)).collect();
        if let [a, b] = &pictures[..] {
            let far = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 16);
            let differing = a.rgba8.chunks(4).zip(b.rgba8.chunks(4)).filter(|pair| far(*pair)).count();
            assert!(differing <= 14, "{mode:?}: {differing}");
        }
        let single = Material { double_sided: false, ..scene.materials()[0].clone() };
        let mut fronts = scene.clone();
        fronts.set_material(0, single).expect("of the same mode");
        let of_fronts = rendered(&executors()[0], &fronts, &style, &camera, SIZE);
        let differing = pictures[0].rgba8.chunks(4).zip(of_fronts.rgba8.chunks(4)).filter(|(a, b)| a != b).count();
        assert!(differing > 300, "{mode:?}: {differing}");
    }
}

/// An inward cube, single-sided: a room, seen through its culled walls.
fn room(double_sided: bool) -> Scene {
    let mut room = embedded::cube();
    room.faces.iter_mut().for_each(|face| face.swap(1, 2));
    room.normals.iter_mut().for_each(|normal| *normal = -*normal);
    room.face_material = vec![0; room.faces.len()];
    room.materials = vec![Material { base_color: Vec4::ONE, double_sided, ..Material::default() }];
    Scene::new(room)
}

/// Walls that are culled for the eye cast shadows nevertheless, from whichever side the light comes.
#[test]
fn a_room_seen_through_its_walls_is_in_shadow() {
    let scene = room(false);
    let camera = Camera {
        eye: glam::DVec3::new(6.0, 5.0, 8.0),
        projection: Projection::Orthographic { height: 5.0, far: 40.0 },
        ..front()
    };
    let light = StyleLight { light: Light::directional(Vec3::new(0.3, 1.0, 0.5)), frame: LightFrame::World };
    let toon = style("toon-shadow").expect("a style");
    for executor in executors() {
        for method in [ShadowMethod::Volumes, ShadowMethod::Map { side: 512 }] {
            let shadow = Some(ShadowStyle { method, terminator: 0.0 });
            let lit = Style { lights: vec![light], shadow: None, lines: Lines::NONE, ..toon.clone() };
            let shadowed = Style { shadow, ..lit.clone() };
            // The floor, which faces the light.
            let [lit, shadowed] = [lit, shadowed].map(|style| rendered(&executor, &scene, &style, &camera, SIZE));
            assert!(gray(&shadowed, 60, 75) < gray(&lit, 60, 75), "{} {method:?}", executor.describe());
        }
    }
}

/// The lines of walls that are culled are not drawn; those between a culled and a shown wall are contours.
#[test]
fn culled_walls_have_no_lines() {
    let camera = Camera {
        eye: glam::DVec3::new(6.0, 5.0, 8.0),
        projection: Projection::Orthographic { height: 5.0, far: 40.0 },
        ..front()
    };
    for executor in executors() {
        let plan = |scene: &Scene| {
            Plan::new(scene, &edges(), &View::new(camera, SIZE), &executor.capabilities()).expect("a plan")
        };
        // Of 12 edges the three at the nearest corner join culled walls.
        let (single, double) = (room(false), room(true));
        let eight = |scene: &Scene| plan(scene).lines(scene).1.iter().sum::<usize>();
        assert_eq!((eight(&single), eight(&double)), (9, 12), "{}", executor.describe());
        // The picture: below the nearest corner (the centre of the picture is the cube's), an edge of two culled walls.
        let camera_x = glam::DVec3::new(8.0, 0.0, -6.0).normalize();
        let corner = glam::DVec3::new(1.0, 0.0, 1.0);
        let x = (60.0 + 24.0 * corner.dot(camera_x)).round() as u32;
        let darkest = |scene: &Scene| {
            let image = rendered(&executor, scene, &edges(), &camera, SIZE);
            (x - 1..=x + 1).map(|x| gray(&image, x, 52)).min().unwrap()
        };
        assert!(darkest(&double) < 60, "{}: {}", executor.describe(), darkest(&double));
        assert_eq!(darkest(&single), 255, "{}", executor.describe());
    }
}

/// Two single-sided faces back to back are one wall that is shown from both sides.
#[test]
fn a_wall_of_two_single_sided_faces_has_its_lines_from_both_sides() {
    let single = Material { double_sided: false, ..Material::default() };
    let mut wall = sheet([-3.0, -3.0], [3.0, 3.0], 0.0, single);
    let behind = Camera { eye: glam::DVec3::new(0.0, 0.0, -20.0), ..front() };
    let dark = |model: &Model, camera: &Camera, executor: &Executor| {
        let image = rendered(executor, &Scene::new(model.clone()), &edges(), camera, SIZE);
        gray(&image, 60, 96) < 60
    };
    for executor in executors() {
        assert!(dark(&wall, &front(), &executor) && !dark(&wall, &behind, &executor), "{}", executor.describe());
    }
    wall.faces.extend([[0, 2, 1], [0, 3, 2]]);
    wall.face_material = vec![0; 4];
    wall.face_polygon = vec![0, 0, 1, 1];
    for executor in executors() {
        assert!(dark(&wall, &front(), &executor) && dark(&wall, &behind, &executor), "{}", executor.describe());
    }
}

/// A scene of opaque materials takes no pass, target or segment of the others.
#[test]
fn opaque_scenes_take_nothing_of_it() {
    let scene = together([sheet([-4.0, 0.0], [4.0, 6.0], 0.0, Material::default())]);
    for executor in executors() {
        let plan = Plan::new(&scene, &edges(), &View::new(front(), SIZE), &executor.capabilities()).expect("a plan");
        assert!(!plan.blended && !plan.blended_hide && !plan.veiled && !plan.cut_out);
        assert!(scene.meshes()[0].cut_lines().edges.is_empty());
        let resources = plan.resources(&scene, &executor.capabilities()).expect("resources");
        assert!(!resources.iter().any(|resource| resource.name.contains("layer")));
    }
}
