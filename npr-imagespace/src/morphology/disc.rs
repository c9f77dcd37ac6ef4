//! Dilation by a Euclidean disc of any radius, exact, at a cost that does not grow with the radius.
//!
//! Line pixels are those with ink 128 and more. d is the distance of a pixel's centre from the nearest line pixel's.
//!
//! - Hard: full ink where d ≤ r.
//! - Antialiased: clamp(r + 1 − d, 0, 1). A line pixel is itself a pixel wide, so that a line of one pixel becomes 2
//!   r + 1 wide, a radius of 0 changes nothing, and full ink is that of the hard disc.
//!
//! # Algorithm
//!
//! With g the distance to the nearest line pixel of the same row, the disc's part in a column is an interval of
//! ⌊√(r² − g²)⌋ to either side, the vertical *reach* of the pixel. Along a row, the reaches between two
//! line pixels are the same numbers from a table forwards and backwards, so a row is made by copying. Two sweeps over
//! the rows, down and up, then carry each reach on, less 1 per row: max-plus with the weight −|y|, which two
//! sweeps compute exactly, as they do any L1 distance, with comparisons of bytes alone. A pixel is covered if the
//! carried reach there is not used up.
//!
//! Antialiased, two such pairs of sweeps, for r and for r + 1, single out the pixels between the two, and for these
//! alone the distance is searched for along their column, 2 r + 3 rows, 16 columns side by side. Since what discs of
//! radius r make up has about 2 / r of its area within a pixel of its border, this too costs about the same at any
//! radius.
//!
//! Rows full of borders, which noise has, are not made by copying but pixel by pixel.
//!
//! Up to a whole radius of 5 px the hard disc is the maximum of shifted rows, which is cheaper still.
//!
//! Distances by two passes over the axes: Saito & Toriwaki 1994, "New algorithms for Euclidean distance transformation
//! of an n-dimensional digitized picture with applications".

use super::ink::root;

pub use super::ink::LINE;
use crate::ImageSpaceError;
use crate::morphology::direct;
use crate::picture::checked_len;
use glam::UVec2;

/// The number of line pixels in a texel of bits, 4 bytes, when a device dilates.
pub const WORD_PX: u32 = 32;
/// The number of pixels in a texel of steps to the nearest line pixel, 16 bytes, when a device dilates. There are two
/// textures of them.
pub const SITE_PX: u32 = 4;
/// The largest integer part of a radius for which shifted rows are used.
const DIRECT_MOST: usize = 5;
/// The largest radius.
pub const RADIUS_MAX_PX: f32 = 32766.0;

/// A disc-shaped structuring element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// The radius, px, 0..=[`RADIUS_MAX_PX`].
    pub radius_px: f32,
    /// Whether the border is antialiased, with a ramp one pixel wide.
    pub antialias: bool,
}

/// Buffers of a dilation, to be kept between calls, since the first access to new memory costs more than the
/// computation.
#[derive(Clone, Debug, Default)]
pub struct DiscBuffers {
    bytes: Planes<u8>,
    words: Planes<u16>,
    rows: Vec<u8>,
    inverse: Vec<u8>,
}

#[derive(Clone, Debug, Default)]
struct Planes<T> {
    inner: Vec<T>,
    outer: Vec<T>,
    /// Distance along the row.
    along: Vec<T>,
    /// Distances of one row.
    far: Vec<u32>,
}

/// The squared radius, rounded down: d² ≤ r² of whole d² is d² ≤ this.
fn square_within(radius_px: f32) -> u32 {
    f64::from(radius_px).powi(2).floor() as u32
}

/// The integers that reaches and distances are stored in.
trait Lane: Copy + Ord + Default {
    const MOST: usize;
    fn from_index(value: usize) -> Self;
    fn less_one(self) -> Self;
    /// For the pixels `from..from + best.len()` of row `y` the smallest squared distance that their column knows of
    /// within `most` rows.
    fn nearest(along: &[Self], width: usize, y: usize, most: usize, from: usize, best: &mut [i32]);
}

/// Columns that are searched side by side.
const SIDE_BY_SIDE: usize = 16;

