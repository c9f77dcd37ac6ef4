//! The passes on whatever graphics adapter there is, against the CPU twins.
//!
//! `NPR_GPU=required` fails without an adapter, `off` uses none, anything else skips, saying so, where there is none.
#![cfg(feature = "wgpu")]
#![allow(clippy::print_stdout)]

#[path = "gpu/device.rs"]
mod device;
#[path = "gpu/hulls.rs"]
mod hulls;
#[path = "gpu/refusals.rs"]
mod refusals;

use device::{COLOR_FORMAT, Gpu, Picture, gpu};
use glam::dcamera::rh::proj::directx as proj;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec2, DVec3, Vec3, Vec4};
use npr_mesh::edges::{EdgeOptions, Edges, find};
use npr_mesh::{Model, embedded};
use npr_outline::contour::{ContourOptions, contour_edges, outline_facing};
use npr_outline::fin_pass::FinPass;
use npr_outline::fin_printed::{FinDepth, FinView, fin_printed_triangles, printed_fins, rasterise};
use npr_outline::line_pass::{LineGroup, LinePass, LineRecord, LineSource, line_records};
use npr_outline::line_style::LineStyle;
use npr_outline::normal_format::{NormalFormat, fibonacci_sphere};
use npr_outline::segment::{LineView, ScreenSegment, outline_coverage, outline_is_visible, outline_project};
use npr_outline::shadow_mask::{MASK_FORMAT, ShadowMaskPass};
use npr_outline::shadow_pass::SHADOW_WGSL;
use npr_outline::shadow_volume::{outline_in_shadow, outline_light_side};
use std::collections::BTreeSet;

const FOV: f64 = 1.0;
const NEAR: f64 = 0.1;

fn line_view([width, height]: [u32; 2], view_from_world: DMat4) -> LineView {
    let viewport_px = DVec2::new(f64::from(width), f64::from(height));
    LineView {
        clip_from_world: proj::perspective_infinite_reverse(FOV, viewport_px.x / viewport_px.y, NEAR) * view_from_world,
        viewport_px,
        depth_per_px: DVec2::new(2.0 * (0.5 * FOV).tan() / viewport_px.y, 0.0),
    }
}

fn black(width_px: f32) -> LineStyle {
    LineStyle { width_px: [width_px; 5], ink: [0.0, 0.0, 0.0, 1.0] }
}

fn record(ends: [DVec3; 2], normals: [DVec3; 2]) -> LineRecord {
    let [end0, end1] = ends.map(|end| end.as_vec3().to_array());
    let [normal0, normal1] = normals.map(|normal| normal.as_vec3().to_array());
    LineRecord { end0, kind_traits: 0, end1, normal0, normal1 }
}

/// Draws lines and returns their coverage, bytes in rows from the top.
fn draw(
    gpu: &Gpu,
    pass: &LinePass,
    picture: &Picture,
    source: LineSource<'_>,
    width_px: f32,
    view: &LineView,
) -> Vec<u8> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_texture(picture.color.as_image_copy(), picture.inked.as_image_copy(), picture.color.size());
    let eye = view.clip_from_world.inverse() * glam::DVec4::Z;
    let lines = LineGroup { source, view: *view, eye: eye / eye.w };
    pass.record(&gpu.device, &mut encoder, &[lines], &black(width_px), &picture.targets()).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let inked = gpu.read_texture(&picture.inked, 4);
    // Black ink on white.
    inked.chunks(4).map(|pixel| 255 - pixel[0]).collect()
}

fn edges_of(model: &Model) -> Edges {
    find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default())
}

