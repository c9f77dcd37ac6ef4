//! What passes refuse: targets and textures of another format, size or number of samples, areas beyond the target,
//! filters of another kind. What differs from a refused case in that one thing alone is accepted.

use crate::device::{Gpu, gpu, view};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::fused::FusedFilter;
use npr_imagespace::filter::printed::PrintedFilter;
use npr_imagespace::filter::separate::SeparateFilter;
use npr_imagespace::format::texel::{DepthCode, TexelLayout};
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::morphology::{Kernel, Operation};
use npr_imagespace::pass::composite::CompositePass;
use npr_imagespace::pass::disc::{DiscPass, DiscScratch};
use npr_imagespace::pass::fused::FusedPass;
use npr_imagespace::pass::printed::PrintedPass;
use npr_imagespace::pass::separate::{SeparatePass, SeparateTextures};
use npr_imagespace::pass::step::{PingPong, Step, StepPass};
use npr_imagespace::pass::{InkTarget, PassTarget};
use npr_imagespace::picture::Taps;
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [6, 4];
const OTHER_SIZE: [u32; 2] = [6, 5];
const PICTURE: InkTarget = InkTarget::Picture(TextureFormat::Rgba8Unorm);
const DISC: Disc = Disc { radius_px: 1.0, antialias: true };

/// One recording, of which the target or a texture is given; the outcome of recording it.
type Record<'a> =
    Box<dyn Fn(&wgpu::TextureView, &mut wgpu::CommandEncoder, &PassTarget<'_>) -> Result<(), ImageSpaceError> + 'a>;

/// Each pass that composites over a picture or writes ink: its name, the format that it reads, and how it records.
fn passes(gpu: &Gpu, target: InkTarget) -> Result<Vec<(&'static str, TextureFormat, Record<'_>)>, ImageSpaceError> {
    let device = &gpu.device;
    let mut passes: Vec<(&str, TextureFormat, Record<'_>)> = Vec::new();
    for (layout, format) in
        [(TexelLayout::Bits32, TextureFormat::R32Uint), (TexelLayout::Bits64, TextureFormat::Rg32Uint)]
    {
        let filter = FusedFilter::default();
        let code = DepthCode::perspective(0.5, 60.0, layout).unwrap();
        let pass = FusedPass::new(device, &filter, layout, target)?;
        let record: Record<'_> =
            Box::new(move |texels, encoder, target| pass.record(device, encoder, &filter, &code, texels, target));
        passes.push(("fused", format, record));
    }
    let filter = PrintedFilter::default();
    let pass = PrintedPass::new(device, &filter, target)?;
    let record: Record<'_> =
        Box::new(move |texels, encoder, target| pass.record(device, encoder, &filter, texels, target));
    passes.push(("printed", TextureFormat::Rgba8Unorm, record));
    let pass = StepPass::new(device, Step::Dilate(Kernel::Cross), target)?;
    let record: Record<'_> = Box::new(move |ink, encoder, target| pass.record(device, encoder, ink, target));
    passes.push(("step", TextureFormat::R8Unorm, record));
    let pass = DiscPass::new(device, target)?;
    let scratch = DiscScratch::new(device, SIZE);
    let record: Record<'_> = Box::new(move |ink, encoder, target| {
        pass.record(device, encoder, Operation::Dilate, &DISC, ink, &scratch, target)
    });
    passes.push(("disc", TextureFormat::R8Unorm, record));
    let separate = SeparateFilter { normal: None, depth: None, ..Default::default() };
    let pass = SeparatePass::new(device, &separate, target)?;
    let record: Record<'_> = Box::new(move |region, encoder, target| {
        let textures = SeparateTextures { region: Some(region), ..Default::default() };
        pass.record(device, encoder, &separate, &textures, target)
    });
    passes.push(("separate", TextureFormat::R32Uint, record));
    let pass = CompositePass::new(device, target)?;
    let record: Record<'_> = Box::new(move |ink, encoder, target| pass.record(device, encoder, ink, target));
    passes.push(("composite", TextureFormat::R8Unorm, record));
    Ok(passes)
}

/// A texture with a number of samples a pixel.
fn texture(gpu: &Gpu, format: TextureFormat, [width, height]: [u32; 2], samples: u32) -> wgpu::TextureView {
    view(&gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    }))
}

#[test]
fn pictures_that_lines_cannot_be_composited_over_are_refused() {
    let Some(gpu) = gpu() else { return };
    for format in [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb] {
        let refused = passes(gpu, InkTarget::Picture(format)).err();
        assert_eq!(refused, Some(ImageSpaceError::SrgbPicture { format }));
        assert!(refused.unwrap().to_string().contains(&format!("{format:?}")));
    }
    for format in [TextureFormat::Rgba8Uint, TextureFormat::Depth32Float] {
        let refused = passes(gpu, InkTarget::Picture(format)).err();
        assert_eq!(refused, Some(ImageSpaceError::PictureFormat { format }));
    }
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm, TextureFormat::Rgba16Float] {
        assert!(passes(gpu, InkTarget::Picture(format)).is_ok(), "{format:?}");
    }
}

