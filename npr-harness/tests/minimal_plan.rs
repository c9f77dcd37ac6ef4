//! A plan models no more than its scene needs: what a picture of a simple solid takes is listed number by number, each
//! technique adds only what it must, and each resource goes when the need for it goes.
#![allow(clippy::print_stdout)]

mod common;

use common::{cards, plain, waves};
use glam::{DAffine3, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::{Capabilities, ExecutorKind};
use npr_harness::hatch::{HatchEncoding, HatchMapping};
use npr_harness::hull_lines::HullLines;
use npr_harness::image_lines::gbuffer::style::{GBuffer, GBufferTarget, InkStep, SeparateTargets, Show, StepKind};
use npr_harness::image_lines::{ImageInk, InkScale, Regions};
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::plan::resources::total_bytes;
use npr_harness::plan::{Plan, Resource, ResourceKind};
use npr_harness::printed_fins::PrintedLines;
use npr_harness::scene::{ObjectLines, Scene};
use npr_harness::shade::Shade;
use npr_harness::shade::ramp::{RampShade, RampSource};
use npr_harness::shadow::{ShadowMethod, ShadowStyle};
use npr_harness::style::{Lines, Style, style};
use npr_harness::texel_format::TexelFormat;
use npr_harness::view::View;
use npr_imagespace::filter::separate::SeparateFilter;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::Disc;
use npr_mesh::{AlphaMode, Material, Model, Object, embedded};
use npr_outline::hull::HullNormals;
use npr_outline::line_style::{LineStyle, widths_px};
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::row::RampRow;
use npr_toon::source::Light;

const SIZE: (u32, u32) = (128, 64);
const PIXELS: u64 = 128 * 64;

/// A hardware adapter with every capability.
const ADAPTER: Capabilities = Capabilities {
    kind: ExecutorKind::HardwareAdapter,
    compute: true,
    no_compute: "the adapter has no compute shaders",
    vertex_storage: true,
    indirect_draws: true,
    uniform_alignment: 256,
    texture_px: 8192,
    storage_bytes: 1 << 27,
    ..Capabilities::RAY_CASTER
};

/// A cube of one material, which is convex and closed. Its edges turn by 90°.
fn solid() -> Scene {
    Scene::new(embedded::cube())
}

fn camera(scene: &Scene) -> Camera {
    Camera::framed(scene.corners(), 2.0, &Framing::default())
}

/// Hard bands, one light from far away, no shadow, no lines.
fn bands() -> Style {
    Style {
        shade: Shade::Toon(Bands { antialias: false, highlight: None, ..Bands::hard_shading() }),
        lights: vec![StyleLight { light: Light::directional(Vec3::ONE), frame: LightFrame::World }],
        shadow: None,
        lines: Lines::NONE,
        // More than any edge of the solid turns.
        crease_angle_rad: 2.0,
        ..style("toon").expect("it is built in")
    }
}

fn with_edges(style: Style, width_px: [f32; 4]) -> Style {
    Style { lines: Lines { edges: Some(LineStyle { width_px, ink: [0.0, 0.0, 0.0, 1.0] }), ..style.lines }, ..style }
}

fn with_ink(style: Style, ink: ImageInk) -> Style {
    Style { lines: Lines { image: Some(ink), ..style.lines }, ..style }
}

fn with_shadow(style: Style, method: ShadowMethod) -> Style {
    Style { shadow: Some(ShadowStyle { method, ..ShadowStyle::default() }), ..style }
}

fn plan_of(scene: &Scene, style: &Style, capabilities: &Capabilities) -> Plan {
    Plan::new(scene, style, &View::new(camera(scene), SIZE), capabilities).expect("a good style")
}

fn resources_on(scene: &Scene, style: &Style, capabilities: &Capabilities) -> Vec<Resource> {
    plan_of(scene, style, capabilities).resources(scene, capabilities).expect("it was planned")
}

fn resources(scene: &Scene, style: &Style) -> Vec<Resource> {
    resources_on(scene, style, &ADAPTER)
}

/// A render target, as (name, format, width and height, bytes).
type Target = (&'static str, TexelFormat, (u32, u32), u64);
/// Any other resource, as (name, count, bytes).
type Other = (&'static str, u32, u64);

#[track_caller]
fn assert_resources(found: &[Resource], targets: &[Target], others: &[Other]) {
    let target = |resource: &Resource| match resource.kind {
        ResourceKind::Target { format, size, .. } => Some((resource.name.clone(), format, size, resource.bytes)),
        _ => None,
    };
    let found_targets: Vec<_> = found.iter().filter_map(target).collect();
    let expected: Vec<_> = targets.iter().map(|&(name, f, size, bytes)| (name.to_owned(), f, size, bytes)).collect();
    assert_eq!(found_targets, expected);
    let is_other = |resource: &&Resource| !matches!(resource.kind, ResourceKind::Target { .. });
    let found_others: Vec<_> = found.iter().filter(is_other).map(|r| (&*r.name, r.count, r.bytes)).collect();
    assert_eq!(found_others, others);
}

/// What `more` has in addition to `less`, which must be part of it, as names and bytes.
#[track_caller]
fn added(less: &[Resource], more: &[Resource]) -> Vec<(String, u64)> {
    for resource in less {
        assert!(more.contains(resource), "{resource:?} is gone or has changed");
    }
    let is_new = |resource: &&Resource| !less.contains(resource);
    more.iter().filter(is_new).map(|resource| (resource.name.clone(), resource.bytes)).collect()
}

#[track_caller]
fn assert_added(less: &[Resource], more: &[Resource], expected: &[(&str, u64)]) {
    let expected: Vec<_> = expected.iter().map(|&(name, bytes)| (name.to_owned(), bytes)).collect();
    assert_eq!(added(less, more), expected);
}

/// The picture, and what hides one surface behind another.
const PICTURE: [Target; 2] =
    [("colour", TexelFormat::Rgba8Unorm, SIZE, 4 * PIXELS), ("depth", TexelFormat::Depth32Float, SIZE, 4 * PIXELS)];

/// The solid: 24 corners with normals of their own, 12 triangles with indices of 16 bits, one object, one material, and the
/// light. Materials are 48 bytes, at multiples of the 256 that the adapter asks for.
const SURFACES: [Other; 6] = [
    ("positions", 1, 24 * 12),
    ("normals", 1, 24 * 12),
    ("faces", 1, 12 * 3 * 2),
    ("objects", 1, 84),
    ("materials", 1, 256),
    ("lights", 1, 64),
];

fn passes(plan: &Plan) -> Vec<&str> {
    plan.passes.iter().map(|reason| reason.pass).collect()
}

#[test]
fn a_solid_in_hard_bands_takes_a_picture_a_depth_buffer_and_itself() {
    let (scene, style) = (solid(), bands());
    let plan = plan_of(&scene, &style, &ADAPTER);
    assert_eq!(passes(&plan), ["geometry: colour and depth"]);
    let found = resources(&scene, &style);
    // No target of normals, regions or coverage, no stencil, no texture, no texture coordinates, no edges.
    assert_resources(&found, &PICTURE, &SURFACES);
    assert_eq!(total_bytes(&found), 2 * 4 * PIXELS + 288 + 288 + 72 + 84 + 256 + 64);
    let paint = plan.paint.as_ref().expect("surfaces are painted");
    assert_eq!((paint.lights.len(), paint.light_pairs.len(), paint.facets.len()), (1, 0, 0));
    assert!(!plan.looks_up && !plan.cut_out && !plan.blended && !paint.interpolates_light);
    for (pass, why) in [
        ("second light", "there is one light"),
        ("texture and vertex colour lookups", "no material needs them"),
        ("back faces", "the model is closed: they are hidden"),
        ("shadow volumes into a stencil", "no light casts shadows"),
        ("line coverage and ink", "the style draws no line along an edge"),
        ("normal, region, depth beside colour", "no line is found in the image"),
        ("positions or light between vertices", "the light comes from far away, and meets normals at pixels"),
    ] {
        let said = plan.left_out.iter().find(|reason| reason.pass == pass).map(|reason| &*reason.why);
        assert_eq!(said, Some(why), "{pass}");
    }
}

#[test]
fn lines_along_edges_add_two_targets_and_the_edges_without_creases() {
    let (scene, style) = (solid(), with_edges(bands(), widths_px(2.0, 2.0, 1.0, 1.0)));
    let plan = plan_of(&scene, &style, &ADAPTER);
    assert_eq!(passes(&plan), ["geometry: colour and depth", "line coverage and ink"]);
    let lines = plan.edge_lines.as_ref().expect("there are lines");
    assert_eq!(lines.contours[0].always, 0, "no edge turns by more than the crease's angle, there is no border");
    // A copy of the picture to draw on, and the greatest coverage of a pixel; a plane for each of 12 triangles, two ends
    // and two faces for each of 12 edges, which are at most all lines, and 24 corners.
    let targets = [
        PICTURE[0],
        PICTURE[1],
        ("colour and lines", TexelFormat::Rgba8Unorm, SIZE, 4 * PIXELS),
        ("greatest coverage", TexelFormat::Depth16Unorm, SIZE, 2 * PIXELS),
    ];
    let edges = [
        ("outline planes", 1, 12 * 16),
        ("outline edges", 1, 12 * 16),
        ("outline positions", 1, 24 * 12),
        ("outline lines", 1, 12 * 4),
        ("outline draw arguments", 1, 16),
    ];
    assert_resources(&resources(&scene, &style), &targets, &[&SURFACES[..], &edges].concat());
    // Found on the CPU, they are uploaded as records: at most every edge.
    let on_cpu = Capabilities { compute: false, ..ADAPTER };
    let found = resources_on(&scene, &style, &on_cpu);
    assert_resources(&found, &targets, &[&SURFACES[..], &[("outline records", 1, 12 * 52)]].concat());
    assert_eq!(found.last().map(|resource| resource.kind), Some(ResourceKind::Buffer { is_bound: true }));
    let (drawn, _) = plan.lines(&scene);
    assert!((4..=12).contains(&drawn.len()), "{} of 12 edges are lines", drawn.len());
}

#[test]
fn edges_have_a_record_only_where_they_can_be_a_line_that_is_drawn() {
    let scene = solid();
    let contours = |style: &Style| {
        let lines = plan_of(&scene, style, &ADAPTER).edge_lines.expect("there are lines");
        (lines.contours[0].edges.len(), lines.contours[0].always)
    };
    let sharp = |width_px| Style { crease_angle_rad: 1.0, ..with_edges(bands(), width_px) };
    assert_eq!(contours(&sharp(widths_px(2.0, 0.0, 1.0, 0.0))), (12, 12), "each edge is a crease");
    assert_eq!(contours(&sharp(widths_px(2.0, 0.0, 0.0, 0.0))), (12, 0), "creases are not drawn");
    assert_eq!(contours(&sharp(widths_px(0.0, 2.0, 0.0, 2.0))), (0, 0), "there is no boundary and no border");
    // Without polygons the diagonals of the sides are edges, but both of their faces are in one plane.
    let triangles = Scene::new(Model { face_polygon: Vec::new(), ..embedded::cube() });
    assert_eq!(triangles.meshes()[0].edges().edges.len(), 18);
    let style = with_edges(bands(), widths_px(2.0, 2.0, 1.0, 1.0));
    let lines = plan_of(&triangles, &style, &ADAPTER).edge_lines.expect("there are lines");
    assert_eq!(lines.contours[0].edges.len(), 12);
}

#[test]
fn lines_in_the_image_add_one_target() {
    let (scene, plain) = (solid(), resources(&solid(), &bands()));
    let ink = ImageInk { regions: Regions::Material, ..ImageInk::default() };
    let plan = plan_of(&scene, &with_ink(bands(), ink), &ADAPTER);
    let expected = ["geometry: colour and depth", "normal, region, depth beside colour", "filter and composite in one"];
    assert_eq!(passes(&plan), expected);
    // One texel of 8 bytes has all three; one material is one region, so that vertices have no numbers.
    assert_added(&plain, &resources(&scene, &with_ink(bands(), ink)), &[("normal, region and depth", 8 * PIXELS)]);
    let small = ImageInk { layout: TexelLayout::Bits32, ..ink };
    assert_added(&plain, &resources(&scene, &with_ink(bands(), small)), &[("normal, region and depth", 4 * PIXELS)]);
    // The sides as regions: 24 numbers. No corner is shared by two sides, so that none is copied.
    let sides = Style { crease_angle_rad: 1.0, ..with_ink(bands(), ImageInk::default()) };
    let regions = [("normal, region and depth", 8 * PIXELS), ("regions", 24 * 4)];
    assert_added(&plain, &resources(&scene, &sides), &regions);
}

#[test]
fn strokes_add_their_map_and_their_directions() {
    let (scene, plain) = (solid(), resources(&solid(), &bands()));
    let Shade::Hatch(hatch) = style("hatch").expect("it is built in").shade else { panic!("it hatches") };
    let hatched = |encoding, mapping| Style {
        shade: Shade::Hatch(npr_harness::hatch::HatchShade { encoding, mapping, ..hatch.clone() }),
        ..bands()
    };
    let by_planes = hatched(HatchEncoding::Thresholds, HatchMapping::Planes);
    let plan = plan_of(&scene, &by_planes, &ADAPTER);
    let expected = ["geometry: colour and depth", "positions or light between vertices", "tonal art map"];
    assert_eq!(passes(&plan), expected);
    // 512 × 512 texels of two bytes with all levels down to one texel.
    let thresholds = ("thresholds", 2 * (4u64.pow(10) - 1) / 3);
    assert_added(&plain, &resources(&scene, &by_planes), &[thresholds]);
    // Along the form: a symmetric tensor at each corner.
    let along_form = hatched(HatchEncoding::Thresholds, HatchMapping::Form);
    assert_added(&plain, &resources(&scene, &along_form), &[thresholds, ("directions of strokes", 24 * 24)]);
    // Six tones: three a texture, of four bytes.
    let six = hatched(HatchEncoding::SixTones, HatchMapping::Planes);
    let tones = 2 * thresholds.1;
    let expected = [("the lighter tones", tones), ("the darker tones", tones)];
    assert_added(&plain, &resources(&scene, &six), &expected);
    // A software rasteriser gets half floats.
    let software = Capabilities { kind: ExecutorKind::SoftwareAdapter, ..ADAPTER };
    let found = resources_on(&scene, &six, &software);
    let expected = [("the lighter tones", 2 * tones), ("the darker tones", 2 * tones)];
    assert_added(&resources_on(&scene, &bands(), &software), &found, &expected);
}

#[test]
fn light_of_faces_adds_their_middles_and_normals() {
    let (scene, plain) = (solid(), resources(&solid(), &bands()));
    let style = Style { normals: NormalUse::PerFace, ..bands() };
    let found = resources(&scene, &style);
    let of = |name: &str| found.iter().find(|resource| resource.name == name).map(|resource| resource.bytes);
    // Two texels of 16 bytes for each of 12 faces, and no two faces share a vertex.
    assert_eq!(of("corners of faces"), Some(12 * 2 * 16));
    assert_eq!((of("positions"), of("normals"), of("faces")), (Some(36 * 12), Some(36 * 12), Some(36 * 2)));
    assert_eq!(found.len(), plain.len() + 1);
}

#[test]
fn shadows_add_a_stencil_and_a_mask_or_a_map() {
    let (scene, plain) = (solid(), resources(&solid(), &bands()));
    let volumes = with_shadow(bands(), ShadowMethod::Volumes);
    let expected = ["geometry: depth, before all", "shadow volumes into a stencil", "geometry: colour and depth"];
    assert_eq!(passes(&plan_of(&scene, &volumes, &ADAPTER)), expected);
    // All 12 edges and 12 faces, from which the device selects, 64 bytes each.
    let casters = [("volume edges", 12 * 64), ("volume faces", 12 * 64)];
    let expected = [("shadow stencil", 8 * PIXELS), ("shadow mask", PIXELS), casters[0], casters[1]];
    assert_added(&plain, &resources(&scene, &volumes), &expected);
    let packed = Capabilities { float_stencil: false, ..ADAPTER };
    let expected = [("shadow stencil", 4 * PIXELS), ("shadow mask", PIXELS), casters[0], casters[1]];
    assert_added(&plain, &resources_on(&scene, &volumes, &packed), &expected);
    let map = with_shadow(bands(), ShadowMethod::Map { side: 256 });
    assert_eq!(passes(&plan_of(&scene, &map, &ADAPTER)), ["shadow map", "geometry: colour and depth"]);
    assert_added(&plain, &resources(&scene, &map), &[("shadow map", 4 * 256 * 256)]);
}

#[test]
fn the_cpu_takes_arrays_of_samples_and_a_hierarchy() {
    let (scene, style) = (solid(), bands());
    let cpu = |style: &Style| resources_on(&scene, style, &Capabilities::RAY_CASTER);
    let plain = cpu(&style);
    // Four f64 of colour and one of depth for each sample, and bytes for the file.
    let (hierarchy, arrays) = plain.split_last().expect("it is not empty");
    let arrays: Vec<_> = arrays.iter().map(|resource| (&*resource.name, resource.bytes)).collect();
    assert_eq!(
        arrays,
        [("colours of samples", 32 * PIXELS), ("depths of samples", 8 * PIXELS), ("picture", 4 * PIXELS)]
    );
    // At most 23 nodes of 32 bytes over 12 triangles of 40 with a number each, and a box of 56 for the object.
    assert_eq!(hierarchy.name, "hierarchy of faces");
    assert!((12 * 44..=23 * 32 + 12 * 44 + 56).contains(&hierarchy.bytes), "{} bytes", hierarchy.bytes);
    let lines = with_edges(bands(), widths_px(2.0, 2.0, 1.0, 1.0));
    let expected = [("coverage by lines", 8 * PIXELS), ("planes of edges", 12 * 16), ("edges", 12 * 16)];
    assert_added(&plain, &cpu(&lines), &expected);
    let expected = [("normals, regions and depths", 8 * PIXELS), ("ink", PIXELS)];
    assert_added(&plain, &cpu(&with_ink(bands(), ImageInk::default())), &expected);
    // Rays need nothing more.
    assert_added(&plain, &cpu(&with_shadow(bands(), ShadowMethod::Volumes)), &[]);
}

/// A card with a texture, texture coordinates and no vertex colours.
fn textured() -> Scene {
    let mut model = cards(1, 1.0, |_| plain(glam::Vec4::ONE, AlphaMode::Opaque, true));
    model.textures = vec![waves(16, 8, [npr_mesh::Wrap::Repeat; 2], true)];
    model.materials[0].texture = Some(0);
    Scene::new(model)
}

/// The card, whose texture is that of what it emits.
fn emitting(emissive: Vec3) -> Scene {
    let mut model = cards(1, 1.0, |_| Material { emissive, ..plain(glam::Vec4::ONE, AlphaMode::Opaque, true) });
    model.textures = vec![waves(16, 8, [npr_mesh::Wrap::Repeat; 2], true)];
    model.materials[0].emissive_texture = Some(0);
    Scene::new(model)
}

/// A solid with two materials.
fn of_two_materials() -> Scene {
    let mut model = embedded::cube();
    model.materials = vec![Material::default(); 2];
    model.materials[1].base_color.x = 0.5;
    model.face_material = (0..12).map(|face| face / 6).collect();
    Scene::new(model)
}

/// A picture of the solid of which the style is not [`bands`].
fn of_style(style: Style) -> (Scene, Style) {
    (solid(), style)
}

fn ink_lines(ink: ImageInk) -> (Scene, Style) {
    of_style(with_ink(bands(), ink))
}

fn with_gbuffer(gbuffer: GBuffer) -> (Scene, Style) {
    ink_lines(ImageInk { gbuffer: Some(gbuffer), ..ImageInk::default() })
}

fn separate(filter: SeparateFilter) -> GBuffer {
    let depth = npr_imagespace::format::depth::DepthFormat::Float;
    let target = GBufferTarget::Separate(SeparateTargets { filter, normals: None, depth, region_sums: false });
    GBuffer { target, ..GBuffer::default() }
}

#[test]
fn each_resource_goes_when_the_need_for_it_goes() {
    let disc = Some(Disc { radius_px: 2.0, antialias: true });
    let paper = || Style { shade: Shade::Paper, ..bands() };
    let lines = widths_px(2.0, 2.0, 2.0, 2.0);
    let toon = |bands: Bands| Style { shade: Shade::Toon(bands), ..self::bands() };
    let hard = || Bands { highlight: None, ..Bands::hard_shading() };
    let Shade::Hatch(hatch) = style("hatch").expect("it is built in").shade else { panic!("it hatches") };
    let hatched =
        |mapping| Style { shade: Shade::Hatch(npr_harness::hatch::HatchShade { mapping, ..hatch.clone() }), ..bands() };
    let row = RampRow { texels: vec![[0; 4], [255; 4]], from: 0.0, to: 1.0, filter: Default::default() };
    let row = RampShade { ramp: RampSource::Image(row), half_lambert: None };
    let all = SeparateFilter::default();
    let step = InkStep { kind: StepKind::SoftCross, times: 1 };
    let steps = [Some(step), None, None, None];
    let colored = || {
        let mut model = embedded::cube();
        model.colors = vec![glam::Vec4::ONE; model.positions.len()];
        Scene::new(model)
    };
    let no_lines = {
        let mut scene = solid();
        scene.object_mut(0).lines = ObjectLines::None;
        scene
    };
    // The need; what is there with it; a picture with the need; the same without it.
    type Case = (&'static str, Vec<&'static str>, (Scene, Style), (Scene, Style));
    let cases: Vec<Case> = vec![
        ("surfaces are painted", vec!["normals"], of_style(bands()), of_style(with_edges(paper(), lines))),
        ("something is drawn", vec!["depth"], of_style(with_edges(paper(), lines)), of_style(paper())),
        (
            "lines along edges",
            vec!["colour and lines", "greatest coverage", "outline edges", "outline planes", "outline lines"],
            of_style(with_edges(bands(), lines)),
            of_style(bands()),
        ),
        (
            "an object with lines",
            vec!["colour and lines", "greatest coverage", "outline edges", "outline planes", "outline lines"],
            of_style(with_edges(bands(), lines)),
            (no_lines, with_edges(bands(), lines)),
        ),
        ("lines in the image", vec!["normal, region and depth"], ink_lines(ImageInk::default()), of_style(bands())),
        (
            "regions within a mesh",
            vec!["regions"],
            (of_two_materials(), with_ink(bands(), ImageInk { regions: Regions::Material, ..Default::default() })),
            (solid(), with_ink(bands(), ImageInk { regions: Regions::Material, ..Default::default() })),
        ),
        (
            "ink of another size",
            vec!["depth of the ink", "ink"],
            ink_lines(ImageInk { scale: InkScale::Half, ..Default::default() }),
            ink_lines(ImageInk::default()),
        ),
        (
            "thick lines",
            vec!["ink", "disc"],
            ink_lines(ImageInk { dilation: disc, ..Default::default() }),
            ink_lines(ImageInk::default()),
        ),
        (
            "thick lines of another size",
            vec!["thick ink"],
            ink_lines(ImageInk { dilation: disc, scale: InkScale::Half, ..Default::default() }),
            ink_lines(ImageInk { dilation: disc, ..Default::default() }),
        ),
        (
            "a G-buffer of the style",
            vec!["G-buffer", "ink"],
            with_gbuffer(separate(all)),
            ink_lines(Default::default()),
        ),
        (
            "lines of a G-buffer",
            vec!["G-buffer", "ink"],
            with_gbuffer(separate(all)),
            with_gbuffer(GBuffer { show: Show::Normals, ..separate(all) }),
        ),
        (
            "steps of morphology",
            vec!["second ink"],
            with_gbuffer(GBuffer { steps, ..separate(all) }),
            with_gbuffer(separate(all)),
        ),
        (
            "a shadow by volumes",
            vec!["shadow stencil", "shadow mask", "volume edges", "volume faces"],
            of_style(with_shadow(bands(), ShadowMethod::Volumes)),
            of_style(with_shadow(bands(), ShadowMethod::Map { side: 64 })),
        ),
        (
            "a shadow by a map",
            vec!["shadow map"],
            of_style(with_shadow(bands(), ShadowMethod::Map { side: 64 })),
            of_style(bands()),
        ),
        (
            "a picture that shows the shadow",
            vec!["shadow stencil", "shadow mask", "volume edges", "volume faces"],
            of_style(with_shadow(bands(), ShadowMethod::Volumes)),
            of_style(with_shadow(with_edges(paper(), lines), ShadowMethod::Volumes)),
        ),
        (
            "a texture that is shown",
            vec!["waves", "texture coordinates"],
            (textured(), toon(hard())),
            (textured(), toon(Bands { absolute: true, ..hard() })),
        ),
        (
            "a texture of what is emitted",
            vec!["waves", "texture coordinates"],
            (emitting(Vec3::ONE), toon(hard())),
            (emitting(Vec3::ZERO), toon(hard())),
        ),
        (
            "an emission that is shown",
            vec!["waves", "texture coordinates"],
            (emitting(Vec3::ONE), toon(hard())),
            (emitting(Vec3::ONE), toon(Bands { absolute: true, ..hard() })),
        ),
        (
            "colours at vertices that are shown",
            vec!["vertex colours"],
            (colored(), bands()),
            (colored(), Style { shade: Shade::Normals, ..bands() }),
        ),
        (
            "strokes by texture coordinates",
            vec!["texture coordinates", "octaves of strokes"],
            (textured(), hatched(HatchMapping::Coordinates)),
            (textured(), hatched(HatchMapping::Planes)),
        ),
        (
            "strokes along the form",
            vec!["directions of strokes"],
            of_style(hatched(HatchMapping::Form)),
            of_style(hatched(HatchMapping::Planes)),
        ),
        (
            "one light for a face",
            vec!["corners of faces"],
            of_style(Style { normals: NormalUse::PerFace, ..bands() }),
            of_style(bands()),
        ),
        (
            "a texture of tones",
            vec!["image of the shade"],
            of_style(Style { shade: Shade::Ramp(row), ..bands() }),
            of_style(bands()),
        ),
        (
            "inverted hulls",
            vec!["hull", "hull's faces"],
            of_style(Style {
                lines: Lines::hull(HullLines { width_px: 2.0, ink: Vec3::ZERO, normals: HullNormals::Welded }),
                ..bands()
            }),
            of_style(bands()),
        ),
        (
            "printed fins",
            vec!["printed fins", "printed fins' normals", "printed fins' indices"],
            of_style(Style { lines: Lines::printed(PrintedLines::default()), ..bands() }),
            of_style(bands()),
        ),
    ];
    for (need, names, (scene, style), (other_scene, other_style)) in cases {
        let (with, without) = (resources(&scene, &style), resources(&other_scene, &other_style));
        let has = |of: &[Resource], name: &str| of.iter().any(|resource| resource.name == name);
        for name in names {
            assert!(has(&with, name), "{need}: no {name}: {with:#?}");
            assert!(!has(&without, name), "without {need} there is {name}");
        }
    }
}

#[test]
fn a_filter_that_leaves_out_a_test_leaves_out_its_target() {
    let all = SeparateFilter::default();
    for (filter, formats) in [
        (all, vec![TexelFormat::Rgba32Float, TexelFormat::R32Float, TexelFormat::R32Uint]),
        (SeparateFilter { normal: None, ..all }, vec![TexelFormat::R32Float, TexelFormat::R32Uint]),
        (SeparateFilter { depth: None, ..all }, vec![TexelFormat::Rgba32Float, TexelFormat::R32Uint]),
        (SeparateFilter { regions: false, ..all }, vec![TexelFormat::Rgba32Float, TexelFormat::R32Float]),
        (SeparateFilter { normal: None, depth: None, ..all }, vec![TexelFormat::R32Uint]),
    ] {
        let (scene, style) = with_gbuffer(separate(filter));
        let format = |resource: Resource| match resource.kind {
            ResourceKind::Target { format, .. } if resource.name == "G-buffer" => Some(format),
            _ => None,
        };
        let found: Vec<_> = resources(&scene, &style).into_iter().filter_map(format).collect();
        assert_eq!(found, formats, "{filter:?}");
    }
}

#[test]
fn what_is_placed_twice_is_there_once() {
    let placed = |count: u32| {
        let object = |number| Object {
            name: String::new(),
            mesh: 0,
            world_from_mesh: DAffine3::from_translation(DVec3::new(3.0 * f64::from(number), 0.0, 0.0)),
        };
        Scene::with_objects(vec![embedded::cube()], (0..count).map(object).collect()).expect("a scene")
    };
    let style = with_edges(bands(), widths_px(2.0, 2.0, 1.0, 1.0));
    let of = |count| resources(&placed(count), &style);
    let (one, three) = (of(1), of(3));
    for (a, b) in one.iter().zip(&three) {
        // What an object has of its own: its place, and its lines.
        let own = ["objects", "outline lines", "outline draw arguments"].contains(&&*a.name);
        assert_eq!((&a.name, b.bytes), (&b.name, if own { 3 * a.bytes } else { a.bytes }));
    }
    assert_eq!(one.len(), three.len());
}

#[test]
fn several_samples_have_one_more_target() {
    let scene = solid();
    let style = with_edges(bands(), widths_px(2.0, 2.0, 1.0, 1.0));
    let mut view = View::new(camera(&scene), SIZE);
    view.samples = 2;
    let plan = Plan::new(&scene, &style, &view, &ADAPTER).expect("a good style");
    let found = plan.resources(&scene, &ADAPTER).expect("it was planned");
    let fine = (256, 128);
    let targets = [
        ("colour", TexelFormat::Rgba8Unorm, fine, 16 * PIXELS),
        ("colour", TexelFormat::Rgba8Unorm, SIZE, 4 * PIXELS),
        ("depth", TexelFormat::Depth32Float, fine, 16 * PIXELS),
        ("colour and lines", TexelFormat::Rgba8Unorm, fine, 16 * PIXELS),
        ("greatest coverage", TexelFormat::Depth16Unorm, fine, 8 * PIXELS),
    ];
    let is_target = |resource: &&Resource| matches!(resource.kind, ResourceKind::Target { .. });
    let found: Vec<_> = found.iter().filter(is_target).map(|r| (&*r.name, r.bytes)).collect();
    assert_eq!(found, targets.map(|(name, .., bytes)| (name, bytes)));
}

/// Against what is really created, by the labels and sizes in the report of the device's allocator.
#[cfg(feature = "gpu")]
mod on_device {
    use super::*;
    use npr_harness::executor::Executor;
    use npr_harness::gallery::{painted_camera, painted_scene};
    use npr_harness::gpu::{GpuContext, GpuRenderer};
    use npr_harness::style::styles;
    use std::collections::BTreeMap;

    /// What stands where a shader declares what it does not read: textures of one texel and small uniforms.
    const PLACEHOLDERS: [&str; 6] = ["no image", "no shadow", "no tonal art map", "white", "placeholder", "uniform"];
    /// Which only live while a frame is drawn.
    const OF_A_FRAME: [&str; 3] = ["lights", "blended faces", "outline records"];

    /// Per label: the number of live objects, and their size, bytes.
    type Live = BTreeMap<String, (u32, u64)>;

    fn live(context: &GpuContext) -> Option<Live> {
        context.wait().expect("no fault");
        let report = context.device.generate_allocator_report()?;
        let mut live = Live::new();
        for allocation in report.allocations {
            let of_label = live.entry(allocation.name).or_default();
            *of_label = (of_label.0 + 1, of_label.1 + allocation.size);
        }
        Some(live)
    }

    /// What a picture has created.
    fn created(context: &GpuContext, scene: &Scene, plan: &Plan) -> Option<Live> {
        let before = live(context)?;
        let renderer = GpuRenderer::new(context);
        let targets = renderer.targets(&plan.view).expect("targets");
        let uploaded = renderer.upload(scene, plan).expect("it fits");
        renderer.draw(scene, &uploaded, plan, &targets).expect("a picture");
        let mut after = live(context)?;
        for (label, (count, bytes)) in before {
            let of_label = after.entry(label).or_default();
            *of_label = (of_label.0.saturating_sub(count), of_label.1.saturating_sub(bytes));
        }
        after.retain(|_, (count, _)| *count > 0);
        Some(after)
    }

    /// The bytes of a texture whose rows are padded to 64 bytes, and whose levels have a multiple of four rows.
    fn padded(format: TexelFormat, (width, height): (u32, u32), levels: u32) -> u64 {
        let of_level = |level: u32| {
            let [width, height] = [width, height].map(|side| u64::from((side >> level).max(1)));
            (width * format.bytes()).next_multiple_of(64) * height.next_multiple_of(4)
        };
        (0..levels).map(of_level).sum()
    }

    fn check(context: &GpuContext, scene: &Scene, camera: Camera, style: &Style, capabilities: &Capabilities) -> bool {
        let plan = Plan::new(scene, style, &View::new(camera, SIZE), capabilities).expect("a good style");
        let Some(mut created) = created(context, scene, &plan) else {
            println!("skipped: the device's allocator has no report");
            return false;
        };
        let mut listed = BTreeMap::<String, (u32, u64, u64)>::new();
        for Resource { name, kind, count, bytes } in plan.resources(scene, capabilities).expect("it was planned") {
            // Each allocation is padded, and so are rows.
            let most = match kind {
                ResourceKind::Target { format, size, .. } => padded(format, size, 1),
                ResourceKind::Texture { format, size, levels } => padded(format, size, levels),
                ResourceKind::Buffer { .. } | ResourceKind::Array => bytes / u64::from(count),
            };
            let of_label = listed.entry(name).or_default();
            *of_label = (of_label.0 + count, of_label.1 + bytes, of_label.2 + (most + 64) * u64::from(count));
        }
        for (name, (count, bytes, most)) in listed {
            if OF_A_FRAME.contains(&&*name) {
                assert!(!created.contains_key(&name), "{}: {name} outlives its frame", style.name);
                continue;
            }
            let (found, found_bytes) = created.remove(&name).unwrap_or_default();
            assert_eq!(found, count, "{}: {name}", style.name);
            assert!((bytes..=most).contains(&found_bytes), "{}: {name}: {bytes}, {found_bytes}", style.name);
        }
        for (label, (_, bytes)) in created {
            // Of wgpu itself: among others what checks the arguments of indirect draws.
            if label.starts_with("(wgpu internal)") {
                continue;
            }
            assert!(PLACEHOLDERS.contains(&&*label), "{}: {label}, {bytes} bytes, is not listed", style.name);
            assert!(bytes < 2048, "{}: {label}, {bytes} bytes", style.name);
        }
        true
    }

    #[test]
    fn the_list_is_what_a_device_creates() {
        let Some(Executor::Gpu(context)) = common::device() else { return };
        let own = context.capabilities.clone();
        // The same device with the methods of hardware.
        let hardware = Capabilities { kind: ExecutorKind::HardwareAdapter, ..own.clone() };
        let (solid, textured, painted) = (solid(), textured(), painted_scene());
        let materials = of_two_materials();
        let mut checked = 0;
        let filters = [SeparateFilter::default(), SeparateFilter { normal: None, ..SeparateFilter::default() }];
        let of_gbuffers = filters.map(|filter| with_gbuffer(separate(filter)).1);
        let map = with_shadow(bands(), ShadowMethod::Map { side: 64 });
        let of_faces = Style { normals: NormalUse::PerFace, ..bands() };
        let more = [bands(), with_edges(bands(), widths_px(2.0, 2.0, 0.0, 0.0)), map, of_faces];
        for style in styles().into_iter().chain(of_gbuffers).chain(more) {
            for (scene, camera, capabilities) in [
                (&solid, camera(&solid), &hardware),
                (&materials, camera(&materials), &hardware),
                (&textured, camera(&textured), &own),
                (&painted, painted_camera(), &own),
            ] {
                checked += u32::from(check(&context, scene, camera, &style, capabilities));
            }
        }
        println!("{checked} pictures");
    }
}
