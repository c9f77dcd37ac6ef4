//! The filters over separate textures.

use crate::device::{gpu, view};
use crate::inputs::{LONG, Random, SIZES, direction, px, scene};
use crate::targets::{COMPOSITES, PICTURE, assert_areas, assert_composited, composited, drawn};
use glam::Vec3;
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::depth::DepthPlain;
use npr_imagespace::filter::separate::*;
use npr_imagespace::format::half::{ink_half_decode, ink_half_encode};
use npr_imagespace::pass::InkTarget;
use npr_imagespace::pass::separate::{SeparatePass, SeparateTextures};
use npr_imagespace::picture::Taps;
use wgpu::TextureFormat;

/// Signed normals of any length, linear depth, regions.
type Texels = Vec<SeparateTexel>;

const NOTHING: SeparateTexel = SeparateTexel { normal: Vec3::ZERO, depth: f32::INFINITY, region: 0 };

fn seen(size: [u32; 2]) -> Texels {
    let texel = |surface: Option<crate::inputs::Surface>| {
        surface.map_or(NOTHING, |seen| SeparateTexel { normal: seen.normal, depth: seen.depth, region: seen.region })
    };
    scene(size).into_iter().map(texel).collect()
}

/// Pictures of a size: a scene, the same with normals of any length, surfaces at random among what is no surface, none.
fn pictures(size: [u32; 2], random: &mut Random) -> Vec<Texels> {
    let len = (size[0] * size[1]) as usize;
    let scene = seen(size);
    let long = scene.iter().map(|&texel| {
        let length = random.one_of(&[1e-30, 0.01, 1.0, 7.5, 1e25]);
        SeparateTexel { normal: texel.normal * length, ..texel }
    });
    let long = long.collect();
    let odd =
        [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0, -3.0, 1e-40, 4.0, 4.03, 4.05, 4.1, 80.0];
    let surfaces = (0..len).map(|_| {
        let mut normal = direction(random);
        match random.below(9) {
            0 => normal = Vec3::ZERO,
            1 => normal.x = f32::NAN,
            2 => normal.y = f32::INFINITY,
            3 => normal = Vec3::new(-0.0, 0.0, 1e-39),
            _ => {}
        }
        SeparateTexel { normal, depth: random.one_of(&odd), region: random.one_of(&[0, 1, 2, 65_536, u32::MAX]) }
    });
    vec![scene, long, surfaces.collect(), vec![NOTHING; len]]
}

/// The filter with its thresholds off by what rounding amounts to, towards less ink and towards more.
fn shaken(filter: &SeparateFilter) -> [SeparateFilter; 2] {
    [1.0f32, -1.0].map(|sign| {
        let mut filter = *filter;
        if let Some(normal) = &mut filter.normal {
            normal.cos = (normal.cos - sign * 2e-6).clamp(0.0, 1.0);
        }
        if let Some(depth) = &mut filter.depth {
            // Near 1/f what a depth buffer's number holds of 1/z is the less the farther away.
            let share = if depth.source == DepthSource::Linear { 2e-4 } else { 3e-2 };
            match &mut depth.test {
                SeparateDepthTest::Bend { step } | SeparateDepthTest::Step { step } => *step *= 1.0 + sign * share,
                SeparateDepthTest::Plain { threshold, .. } => *threshold *= 1.0 + sign * 1e-4,
            }
        }
        filter
    })
}

/// Pixels compared, and those among them that rounding may decide.
#[derive(Default)]
struct Count {
    inked: usize,
    pixels: usize,
    borderline: usize,
}

impl Count {
    fn compare(&mut self, got: &[u8], filter: &SeparateFilter, texels: &Texels, size: [u32; 2], what: &str) -> Vec<u8> {
        let [less, more] = shaken(filter).map(|filter| filter_separate(&filter, texels, px(size)).unwrap());
        let expected = filter_separate(filter, texels, px(size)).unwrap();
        let off = u8::from(filter.softness > 0.0);
        for (i, &got) in got.iter().enumerate() {
            let is_right = got >= less[i].saturating_sub(off) && got <= more[i].saturating_add(off);
            assert!(
                is_right,
                "{got} for {} ({}..{}) at {i} of {size:?}, {filter:?}, {what}",
                expected[i], less[i], more[i]
            );
            self.borderline += usize::from(more[i] - less[i] > 2);
            self.inked += usize::from(expected[i] > 0);
        }
        self.pixels += got.len();
        expected
    }

