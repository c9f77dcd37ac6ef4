//! Primitives of lines (glTF 2.0, 3.7.2.1 "Overview").

use gltf::json::mesh::Mode;

pub(super) fn are_lines(mode: Mode) -> bool {
    matches!(mode, Mode::Lines | Mode::LineLoop | Mode::LineStrip)
}

/// The number of segments of a primitive with so many ends.
pub(super) fn count(mode: Mode, ends: u64) -> u64 {
    match mode {
        Mode::Lines => ends / 2,
        Mode::LineLoop if ends >= 2 => ends,
        _ => ends.saturating_sub(1),
    }
}

/// Whether some ends belong to no segment.
pub(super) fn leaves_a_rest(mode: Mode, ends: u64) -> bool {
    ends < 2 || (mode == Mode::Lines && !ends.is_multiple_of(2))
}

/// The segments of a primitive: those between successive ends, and in a loop that from the last end to the first.
///
/// Without `ends` these are all vertices in their order.
pub(super) fn segments(mode: Mode, vertices: usize, ends: Option<&[u32]>) -> Vec<[u32; 2]> {
    let all: Vec<u32>;
    let ends = match ends {
        Some(ends) => ends,
        None => {
            all = (0..vertices as u32).collect();
            &all
        }
    };
    if mode == Mode::Lines {
        return ends.as_chunks::<2>().0.to_vec();
    }
    let mut segments: Vec<[u32; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    if let (Mode::LineLoop, [first, _, .., last] | [first, last]) = (mode, ends) {
        segments.push([*last, *first]);
    }
    segments
}
