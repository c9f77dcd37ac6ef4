//! Edges that were begun twice, and sides that were set aside: turned faces, non-manifold edges, hubs.

use super::{Side, Unique};
use crate::edges::{Edge, FACE, NO_FACE, NON_MANIFOLD, WOUND_OPPOSITELY};

/// Makes one edge of each that was begun twice, and edges of the sides set aside.
///
/// - `corners`: of a face, welded.
///
/// Linear in the edges, n log n in those of the vertices that come under suspicion.
pub(super) fn settle(found: &mut Unique, vertices: usize, aside: Vec<Side>, corners: impl Fn(u32) -> [u32; 3]) {
    let mut suspects = suspects(&found.edges, vertices);
    suspects.extend(aside.iter().map(|side| side.low));
    if suspects.is_empty() {
        return;
    }
    let mut is_suspect = vec![false; vertices];
    for low in suspects {
        is_suspect[low as usize] = true;
    }
    // (side, the edge that has it so far or `NO_EDGE`)
    const NO_EDGE: u32 = u32::MAX;
    let mut sides: Vec<(Side, u32)> = aside.into_iter().map(|side| (side, NO_EDGE)).collect();
    for (number, edge) in (0u32..).zip(&found.edges) {
        let [from, to] = edge.ends;
        let (low, high) = (from.min(to), from.max(to));
        if is_suspect[low as usize] {
            let [first, second] = edge.faces();
            sides.push((Side { low, high, face: first, up: from < to }, number));
            if second != NO_FACE {
                sides.push((Side { low, high, face: second, up: from > to }, number));
            }
        }
    }
    sides.sort_unstable();
    let mut gaps = Vec::new();
    let mut crowd = Vec::new();
    for group in sides.chunk_by(|(a, _), (b, _)| (a.low, a.high) == (b.low, b.high)) {
        let mut numbers: Vec<u32> = group.iter().map(|&(_, edge)| edge).filter(|&edge| edge != NO_EDGE).collect();
        numbers.sort_unstable();
        numbers.dedup();
        if numbers.len() == 1 && group.iter().all(|&(_, edge)| edge != NO_EDGE) {
            continue;
        }
        let Side { low, high, .. } = group[0].0;
        let met: Vec<(u32, bool)> = group.iter().map(|(side, _)| (side.face, side.up)).collect();
        let edge = edge_of(low, high, &met);
        let number = match numbers.first() {
            Some(&number) => {
                found.edges[number as usize] = edge;
                gaps.extend(&numbers[1..]);
                number
            }
            None => {
                found.edges.push(edge);
                found.edges.len() as u32 - 1
            }
        };
        found.further_faces.extend(met.iter().skip(2).map(|&(face, _)| (number, face)));
        if met.len() > 1 {
            crowd.extend(met.iter().map(|&(face, _)| {
                let mut corners = corners(face);
                corners.sort_unstable();
                (number, corners, face)
            }));
        }
    }
    // Of each set of corners at an edge, all faces but the first are redundant.
    crowd.sort_unstable();
    crowd.dedup();
    let twins = crowd.windows(2).filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 == pair[1].1);
    found.redundant.extend(twins.map(|pair| pair[1].2));
    gaps.sort_unstable();
    close_gaps(found, &gaps);
    found.further_faces.sort_unstable();
}

/// An edge from all its faces in ascending order, each with whether it runs upwards.
pub(in crate::edges) fn edge_of(low: u32, high: u32, met: &[(u32, bool)]) -> Edge {
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

/// The lower ends of all edges that were begun more than once, and a few more.
///
/// For each vertex a word holds the fingerprints, 8 bits each, of the last eight upper ends. Where one comes that is
/// there already, or one falls out, the vertex is a suspect. By chance a fingerprint is there already once in some
/// hundred edges.
fn suspects(edges: &[Edge], vertices: usize) -> Vec<u32> {
    const EACH_BYTE: u64 = 0x0101_0101_0101_0101;
    let mut fingerprints = vec![0u64; vertices];
    let mut suspects = Vec::new();
    for edge in edges {
        let [from, to] = edge.ends;
        let (low, high) = (from.min(to), from.max(to));
        let known = &mut fingerprints[low as usize];
        let fingerprint = u64::from(high.wrapping_mul(0x9e37_79b1) >> 24).max(1);
        let differences = *known ^ (fingerprint * EACH_BYTE);
        // The lowest byte of zero sets its upper bit (S. E. Anderson's "Bit Twiddling Hacks").
        let has_equal = differences.wrapping_sub(EACH_BYTE) & !differences & (EACH_BYTE << 7);
        if has_equal | (*known >> 56) != 0 {
            suspects.push(low);
        }
        *known = *known << 8 | fingerprint;
    }
    suspects
}

/// Takes the edges with these numbers, ascending, out.
fn close_gaps(found: &mut Unique, gaps: &[u32]) {
    if gaps.is_empty() {
        return;
    }
    for (edge, _) in &mut found.further_faces {
        *edge -= gaps.partition_point(|gap| gap < edge) as u32;
    }
    let mut number = 0;
    let mut gaps = gaps.iter().peekable();
    found.edges.retain(|_| {
        let is_gap = gaps.next_if(|&&gap| gap == number).is_some();
        number += 1;
        !is_gap
    });
}
