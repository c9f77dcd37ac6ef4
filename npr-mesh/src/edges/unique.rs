//! Groups the sides of faces by edge.
//!
//! A counting sort by the lower vertex (Knuth, The Art of Computer Programming 3, section 5.2, algorithm D) collects
//! all sides of the edges whose lower end is a vertex, in the order of the faces; usually there are twice as many
//! sides as edges. A small sort by the upper vertex then groups them by edge. This is correct for any topology. A
//! slower path handles vertices with more than six such edges or with edges that do not have exactly two sides.
//!
//! Two of the three sides of a face have the same lower vertex, the lowest corner, so that each face writes to two
//! memory locations. Sorting networks avoid unpredictable branches except on the number of sides of a vertex.

mod networks;

use super::edge::{Edge, FACE, NON_MANIFOLD, WOUND_OPPOSITELY};
use bytemuck::Zeroable;
use networks::sort_few;

/// The result of the search.
pub(super) struct Unique {
    /// Sorted by lower and then by upper vertex. The faces of an edge are in ascending order.
    pub edges: Vec<Edge>,
    /// (edge, face) for third and further faces, sorted by edge.
    pub further_faces: Vec<(u32, u32)>,
    /// Faces with two corners at one position, ascending.
    pub collapsed: Vec<u32>,
    /// Pairs of a face and the next one with the same three corners; possibly repeated.
    pub twins: Vec<[u32; 2]>,
}

/// Finds the unique edges of the faces that are not skipped.
///
/// - `representative`: per vertex the representative of its position; the corners of all faces are below its length.
/// - `skipped`: empty, or per face.
///
/// It temporarily takes 24 bytes per face and 4 bytes per vertex. The time is linear in faces and vertices, and n log
/// n in the number of sides at a vertex.
pub(super) fn unique(faces: &[[u32; 3]], representative: &[u32], skipped: &[bool]) -> Unique {
    let corners = |face: [u32; 3]| face.map(|vertex| representative[vertex as usize]);
    if skipped.is_empty() {
        search(faces, representative.len(), |_| false, corners)
    } else {
        search(faces, representative.len(), |number| skipped[number as usize], corners)
    }
}

/// A side of a face, seen from the lower vertex of its edge: the upper vertex in the upper 32 bits, the face in the
/// next 31 bits, and in the lowest bit whether the face traverses it upwards. An integer, since large arrays of zeros
/// need no initialisation.
type Side = u64;

fn side(high: u32, face: u32, up: bool) -> Side {
    u64::from(high) << 32 | u64::from(face << 1 | u32::from(up))
}

fn high_of(side: Side) -> u32 {
    (side >> 32) as u32
}

fn face_of(side: Side) -> u32 {
    side as u32 >> 1
}

fn is_up(side: Side) -> bool {
    side & 1 != 0
}

/// `corners` maps the corners of a face to their representatives.
fn search(
    faces: &[[u32; 3]],
    vertices: usize,
    skipped: impl Fn(u32) -> bool,
    corners: impl Fn([u32; 3]) -> [u32; 3],
) -> Unique {
    // First the number of sides with each vertex as their lower end, then the start of its range, and finally the
    // end.
    let mut starts = vec![0u32; vertices];
    for (number, &face) in (0u32..).zip(faces) {
        if !skipped(number) {
            let [low, middle, _] = ascending(corners(face));
            starts[low as usize] += 2;
            starts[middle as usize] += 1;
        }
    }
    let mut total = 0;
    for start in &mut starts {
        total += std::mem::replace(start, total);
    }
    let mut sides = vec![0; total as usize];
    let mut collapsed = Vec::new();
    for (number, &face) in (0u32..).zip(faces) {
        if skipped(number) {
            continue;
        }
        let [a, b, c] = corners(face);
        let [low, middle, high] = ascending([a, b, c]);
        if low == middle || middle == high {
            collapsed.push(number);
        }
        // Whether the face traverses its corners in the order lowest, middle, highest.
        let up = u32::from(a < b) + u32::from(b < c) + u32::from(c < a) == 2;
        let start = &mut starts[low as usize];
        let at = *start as usize;
        *start += 2;
        sides[at..at + 2].copy_from_slice(&[side(middle, number, up), side(high, number, !up)]);
        let start = &mut starts[middle as usize];
        sides[*start as usize] = side(high, number, up);
        *start += 1;
    }

    // A closed surface has three edges per two faces.
    let edges = Vec::with_capacity(faces.len() + faces.len() / 2 + faces.len() / 32 + 16);
    let mut found = Unique { edges, further_faces: Vec::new(), collapsed, twins: Vec::new() };
    let mut begin = 0;
    for (low, end) in (0u32..).zip(starts) {
        let sides = &mut sides[begin..end as usize];
        begin = end as usize;
        if !pair(low, sides, &mut found) {
            gather(low, sides, &mut found, |face| corners(faces[face as usize]));
        }
    }
    found
}