#[test]
fn lines_found_on_the_device_are_those_of_the_scan() {
    let Some(gpu) = gpu() else { return };
    if !gpu.compute {
        return println!("skipped: the device does not run compute shaders");
    }
    let pass = LinePass::new(&gpu.device, COLOR_FORMAT, true).unwrap();
    let size = [160, 120];
    let (mut borderline, mut lines_in_all) = (0, 0);
    let mut turned = embedded::torus(1.0, 0.4, 48, 24);
    turned.faces.iter_mut().step_by(3).for_each(|face| face.swap(0, 1));
    turned.face_polygon.clear();
    let models = [
        (embedded::cube(), None),
        (embedded::torus(1.0, 0.4, 48, 24), None),
        (embedded::teapot(6), None),
        (embedded::cube(), Some(false)),
        (embedded::teapot(6), Some(false)),
        (turned, Some(false)),
    ];
    for (model, double_sided) in models {
        let options = ContourOptions { double_sided, ..ContourOptions::default() };
        let contours = contour_edges(&model, &edges_of(&model), &options).unwrap();
        assert_eq!(contours.single_sided, double_sided.is_some());
        let edges = pass.upload_edges(&gpu.device, &contours, &model.positions).unwrap();
        for direction in fibonacci_sphere(20) {
            let eye = contours.origin.as_dvec3() + 5.0 * direction;
            let view = line_view(size, look_at_mat4(eye, contours.origin.as_dvec3(), DVec3::Y));
            let eye = eye.extend(1.0);
            let picture = gpu.picture(size);
            let mut scanned = Vec::new();
            contours.scan(eye, &mut scanned);
            let from_device = draw(gpu, &pass, &picture, LineSource::OnDevice(&edges), 1.5, &view);
            let count = bytemuck::pod_collect_to_vec::<u8, u32>(&gpu.read_buffer(edges.arguments()));
            assert_eq!((count[0], count[2], count[3]), (4, 0, 0));
            let found = bytemuck::pod_collect_to_vec::<u8, u32>(&gpu.read_buffer(edges.lines()));
            let found = &found[..count[1] as usize];
            let (on_device, on_cpu) =
                (found.iter().copied().collect::<BTreeSet<_>>(), scanned.iter().copied().collect::<BTreeSet<_>>());
            assert_eq!(on_device.len(), found.len(), "a line twice");
            // A device may fuse products and sums, which moves an eye that lies in a face's plane to within rounding.
            let local_eye = contours.local_eye(eye);
            for &line in on_device.symmetric_difference(&on_cpu) {
                let planes = contours.edge_planes(line as usize);
                let margin = [planes.plane0, planes.plane1].map(|plane| outline_facing(plane, local_eye).abs());
                assert!(margin[0].min(margin[1]) < 1e-5, "line {line} is off by {margin:?}");
                borderline += 1;
            }
            lines_in_all += on_cpu.len();
            // And the two sources draw the same picture.
            if on_device == on_cpu {
                let mut records = Vec::new();
                line_records(&contours, &model.positions, &scanned, eye, &mut records);
                let from_records = draw(gpu, &pass, &picture, LineSource::Records(&records), 1.5, &view);
                assert!(from_records.iter().any(|&c| c > 0));
                assert_eq!(from_records, from_device);
            }
        }
    }
    println!("{lines_in_all} lines, {borderline} of them within rounding of another answer");
    assert!(borderline * 1000 <= lines_in_all);
}

/// The mean over columns of a line's width, from the sums of its coverage down each column.
fn width_in_columns(coverage: &[u8], size: [u32; 2], columns: std::ops::Range<u32>, segment: &ScreenSegment) -> f64 {
    let cos = segment.direction().0.x.abs();
    let sum: u64 = (0..size[1])
        .flat_map(|y| columns.clone().map(move |x| (y * size[0] + x) as usize))
        .map(|at| u64::from(coverage[at]))
        .sum();
    sum as f64 / 255.0 / columns.len() as f64 * cos
}

