//! One image with the colour of one and the alpha of another.

use super::texture_map::{Placement, TextureMap};
use crate::Wrap;
use crate::load::image_file::Decoded;

/// Images that are enlarged in order to be joined have at most this many texels along a side, unless one of them has
/// more.
const LARGEST_SIDE: u32 = 4096;

/// How the images of `map_Kd` and `map_d` lie on a common one. Along each axis, coordinate t of the common image is
/// coordinate t · repeats + shift of each of the two.
pub(super) struct Joined {
    axes: [Axis; 2],
    wraps: [Wrap; 2],
    /// Whether one image can repeat like both. Otherwise the alpha lies like the colour.
    pub is_exact: bool,
}

#[derive(Clone, Copy)]
struct Axis {
    scale: f32,
    offset: f32,
    color: (f64, f64),
    alpha: (f64, f64),
}

impl Joined {
    pub fn new(color: &TextureMap, alpha: &TextureMap) -> Self {
        let axis = |axis: usize| {
            let of = |placement: &Placement| (placement.scale[axis], placement.offset[axis]);
            Axis::new(of(&color.placement), of(&alpha.placement))
        };
        let axes = [axis(0), axis(1)];
        let is_exact = axes.iter().all(Option::is_some);
        let like_color = |axis: usize| {
            let Placement { scale, offset } = color.placement;
            Axis { scale: scale[axis], offset: offset[axis], color: (1.0, 0.0), alpha: (1.0, 0.0) }
        };
        let axes = [0, 1].map(|axis| axes[axis].filter(|_| is_exact).unwrap_or(like_color(axis)));
        Self { axes, wraps: [color.wrap, alpha.wrap], is_exact }
    }

    /// How texture coordinates are placed on the common image.
    pub fn placement(&self) -> Placement {
        Placement { scale: self.axes.map(|axis| axis.scale), offset: self.axes.map(|axis| axis.offset) }
    }

    /// Width and height of the common image.
    pub fn size(&self, color: &Decoded, alpha: &Decoded) -> (u32, u32) {
        let side = |colors: u32, alphas: u32, axis: Axis| {
            let enlarged = |size: u32, (repeats, _): (f64, f64)| (f64::from(size) * repeats.abs()) as u32;
            let most = LARGEST_SIDE.max(colors).max(alphas);
            enlarged(colors, axis.color).max(enlarged(alphas, axis.alpha)).clamp(1, most)
        };
        let [across, down] = self.axes;
        (side(color.width, alpha.width, across), side(color.height, alpha.height, down))
    }

    /// The common image. `alpha` has one byte per texel.
    pub fn image(&self, color: &Decoded, alpha: &Decoded, (width, height): (u32, u32)) -> Decoded {
        let is_same = |axis: &Axis| (axis.color, axis.alpha) == ((1.0, 0.0), (1.0, 0.0));
        let sizes = [(color.width, color.height), (alpha.width, alpha.height)];
        if sizes == [(width, height); 2] && self.axes.iter().all(is_same) {
            let texels = color.rgba8.as_chunks::<4>().0.iter().zip(&alpha.rgba8);
            let rgba8 = texels.flat_map(|(&[r, g, b, _], &alpha)| [r, g, b, alpha]).collect();
            return Decoded { width, height, rgba8, has_alpha: true };
        }
        let [across, down] = self.axes;
        let rows = |(repeats, shift): (f64, f64), size: u32, wrap: Wrap| -> Vec<[(usize, f64); 2]> {
            (0..height)
                .map(|y| {
                    // Coordinates run upwards, rows downwards.
                    let t = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
                    neighbours(1.0 - (t * repeats + shift), size, wrap)
                })
                .collect()
        };
        let columns = |(repeats, shift): (f64, f64), size: u32, wrap: Wrap| -> Vec<[(usize, f64); 2]> {
            (0..width)
                .map(|x| neighbours((f64::from(x) + 0.5) / f64::from(width) * repeats + shift, size, wrap))
                .collect()
        };
        let [color_wrap, alpha_wrap] = self.wraps;
        let color_columns = columns(across.color, color.width, color_wrap);
        let color_rows = rows(down.color, color.height, color_wrap);
        let alpha_columns = columns(across.alpha, alpha.width, alpha_wrap);
        let alpha_rows = rows(down.alpha, alpha.height, alpha_wrap);
        let mut rgba8 = Vec::with_capacity(width as usize * height as usize * 4);
        for y in 0..height as usize {
            for x in 0..width as usize {
                let mix = |bytes: &[u8],
                           stride: usize,
                           channel: usize,
                           size: u32,
                           row: &[(usize, f64); 2],
                           column: &[(usize, f64); 2]| {
                    let mut sum = 0.0;
                    for (y, of_row) in row {
                        for (x, of_column) in column {
                            let at = (y * size as usize + x) * stride + channel;
                            sum += f64::from(bytes[at]) * of_row * of_column;
                        }
                    }
                    sum.round() as u8
                };
                for channel in 0..3 {
                    rgba8.push(mix(&color.rgba8, 4, channel, color.width, &color_rows[y], &color_columns[x]));
                }
                rgba8.push(mix(&alpha.rgba8, 1, 0, alpha.width, &alpha_rows[y], &alpha_columns[x]));
            }
        }
        Decoded { width, height, rgba8, has_alpha: true }
    }
}

