//! Shares the sides of faces that meet at T-junctions.
//!
//! At a T-junction a vertex of some faces lies within the side of another, as boolean operations and terrain tiles leave
//! them. No two sides have both ends in common there, so that all are boundaries, within a surface that has no gap.
//!
//! Each boundary edge is split at the ends of other boundary edges that lie on it. Pieces with the same ends are then one
//! edge of all their faces. Adjacent pieces of an edge that have no partner are one piece again, and so is an edge none
//! of whose pieces has one. All ends of pieces are vertices of the mesh, but need not be corners of all faces there.

use super::around::{Side, Surface};
use super::edge::{Edge, EdgeKind};
use super::points::PointTree;
use super::unique::edge_of;

/// The number of pieces, relative to the number of boundary edges, beyond which none is shared. Long boundaries on one
/// line, each over many ends of the others, may have a quadratic number of pieces.
const MOST_PIECES: usize = 16;

/// `edges` is sorted by lower and then by upper vertex, and `further_faces` by edge; both remain sorted. Returns pairs of
/// faces that overlap at a shared edge.
pub(super) fn share(
    edges: &mut Vec<Edge>,
    further_faces: &mut Vec<(u32, u32)>,
    surface: &Surface,
    runs_upwards: impl Fn(u32, [u32; 2]) -> bool,
) -> Vec<[u32; 2]> {
    let Some(mut split) = split_edges(edges, surface) else { return Vec::new() };
    let mut pieces = pieces_of(&split, edges);
    pieces.sort_unstable_by_key(|piece| (piece.ends, piece.side));
    // Whether each edge is replaced, and what replaces them.
    let mut replaced = vec![false; edges.len()];
    let is_split: Vec<u32> = split.iter().map(|chain| chain.edge).collect();
    let mut new: Vec<(Edge, Vec<u32>)> = Vec::new();
    let mut overlaps = Vec::new();
    for same in pieces.chunk_by(|a, b| a.ends == b.ends) {
        let ends = same[0].ends;
        let mut sides: Vec<Side> = same.iter().map(|piece| piece.side).collect();
        let whole = edges.binary_search_by_key(&ends, sorted_ends).ok();
        let whole = whole.filter(|&whole| is_split.binary_search(&(whole as u32)).is_err());
        if let Some(whole) = whole {
            replaced[whole] = true;
            sides.extend(sides_of(edges, further_faces, whole, &runs_upwards));
        }
        if sides.len() == 1 {
            continue;
        }
        sides.sort_unstable();
        let around = surface.edge(ends, &sides);
        overlaps.extend(around.overlaps);
        new.push((around.edge, around.further));
        for piece in same {
            split[piece.chain as usize].shared[piece.number as usize] = true;
        }
    }
    for chain in split.iter().filter(|chain| chain.shared.contains(&true)) {
        replaced[chain.edge as usize] = true;
        let face = edges[chain.edge as usize].faces()[0];
        let mut start = 0;
        for run in chain.shared.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            if !run[0] {
                let [from, to] = [chain.vertices[start], chain.vertices[end]];
                new.push((edge_of(from.min(to), from.max(to), &[(face, from < to)]), Vec::new()));
            }
            start = end;
        }
    }
    if !new.is_empty() {
        replace(edges, further_faces, &replaced, new);
    }
    overlaps
}

/// A boundary edge that is split.
struct Chain {
    edge: u32,
    /// In the direction of the edge.
    vertices: Vec<u32>,
    /// Per piece, whether it has a partner.
    shared: Vec<bool>,
}

/// A piece of a split edge.
struct Piece {
    /// The lower and the upper vertex.
    ends: [u32; 2],
    side: Side,
    chain: u32,
    number: u32,
}

fn sorted_ends(edge: &Edge) -> [u32; 2] {
    [edge.ends[0].min(edge.ends[1]), edge.ends[0].max(edge.ends[1])]
}