#[test]
fn widths_are_as_asked_at_any_distance() {
    let Some(gpu) = gpu() else { return };
    let pass = LinePass::new(&gpu.device, COLOR_FORMAT, false).unwrap();
    let size = [640, 480];
    let view = line_view(size, DMat4::IDENTITY);
    let picture = gpu.picture(size);
    let widths_px = [1.0f32, 2.0, 4.0, 8.0];
    let mut worst = 0.0f64;
    for distance in [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0] {
        for rise in [0.0, 0.037, 0.1, 0.23] {
            let ends = [DVec3::new(-0.3, 0.013 - rise, -1.0), DVec3::new(0.3, 0.013 + rise, -1.0)];
            let ends = ends.map(|end| distance * end);
            for width_px in widths_px {
                let segment = outline_project(ends, [DVec3::ZERO; 2], f64::from(width_px), &view).unwrap();
                let lines = [record(ends, [DVec3::ZERO; 2])];
                let coverage = draw(gpu, &pass, &picture, LineSource::Records(&lines), width_px, &view);
                let columns = segment.ends_px[0].x as u32 + 12..segment.ends_px[1].x as u32 - 12;
                let width = width_in_columns(&coverage, size, columns, &segment);
                worst = worst.max((width / f64::from(width_px) - 1.0).abs());
                assert!((width / f64::from(width_px) - 1.0).abs() < 0.1, "{width_px} px at {distance}: {width}");
            }
        }
    }
    println!("segments across the view, 0.5 to 50 units away: width off by at most {:.3} %", 100.0 * worst);
    let ends = [DVec3::new(-0.15, -0.05, -0.5), DVec3::new(20.0, 10.0, -50.0)];
    let mut worst_along = 0.0f64;
    for width_px in widths_px {
        let segment = outline_project(ends, [DVec3::ZERO; 2], f64::from(width_px), &view).unwrap();
        let lines = [record(ends, [DVec3::ZERO; 2])];
        let coverage = draw(gpu, &pass, &picture, LineSource::Records(&lines), width_px, &view);
        let (from, to) = (segment.ends_px[0].x as u32 + 12, segment.ends_px[1].x as u32 - 12);
        assert!(to - from > 200);
        for first in (from..to - 20).step_by(20) {
            let width = width_in_columns(&coverage, size, first..first + 20, &segment);
            worst_along = worst_along.max((width / f64::from(width_px) - 1.0).abs());
            assert!((width / f64::from(width_px) - 1.0).abs() < 0.1, "{width_px} px at column {first}: {width}");
        }
    }
    println!("a segment from 0.5 to 50 units away: width off by at most {:.3} % anywhere", 100.0 * worst_along);
}

#[test]
fn a_segment_through_the_near_plane_is_cut_there() {
    let Some(gpu) = gpu() else { return };
    let pass = LinePass::new(&gpu.device, COLOR_FORMAT, false).unwrap();
    let size = [320, 240];
    let view = line_view(size, DMat4::IDENTITY);
    let picture = gpu.picture(size);
    let ends = [DVec3::new(0.05, -0.02, -4.0), DVec3::new(-0.01, 0.03, 3.0)];
    for ends in [ends, [ends[1], ends[0]]] {
        let segment = outline_project(ends, [DVec3::ZERO; 2], 4.0, &view).unwrap();
        let lines = [record(ends, [DVec3::ZERO; 2])];
        let coverage = draw(gpu, &pass, &picture, LineSource::Records(&lines), 4.0, &view);
        let (differ, compared) = compare(&coverage, size, |point| outline_coverage(&segment, point, 4.0), |_| true);
        assert_eq!(differ, 0);
        assert_eq!(compared, size[0] * size[1]);
        assert!(coverage.iter().filter(|&&c| c == 255).count() > 20);
        // The cut end lies within the picture, and nothing is drawn beyond.
        let inside = |p: DVec2| p.x > 10.0 && p.y > 10.0 && p.x < 310.0 && p.y < 230.0;
        assert!(segment.ends_px.iter().all(|&p| inside(p)));
    }
    let behind = [record([DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.5, 0.2, 3.0)], [DVec3::ZERO; 2])];
    assert!(draw(gpu, &pass, &picture, LineSource::Records(&behind), 4.0, &view).iter().all(|&c| c == 0));
    assert!(draw(gpu, &pass, &picture, LineSource::Records(&[]), 4.0, &view).iter().all(|&c| c == 0));
}

/// Pixels whose coverage is more than 1/255 (and rounding) off, and pixels compared.
fn compare(
    coverage: &[u8],
    size: [u32; 2],
    expected: impl Fn(DVec2) -> f64,
    is_compared: impl Fn(DVec2) -> bool,
) -> (u32, u32) {
    let (mut differ, mut compared) = (0, 0);
    for (at, &got) in (0u32..).zip(coverage) {
        let point = DVec2::new(f64::from(at % size[0]), f64::from(at / size[0])) + 0.5;
        if is_compared(point) {
            compared += 1;
            differ += u32::from((f64::from(got) - 255.0 * expected(point)).abs() > 1.0);
        }
    }
    (differ, compared)
}

