//! A disc as the maximum of shifted rows: for small radii.
//!
//! For each row of the disc, 2 w + 1 pixels wide, the maxima over so many pixels of a picture's row; of these, each from its
//! own row, the maximum. All of it is bytes compared side by side.

use super::disc::{LINE, root};

/// `out` = ink where a line pixel is within a squared distance of `square`. `rows` is a buffer.
pub(super) fn dilate(ink: &[u8], width: usize, square: u32, rows: &mut Vec<u8>, out: &mut [u8]) {
    let most = root(square);
    let height = ink.len() / width;
    // For each row in use, its maxima over 1, 3, .. 2 most + 1 pixels.
    let (window, kinds) = (2 * most + 1, most + 1);
    let padded = width + 2 * most;
    rows.clear();
    rows.resize(window * kinds * width + padded, 0);
    let (maxima, line) = rows.split_at_mut(window * kinds * width);
    let place = |y: usize, kind: usize| ((y % window) * kinds + kind) * width;
    for ahead in 0..height + most {
        if ahead < height {
            for (line, &ink) in line[most..most + width].iter_mut().zip(&ink[ahead * width..][..width]) {
                *line = if ink >= LINE { 255 } else { 0 };
            }
            let first = place(ahead, 0);
            maxima[first..first + width].copy_from_slice(&line[most..most + width]);
            for kind in 1..kinds {
                let (narrow, wide) = maxima.split_at_mut(place(ahead, kind));
                let narrow = &narrow[place(ahead, kind - 1)..];
                let (left, right) = (&line[most - kind..][..width], &line[most + kind..][..width]);
                for (((wide, &narrow), &a), &b) in wide[..width].iter_mut().zip(narrow).zip(left).zip(right) {
                    *wide = narrow.max(a).max(b);
                }
            }
        }
        let Some(y) = ahead.checked_sub(most) else { continue };
        let to = &mut out[y * width..][..width];
        let own = place(y, most);
        to.copy_from_slice(&maxima[own..own + width]);
        for away in 1..=most {
            let kind = root(square - (away * away) as u32);
            let above = y.checked_sub(away).map(|row| &maxima[place(row, kind)..][..width]);
            let below = (y + away < height).then(|| &maxima[place(y + away, kind)..][..width]);
            match (above, below) {
                (Some(above), Some(below)) => {
                    for ((to, &a), &b) in to.iter_mut().zip(above).zip(below) {
                        *to = (*to).max(a).max(b);
                    }
                }
                (Some(one), None) | (None, Some(one)) => {
                    to.iter_mut().zip(one).for_each(|(to, &one)| *to = (*to).max(one));
                }
                (None, None) => {}
            }
        }
    }
}
