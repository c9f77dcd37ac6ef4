//! What the passes refuse: textures of another format, size or number of samples, areas beyond the target, matrices
//! whose depth is not reversed. What differs from a refused case in that one thing alone is accepted.

use crate::device::{COLOR_FORMAT, Gpu, gpu};
use crate::line_view;
use glam::dcamera::rh::proj::directx as proj;
use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};
use npr_mesh::edges::{EdgeOptions, find};
use npr_mesh::{Model, embedded};
use npr_outline::OutlineError;
use npr_outline::fin_pass::FinPass;
use npr_outline::fin_printed::{FinDepth, FinView, printed_fins};
use npr_outline::hull::{Hull, HullNormals, HullView};
use npr_outline::hull_pass::{HullOnDevice, HullPass, PlacedHull};
use npr_outline::line_pass::{COVERAGE_FORMAT, LineGroup, LinePass, LineSource, LineTargets};
use npr_outline::line_style::LineStyle;
use npr_outline::normal_format::NormalFormat;
use npr_outline::segment::LineView;
use npr_outline::shadow_mask::{MASK_FORMAT, ShadowMaskPass};
use npr_outline::shadow_pass::{CastersOnDevice, PlacedCasters, ShadowPass};
use npr_outline::shadow_volume::shadow_casters;
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [16, 12];
const OTHER_SIZE: [u32; 2] = [16, 13];
const STENCIL_FORMAT: TextureFormat = TextureFormat::Depth24PlusStencil8;

fn texture(gpu: &Gpu, format: TextureFormat, [width, height]: [u32; 2], samples: u32) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

/// What a recording returns, submitted.
fn recorded(
    gpu: &Gpu,
    record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), OutlineError>,
) -> Result<(), OutlineError> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let outcome = record(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    outcome
}

/// Whether an outcome is the refusal for a texture of this format, size or number of samples.
fn is_refused(outcome: &Result<(), OutlineError>, format: TextureFormat, size: [u32; 2], samples: u32) -> bool {
    match *outcome {
        Err(OutlineError::ViewFormat { format: found, .. }) => found == format,
        Err(OutlineError::ViewSize { size_px, needed_px, .. }) => [size_px, needed_px].contains(&size),
        Err(OutlineError::ViewSamples { samples: found, .. }) => found == samples,
        _ => false,
    }
}

/// A texture in place of the one that is right, and whether it is.
fn others(right: TextureFormat) -> [(TextureFormat, [u32; 2], u32, bool); 4] {
    let wrong = if right == TextureFormat::R8Uint { TextureFormat::R16Uint } else { TextureFormat::R8Uint };
    [(right, SIZE, 1, true), (wrong, SIZE, 1, false), (right, OTHER_SIZE, 1, false), (right, SIZE, 4, false)]
}

#[test]
fn color_formats_that_encode_srgb_and_that_are_no_floats_are_refused() {
    let Some(gpu) = gpu() else { return };
    let made = |format| {
        [
            LinePass::new(&gpu.device, format, false).map(|_| ()),
            FinPass::new(&gpu.device, format, NormalFormat::F32).map(|_| ()),
            HullPass::new(&gpu.device, format).map(|_| ()),
        ]
    };
    for format in [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb] {
        assert_eq!(made(format), [Err(OutlineError::SrgbTarget { format }); 3]);
    }
    for format in [TextureFormat::Rgba8Uint, TextureFormat::Depth32Float] {
        assert!(made(format).iter().all(|made| matches!(made, Err(OutlineError::ViewFormat { .. }))));
    }
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm, TextureFormat::Rgba16Float] {
        assert_eq!(made(format), [Ok(()); 3]);
    }
}

#[test]
fn stencil_formats_without_depth_or_without_stencil_are_refused() {
    let Some(gpu) = gpu() else { return };
    for (format, is_right) in
        [(STENCIL_FORMAT, true), (TextureFormat::Depth32Float, false), (TextureFormat::Rgba8Unorm, false)]
    {
        assert_eq!(ShadowPass::new(&gpu.device, format, false).is_ok(), is_right, "{format:?}");
        assert_eq!(ShadowMaskPass::new(&gpu.device, format).is_ok(), is_right, "{format:?}");
    }
}