#[test]
fn overlapping_joints_are_not_counted_twice() {
    let Some(gpu) = gpu() else { return };
    let pass = LinePass::new(&gpu.device, COLOR_FORMAT, false).unwrap();
    let size = [320, 240];
    let view = line_view(size, DMat4::IDENTITY);
    let ends = [DVec3::new(-0.5, -0.31, -1.0), DVec3::new(0.61, 0.4, -1.0)];
    for width_px in [1.0, 3.0, 6.5] {
        let whole_picture = gpu.picture(size);
        let whole =
            draw(gpu, &pass, &whole_picture, LineSource::Records(&[record(ends, [DVec3::ZERO; 2])]), width_px, &view);
        let segment = outline_project(ends, [DVec3::ZERO; 2], f64::from(width_px), &view).unwrap();
        let pieces = segment.direction().1.ceil() as usize;
        assert!(pieces > 200);
        let at = |i: usize| ends[0].lerp(ends[1], i as f64 / pieces as f64);
        let lines: Vec<_> = (0..pieces).map(|i| record([at(i), at(i + 1)], [DVec3::ZERO; 2])).collect();
        let picture = gpu.picture(size);
        let in_pieces = draw(gpu, &pass, &picture, LineSource::Records(&lines), width_px, &view);
        let most = whole.iter().zip(&in_pieces).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(1), "{width_px} px: {most:?}");
        // Black ink on white, each pixel once.
        for (ink, covered) in gpu.read_texture(&picture.inked, 4).chunks(4).zip(&in_pieces) {
            assert!(ink[0].abs_diff(255 - covered) <= 1 && ink[0] == ink[1] && ink[1] == ink[2]);
        }
    }
}

/// Numbers in 0..1 from a seed (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn unit(&mut self) -> DVec3 {
        let v = DVec3::from_array(std::array::from_fn(|_| self.between(-1.0, 1.0)));
        if v.length() > 1.0 || v.length() < 0.1 { self.unit() } else { v.normalize() }
    }
}

#[test]
fn coverage_is_that_of_the_twin() {
    let Some(gpu) = gpu() else { return };
    let pass = LinePass::new(&gpu.device, COLOR_FORMAT, false).unwrap();
    let size = [128, 96];
    let view = line_view(size, DMat4::IDENTITY);
    let picture = gpu.picture(size);
    let mut random = Random(1);
    let (mut touched, mut exempt, mut differing, mut hidden) = (0u32, 0u32, 0u32, 0u32);
    for case in 0..300 {
        let mut point = |far: f64| {
            let z = random.between(0.05, far);
            DVec3::new(random.between(-0.8, 0.8) * z, random.between(-0.6, 0.6) * z, -z)
        };
        let ends = [point(6.0), point(6.0)].map(|end| end.as_vec3().as_dvec3());
        let width_px = random.between(0.4, 7.0) as f32;
        let width = f64::from(width_px);
        // A face of the edge, and a scene that is that face's plane, or lies near it, or anywhere.
        let along = ends[1] - ends[0];
        let normal = along.cross(random.unit()).normalize().as_vec3().as_dvec3();
        let normals = [normal, if case % 2 == 0 { DVec3::ZERO } else { random.unit().as_vec3().as_dvec3() }];
        let Some(segment) = outline_project(ends, normals, width, &view) else { continue };
        gpu.fill_depth(&picture, scene_plane(&segment, &view, case % 3, &mut random));
        let depths = gpu.read_depth(&picture.depth);
        let depth_at = |x: i64, y: i64| {
            let (x, y) = (x.clamp(0, i64::from(size[0]) - 1), y.clamp(0, i64::from(size[1]) - 1));
            f64::from(depths[(y * i64::from(size[0]) + x) as usize])
        };
        let coverage = draw(gpu, &pass, &picture, LineSource::Records(&[record(ends, normals)]), width_px, &view);
        let visible = |segment: &ScreenSegment, point: DVec2| {
            outline_is_visible(segment, segment.nearest(point), &view, false, depth_at)
        };
        let expected = |point| {
            let covered = outline_coverage(&segment, point, width);
            if covered > 0.0 && visible(&segment, point) { covered } else { 0.0 }
        };
        // The same decision for segments a thousandth of a px, of depth or of slope beside it: f32 is better than that.
        let shaken = perturbed(&segment, &view);
        let is_firm = |point: DVec2| {
            let seen = visible(&segment, point);
            shaken.iter().all(|other| visible(other, point) == seen)
        };
        let near = |point: DVec2| outline_coverage(&segment, point, width) > 0.0;
        let (differ, compared) = compare(&coverage, size, expected, |p| !near(p) || is_firm(p));
        let points =
            (0..size[0] * size[1]).map(|at| DVec2::new(f64::from(at % size[0]), f64::from(at / size[0])) + 0.5);
        touched += points.clone().filter(|&p| near(p)).count() as u32;
        hidden += points.filter(|&p| near(p) && !visible(&segment, p)).count() as u32;
        exempt += size[0] * size[1] - compared;
        differing += differ;
        assert_eq!(differ, 0, "case {case}: {segment:?}, {width_px} px");
    }
    println!(
        "{touched} pixels covered, {hidden} of them hidden; {:.2} % exempt, {differing} differ",
        100.0 * f64::from(exempt) / f64::from(touched)
    );
    assert!(touched > 20_000 && hidden * 10 > touched && hidden * 10 < 9 * touched);
    assert!(exempt * 20 < touched);
}

