//! Removes the diagonals that triangulation added.

use super::edge::{Edge, EdgeKind, NO_FACE};
use super::unique::edge_of;

/// Removes pairs of faces of one polygon from each edge; between these the edge is a diagonal. Two adjacent polygons
/// can share a diagonal, which then has four faces and is still not an edge.
///
/// `further_faces` is sorted by edge and remains sorted. Returns the diagonals, each with its two faces.
pub(super) fn drop_diagonals(
    edges: &mut Vec<Edge>,
    further_faces: &mut Vec<(u32, u32)>,
    faces: &[[u32; 3]],
    representative: &[u32],
    face_polygon: &[u32],
) -> Vec<Edge> {
    let polygon = |face: u32| face_polygon[face as usize];
    let mut kept_further = Vec::new();
    let mut further = further_faces.iter().copied().peekable();
    let (mut old_number, mut new_number) = (0, 0);
    let mut diagonals = Vec::new();
    edges.retain_mut(|edge| {
        let number = old_number;
        old_number += 1;
        let [first, second] = edge.faces();
        if edge.kind() != EdgeKind::NonManifold {
            let diagonal = second != NO_FACE && first != second && polygon(first) == polygon(second);
            new_number += u32::from(!diagonal);
            if diagonal {
                diagonals.push(*edge);
            }
            return !diagonal;
        }
        let mut all = vec![first, second];
        all.extend(std::iter::from_fn(|| further.next_if(|f| f.0 == number)).map(|(_, face)| face));
        let (low, high) = (edge.ends[0].min(edge.ends[1]), edge.ends[0].max(edge.ends[1]));
        let edge_between = |met: &[u32]| {
            let run = |&face: &u32| (face, runs_over(faces, representative, face, low, high));
            edge_of(low, high, &met.iter().map(run).collect::<Vec<_>>())
        };
        let (left, pairs) = without_pairs(&all, polygon);
        diagonals.extend(pairs.iter().map(|pair| edge_between(pair)));
        if left.is_empty() {
            return false;
        }
        if !pairs.is_empty() {
            *edge = edge_between(&left);
        }
        kept_further.extend(left.iter().skip(2).map(|&face| (new_number, face)));
        new_number += 1;
        true
    });
    *further_faces = kept_further;
    diagonals
}

/// Whether the face traverses the edge in this direction.
fn runs_over(faces: &[[u32; 3]], representative: &[u32], face: u32, from: u32, to: u32) -> bool {
    let [a, b, c] = faces[face as usize].map(|v| representative[v as usize]);
    [(a, b), (b, c), (c, a)].contains(&(from, to))
}

/// Repeatedly removes pairs of different faces of one polygon from an ascending list of faces. Returns the remaining
/// faces, and the pairs.
fn without_pairs(faces: &[u32], polygon: impl Fn(u32) -> u32) -> (Vec<u32>, Vec<[u32; 2]>) {
    let (mut left, mut pairs) = (Vec::new(), Vec::new());
    // The faces of a polygon are adjacent in the list.
    for of_polygon in faces.chunk_by(|&a, &b| polygon(a) == polygon(b)) {
        // From here on `left` holds a single face of this polygon, possibly repeated.
        let begin = left.len();
        for &face in of_polygon {
            if left.get(begin).is_some_and(|waiting| *waiting != face) {
                pairs.push([left.remove(begin), face]);
            } else {
                left.push(face);
            }
        }
    }
    (left, pairs)
}
