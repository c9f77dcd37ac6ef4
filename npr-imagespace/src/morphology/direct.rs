//! Dilation by a small disc as the maximum of shifted rows.
//!
//! For each row of the disc, 2 w + 1 pixels wide, the maxima over that many pixels of a picture's row; the result is
//! the maximum of these over the disc's rows. All steps are maxima of bytes, which vectorise.

use super::ink::{LINE, root};

/// `to` = the largest of three. A separate function, so that the compiler knows from the arguments that the slices do
/// not overlap.
#[inline(never)]
fn largest(to: &mut [u8], a: &[u8], b: &[u8], c: &[u8]) {
    for (((to, &a), &b), &c) in to.iter_mut().zip(a).zip(b).zip(c) {
        *to = a.max(b).max(c);
    }
}

/// `to` becomes the largest of three, of which it is one.
#[inline(never)]
fn raise(to: &mut [u8], a: &[u8], b: &[u8]) {
    for ((to, &a), &b) in to.iter_mut().zip(a).zip(b) {
        *to = (*to).max(a).max(b);
    }
}

#[inline(never)]
fn lines(to: &mut [u8], ink: &[u8]) {
    for (to, &ink) in to.iter_mut().zip(ink) {
        *to = if ink >= LINE { 255 } else { 0 };
    }
}

/// `out` = ink where a line pixel is within a squared distance of `square`. `rows` is a buffer.
pub(super) fn dilate(ink: &[u8], width: usize, square: u32, rows: &mut Vec<u8>, out: &mut [u8]) {
    let most = root(square);
    let height = ink.len() / width;
    // For each row in use, its maxima over 1, 3, .. 2 most + 1 pixels, each with paper at both ends; and a row of
    // paper.
    let (window, kinds) = (2 * most + 1, most + 1);
    let padded = width + 2 * most;
    rows.clear();
    rows.resize((window * kinds + 1) * padded, 0);
    let (maxima, paper) = rows.split_at_mut(window * kinds * padded);
    let place = |y: usize, kind: usize| ((y % window) * kinds + kind) * padded;
    for ahead in 0..height + most {
        if ahead < height {
            lines(&mut maxima[place(ahead, 0) + most..][..width], &ink[ahead * width..][..width]);
            for kind in 1..kinds {
                let (narrow, wide) = maxima.split_at_mut(place(ahead, kind));
                let line = &narrow[place(ahead, 0)..];
                let narrow = &narrow[place(ahead, kind - 1) + most..][..width];
                let (left, right) = (&line[most - kind..][..width], &line[most + kind..][..width]);
                largest(&mut wide[most..][..width], narrow, left, right);
            }
        }
        let Some(y) = ahead.checked_sub(most) else { continue };
        let to = &mut out[y * width..][..width];
        let row = |row: Option<usize>, kind: usize| match row {
            Some(row) if row < height => &maxima[place(row, kind) + most..][..width],
            _ => &paper[..width],
        };
        let own = row(Some(y), most);
        for away in 0..=most {
            let kind = root(square - (away * away) as u32);
            let (above, below) = (row(y.checked_sub(away), kind), row(Some(y + away), kind));
            match away {
                0 if most == 0 => to.copy_from_slice(own),
                0 => {}
                1 => largest(to, own, above, below),
                _ => raise(to, above, below),
            }
        }
    }
}