fn ascending([a, b, c]: [u32; 3]) -> [u32; 3] {
    let (ab, ba) = (a.min(b), a.max(b));
    let (low, rest) = (ab.min(c), ab.max(c));
    [low, ba.min(rest), ba.max(rest)]
}

/// Finds the edges of a vertex if there are few and each has exactly two sides, as on closed surfaces. Otherwise adds
/// nothing and returns `false`.
#[inline(always)]
fn pair(low: u32, sides: &[Side], found: &mut Unique) -> bool {
    match sides.len() {
        0 => true,
        2 => pair_few::<2, 1>(low, sides, found),
        4 => pair_few::<4, 2>(low, sides, found),
        6 => pair_few::<6, 3>(low, sides, found),
        8 => pair_few::<8, 4>(low, sides, found),
        10 => pair_few::<10, 5>(low, sides, found),
        12 => pair_few::<12, 6>(low, sides, found),
        _ => false,
    }
}

#[inline(always)]
fn pair_few<const SIDES: usize, const EDGES: usize>(low: u32, sides: &[Side], found: &mut Unique) -> bool {
    let Ok(sides) = <[Side; SIDES]>::try_from(sides) else { return false };
    let sides = sort_few(sides);
    // A side from a vertex to itself, of a face with two corners at one position, is sorted first.
    let mut before = low;
    let mut fits = true;
    let mut twins = false;
    let mut edges = [Edge::zeroed(); EDGES];
    for i in 0..EDGES {
        let [first, second] = [sides[2 * i], sides[2 * i + 1]];
        let high = high_of(first);
        fits &= (high == high_of(second)) & (high != before);
        before = high;
        let ends = if is_up(first) { [low, high] } else { [high, low] };
        let oppositely = if (first ^ second) & 1 == 0 { WOUND_OPPOSITELY } else { 0 };
        let packed = [face_of(first), face_of(second) | oppositely];
        edges[i] = Edge { ends, packed };
        // Two faces with two common edges have all corners in common.
        for other in &edges[..i] {
            twins |= (other.packed[0] == packed[0]) & ((other.packed[1] ^ packed[1]) & FACE == 0);
        }
    }
    if !fits | twins {
        return false;
    }
    found.edges.extend_from_slice(&edges);
    true
}

/// Finds the edges of a vertex for any number of sides.
///
/// `corners` returns the representatives of a face's corners.
fn gather(low: u32, sides: &mut [Side], found: &mut Unique, corners: impl Fn(u32) -> [u32; 3]) {
    sides.sort_unstable();
    let mut met = Vec::new();
    let mut duplicates = Vec::new();
    for of_edge in sides.chunk_by(|&a, &b| high_of(a) == high_of(b)) {
        let high = high_of(of_edge[0]);
        // A side from the vertex to itself.
        if high == low {
            continue;
        }
        met.clear();
        met.extend(of_edge.iter().map(|&side| (face_of(side), is_up(side))));
        let number = found.edges.len() as u32;
        found.edges.push(edge_of(low, high, &met));
        found.further_faces.extend(met.iter().skip(2).map(|&(face, _)| (number, face)));
        if met.len() > 1 {
            // A face that occurs twice, because two of its corners are at one position, is no twin of itself.
            duplicates.clear();
            duplicates.extend(met.iter().map(|&(face, _)| (ascending(corners(face)), face)));
            duplicates.sort_unstable();
            let twins = duplicates.windows(2).filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1);
            found.twins.extend(twins.map(|pair| [pair[0].1, pair[1].1]));
        }
    }
}

/// An edge from all its faces in ascending order, each with whether it runs upwards.
pub(super) fn edge_of(low: u32, high: u32, met: &[(u32, bool)]) -> Edge {
    let (first, first_up) = met[0];
    let (mut packed0, mut packed1) = (first, FACE);
    if let Some(&(second, second_up)) = met.get(1) {
        packed1 = second | if first_up == second_up { WOUND_OPPOSITELY } else { 0 };
    }
    if met.len() > 2 {
        packed0 |= NON_MANIFOLD;
    }
    Edge { ends: if first_up { [low, high] } else { [high, low] }, packed: [packed0, packed1] }
}
