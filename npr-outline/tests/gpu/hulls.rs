//! Inverted hulls on a device, compared with the rasteriser.

use crate::device::{COLOR_FORMAT, gpu};
use crate::{edges_of, line_view};
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat3, DMat4, DVec3};
use npr_mesh::embedded;
use npr_outline::hull::{Hull, HullNormals, HullView, hull_triangles};
use npr_outline::hull_pass::{HullOnDevice, HullPass, PlacedHull};
use npr_outline::raster::rasterise;

#[test]
fn hulls_are_those_of_the_rasteriser() {
    let Some(gpu) = gpu() else { return };
    let size = [320, 240];
    let pass = HullPass::new(&gpu.device, COLOR_FORMAT).unwrap();
    let mut slanted = embedded::teapot(6);
    slanted.positions.iter_mut().for_each(|p| p.z += 0.3 * p.x);
    let models =
        [("cube", embedded::cube()), ("slanted teapot", slanted), ("torus", embedded::torus(1.0, 0.4, 32, 16))];
    let cases = models.iter().flat_map(|model| [(model, false), (model, true)]);
    for ((name, model), mirrored) in cases {
        for normals in [HullNormals::Welded, HullNormals::Vertices] {
            let hull = Hull::new(model, &edges_of(model), normals);
            let on_device = HullOnDevice::new(&gpu.device, &hull).unwrap();
            let (low, high) = model.bounds().unwrap();
            let centre = low.midpoint(high).as_dvec3();
            let view_from_world = look_at_mat4(centre + DVec3::new(3.1, 2.3, 4.2), centre, DVec3::Y);
            let mirror = DMat4::from_scale(DVec3::new(if mirrored { -1.0 } else { 1.0 }, 1.0, 1.0));
            let lines = line_view(size, view_from_world);
            let view = HullView {
                clip_from_world: lines.clip_from_world * mirror,
                view_from_normal: DMat3::from_mat4(view_from_world * mirror),
                viewport_px: lines.viewport_px,
                depth_per_px: lines.depth_per_px,
                width_px: 5.0,
                mirrored,
            };
            let picture = gpu.picture(size);
            // A wall that hides some of the hull.
            gpu.fill_depth(&picture, [1e-4, 2e-5, 0.001]);
            let scene = gpu.read_depth(&picture.depth);
            let at = |x: u32, y: u32| (y * size[0] + x) as usize;
            let mut expected: Vec<f64> = scene.iter().map(|&depth| f64::from(depth)).collect();
            let triangles = hull_triangles(&hull, &view);
            let visit = |x: u32, y: u32, depth: f64| expected[at(x, y)] = expected[at(x, y)].max(depth);
            rasterise(&triangles, size, |x, y| f64::from(scene[at(x, y)]), visit);
            let targets = picture.targets();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let placed = [PlacedHull { hull: &on_device, view }];
            let ink = [0.0, 0.0, 0.0, 1.0];
            pass.record(&gpu.device, &mut encoder, &placed, ink, targets.painted, targets.depth).unwrap();
            gpu.queue.submit([encoder.finish()]);
            let (color, depth) = (gpu.read_texture(&picture.color, 4), gpu.read_depth(&picture.depth));
            let (mut inked, mut differ) = (0, 0);
            for pixel in 0..scene.len() {
                let is_hull = expected[pixel] > f64::from(scene[pixel]);
                inked += usize::from(is_hull);
                // Corners are rounded to a fraction of a px before they are drawn.
                let same_depth = (f64::from(depth[pixel]) / expected[pixel] - 1.0).abs() < 1e-3;
                differ += usize::from((color[4 * pixel] == 0) != is_hull || !same_depth);
            }
            let (mut unhidden, mut seen) = (0, vec![false; scene.len()]);
            rasterise(
                &triangles,
                size,
                |_, _| 0.0,
                |x, y, _| unhidden += usize::from(!std::mem::replace(&mut seen[at(x, y)], true)),
            );
            println!("{name}, {normals:?}, mirrored {mirrored}: {inked} of {unhidden} px of ink, {differ} differ");
            assert!(inked > 1000 && inked < unhidden && differ * 100 <= inked, "{name}, {normals:?}, {mirrored}");
        }
    }
}
