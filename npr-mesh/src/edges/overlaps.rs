//! Counts faces that overlap at their common edge once.

use super::around::{Side, Surface};
use super::edge::{Edge, EdgeKind};

/// Two normals in equal winding of faces that may fold back onto each other have a cosine below this.
const FOLDS_BACK: f32 = -0.999;

/// Leaves each edge one face for each half-plane, and orders the faces of non-manifold edges.
///
/// `further_faces` is sorted by edge and remains sorted. Returns pairs of overlapping faces; the first is that with the
/// lower number.
pub(super) fn merge_overlaps(
    edges: &mut [Edge],
    further_faces: &mut Vec<(u32, u32)>,
    surface: &Surface,
    runs_upwards: impl Fn(u32, [u32; 2]) -> bool,
) -> Vec<[u32; 2]> {
    // Two faces that fold back onto each other are a boundary of what they cover. It makes a difference only beside other
    // boundaries.
    let irregular = edges.iter().filter(|edge| edge.kind() != EdgeKind::TwoFace);
    let mut beside = Vec::new();
    let mut is_regular = true;
    for edge in irregular {
        is_regular = false;
        if edge.kind() == EdgeKind::Boundary {
            beside.resize(surface.positions.len().div_ceil(64), 0u64);
            edge.ends.iter().for_each(|&end| beside[end as usize / 64] |= 1 << (end % 64));
        }
    }
    if is_regular {
        return Vec::new();
    }
    let is_beside = |edge: &Edge| {
        let has = |end: u32| beside.get(end as usize / 64).is_some_and(|bits: &u64| bits & 1 << (end % 64) != 0);
        edge.ends.into_iter().any(has)
    };
    let (mut overlaps, mut kept_further) = (Vec::new(), Vec::new());
    let mut further = further_faces.iter().copied().peekable();
    for (number, edge) in (0u32..).zip(edges) {
        if edge.kind() == EdgeKind::TwoFace && !is_beside(edge) {
            continue;
        }
        let [first, second] = edge.faces();
        let ends = [edge.ends[0].min(edge.ends[1]), edge.ends[0].max(edge.ends[1])];
        let first_up = edge.ends == ends;
        let second_up = first_up == edge.wound_oppositely();
        match edge.kind() {
            EdgeKind::Boundary => {}
            EdgeKind::TwoFace => {
                let [n0, n1] = [first, second].map(|face| surface.face_normals[face as usize]);
                let cos = if edge.wound_oppositely() { -n0.dot(n1) } else { n0.dot(n1) };
                if cos < FOLDS_BACK && first != second {
                    let around = surface.edge(ends, &[(first, first_up), (second, second_up)]);
                    *edge = around.edge;
                    overlaps.extend(around.overlaps);
                }
            }
            EdgeKind::NonManifold => {
                let mut sides: Vec<Side> = vec![(first, first_up), (second, second_up)];
                while let Some((_, face)) = further.next_if(|of| of.0 == number) {
                    sides.push((face, runs_upwards(face, ends)));
                }
                let around = surface.edge(ends, &sides);
                *edge = around.edge;
                kept_further.extend(around.further.iter().map(|&face| (number, face)));
                overlaps.extend(around.overlaps);
            }
        }
    }
    *further_faces = kept_further;
    overlaps
}