impl Axis {
    /// An axis on which both images repeat a whole number of times; `None` if there is none.
    fn new((color_scale, color_offset): (f32, f32), (alpha_scale, alpha_offset): (f32, f32)) -> Option<Self> {
        if (color_scale, color_offset) == (alpha_scale, alpha_offset) {
            return Some(Self { scale: color_scale, offset: color_offset, color: (1.0, 0.0), alpha: (1.0, 0.0) });
        }
        let ratio = |a: f32, b: f32| {
            let ratio = f64::from(a) / f64::from(b);
            ((ratio - ratio.round()).abs() < 1e-4 && ratio.round() != 0.0).then(|| ratio.round())
        };
        let on = |scale: f32, offset: f32| {
            let repeats = (ratio(color_scale, scale)?, ratio(alpha_scale, scale)?);
            let shift = |of: f32, repeats: f64| f64::from(of) - f64::from(offset) * repeats;
            let (color, alpha) = (shift(color_offset, repeats.0), shift(alpha_offset, repeats.1));
            Some(Self { scale, offset, color: (repeats.0, color), alpha: (repeats.1, alpha) })
        };
        on(color_scale, color_offset).or_else(|| on(alpha_scale, alpha_offset)).or_else(|| on(1.0, 0.0))
    }
}

/// The two texels next to a coordinate, and their shares.
fn neighbours(coordinate: f64, size: u32, wrap: Wrap) -> [(usize, f64); 2] {
    let at = coordinate * f64::from(size) - 0.5;
    // Rounding of a coordinate that falls on a texel.
    let at = if (at - at.round()).abs() < 1e-6 { at.round() } else { at };
    let (first, share) = (at.floor(), at - at.floor());
    let texel = |at: f64| match wrap {
        Wrap::Clamp => at.clamp(0.0, f64::from(size - 1)) as usize,
        _ => at.rem_euclid(f64::from(size)) as usize % size as usize,
    };
    [(texel(first), 1.0 - share), (texel(first + 1.0), share)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(options: &str) -> TextureMap {
        TextureMap::read(&format!("{options} a.png")).0.unwrap()
    }

    fn gray(width: u32, height: u32, values: &[u8]) -> Decoded {
        Decoded { width, height, rgba8: values.iter().flat_map(|&v| [v, v, v, 255]).collect(), has_alpha: false }
    }

    fn alpha(width: u32, height: u32, values: &[u8]) -> Decoded {
        Decoded { width, height, rgba8: values.to_vec(), has_alpha: true }
    }

    fn image(joined: &Joined, color: &Decoded, alpha: &Decoded) -> Decoded {
        joined.image(color, alpha, joined.size(color, alpha))
    }

    fn texels(image: &Decoded) -> Vec<(u8, u8)> {
        image.rgba8.chunks(4).map(|texel| (texel[0], texel[3])).collect()
    }

    #[test]
    fn images_of_one_size_and_placement_are_joined_texel_by_texel() {
        let joined = Joined::new(&map("-s 3 3"), &map("-s 3 3"));
        let image = image(&joined, &gray(2, 2, &[1, 2, 3, 4]), &alpha(2, 2, &[5, 6, 7, 8]));
        assert_eq!((image.width, image.height), (2, 2));
        assert_eq!(texels(&image), [(1, 5), (2, 6), (3, 7), (4, 8)]);
        assert_eq!(joined.placement(), Placement { scale: [3.0; 2], offset: [0.0; 2] });
    }

    #[test]
    fn a_repeated_colour_lies_in_the_period_of_the_alpha() {
        let joined = Joined::new(&map("-s 2 1"), &map(""));
        assert!(joined.is_exact);
        assert_eq!(joined.placement(), Placement::default());
        let image = image(&joined, &gray(2, 1, &[10, 20]), &alpha(4, 1, &[1, 2, 3, 4]));
        assert_eq!(texels(&image), [(10, 1), (20, 2), (10, 3), (20, 4)]);
    }

    #[test]
    fn a_shifted_alpha_is_turned_back() {
        // The colour at u is that of u + 1/2 in its image; the common image is the colour's.
        let joined = Joined::new(&map("-o 0.5"), &map(""));
        let turned = image(&joined, &gray(2, 1, &[10, 20]), &alpha(2, 1, &[1, 2]));
        assert_eq!(joined.placement(), Placement { scale: [1.0; 2], offset: [0.5, 0.0] });
        assert_eq!(texels(&turned), [(10, 2), (20, 1)]);
        // v runs upwards.
        let joined = Joined::new(&map("-o 0 0.5"), &map(""));
        assert_eq!(texels(&image(&joined, &gray(1, 2, &[10, 20]), &alpha(1, 2, &[1, 2]))), [(10, 2), (20, 1)]);
    }

    #[test]
    fn repetitions_without_a_common_period() {
        let joined = Joined::new(&map("-s 2 2"), &map("-s 3 3"));
        assert!(joined.is_exact);
        assert_eq!(joined.placement(), Placement::default());
        assert!(!Joined::new(&map("-s 1.7 1"), &map("-s 1 1")).is_exact);
    }
}