#[test]
fn targets_of_another_format_size_or_number_of_samples_are_refused() {
    let Some(gpu) = gpu() else { return };
    let composite = Composite::default();
    for target in [InkTarget::Ink, PICTURE] {
        let (format, other) = match target {
            InkTarget::Ink => (TextureFormat::R8Unorm, TextureFormat::Rgba8Unorm),
            InkTarget::Picture(format) => (format, TextureFormat::Bgra8Unorm),
        };
        for (name, from, record) in passes(gpu, target).unwrap() {
            let from = texture(gpu, from, SIZE, 1);
            let outcome = |view: &wgpu::TextureView, area| {
                let mut outcome = Ok(());
                gpu.run(|encoder| outcome = record(&from, encoder, &PassTarget { view, composite: &composite, area }));
                outcome
            };
            let right = texture(gpu, format, SIZE, 1);
            for area in [None, Some([0, 0, 6, 4]), Some([5, 3, 1, 1]), Some([6, 4, 0, 0])] {
                assert_eq!(outcome(&right, area), Ok(()), "{name} {area:?}");
            }
            let refused = outcome(&texture(gpu, other, SIZE, 1), None).unwrap_err();
            assert!(matches!(refused, ImageSpaceError::ViewFormat { format, .. } if format == other), "{name}");
            let refused = outcome(&texture(gpu, format, SIZE, 4), None).unwrap_err();
            assert_eq!(refused, ImageSpaceError::ViewSamples { what: "a target", samples: 4 }, "{name}");
            let refused = outcome(&texture(gpu, format, OTHER_SIZE, 1), None);
            if name == "composite" {
                assert_eq!(refused, Ok(()), "ink of any size is resampled");
            } else {
                assert!(matches!(refused, Err(ImageSpaceError::ViewSize { .. })), "{name}");
            }
            for area in [[0, 0, 7, 4], [0, 4, 1, 1], [u32::MAX, 0, 2, 1]] {
                let refused = outcome(&right, Some(area)).unwrap_err();
                assert_eq!(refused, ImageSpaceError::Area { area, size_px: SIZE.into() }, "{name}");
            }
        }
    }
}

#[test]
fn textures_of_another_format_size_or_number_of_samples_are_refused() {
    let Some(gpu) = gpu() else { return };
    let composite = Composite::default();
    let target = texture(gpu, TextureFormat::Rgba8Unorm, SIZE, 1);
    for (name, format, record) in passes(gpu, PICTURE).unwrap() {
        let outcome = |from: &wgpu::TextureView| {
            let mut outcome = Ok(());
            gpu.run(|encoder| {
                outcome = record(from, encoder, &PassTarget { view: &target, composite: &composite, area: None });
            });
            outcome
        };
        assert_eq!(outcome(&texture(gpu, format, SIZE, 1)), Ok(()), "{name}");
        let other = TextureFormat::Rg16Float;
        let refused = outcome(&texture(gpu, other, SIZE, 1)).unwrap_err();
        assert!(matches!(refused, ImageSpaceError::ViewFormat { format, .. } if format == other), "{name}");
        let refused = outcome(&texture(gpu, format, OTHER_SIZE, 1));
        if name == "composite" {
            assert_eq!(refused, Ok(()), "ink of any size is resampled");
        } else {
            let Err(ImageSpaceError::ViewSize { size_px, needed_px, .. }) = refused else { panic!("{name}") };
            assert_eq!((size_px, needed_px), (OTHER_SIZE.into(), SIZE.into()));
        }
        // Multisampled integer textures are not required of devices.
        if format == TextureFormat::R8Unorm || format == TextureFormat::Rgba8Unorm {
            let refused = outcome(&texture(gpu, format, SIZE, 4)).unwrap_err();
            assert!(matches!(refused, ImageSpaceError::ViewSamples { samples: 4, .. }), "{name}");
        }
    }
}

#[test]
fn a_view_without_srgb_of_an_srgb_texture_is_accepted() {
    let Some(gpu) = gpu() else { return };
    let format = TextureFormat::Rgba8UnormSrgb;
    if !gpu.view_formats {
        return println!("skipped: the adapter has no views of other formats");
    }
    let surface = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[TextureFormat::Rgba8Unorm],
    });
    let unorm = wgpu::TextureViewDescriptor { format: Some(TextureFormat::Rgba8Unorm), ..Default::default() };
    let picture = surface.create_view(&unorm);
    let ink = texture(gpu, TextureFormat::R8Unorm, SIZE, 1);
    let pass = CompositePass::new(&gpu.device, PICTURE).unwrap();
    gpu.run(|encoder| {
        let target = PassTarget { view: &picture, composite: &Composite::default(), area: None };
        pass.record(&gpu.device, encoder, &ink, &target).unwrap();
    });
}