    fn report(&self, name: &str, most_per_mille: usize) {
        let Self { inked, pixels, borderline } = self;
        println!("{name}: {inked} of {pixels} pixels are ink, {borderline} lie at a threshold");
        assert!(borderline * 1000 <= most_per_mille * pixels, "{name}");
        assert!(inked * 20 > *pixels && inked * 20 < 19 * pixels, "{name}");
    }
}

/// Uploaded as signed floats, linear depth and words.
fn textures(gpu: &crate::device::Gpu, size: [u32; 2], texels: &Texels) -> [wgpu::TextureView; 3] {
    let normals: Vec<[f32; 4]> = texels.iter().map(|texel| texel.normal.extend(9.0).to_array()).collect();
    let depths: Vec<f32> = texels.iter().map(|texel| texel.depth).collect();
    let regions: Vec<u32> = texels.iter().map(|texel| texel.region).collect();
    [
        view(&gpu.upload(TextureFormat::Rgba32Float, size, bytemuck::cast_slice(&normals))),
        view(&gpu.upload(TextureFormat::R32Float, size, bytemuck::cast_slice(&depths))),
        view(&gpu.upload(TextureFormat::R32Uint, size, bytemuck::cast_slice(&regions))),
    ]
}

fn all([normal, depth, region]: &[wgpu::TextureView; 3]) -> SeparateTextures<'_> {
    SeparateTextures { normal: Some(normal), depth: Some(depth), region: Some(region) }
}

const NONE: SeparateFilter =
    SeparateFilter { normal: None, depth: None, regions: false, taps: Taps::Diagonal, softness: 0.0 };

fn depth_test(test: SeparateDepthTest) -> SeparateFilter {
    SeparateFilter { depth: Some(SeparateDepth { test, ..Default::default() }), ..NONE }
}

fn filters() -> Vec<SeparateFilter> {
    let parallel =
        SeparateDepth { parallel: true, test: SeparateDepthTest::Bend { step: 0.07 }, ..SeparateDepth::default() };
    vec![
        SeparateFilter::default(),
        SeparateFilter { normal: Some(SeparateNormal::default()), ..NONE },
        SeparateFilter { regions: true, ..NONE },
        depth_test(SeparateDepthTest::default()),
        depth_test(SeparateDepthTest::Step { step: 0.02 }),
        SeparateFilter { depth: Some(parallel), ..NONE },
        SeparateFilter { depth: None, ..SeparateFilter::default() },
    ]
}

#[test]
fn ink_and_pictures_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(21);
    let mut count = Count::default();
    let mut at_reference = 0;
    for taps in [Taps::Diagonal, Taps::Cross, LONG] {
        for softness in [0.0, 0.3] {
            for filter in filters() {
                let filter = SeparateFilter { taps, softness, ..filter };
                let on_ink = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
                let on_picture = SeparatePass::new(&gpu.device, &filter, PICTURE).unwrap();
                for size in SIZES {
                    for texels in pictures(size, &mut random) {
                        if size != SIZES[8] && random.below(3) > 0 {
                            continue;
                        }
                        let views = textures(gpu, size, &texels);
                        let draw = |pass: &SeparatePass, target, composite: &Composite| {
                            drawn(gpu, size, target, composite, None, |encoder, target| {
                                pass.record(&gpu.device, encoder, &filter, &all(&views), target).unwrap();
                            })
                        };
                        let got = draw(&on_ink, InkTarget::Ink, &Composite::default());
                        count.compare(&got, &filter, &texels, size, "floats");
                        // What comes over a picture is what the ink picture holds, whichever way rounding went.
                        let composite = &random.one_of(&COMPOSITES);
                        let over = draw(&on_picture, PICTURE, composite);
                        at_reference += assert_composited(
                            &over,
                            &composited(size, &got, composite),
                            &got,
                            composite,
                            softness > 0.0,
                        );
                    }
                }
            }
        }
    }
    count.report("textures of floats", 2);
    assert!(at_reference * 1000 < count.pixels, "{at_reference}");
}