impl Lane for u8 {
    const MOST: usize = 255;
    fn from_index(value: usize) -> Self {
        value as u8
    }
    fn less_one(self) -> Self {
        self.saturating_sub(1)
    }
    fn nearest(along: &[Self], width: usize, y: usize, most: usize, from: usize, best: &mut [i32]) {
        // Distances are capped at one more than `most`, and the two squares of 126 and 127 sum to less than 2^15.
        if best.len() < SIDE_BY_SIDE || most > 126 {
            return nearest_in_words(along, width, y, most, from, best);
        }
        let mut nearest = [i16::MAX; SIDE_BY_SIDE];
        for row in rows(along.len() / width, y, most) {
            let away = y.abs_diff(row) as i16;
            let squared = away * away;
            let chunk = &along[row * width + from..][..SIDE_BY_SIDE];
            for (nearest, &g) in nearest.iter_mut().zip(chunk) {
                let g = i16::from(g);
                *nearest = (*nearest).min(g * g + squared);
            }
        }
        best.iter_mut().zip(nearest).for_each(|(best, nearest)| *best = i32::from(nearest));
    }
}

impl Lane for u16 {
    const MOST: usize = 65535;
    fn from_index(value: usize) -> Self {
        value as u16
    }
    fn less_one(self) -> Self {
        self.saturating_sub(1)
    }
    fn nearest(along: &[Self], width: usize, y: usize, most: usize, from: usize, best: &mut [i32]) {
        nearest_in_words(along, width, y, most, from, best);
    }
}

/// The rows within `most` of row `y`.
fn rows(height: usize, y: usize, most: usize) -> std::ops::Range<usize> {
    y.saturating_sub(most)..height.min(y + most + 1)
}

fn nearest_in_words<T: Copy + Into<i32>>(
    along: &[T],
    width: usize,
    y: usize,
    most: usize,
    from: usize,
    best: &mut [i32],
) {
    best.fill(i32::MAX);
    for row in rows(along.len() / width, y, most) {
        let away = y.abs_diff(row) as i32;
        let squared = away * away;
        let chunk = &along[row * width + from..][..best.len()];
        for (best, &g) in best.iter_mut().zip(chunk) {
            let g: i32 = g.into();
            *best = (*best).min(g * g + squared);
        }
    }
}

/// A value for each distance along a row, from 0 on, and the same reversed without the first.
struct Ramp<T> {
    up: Vec<T>,
    down: Vec<T>,
    far: T,
}

impl<T: Lane> Ramp<T> {
    fn new(up: Vec<T>, far: T) -> Self {
        let down = up[1..].iter().rev().copied().collect();
        Self { up, down, far }
    }

    /// One more than the reach; 0 where there is none.
    fn of_reaches(square: u32) -> Self {
        let most = root(square);
        let reach = |g: usize| T::from_index(root(square - (g * g) as u32) + 1);
        Self::new((0..=most).map(reach).collect(), T::default())
    }

    fn of_distances(most: usize) -> Self {
        Self::new((0..=most).map(T::from_index).collect(), T::from_index(most + 1))
    }

    /// Pixels `from..to` of a row: a line pixel precedes them if `after` and follows them if `before`.
    fn fill(&self, row: &mut [T], after: bool, before: bool) {
        let most = self.down.len();
        let left = match (after, before) {
            (true, true) => row.len().div_ceil(2),
            (true, false) => row.len(),
            _ => 0,
        };
        let (left, right) = row.split_at_mut(left);
        let near = left.len().min(most);
        left[..near].copy_from_slice(&self.up[1..=near]);
        left[near..].fill(self.far);
        let near = if before { right.len().min(most) } else { 0 };
        let (gap, ramp) = right.split_at_mut(right.len() - near);
        gap.fill(self.far);
        ramp.copy_from_slice(&self.down[most - near..]);
    }
}

/// Whether ink changes more often than every 16 pixels, estimated from a quarter of the row.
#[inline(never)]
fn is_busy(ink: &[u8]) -> bool {
    // Counted in bytes: wider counters would lose the gain of vectorisation.
    let changes = |(a, b): (&[u8], &[u8])| a.iter().zip(b).map(|(a, b)| (a ^ b) >> 7).sum::<u8>();
    let pairs = ink.chunks(128).zip(ink.get(1..).unwrap_or_default().chunks(128)).step_by(4);
    let (borders, looked_at) =
        pairs.fold((0, 0), |(borders, len), pair| (borders + usize::from(changes(pair)), len + pair.0.len()));
    16 * borders > looked_at
}

/// Distances along a row, pixel by pixel and without a branch: for rows full of borders.
fn distances(ink: &[u8], far: &mut Vec<u32>) {
    far.clear();
    let mut away = 1 << 30;
    far.extend(ink.iter().map(|&ink| {
        away = if ink >= LINE { 0 } else { away + 1 };
        away
    }));
    away = 1 << 30;
    for far in far.iter_mut().rev() {
        away = (away + 1).min(*far);
        *far = away;
    }
}