/// Per px and at the upper left: a plane of depths through the segment (0), just before or behind it (1), or across it
/// (2).
fn scene_plane(segment: &ScreenSegment, view: &LineView, kind: usize, random: &mut Random) -> [f32; 3] {
    let (direction, length) = segment.direction();
    let along = (segment.depths[1] - segment.depths[0]) / length.max(1.0);
    let (middle, depth) = segment.at(0.5);
    let per_px = depth * view.depth_per_px.x;
    let across = random.between(-6.0, 6.0) * per_px;
    let gradient = match kind {
        2 => direction * along + DVec2::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0)) * per_px,
        _ => direction * along + direction.perp() * across,
    };
    let offset = if kind == 1 { random.between(-3.0, 6.0) * per_px } else { 0.0 };
    [gradient.x as f32, gradient.y as f32, (depth + offset - gradient.dot(middle)) as f32]
}

/// The segment with small changes in every quantity that its visibility depends on.
fn perturbed(segment: &ScreenSegment, view: &LineView) -> Vec<ScreenSegment> {
    let px = 1e-3;
    let mut all = Vec::new();
    for shift in [DVec2::ZERO, DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
        for sign in [-1.0, 1.0] {
            let mut other = *segment;
            for end in 0..2 {
                other.ends_px[end] += shift * px;
                let per_px = other.depths[end] * view.depth_per_px.x + view.depth_per_px.y;
                other.depths[end] += sign * px * per_px;
                other.slopes[end] = (segment.slopes[end] * (1.0 + sign * px) + sign * px * per_px).max(0.0);
            }
            all.push(other);
        }
    }
    all
}

#[test]
fn printed_fins_are_those_of_the_rasteriser() {
    let Some(gpu) = gpu() else { return };
    let size = [320, 240];
    for (name, model) in [("cube", embedded::cube()), ("teapot", embedded::teapot(6)), ("disc", embedded::ground(2.0))]
    {
        let fins = printed_fins(&model, &edges_of(&model));
        let (low, high) = model.bounds().unwrap();
        let centre = low.midpoint(high);
        let eye = (centre + Vec3::new(3.1, 2.3, 4.2)).as_dvec3();
        let lines = line_view(size, look_at_mat4(eye, centre.as_dvec3(), DVec3::Y));
        for format in NormalFormat::ALL {
            let pass = FinPass::new(&gpu.device, COLOR_FORMAT, format).unwrap();
            let on_device = pass.upload(&gpu.device, &fins).unwrap();
            let quantised = fins.quantised(format);
            for depth in [FinDepth::Eye, FinDepth::Printed { near: NEAR, far: 50.0 }] {
                let thickness = 3.0 * lines.depth_per_px.x;
                let view = FinView { clip_from_world: lines.clip_from_world, eye, thickness, depth, reversed: false };
                let picture = gpu.picture(size);
                // A wall that hides some of the fins.
                gpu.fill_depth(&picture, [1e-4, 2e-5, 0.001]);
                let depths = gpu.read_depth(&picture.depth);
                let at = |x: u32, y: u32| (y * size[0] + x) as usize;
                let mut expected = vec![false; (size[0] * size[1]) as usize];
                let triangles = fin_printed_triangles(&quantised, &view);
                rasterise(&triangles, size, |x, y| f64::from(depths[at(x, y)]), |x, y| expected[at(x, y)] = true);
                let targets = picture.targets();
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let ink = [0.0, 0.0, 0.0, 1.0];
                pass.record(&gpu.device, &mut encoder, &on_device, &view, ink, targets.painted, targets.depth).unwrap();
                gpu.queue.submit([encoder.finish()]);
                let got = gpu.read_texture(&picture.color, 4);
                let mut unhidden = 0;
                rasterise(&triangles, size, |_, _| 0.0, |_, _| unhidden += 1);
                let inked = expected.iter().filter(|&&inked| inked).count();
                let differ = got.chunks(4).zip(&expected).filter(|(px, inked)| (px[0] == 0) != **inked).count();
                // Corners are rounded to a fraction of a px before they are drawn.
                println!("{name}, {format:?}, {depth:?}: {inked} px of ink, {differ} differ");
                assert!(inked > 300 && inked < unhidden && differ * 50 <= inked, "{name}, {format:?}");
            }
        }
    }
}

