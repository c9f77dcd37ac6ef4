//! The silhouette test, by the format of the faces' normals.
//!
//! The error is the share of edges that are misjudged over a sphere of views, against an orientation test in f64. The
//! time is that of testing all edges for one eye, with normals decoded as they are read.

use super::frames::{Work, part_of, rows_of_work};
use super::{Chart, Lab, Row};
use crate::error::HarnessError;
use glam::Vec3;
use npr_mesh::edges::{Edge, Edges, NO_FACE};
use npr_outline::normal_format::{NormalFormat, misclassified_share, misclassified_share_of_planes};
use npr_outline::{ContourOptions, contour_edges};
use std::hint::black_box;

pub(super) const CHART: Chart = Chart {
    name: "silhouettes",
    title: "The silhouette test",
    error: SHARE,
    about: "Share of edges that are misjudged over 32 views, by the format of the faces' normals, and for planes of faces, \
            which lines along edges are found with. Time of a test of all edges on one thread of the CPU.",
    choices: &[
        "npr_outline::NormalFormat::F32",
        "npr_outline::NormalFormat::Snorm16",
        "npr_outline::NormalFormat::Snorm8",
        "npr_outline::NormalFormat::Oct16",
        "npr_outline::NormalFormat::Oct8",
    ],
    run,
};

const SHARE: &str = "share of misjudged edges";
const VIEWS: usize = 32;

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let progress = part_of(lab, number, lab.subjects.len());
        let scene = subject.scene.flattened();
        let mesh = scene.single();
        let (model, edges) = (mesh.model(), mesh.edges());
        let eye = subject.camera.eye;
        let mut tests: Vec<Work<'_>> = Vec::new();
        for format in NormalFormat::ALL {
            let mut stored = Vec::new();
            edges.face_normals.iter().for_each(|&normal| format.encode(normal, &mut stored));
            tests.push(Work {
                name: name(format),
                errors: vec![(SHARE.into(), misclassified_share(model, edges, format, VIEWS))],
                bytes: stored.len() as u64,
                work: Box::new(move || {
                    black_box(silhouettes(&model.positions, edges, format, &stored, eye.as_vec3()));
                }),
            });
        }
        let contours = contour_edges(model, edges, &ContourOptions::default())?;
        let mut lines = Vec::new();
        tests.push(Work {
            name: "planes of faces",
            errors: vec![(SHARE.into(), misclassified_share_of_planes(model, edges, VIEWS)?)],
            bytes: 16 * model.faces.len() as u64,
            work: Box::new(move || {
                contours.scan(eye.extend(1.0), &mut lines);
                black_box(&lines);
            }),
        });
        all.extend(rows_of_work(CHART.name, lab, subject, tests, &progress)?);
    }
    Ok(all)
}

fn name(format: NormalFormat) -> &'static str {
    match format {
        NormalFormat::F32 => "three floats",
        NormalFormat::Snorm16 => "four of 16 bits",
        NormalFormat::Snorm8 => "four of 8 bits",
        NormalFormat::Oct16 => "octahedral, two of 16 bits",
        NormalFormat::Oct8 => "octahedral, two of 8 bits",
    }
}

/// The number of edges whose two faces are seen from different sides, by the test of Card & Mitchell 2002, listing 1.
fn silhouettes(positions: &[Vec3], edges: &Edges, format: NormalFormat, stored: &[u8], eye: Vec3) -> usize {
    let bytes = format.bytes_per_normal();
    let is_silhouette = |edge: &&Edge| {
        let [first, second] = edge.faces();
        if second == NO_FACE {
            return true;
        }
        let view = positions[edge.ends[0] as usize] - eye;
        let side = |face: u32| view.dot(format.decode(&stored[face as usize * bytes..]));
        (side(first) * side(second) < 0.0) != edge.wound_oppositely()
    };
    edges.edges.iter().filter(is_silhouette).count()
}