/// Fills rows with the values of several ramps at a row's distances.
fn fill_rows<T: Lane, const N: usize>(ink: &[u8], mut rows: [(&Ramp<T>, &mut [T]); N], far: &mut Vec<u32>) {
    let is_line = |&ink: &u8| ink >= LINE;
    if is_busy(ink) {
        distances(ink, far);
        for (ramp, row) in &mut rows {
            for (worth, &far) in row.iter_mut().zip(&*far) {
                *worth = ramp.up.get(far as usize).copied().unwrap_or(ramp.far);
            }
        }
        return;
    }
    let mut at = 0;
    while at < ink.len() {
        let from = at;
        // 64 bytes at a time where there is nothing but paper.
        while ink.get(at..at + 64).is_some_and(|chunk| chunk.iter().fold(0, |all, &ink| all | ink) < LINE) {
            at += 64;
        }
        at += ink[at..].iter().position(is_line).unwrap_or(ink.len() - at);
        for (ramp, row) in &mut rows {
            ramp.fill(&mut row[from..at], from > 0, at < ink.len());
        }
        let from = at;
        at += ink[at..].iter().position(|ink| !is_line(ink)).unwrap_or(ink.len() - at);
        for (ramp, row) in &mut rows {
            row[from..at].fill(ramp.up[0]);
        }
    }
}

/// Carries reaches from one row to the next.
#[inline(never)]
fn carry<T: Lane>(from: &[T], to: &mut [T]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = (*to).max(from.less_one());
    }
}

fn row_pair<T>(plane: &mut [T], width: usize, from: usize, to: usize) -> (&[T], &mut [T]) {
    let (low, high) = plane.split_at_mut(from.max(to) * width);
    if from < to { (&low[from * width..], &mut high[..width]) } else { (&high[..width], &mut low[to * width..]) }
}

fn sweep_down_row<T: Lane>(plane: &mut [T], width: usize, y: usize) {
    if y > 0 {
        let (from, to) = row_pair(plane, width, y - 1, y);
        carry(from, to);
    }
}

fn sweep_up_row<T: Lane>(plane: &mut [T], width: usize, y: usize) {
    if (y + 1) * width < plane.len() {
        let (from, to) = row_pair(plane, width, y + 1, y);
        carry(from, to);
    }
}

fn hard<T: Lane>(ink: &[u8], width: usize, square: u32, planes: &mut Planes<T>, out: &mut [u8]) {
    let ramp = Ramp::of_reaches(square);
    planes.inner.resize(ink.len(), T::default());
    for (y, row) in ink.chunks_exact(width).enumerate() {
        fill_rows(row, [(&ramp, &mut planes.inner[y * width..][..width])], &mut planes.far);
        sweep_down_row(&mut planes.inner, width, y);
    }
    for (y, row) in out.chunks_exact_mut(width).enumerate().rev() {
        sweep_up_row(&mut planes.inner, width, y);
        for (out, &reach) in row.iter_mut().zip(&planes.inner[y * width..]) {
            *out = if reach > T::default() { 255 } else { 0 };
        }
    }
}