/// A plane through the light, and planes that pass it by a little on either side; x and w of the plane decide.
#[test]
fn a_face_exactly_edge_on_faces_the_light() {
    let Some(gpu) = gpu() else { return };
    let planes = [[0.0, 0.0], [-0.0, 0.0], [0.5, -0.5], [-0.5, 0.5], [0.5, -0.25], [-0.5, 0.25], [0.5, -0.75]];
    let expected = [1, 1, 1, 1, 1, -1, -1];
    let cases: String = (planes.iter().enumerate())
        .map(|(i, [x, w])| format!("case {i}u: {{ plane.x = {x:?}; plane.w = {w:?}; }}\n"))
        .collect();
    let source = format!(
        "{SHADOW_WGSL}
        @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
            return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        }}
        @fragment fn fs(@builtin(position) p: vec4<f32>) -> @location(0) vec4<u32> {{
            var plane = vec4<f32>(0.0);
            switch u32(p.x) {{
                {cases}
                default: {{}}
            }}
            return vec4<u32>(u32(outline_light_side(plane, vec4<f32>(1.0, 2.0, 3.0, 1.0)) + 1));
        }}"
    );
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let format = wgpu::TextureFormat::R8Uint;
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: planes.len() as u32, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
    let found: Vec<i32> = gpu.read_texture(&texture, 1).into_iter().map(|turn| i32::from(turn) - 1).collect();
    assert_eq!(found, expected);
    let light = Vec4::new(1.0, 2.0, 3.0, 1.0);
    assert_eq!(planes.map(|[x, w]| outline_light_side([x, 0.0, 0.0, w], light)), expected);
}

/// All counts that a stencil can hold, in bands of the picture; nothing outside of the area.
#[test]
fn the_mask_is_what_the_twin_says_of_each_count() {
    let Some(gpu) = gpu() else { return };
    let (size, area) = ([256u32, 4u32], [16, 1, 200, 2]);
    let texture = |format, usage| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
            view_formats: &[],
        })
    };
    let format = wgpu::TextureFormat::Depth24PlusStencil8;
    let stencil = texture(format, wgpu::TextureUsages::empty()).create_view(&Default::default());
    let mask = texture(MASK_FORMAT, wgpu::TextureUsages::COPY_SRC);
    let view = mask.create_view(&Default::default());
    let pass = ShadowMaskPass::new(&gpu.device, format).unwrap();
    let counted = ColumnCounts::new(gpu, format);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    counted.record(&mut encoder, &stencil);
    for (area, is_inside) in [
        (None, &(|_: u32, _: u32| true) as &dyn Fn(u32, u32) -> bool),
        (Some(area), &|x, y| (16..216).contains(&x) && (1..3).contains(&y)),
    ] {
        pass.record(&mut encoder, &stencil, &view, area).unwrap();
        let submitted = std::mem::replace(&mut encoder, gpu.device.create_command_encoder(&Default::default()));
        gpu.queue.submit([submitted.finish()]);
        for (at, found) in (0u32..).zip(gpu.read_texture(&mask, 1)) {
            let (x, y) = (at % size[0], at / size[0]);
            let expected = is_inside(x, y) && outline_in_shadow(x as u8);
            assert_eq!(found, u8::from(expected), "a count of {x} in row {y}, area {area:?}");
        }
    }
}

/// Writes the number of each column to the stencil.
struct ColumnCounts {
    pipeline: wgpu::RenderPipeline,
}

impl ColumnCounts {
    fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let source = "@vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
            return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        }";
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let face = wgpu::StencilFaceState { pass_op: wgpu::StencilOperation::Replace, ..Default::default() };
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff },
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline }
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, stencil: &wgpu::TextureView) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: stencil,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        for count in 0..stencil.texture().width() {
            pass.set_scissor_rect(count, 0, 1, stencil.texture().height());
            pass.set_stencil_reference(count);
            pass.draw(0..3, 0..1);
        }
    }
}
