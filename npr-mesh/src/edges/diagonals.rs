//! Diagonals that triangulation added, taken out again.

use super::unique::edge_of;
use super::{Edge, EdgeKind, NO_FACE};

/// Takes pairs of faces of one polygon out of each edge: between those, the edge is a diagonal. Two polygons side by
/// side can be cut along the same one, which then has four faces and is still no line.
///
/// `further_faces`: sorted by edge, and so left.
pub(super) fn drop_diagonals(
    edges: &mut Vec<Edge>,
    further_faces: &mut Vec<(u32, u32)>,
    faces: &[[u32; 3]],
    representative: &[u32],
    face_polygon: &[u32],
) {
    let polygon = |face: u32| face_polygon[face as usize];
    let mut kept_further = Vec::new();
    let mut further = further_faces.iter().copied().peekable();
    let (mut old_number, mut new_number) = (0, 0);
    edges.retain_mut(|edge| {
        let number = old_number;
        old_number += 1;
        let [first, second] = edge.faces();
        if edge.kind() != EdgeKind::NonManifold {
            let diagonal = second != NO_FACE && first != second && polygon(first) == polygon(second);
            new_number += u32::from(!diagonal);
            return !diagonal;
        }
        let mut left = vec![first, second];
        left.extend(std::iter::from_fn(|| further.next_if(|f| f.0 == number)).map(|(_, face)| face));
        let before = left.len();
        while let Some((a, b)) = pair_of_one_polygon(&left, polygon) {
            left.remove(b);
            left.remove(a);
        }
        if left.is_empty() {
            return false;
        }
        if left.len() < before {
            let (low, high) = (edge.ends[0].min(edge.ends[1]), edge.ends[0].max(edge.ends[1]));
            let met: Vec<(u32, bool)> =
                left.iter().map(|&face| (face, runs_over(faces, representative, face, low, high))).collect();
            *edge = edge_of(low, high, &met);
        }
        kept_further.extend(left.iter().skip(2).map(|&face| (new_number, face)));
        new_number += 1;
        true
    });
    *further_faces = kept_further;
}

/// Whether the face runs over the edge in this direction.
fn runs_over(faces: &[[u32; 3]], representative: &[u32], face: u32, from: u32, to: u32) -> bool {
    let [a, b, c] = faces[face as usize].map(|v| representative[v as usize]);
    [(a, b), (b, c), (c, a)].contains(&(from, to))
}

/// The positions of two different faces of one polygon.
fn pair_of_one_polygon(faces: &[u32], polygon: impl Fn(u32) -> u32) -> Option<(usize, usize)> {
    (0..faces.len()).find_map(|a| {
        let b = (a + 1..faces.len()).find(|&b| faces[a] != faces[b] && polygon(faces[a]) == polygon(faces[b]))?;
        Some((a, b))
    })
}