fn soft<T: Lane>(
    ink: &[u8],
    width: usize,
    radius_px: f32,
    planes: &mut Planes<T>,
    fringe: &mut Vec<u8>,
    out: &mut [u8],
) {
    let (inner, outer) = (square_within(radius_px), square_beyond(radius_px));
    let most = root(outer);
    let radius = f64::from(radius_px);
    // Ink by squared distance, from the first above the inner square on.
    let shades: Vec<u8> = (inner + 1..=outer)
        .map(|square| ((radius + 1.0 - f64::from(square).sqrt()).clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
        .collect();
    let ramps = [Ramp::of_reaches(inner), Ramp::of_reaches(outer), Ramp::of_distances(most)];
    for plane in [&mut planes.inner, &mut planes.outer, &mut planes.along] {
        plane.resize(ink.len(), T::default());
    }
    for (y, row) in ink.chunks_exact(width).enumerate() {
        let here = y * width..(y + 1) * width;
        fill_rows(
            row,
            [
                (&ramps[0], &mut planes.inner[here.clone()]),
                (&ramps[1], &mut planes.outer[here.clone()]),
                (&ramps[2], &mut planes.along[here]),
            ],
            &mut planes.far,
        );
        sweep_down_row(&mut planes.inner, width, y);
        sweep_down_row(&mut planes.outer, width, y);
    }
    fringe.resize(width, 0);
    for (y, row) in out.chunks_exact_mut(width).enumerate().rev() {
        sweep_up_row(&mut planes.inner, width, y);
        sweep_up_row(&mut planes.outer, width, y);
        let (inside, around) = (&planes.inner[y * width..][..width], &planes.outer[y * width..][..width]);
        between(inside, around, row, fringe);
        for (block, fringe) in fringe.chunks(4 * SIDE_BY_SIDE).enumerate() {
            if fringe.iter().fold(0, |all, &fringe| all | fringe) == 0 {
                continue;
            }
            for (chunk, fringe) in fringe.chunks(SIDE_BY_SIDE).enumerate() {
                if fringe.iter().fold(0, |all, &fringe| all | fringe) == 0 {
                    continue;
                }
                let from = (4 * block + chunk) * SIDE_BY_SIDE;
                let mut best = [0; SIDE_BY_SIDE];
                let best = &mut best[..fringe.len()];
                T::nearest(&planes.along, width, y, most, from, best);
                for ((out, &fringe), &square) in row[from..].iter_mut().zip(fringe).zip(&*best) {
                    if fringe != 0 {
                        *out = shades[(square as u32 - inner - 1) as usize];
                    }
                }
            }
        }
    }
}

/// Pixels that the inner disc covers, and those that only the outer one covers.
#[inline(never)]
fn between<T: Lane>(inside: &[T], around: &[T], covered: &mut [u8], fringe: &mut [u8]) {
    for (((covered, fringe), &inside), &around) in covered.iter_mut().zip(fringe).zip(inside).zip(around) {
        *covered = if inside > T::default() { 255 } else { 0 };
        *fringe = !*covered & if around > T::default() { 255 } else { 0 };
    }
}

/// The largest square of a distance below r + 1.
fn square_beyond(radius_px: f32) -> u32 {
    (f64::from(radius_px) + 1.0).powi(2).ceil() as u32 - 1
}

/// Dilates the line pixels of `ink` by a disc.
///
/// # Errors
/// If `ink` does not have one element for each pixel, or the radius is not within 0..=[`RADIUS_MAX_PX`].
pub fn dilate_disc(
    ink: &[u8],
    size_px: UVec2,
    disc: &Disc,
    buffers: &mut DiscBuffers,
    out: &mut Vec<u8>,
) -> Result<(), ImageSpaceError> {
    let len = checked_len(ink.len(), size_px)?;
    if !(0.0..=RADIUS_MAX_PX).contains(&disc.radius_px) {
        return Err(ImageSpaceError::Radius { radius_px: disc.radius_px });
    }
    out.resize(len, 0);
    let width = size_px.x as usize;
    if len == 0 {
        return Ok(());
    }
    let square = square_within(disc.radius_px);
    let within = root(square);
    if disc.antialias && square_beyond(disc.radius_px) > square {
        if root(square_beyond(disc.radius_px)) + 2 <= u8::MOST {
            soft(ink, width, disc.radius_px, &mut buffers.bytes, &mut buffers.rows, out);
        } else {
            soft(ink, width, disc.radius_px, &mut buffers.words, &mut buffers.rows, out);
        }
    } else if within <= DIRECT_MOST {
        direct::dilate(ink, width, square, &mut buffers.rows, out);
    } else if within < u8::MOST {
        hard(ink, width, square, &mut buffers.bytes, out);
    } else {
        hard(ink, width, square, &mut buffers.words, out);
    }
    Ok(())
}

/// Erodes the line pixels of `ink` by a disc: the result is the complement of the dilated paper.
///
/// # Errors
/// As [`dilate_disc`].
pub fn erode_disc(
    ink: &[u8],
    size_px: UVec2,
    disc: &Disc,
    buffers: &mut DiscBuffers,
    out: &mut Vec<u8>,
) -> Result<(), ImageSpaceError> {
    let mut inverse = std::mem::take(&mut buffers.inverse);
    inverse.clear();
    inverse.extend(ink.iter().map(|ink| !ink));
    let done = dilate_disc(&inverse, size_px, disc, buffers, out);
    buffers.inverse = inverse;
    done?;
    out.iter_mut().for_each(|ink| *ink = !*ink);
    Ok(())
}
