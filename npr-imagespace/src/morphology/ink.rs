//! What dilation by a disc and by shifted rows have in common.

/// The least ink of a line pixel.
pub const LINE: u8 = 128;

/// The integer square root: the largest integer with a square of at most `square`.
pub(crate) fn root(square: u32) -> usize {
    let mut root = f64::from(square).sqrt() as u32;
    while root * root > square {
        root -= 1;
    }
    root as usize
}