#[test]
fn scratch_textures_and_pairs_of_another_size_are_refused() {
    let Some(gpu) = gpu() else { return };
    let [ink, target] = [(); 2].map(|()| texture(gpu, TextureFormat::R8Unorm, SIZE, 1));
    let target = PassTarget { view: &target, composite: &Composite::default(), area: None };
    let disc = DiscPass::new(&gpu.device, InkTarget::Ink).unwrap();
    for (size, is_right) in [(SIZE, true), (OTHER_SIZE, false)] {
        let scratch = DiscScratch::new(&gpu.device, size);
        let mut outcome = Ok(());
        gpu.run(|encoder| {
            outcome = disc.record(&gpu.device, encoder, Operation::Open, &DISC, &ink, &scratch, &target);
        });
        assert_eq!(outcome.is_ok(), is_right, "{outcome:?}");
    }
    let steps = PingPong::new(&gpu.device, Kernel::Square);
    for (size, format, is_right) in [
        (SIZE, TextureFormat::R8Unorm, true),
        (OTHER_SIZE, TextureFormat::R8Unorm, false),
        (SIZE, TextureFormat::Rgba8Unorm, false),
    ] {
        let other = texture(gpu, format, size, 1);
        let mut outcome = Ok(0);
        gpu.run(|encoder| {
            outcome = steps.record(&gpu.device, encoder, Operation::Dilate, 3, [&ink, &other]);
        });
        assert_eq!(outcome.is_ok(), is_right, "{outcome:?}");
    }
}

#[test]
fn separate_textures_of_a_wrong_kind_and_missing_ones_are_refused() {
    let Some(gpu) = gpu() else { return };
    let target = texture(gpu, TextureFormat::R8Unorm, SIZE, 1);
    let target = PassTarget { view: &target, composite: &Composite::default(), area: None };
    let filter = SeparateFilter::default();
    let pass = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
    let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float, TextureFormat::R32Uint];
    let outcome = |formats: [Option<TextureFormat>; 3]| {
        let views = formats.map(|format| format.map(|format| texture(gpu, format, SIZE, 1)));
        let [normal, depth, region] = views.each_ref().map(Option::as_ref);
        let mut outcome = Ok(());
        gpu.run(|encoder| {
            let textures = SeparateTextures { normal, depth, region };
            outcome = pass.record(&gpu.device, encoder, &filter, &textures, &target);
        });
        outcome
    };
    let right = formats.map(Some);
    assert_eq!(outcome(right), Ok(()));
    for (i, what) in ["normals", "depths", "region numbers"].into_iter().enumerate() {
        let mut missing = right;
        missing[i] = None;
        assert_eq!(outcome(missing), Err(ImageSpaceError::MissingTexture { what }));
    }
    let wrong = [
        (0, TextureFormat::Rg8Unorm),
        (0, TextureFormat::Rgba8UnormSrgb),
        (0, TextureFormat::Rgba8Uint),
        (1, TextureFormat::R32Uint),
        (2, TextureFormat::R8Unorm),
        (2, TextureFormat::R32Sint),
    ];
    for (i, format) in wrong {
        let mut formats = right;
        formats[i] = Some(format);
        let refused = outcome(formats).unwrap_err();
        assert!(matches!(refused, ImageSpaceError::ViewFormat { format: found, .. } if found == format), "{refused}");
    }
}

#[test]
fn filters_of_another_kind_are_refused() {
    let Some(gpu) = gpu() else { return };
    let (device, target) = (&gpu.device, texture(gpu, TextureFormat::R8Unorm, SIZE, 1));
    let target = PassTarget { view: &target, composite: &Composite::default(), area: None };
    let hard = FusedFilter::default();
    let layout = TexelLayout::Bits32;
    let code = DepthCode::perspective(0.5, 60.0, layout).unwrap();
    let fused = FusedPass::new(device, &hard, layout, InkTarget::Ink).unwrap();
    let texels = texture(gpu, TextureFormat::R32Uint, SIZE, 1);
    let printed = PrintedPass::new(device, &PrintedFilter::default(), InkTarget::Ink).unwrap();
    let bytes = texture(gpu, TextureFormat::Rgba8Unorm, SIZE, 1);
    let separate = SeparatePass::new(device, &SeparateFilter::default(), InkTarget::Ink).unwrap();
    let other = Err(ImageSpaceError::OtherFilter);
    gpu.run(|encoder| {
        for filter in [FusedFilter { softness: 0.1, ..hard }, FusedFilter { taps: Taps::Cross, ..hard }] {
            assert_eq!(fused.record(device, encoder, &filter, &code, &texels, &target), other);
        }
        // Thresholds may change.
        let filter = FusedFilter { normal_cos: Some(0.1), ..hard };
        assert_eq!(fused.record(device, encoder, &filter, &code, &texels, &target), Ok(()));
        let inker = PrintedFilter::Inker(Default::default());
        assert_eq!(printed.record(device, encoder, &inker, &bytes, &target), other);
        let filter = SeparateFilter { regions: false, ..Default::default() };
        assert_eq!(separate.record(device, encoder, &filter, &SeparateTextures::default(), &target), other);
    });
}