#[test]
fn the_line_pass_refuses_other_textures_and_matrices() {
    let Some(gpu) = gpu() else { return };
    let pass = LinePass::new(&gpu.device, COLOR_FORMAT, false).unwrap();
    let style = LineStyle { width_px: [1.0; 5], ink: [0.0, 0.0, 0.0, 1.0] };
    let formats = [COLOR_FORMAT, TextureFormat::Depth32Float, COLOR_FORMAT, COVERAGE_FORMAT];
    let draw = |views: &[wgpu::TextureView; 4], view: &LineView, eye: DVec4| {
        let [painted, depth, inked, coverage] = views;
        let targets = LineTargets { painted, depth, inked, coverage };
        recorded(gpu, |encoder| {
            let lines = LineGroup { source: LineSource::Records(&[]), view: *view, eye };
            pass.record(&gpu.device, encoder, &[lines], &style, &targets)
        })
    };
    let right = || formats.map(|format| texture(gpu, format, SIZE, 1));
    let view = line_view(SIZE, DMat4::IDENTITY);
    for i in 0..4 {
        for (format, size, samples, is_right) in others(formats[i]) {
            let mut views = right();
            views[i] = texture(gpu, format, size, samples);
            let outcome = draw(&views, &view, DVec4::W);
            assert_eq!(outcome.is_ok(), is_right, "texture {i}: {outcome:?}");
            assert!(is_right || is_refused(&outcome, format, size, samples), "texture {i}: {outcome:?}");
        }
    }
    let outcome = draw(&right(), &line_view(OTHER_SIZE, DMat4::IDENTITY), DVec4::W);
    assert!(matches!(outcome, Err(OutlineError::ViewSize { .. })), "{outcome:?}");
    for (clip_from_world, eye, is_right) in [
        (proj::perspective(1.0, 1.3, 100.0, 0.1), DVec4::W, true),
        (proj::perspective(1.0, 1.3, 0.1, 100.0), DVec4::W, false),
        (proj::orthographic(-1.0, 1.0, -1.0, 1.0, 100.0, 0.1), DVec4::Z, true),
        (proj::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 100.0), DVec4::Z, false),
    ] {
        let outcome = draw(&right(), &LineView { clip_from_world, ..view }, eye);
        assert_eq!(outcome.is_ok(), is_right, "{outcome:?}");
        assert!(is_right || matches!(outcome, Err(OutlineError::StandardDepth { .. })), "{outcome:?}");
    }
}

fn edges_of(model: &Model) -> npr_mesh::edges::Edges {
    find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default())
}

#[test]
fn the_fin_pass_refuses_other_textures_and_matrices() {
    let Some(gpu) = gpu() else { return };
    let pass = FinPass::new(&gpu.device, COLOR_FORMAT, NormalFormat::F32).unwrap();
    let model = embedded::cube();
    let fins = pass.upload(&gpu.device, &printed_fins(&model, &edges_of(&model))).unwrap();
    let draw = |clip_from_world, color: &wgpu::TextureView, depth: &wgpu::TextureView| {
        let view =
            FinView { clip_from_world, eye: DVec3::ZERO, thickness: 0.01, depth: FinDepth::Eye, reversed: false };
        recorded(gpu, |encoder| pass.record(&gpu.device, encoder, &fins, &view, [0.0; 4], color, depth))
    };
    let reversed = proj::perspective(1.0, 1.3, 100.0, 0.1);
    let formats = [COLOR_FORMAT, TextureFormat::Depth32Float];
    for i in 0..2 {
        for (format, size, samples, is_right) in others(formats[i]) {
            let mut views = formats.map(|format| texture(gpu, format, SIZE, 1));
            views[i] = texture(gpu, format, size, samples);
            let outcome = draw(reversed, &views[0], &views[1]);
            assert_eq!(outcome.is_ok(), is_right, "texture {i}: {outcome:?}");
            assert!(is_right || is_refused(&outcome, format, size, samples), "texture {i}: {outcome:?}");
        }
    }
    let views = formats.map(|format| texture(gpu, format, SIZE, 1));
    let outcome = draw(proj::perspective(1.0, 1.3, 0.1, 100.0), &views[0], &views[1]);
    assert!(matches!(outcome, Err(OutlineError::StandardDepth { .. })), "{outcome:?}");
}