#[test]
fn plain_tests_of_depth_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(22);
    let mut count = Count::default();
    for form in [DepthPlain::Sum, DepthPlain::SumPrinted, DepthPlain::Any] {
        for softness in [0.0, 0.5] {
            let test = SeparateDepthTest::Plain { form, threshold: 0.02 };
            let filter = SeparateFilter { softness, ..depth_test(test) };
            let pass = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
            for size in SIZES {
                let near: Texels = seen(size)
                    .iter()
                    .map(|texel| SeparateTexel { depth: (texel.depth / 40.0).min(1.0), ..NOTHING })
                    .collect();
                let random: Texels = near
                    .iter()
                    .map(|_| SeparateTexel { depth: random.one_of(&[0.5, 0.505, 0.5099, 0.52, 0.53, 0.0]), ..NOTHING })
                    .collect();
                for texels in [near, random] {
                    let views = textures(gpu, size, &texels);
                    let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                        let depth = SeparateTextures { depth: Some(&views[1]), ..Default::default() };
                        pass.record(&gpu.device, encoder, &filter, &depth, target).unwrap();
                    });
                    count.compare(&got, &filter, &texels, size, "plain");
                }
            }
        }
    }
    // Some of the values lie just there.
    count.report("plain tests", 20);
}

/// The textures that engines have: a depth buffer of each kind of projection, biased bytes, halves, small numbers.
#[test]
fn depth_buffers_and_small_formats_are_read() {
    let Some(gpu) = gpu() else { return };
    let size = [61, 37];
    let (near, far) = (0.5, 45.0);
    let parallel = |source| SeparateDepth { source, parallel: true, test: SeparateDepthTest::Bend { step: 0.1 } };
    let perspective = |source| SeparateDepth { source, ..Default::default() };
    let depths = [
        perspective(DepthSource::perspective(near, far).unwrap()),
        perspective(DepthSource::perspective(near, f32::INFINITY).unwrap()),
        perspective(DepthSource::reversed(near, far).unwrap()),
        perspective(DepthSource::reversed(near, f32::INFINITY).unwrap()),
        parallel(DepthSource::parallel(near, far).unwrap()),
        parallel(DepthSource::parallel_reversed(near, far).unwrap()),
    ];
    let mut count = Count::default();
    for depth in depths {
        let DepthSource::Buffer { scale, bias, clear } = depth.source else { unreachable!("they are buffers") };
        // Nearer than the far end of those that have one.
        let number = |depth_of: f32| {
            let v = if depth.parallel { f64::from(depth_of) } else { 1.0 / f64::from(depth_of) };
            ((v - f64::from(bias)) / f64::from(scale)) as f32
        };
        let scene = seen(size);
        let mut texels: Texels = scene
            .iter()
            .map(|texel| {
                let depth = if texel.region == 0 { clear } else { number(texel.depth) };
                assert!((0.0..=1.0).contains(&depth), "{depth}");
                SeparateTexel { depth, region: texel.region % 200, ..*texel }
            })
            .collect();
        let normals: Vec<[u8; 4]> = texels
            .iter()
            .map(|texel| {
                let biased = (texel.normal * 0.5 + 0.5) * 255.0 + 0.5;
                let [x, y, z] = biased.to_array().map(|c| c as u8);
                if texel.region == 0 { [0; 4] } else { [x, y, z, 255] }
            })
            .collect();
        for (texel, [x, y, z, _]) in texels.iter_mut().zip(&normals) {
            texel.normal = Vec3::new(f32::from(*x), f32::from(*y), f32::from(*z)) / 255.0;
        }
        let numbers: Vec<f32> = texels.iter().map(|texel| texel.depth).collect();
        let regions: Vec<u8> = texels.iter().map(|texel| texel.region as u8).collect();
        let buffer = view(&gpu.depth_buffer(size, &numbers));
        let floats = view(&gpu.upload(TextureFormat::R32Float, size, bytemuck::cast_slice(&numbers)));
        let normals = view(&gpu.upload(TextureFormat::Rgba8Unorm, size, normals.as_flattened()));
        let regions = view(&gpu.upload(TextureFormat::R8Uint, size, &regions));
        for softness in [0.0, 0.375] {
            let normal = Some(SeparateNormal { biased: true, ..Default::default() });
            let filter = SeparateFilter { normal, depth: Some(depth), softness, ..Default::default() };
            let pass = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
            for (what, texture) in [("depth buffer", &buffer), ("float", &floats)] {
                let textures =
                    SeparateTextures { normal: Some(&normals), depth: Some(texture), region: Some(&regions) };
                let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                    pass.record(&gpu.device, encoder, &filter, &textures, target).unwrap();
                });
                count.compare(&got, &filter, &texels, size, what);
            }
            // And what was linear gives the same lines, but where the number holds less of the depth.
            let linear = SeparateDepth { source: DepthSource::Linear, ..depth };
            let by_linear = SeparateFilter { depth: Some(linear), ..filter };
            let with_depths: Texels =
                texels.iter().zip(&scene).map(|(texel, seen)| SeparateTexel { depth: seen.depth, ..*texel }).collect();
            let expected = filter_separate(&by_linear, &with_depths, px(size)).unwrap();
            let by_number = filter_separate(&filter, &texels, px(size)).unwrap();
            let differ = expected.iter().zip(&by_number).filter(|(a, b)| a.abs_diff(**b) > 8).count();
            assert!(differ * 200 < expected.len(), "{depth:?}: {differ}");
        }
    }
    count.report("depth buffers", 20);
}