/// The boundary edges on which ends of others lie, in ascending order; `None` if there are none, or too many.
fn split_edges(edges: &[Edge], surface: &Surface) -> Option<Vec<Chain>> {
    let boundaries: Vec<(u32, [u32; 2])> = (0u32..)
        .zip(edges)
        .filter(|(_, edge)| edge.kind() == EdgeKind::Boundary)
        .map(|(number, edge)| (number, edge.ends))
        .collect();
    let count = boundaries.len();
    if count < 2 {
        return None;
    }
    let mut ends: Vec<u32> = boundaries.iter().flat_map(|(_, ends)| *ends).collect();
    ends.sort_unstable();
    ends.dedup();
    let tree = PointTree::new(surface.positions, ends);
    let mut chains = Vec::new();
    let mut on_it: Vec<(f64, u32)> = Vec::new();
    let mut pieces = 0;
    for &(number, ends) in &boundaries {
        on_it.clear();
        let fits = tree.on_segment(surface.positions, ends, f64::from(surface.tolerance), |at, vertex| {
            on_it.push((at, vertex));
            on_it.len() <= MOST_PIECES * count
        });
        if on_it.is_empty() {
            continue;
        }
        pieces += on_it.len() + 1;
        if !fits || pieces > MOST_PIECES * count {
            return None;
        }
        on_it.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut vertices = Vec::with_capacity(on_it.len() + 2);
        vertices.push(ends[0]);
        vertices.extend(on_it.iter().map(|(_, vertex)| *vertex));
        vertices.push(ends[1]);
        let shared = vec![false; vertices.len() - 1];
        chains.push(Chain { edge: number, vertices, shared });
    }
    (!chains.is_empty()).then_some(chains)
}

fn pieces_of(chains: &[Chain], edges: &[Edge]) -> Vec<Piece> {
    let of_chain = |(chain, Chain { edge, vertices, .. }): (u32, &Chain)| {
        let face = edges[*edge as usize].faces()[0];
        let piece = move |(number, pair): (u32, &[u32])| {
            let (from, to) = (pair[0], pair[1]);
            Piece { ends: [from.min(to), from.max(to)], side: (face, from < to), chain, number }
        };
        (0u32..).zip(vertices.windows(2)).map(piece).collect::<Vec<_>>()
    };
    (0u32..).zip(chains).flat_map(of_chain).collect()
}

fn sides_of(
    edges: &[Edge],
    further_faces: &[(u32, u32)],
    number: usize,
    runs_upwards: &impl Fn(u32, [u32; 2]) -> bool,
) -> Vec<Side> {
    let edge = &edges[number];
    let ends = sorted_ends(edge);
    let first_up = edge.ends == ends;
    let [first, second] = edge.faces();
    let mut sides = vec![(first, first_up)];
    if edge.kind() != EdgeKind::Boundary {
        sides.push((second, first_up == edge.wound_oppositely()));
    }
    let start = further_faces.partition_point(|further| (further.0 as usize) < number);
    let of_edge = further_faces[start..].iter().take_while(|further| further.0 as usize == number);
    sides.extend(of_edge.map(|&(_, face)| (face, runs_upwards(face, ends))));
    sides
}

/// Takes the replaced edges out and puts the new ones in.
fn replace(
    edges: &mut Vec<Edge>,
    further_faces: &mut Vec<(u32, u32)>,
    replaced: &[bool],
    mut new: Vec<(Edge, Vec<u32>)>,
) {
    new.sort_unstable_by_key(|(edge, _)| (sorted_ends(edge), edge.faces()));
    let mut merged = Vec::with_capacity(edges.len() + new.len());
    let mut merged_further = Vec::with_capacity(further_faces.len());
    let mut new = new.into_iter().peekable();
    let mut further = further_faces.iter().copied().peekable();
    let mut add_new = |until: Option<[u32; 2]>, merged: &mut Vec<Edge>, merged_further: &mut Vec<(u32, u32)>| {
        while let Some((edge, faces)) = new.next_if(|(edge, _)| until.is_none_or(|until| sorted_ends(edge) < until)) {
            merged_further.extend(faces.into_iter().map(|face| (merged.len() as u32, face)));
            merged.push(edge);
        }
    };
    for (number, (edge, &is_replaced)) in (0u32..).zip(edges.iter().zip(replaced)) {
        add_new(Some(sorted_ends(edge)), &mut merged, &mut merged_further);
        while let Some((_, face)) = further.next_if(|further| further.0 == number) {
            if !is_replaced {
                merged_further.push((merged.len() as u32, face));
            }
        }
        if !is_replaced {
            merged.push(*edge);
        }
    }
    add_new(None, &mut merged, &mut merged_further);
    (*edges, *further_faces) = (merged, merged_further);
}
