//! The sides of every edge brought together.
//!
//! A counting sort by the lower end (Knuth, The Art of Computer Programming 3, section 5.2, algorithm D) puts all sides
//! of all edges that begin upwards at a vertex in one place, usually twice as many as edges, in the order of the faces.
//! A small sort by the upper end brings the sides of each edge together. Nothing can be missed this way, so that
//! surfaces of any topology take the same way; only where an edge has not exactly two sides, or a vertex more than
//! six edges, a slower one is taken for that vertex.
//!
//! Of a face two of three sides have the same lower end, its lowest corner: two places to write to, not three. Nothing
//! depends on an outcome that a processor would have to predict but the number of a vertex's sides: sorting networks
//! bring them in order.
//!
//! What stood here before went through the faces once, with chains of edges that waited for their second side at each
//! vertex, and then had to prove that no edge was begun twice. This takes 0.65 of its time on the bunny, 1.05 to 1.15 on
//! the bunny subdivided twice (whose faces come in strips and whose vertices have six edges upwards or two), and 0.65 on
//! that with its faces shuffled, weld and normals included.

mod networks;

use super::{Edge, FACE, NON_MANIFOLD, WOUND_OPPOSITELY};
use bytemuck::Zeroable;
use networks::sort_few;

/// What one search finds.
pub(super) struct Unique {
    /// By their lower ends, and those of one by their upper ends; an edge's faces come in ascending order.
    pub edges: Vec<Edge>,
    /// (edge, face) for third and further faces, sorted by edge.
    pub further_faces: Vec<(u32, u32)>,
    /// Faces that lie on an earlier one or have two corners at one place; some several times.
    pub redundant: Vec<u32>,
}

/// Finds the unique edges of the faces that are not skipped.
///
/// - `representative`: per vertex the one at its place that stands for it; every face's corners are below its length.
/// - `skipped`: empty, or per face.
///
/// On the way 24 bytes a face and 4 a vertex. Linear in the faces and vertices; n log n in the sides at a vertex that
/// has many.
pub(super) fn unique(faces: &[[u32; 3]], representative: &[u32], skipped: &[bool]) -> Unique {
    let corners = |face: [u32; 3]| face.map(|vertex| representative[vertex as usize]);
    if skipped.is_empty() {
        search(faces, representative.len(), |_| false, corners)
    } else {
        search(faces, representative.len(), |number| skipped[number as usize], corners)
    }
}

/// A face's side of an edge, seen from the edge's lower end: the upper end in the upper half, below it the face and
/// whether it runs upwards. A number, since memory for those comes zeroed without being written.
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

/// `corners`: the welded corners of a face, from its own corners.
fn search(
    faces: &[[u32; 3]],
    vertices: usize,
    skipped: impl Fn(u32) -> bool,
    corners: impl Fn([u32; 3]) -> [u32; 3],
) -> Unique {
    // How many sides have each vertex as their lower end, then where those begin, in the end where those of the next
    // vertex do.
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
    let mut redundant = Vec::new();
    for (number, &face) in (0u32..).zip(faces) {
        if skipped(number) {
            continue;
        }
        let [a, b, c] = corners(face);
        let [low, middle, high] = ascending([a, b, c]);
        if low == middle || middle == high {
            redundant.push(number);
        }
        // Whether it runs from the lowest corner to the middle one and on to the highest.
        let up = u32::from(a < b) + u32::from(b < c) + u32::from(c < a) == 2;
        let start = &mut starts[low as usize];
        let at = *start as usize;
        *start += 2;
        sides[at..at + 2].copy_from_slice(&[side(middle, number, up), side(high, number, !up)]);
        let start = &mut starts[middle as usize];
        sides[*start as usize] = side(high, number, up);
        *start += 1;
    }

    // A closed surface has three edges for two faces.
    let edges = Vec::with_capacity(faces.len() + faces.len() / 2 + faces.len() / 32 + 16);
    let mut found = Unique { edges, further_faces: Vec::new(), redundant };
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

/// Finds the edges of a vertex's sides if each has two of its own, as on any closed surface, and they are few. If not,
/// finds none and says so.
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
    // A side from a vertex to itself, of a face with two corners at one place, comes first.
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
        // Two faces with two edges in common have all corners in common.
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

/// Finds the edges of a vertex's sides, however many each has.
///
/// `corners`: of a face, welded.
fn gather(low: u32, sides: &mut [Side], found: &mut Unique, corners: impl Fn(u32) -> [u32; 3]) {
    sides.sort_unstable();
    let mut met = Vec::new();
    let mut crowd = Vec::new();
    for of_edge in sides.chunk_by(|&a, &b| high_of(a) == high_of(b)) {
        let high = high_of(of_edge[0]);
        // From a vertex to itself.
        if high == low {
            continue;
        }
        met.clear();
        met.extend(of_edge.iter().map(|&side| (face_of(side), is_up(side))));
        let number = found.edges.len() as u32;
        found.edges.push(edge_of(low, high, &met));
        found.further_faces.extend(met.iter().skip(2).map(|&(face, _)| (number, face)));
        if met.len() > 1 {
            // Of each set of corners at an edge, all faces but the first are redundant; and a face that is there twice, which
            // has two corners at one place.
            crowd.clear();
            crowd.extend(met.iter().map(|&(face, _)| (ascending(corners(face)), face)));
            crowd.sort_unstable();
            let twins = crowd.windows(2).filter(|pair| pair[0].0 == pair[1].0);
            found.redundant.extend(twins.map(|pair| pair[1].1));
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