/// Depths whose differences are exact, so that no rounding decides.
#[test]
fn a_plain_measure_equal_to_its_threshold_is_ink() {
    let Some(gpu) = gpu() else { return };
    let size = [6, 1];
    // In a row each neighbour is two of the four taps; the first and the last are on one side of the pixel.
    for (form, threshold) in [(DepthPlain::Any, 0.25), (DepthPlain::Sum, 0.5), (DepthPlain::SumPrinted, 0.5)] {
        let filter = depth_test(SeparateDepthTest::Plain { form, threshold });
        let pass = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
        for (far, is_reached) in [(0.75f32, true), (0.75f32.next_down(), false), (0.75f32.next_up(), true)] {
            let texels: Texels =
                [0.5, 0.5, 0.5, far, far, far].map(|depth| SeparateTexel { depth, ..NOTHING }).to_vec();
            let views = textures(gpu, size, &texels);
            let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                let depth = SeparateTextures { depth: Some(&views[1]), ..Default::default() };
                pass.record(&gpu.device, encoder, &filter, &depth, target).unwrap();
            });
            assert_eq!(got, filter_separate(&filter, &texels, px(size)).unwrap(), "{form:?} {far}");
            assert_eq!(got.contains(&255), is_reached, "{form:?} {far}");
        }
    }
}

/// Near the far plane surfaces differ from the background by the depth value alone.
#[test]
fn a_cleared_depth_buffer_is_background_even_beside_the_far_end() {
    let Some(gpu) = gpu() else { return };
    let size = [6, 1];
    for (source, d) in [
        (DepthSource::perspective(1.0, 2.0).unwrap(), [0.999, 0.999, 0.999, 1.0, 1.0, 1.0]),
        (DepthSource::reversed(1.0, 2.0).unwrap(), [0.001, 0.001, 0.001, 0.0, 0.0, 0.0]),
        (DepthSource::reversed(1.0, f32::INFINITY).unwrap(), [1e-30, 1e-30, 1e-30, 0.0, 0.0, 0.0]),
    ] {
        let depth = SeparateDepth { source, ..Default::default() };
        let filter = SeparateFilter { depth: Some(depth), ..NONE };
        let pass = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
        let buffer = view(&gpu.depth_buffer(size, &d));
        let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
            let textures = SeparateTextures { depth: Some(&buffer), ..Default::default() };
            pass.record(&gpu.device, encoder, &filter, &textures, target).unwrap();
        });
        assert_eq!(got, [0, 0, 255, 255, 0, 0], "{source:?}");
    }
}

#[test]
fn halves_and_signed_bytes_are_normals_too() {
    let Some(gpu) = gpu() else { return };
    let size = [61, 37];
    let filter = SeparateFilter { normal: Some(SeparateNormal::default()), ..NONE };
    let pass = SeparatePass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
    let mut count = Count::default();
    let scene = seen(size);
    let halves: Vec<[u16; 4]> =
        scene.iter().map(|texel| texel.normal.extend(f32::NAN).to_array().map(ink_half_encode)).collect();
    let by_half = halves.iter().map(|&[x, y, z, _]| [x, y, z].map(ink_half_decode));
    let bytes: Vec<[i8; 4]> =
        scene.iter().map(|texel| texel.normal.extend(0.0).to_array().map(|c| (127.0 * c).round() as i8)).collect();
    let by_byte = bytes.iter().map(|&[x, y, z, _]| [x, y, z].map(|c| f32::from(c) / 127.0));
    let with = |normals: Vec<[f32; 3]>| -> Texels {
        normals.into_iter().map(|normal| SeparateTexel { normal: normal.into(), ..NOTHING }).collect()
    };
    for (format, uploaded, texels) in [
        (TextureFormat::Rgba16Float, bytemuck::cast_slice(&halves), with(by_half.collect())),
        (TextureFormat::Rgba8Snorm, bytemuck::cast_slice(&bytes), with(by_byte.collect())),
    ] {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        gpu.write(&texture, uploaded);
        let normals = view(&texture);
        let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
            let textures = SeparateTextures { normal: Some(&normals), ..Default::default() };
            pass.record(&gpu.device, encoder, &filter, &textures, target).unwrap();
        });
        count.compare(&got, &filter, &texels, size, "small normals");
    }
    count.report("small normals", 5);
}

