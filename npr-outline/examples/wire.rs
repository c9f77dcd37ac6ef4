//! Outlines and creases of the teapot as a vector picture, hidden lines included:
//! `cargo run -p npr-outline --example wire -- teapot.svg`.

use glam::dcamera::rh::proj::directx::perspective_infinite_reverse;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DVec2, DVec3};
use npr_mesh::{edges, embedded};
use npr_outline::contour_edges;
use npr_outline::segment::{LineView, outline_project};
use std::error::Error;
use std::fmt::Write;

const SIZE: DVec2 = DVec2::new(800.0, 500.0);
const FOV_Y_RAD: f64 = 0.6;

fn main() -> Result<(), Box<dyn Error>> {
    let model = embedded::teapot(12);
    let edges =
        edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
    let contours = contour_edges(&model, &edges, &Default::default())?;
    let eye = DVec3::new(2.0, 5.0, 10.0);
    let mut lines = Vec::new();
    contours.scan(eye.extend(1.0), &mut lines);

    let view = LineView {
        clip_from_world: perspective_infinite_reverse(FOV_Y_RAD, SIZE.x / SIZE.y, 0.1)
            * look_at_mat4(eye, DVec3::new(0.2, 1.5, 0.0), DVec3::Y),
        viewport_px: SIZE,
        depth_per_px: DVec2::new(2.0 * (0.5 * FOV_Y_RAD).tan() / SIZE.y, 0.0),
    };
    let mut path = String::new();
    for line in lines.into_iter().map(|line| line as usize) {
        let ends = contours.edges[line].ends.map(|end| model.positions[end as usize].as_dvec3());
        let normals = contours.normals(line).map(|normal| normal.as_dvec3());
        // Cut to the near plane and to the picture; none if nothing is left.
        if let Some(segment) = outline_project(ends, normals, 1.0, &view) {
            let [a, b] = segment.ends_px;
            write!(path, "M{:.2} {:.2}L{:.2} {:.2}", a.x, a.y, b.x, b.y)?;
        }
    }
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"><path d=\"{path}\" fill=\"none\" \
         stroke=\"black\" stroke-width=\"1.5\" stroke-linecap=\"round\"/></svg>\n",
        SIZE.x, SIZE.y
    );
    std::fs::write(std::env::args().nth(1).unwrap_or_else(|| "teapot.svg".into()), svg)?;
    Ok(())
}