#[test]
fn the_hull_pass_refuses_other_textures_widths_and_matrices() {
    let Some(gpu) = gpu() else { return };
    let pass = HullPass::new(&gpu.device, COLOR_FORMAT).unwrap();
    let model = embedded::cube();
    let hull = Hull::new(&model, &edges_of(&model), HullNormals::Welded);
    let hull = HullOnDevice::new(&gpu.device, &hull).unwrap();
    let lines = line_view(SIZE, DMat4::IDENTITY);
    let view = HullView {
        clip_from_world: lines.clip_from_world,
        view_from_normal: DMat3::IDENTITY,
        viewport_px: lines.viewport_px,
        depth_per_px: lines.depth_per_px,
        width_px: 2.0,
        mirrored: false,
    };
    let draw = |view: HullView, color: &wgpu::TextureView, depth: &wgpu::TextureView| {
        let placed = [PlacedHull { hull: &hull, view }];
        recorded(gpu, |encoder| pass.record(&gpu.device, encoder, &placed, [0.0; 4], color, depth))
    };
    let formats = [COLOR_FORMAT, TextureFormat::Depth32Float];
    for i in 0..2 {
        for (format, size, samples, is_right) in others(formats[i]) {
            let mut views = formats.map(|format| texture(gpu, format, SIZE, 1));
            views[i] = texture(gpu, format, size, samples);
            let outcome = draw(view, &views[0], &views[1]);
            assert_eq!(outcome.is_ok(), is_right, "texture {i}: {outcome:?}");
            assert!(is_right || is_refused(&outcome, format, size, samples), "texture {i}: {outcome:?}");
        }
    }
    let [color, depth] = formats.map(|format| texture(gpu, format, SIZE, 1));
    for (width_px, is_right) in [(0.0, true), (1e3, true), (-1.0, false), (f64::NAN, false), (f64::INFINITY, false)] {
        let outcome = draw(HullView { width_px, ..view }, &color, &depth);
        assert_eq!(outcome.is_ok(), is_right, "{outcome:?}");
        assert!(is_right || matches!(outcome, Err(OutlineError::Width { .. })), "{outcome:?}");
    }
    let other = line_view(OTHER_SIZE, DMat4::IDENTITY).viewport_px;
    let outcome = draw(HullView { viewport_px: other, ..view }, &color, &depth);
    assert!(matches!(outcome, Err(OutlineError::ViewSize { .. })), "{outcome:?}");
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    for (clip_from_world, is_right) in [
        (proj::perspective(1.0, 1.3, 100.0, 0.1), true),
        (proj::perspective(1.0, 1.3, 0.1, 100.0), false),
        (proj::orthographic(-1.0, 1.0, -1.0, 1.0, 100.0, 0.1), true),
        (proj::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 100.0), false),
    ] {
        for (mirrored, mirror) in [(false, DMat4::IDENTITY), (true, mirror)] {
            let view = HullView { clip_from_world: clip_from_world * mirror, mirrored, ..view };
            let outcome = draw(view, &color, &depth);
            assert_eq!(outcome.is_ok(), is_right, "{mirrored}: {outcome:?}");
            assert!(is_right || matches!(outcome, Err(OutlineError::StandardDepth { .. })), "{outcome:?}");
        }
    }
}

#[test]
fn the_shadow_pass_refuses_other_textures_matrices_and_areas() {
    let Some(gpu) = gpu() else { return };
    let pass = ShadowPass::new(&gpu.device, STENCIL_FORMAT, false).unwrap();
    let model = embedded::cube();
    let casters = CastersOnDevice::new(&gpu.device, &shadow_casters(&model, &edges_of(&model))).unwrap();
    let right = texture(gpu, STENCIL_FORMAT, SIZE, 1);
    let draw = |clip_from_world, view: &wgpu::TextureView, area| {
        let placed = [PlacedCasters { casters: &casters, world_from_mesh: DAffine3::IDENTITY, light: DVec4::Y }];
        recorded(gpu, |encoder| pass.record(&gpu.device, encoder, &placed, clip_from_world, view, 0, area))
    };
    let infinite = proj::perspective_infinite_reverse(1.0, 1.3, 0.1);
    assert_eq!(draw(infinite, &right, None), Ok(()));
    assert_eq!(draw(infinite, &right, Some([0, 0, 16, 12])), Ok(()));
    for (format, samples) in [(TextureFormat::Depth32Float, 1), (STENCIL_FORMAT, 4)] {
        let outcome = draw(infinite, &texture(gpu, format, SIZE, samples), None);
        assert!(is_refused(&outcome, format, SIZE, samples), "{outcome:?}");
    }
    let area = [0, 1, 16, 12];
    assert_eq!(draw(infinite, &right, Some(area)), Err(OutlineError::Area { area, size_px: SIZE }));
    for standard in [
        proj::perspective_infinite(1.0, 1.3, 0.1),
        proj::perspective(1.0, 1.3, 0.1, 100.0),
        proj::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 100.0),
    ] {
        assert!(matches!(draw(standard, &right, None), Err(OutlineError::StandardDepth { .. })));
    }
    for finite in [proj::perspective(1.0, 1.3, 100.0, 0.1), proj::orthographic(-1.0, 1.0, -1.0, 1.0, 100.0, 0.1)] {
        assert!(matches!(draw(finite, &right, None), Err(OutlineError::FarPlane { .. })));
    }
}

#[test]
fn the_mask_pass_refuses_other_textures_and_areas() {
    let Some(gpu) = gpu() else { return };
    let pass = ShadowMaskPass::new(&gpu.device, STENCIL_FORMAT).unwrap();
    let formats = [STENCIL_FORMAT, MASK_FORMAT];
    let draw = |views: &[wgpu::TextureView; 2], area| {
        recorded(gpu, |encoder| pass.record(encoder, &views[0], &views[1], area))
    };
    let right = || formats.map(|format| texture(gpu, format, SIZE, 1));
    assert_eq!(draw(&right(), None), Ok(()));
    for (i, other) in [(0, TextureFormat::Depth32Float), (1, TextureFormat::R8Unorm)] {
        for (format, size) in [(other, SIZE), (formats[i], OTHER_SIZE)] {
            let mut views = right();
            views[i] = texture(gpu, format, size, 1);
            let outcome = draw(&views, None);
            assert!(is_refused(&outcome, format, size, 1), "texture {i}: {outcome:?}");
        }
    }
    let area = [15, 0, 2, 1];
    assert_eq!(draw(&right(), Some(area)), Err(OutlineError::Area { area, size_px: SIZE }));
}