#[test]
fn what_is_no_surface_is_background_and_not_noise() {
    // The rule itself, by the CPU alone: the GPU is held against it above.
    let background = [f32::NAN, f32::INFINITY, 0.0, -1.0].map(|depth| SeparateTexel { depth, ..NOTHING });
    let ink = |filter: &SeparateFilter, texels: &[SeparateTexel]| {
        filter_separate(filter, texels, px([texels.len() as u32, 1])).unwrap()
    };
    let depth = depth_test(SeparateDepthTest::default());
    assert_eq!(ink(&depth, &background), [0; 4]);
    let surface = SeparateTexel { normal: Vec3::Z, depth: 5.0, region: 1 };
    let filter = SeparateFilter { regions: false, ..SeparateFilter::default() };
    let row = [surface, surface, NOTHING, NOTHING, NOTHING];
    assert_eq!(ink(&filter, &row), [0, 255, 255, 0, 0]);
    // Biased, zeros are none, and the middle of the bytes is as short as no normal that is drawn.
    assert_eq!(ink_separate_normal(Vec3::ZERO, true), glam::DVec3::ZERO);
    assert_eq!(ink_separate_normal(Vec3::splat(0.5), true), glam::DVec3::ZERO);
    assert_eq!(ink_separate_normal(Vec3::new(0.0, 0.0, 1e-30), false), glam::DVec3::Z);
    assert_eq!(ink_separate_normal(Vec3::new(1.0, f32::NAN, 0.0), false), glam::DVec3::ZERO);
}

#[test]
fn lines_are_drawn_within_their_area() {
    let Some(gpu) = gpu() else { return };
    let (size, filter) = ([61, 37], SeparateFilter::default());
    let views = textures(gpu, size, &seen(size));
    for target in [InkTarget::Ink, PICTURE] {
        let pass = SeparatePass::new(&gpu.device, &filter, target).unwrap();
        assert_areas(gpu, size, target, |encoder, target| {
            pass.record(&gpu.device, encoder, &filter, &all(&views), target).unwrap();
        });
    }
}

#[test]
fn what_makes_no_filter_is_refused() {
    let usual = SeparateFilter::default();
    let refused = |filter: SeparateFilter| SeparateUniform::new(&filter).unwrap_err();
    for cos in [-0.1, 1.1, f32::NAN] {
        let normal = Some(SeparateNormal { cos, biased: false });
        assert!(matches!(refused(SeparateFilter { normal, ..usual }), ImageSpaceError::NormalThreshold { .. }));
    }
    for step in [-1.0, f32::NAN, f32::INFINITY] {
        let filter = depth_test(SeparateDepthTest::Bend { step });
        assert!(matches!(refused(filter), ImageSpaceError::DepthStep { .. }));
    }
    assert!(matches!(refused(SeparateFilter { softness: -1.0, ..usual }), ImageSpaceError::Softness { .. }));
    for (scale, bias, clear) in [(0.0, 0.0, 0.0), (f32::NAN, 0.0, 0.0), (1.0, f32::INFINITY, 0.0), (1.0, 0.0, f32::NAN)]
    {
        let depth = SeparateDepth { source: DepthSource::Buffer { scale, bias, clear }, ..Default::default() };
        let error = refused(SeparateFilter { depth: Some(depth), ..usual });
        assert!(matches!(error, ImageSpaceError::DepthSource { .. }));
    }
    for (near, far) in [(0.0, 1.0), (2.0, 1.0), (f32::NAN, 1.0)] {
        assert!(DepthSource::perspective(near, far).is_err() && DepthSource::reversed(near, far).is_err());
    }
    assert!(DepthSource::parallel(1.0, f32::INFINITY).is_err());
    assert!(DepthSource::parallel_reversed(1.0, f32::INFINITY).is_err());
    assert_eq!(
        filter_separate(&usual, &[SeparateTexel::default(); 3], px([2, 2])),
        Err(ImageSpaceError::Length { len: 3, size_px: px([2, 2]) })
    );
}
