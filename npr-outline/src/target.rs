//! Checks of textures, areas and matrices, whose errors the passes return before they record anything.

use crate::OutlineError;
use glam::{DMat4, DVec3, Vec4Swizzles};

/// Refuses colour formats whose stores encode sRGB, and those that are no colours of floats.
pub(crate) fn check_color_format(device: &wgpu::Device, format: wgpu::TextureFormat) -> Result<(), OutlineError> {
    if format.is_srgb() {
        return Err(OutlineError::SrgbTarget { format });
    }
    let is_float =
        matches!(format.sample_type(None, Some(device.features())), Some(wgpu::TextureSampleType::Float { .. }));
    if !is_float || format.has_depth_aspect() {
        return Err(OutlineError::ViewFormat { what: "a colour target", format, needed: "a colour format of floats" });
    }
    Ok(())
}

/// Refuses a texture that `accepts` does not take for its format, with more than one sample a pixel, or, if `size_px`
/// is given, of another size.
pub(crate) fn check_view(
    what: &'static str,
    view: &wgpu::TextureView,
    needed: &'static str,
    accepts: impl Fn(wgpu::TextureFormat) -> bool,
    size_px: Option<[u32; 2]>,
) -> Result<(), OutlineError> {
    let texture = view.texture();
    let (format, samples) = (texture.format(), texture.sample_count());
    if !accepts(format) {
        return Err(OutlineError::ViewFormat { what, format, needed });
    }
    if samples != 1 {
        return Err(OutlineError::ViewSamples { what, samples });
    }
    match size_px {
        Some(needed) if needed != size(view) => {
            Err(OutlineError::ViewSize { what, size_px: size(view), needed_px: needed })
        }
        _ => Ok(()),
    }
}

/// Whether two formats are the same but for the encoding of sRGB, which a view may leave out.
pub(crate) fn is_same(a: wgpu::TextureFormat, b: wgpu::TextureFormat) -> bool {
    a.remove_srgb_suffix() == b.remove_srgb_suffix()
}

/// Width and height of the texture of a view, px.
pub(crate) fn size(view: &wgpu::TextureView) -> [u32; 2] {
    [view.texture().width(), view.texture().height()]
}

/// Refuses an area beyond a target.
pub(crate) fn check_area(area: Option<[u32; 4]>, size_px: [u32; 2]) -> Result<(), OutlineError> {
    let Some(area @ [x, y, width, height]) = area else { return Ok(()) };
    let is_within = x.checked_add(width).is_some_and(|right| right <= size_px[0])
        && y.checked_add(height).is_some_and(|bottom| bottom <= size_px[1]);
    if is_within { Ok(()) } else { Err(OutlineError::Area { area, size_px }) }
}

/// How a matrix makes depth.
enum Depth {
    /// z/w = `limit` + `fall` / w, with w the distance.
    Perspective { limit: f64, fall: f64 },
    /// w is the same everywhere; the gradient of z/w in the world.
    Parallel(DVec3),
}

/// Relative differences below this are rounding: f32 has 2^-24.
const ROUNDING: f64 = 1e-6;

/// `None` for matrices in which depth is no function of the distance alone, or that are degenerate.
fn depth_of(clip_from_world: &DMat4) -> Option<Depth> {
    let (z, w) = (clip_from_world.row(2), clip_from_world.row(3));
    if !clip_from_world.is_finite() {
        return None;
    }
    let ahead = w.xyz();
    if ahead.length() <= 1e-12 * w.w.abs() {
        return (w.w > 0.0 && z.xyz() != DVec3::ZERO).then(|| Depth::Parallel(z.xyz() / w.w));
    }
    let limit = z.xyz().dot(ahead) / ahead.length_squared();
    // With an oblique near plane depth does not depend on the distance alone.
    if (z.xyz() - limit * ahead).length() > ROUNDING * (z.xyz().length() + ROUNDING * ahead.length()) {
        return None;
    }
    Some(Depth::Perspective { limit, fall: z.w - limit * w.w })
}

/// Refuses a matrix whose depth grows with distance. Matrices that cannot be judged are accepted.
///
/// In perspective the third row is k times the fourth and c in its last column, so that depth is k + c/w: it falls with
/// the distance w where c > 0. In a parallel view depth must grow in the direction `towards_viewer`, world space, if
/// that is known.
pub(crate) fn check_reversed(clip_from_world: &DMat4, towards_viewer: Option<DVec3>) -> Result<(), OutlineError> {
    match depth_of(clip_from_world) {
        Some(Depth::Perspective { limit, fall }) if fall < 0.0 => {
            Err(OutlineError::StandardDepth { nearer: limit + fall, farther: limit + 0.5 * fall })
        }
        Some(Depth::Parallel(gradient)) => {
            let Some(rise) = towards_viewer.map(|towards| gradient.dot(towards.normalize_or_zero())) else {
                return Ok(());
            };
            if rise < -ROUNDING * gradient.length() {
                return Err(OutlineError::StandardDepth { nearer: rise, farther: 0.0 });
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The direction towards the viewer in a parallel view of a right-handed world, world space.
pub(crate) fn towards_viewer(clip_from_world: &DMat4) -> DVec3 {
    clip_from_world.row(0).xyz().cross(clip_from_world.row(1).xyz())
}

/// Refuses a matrix with a far plane. Matrices that cannot be judged are accepted.
pub(crate) fn check_no_far_plane(clip_from_world: &DMat4) -> Result<(), OutlineError> {
    match depth_of(clip_from_world) {
        Some(Depth::Parallel(_)) => Err(OutlineError::FarPlane { far: f64::INFINITY }),
        // Depth reaches 0 at a finite distance.
        Some(Depth::Perspective { limit, fall }) if limit < -1e-12 => {
            Err(OutlineError::FarPlane { far: -fall / limit })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dcamera::rh::proj::directx as proj;
    use glam::dcamera::rh::view::look_at_mat4;
    use glam::{DMat4, DVec3};

    const EYE: DVec3 = DVec3::new(3.0, 2.0, 5.0);

    fn views() -> [DMat4; 3] {
        let far = DVec3::new(-400.0, 250.0, 90.0);
        [
            look_at_mat4(EYE, DVec3::ZERO, DVec3::Y),
            look_at_mat4(far, far + DVec3::new(1.0, 2.0, -0.5), DVec3::Z),
            DMat4::IDENTITY,
        ]
    }

    /// Both as made in f64 and as rounded to f32, which is how matrices often arrive.
    fn each(matrix: DMat4) -> [DMat4; 2] {
        [matrix, matrix.as_mat4().as_dmat4()]
    }

    #[test]
    fn standard_perspective_depth_is_refused_and_reversed_accepted() {
        for view in views() {
            for (near, far) in [(0.1, 1e4), (0.01, 100.0), (1.0, 1.5)] {
                for standard in each(proj::perspective(1.0, 1.5, near, far) * view) {
                    assert!(matches!(check_reversed(&standard, None), Err(OutlineError::StandardDepth { .. })));
                }
                for reversed in each(proj::perspective(1.0, 1.5, far, near) * view) {
                    assert_eq!(check_reversed(&reversed, None), Ok(()));
                }
                for reversed in each(proj::perspective_infinite_reverse(1.0, 1.5, near) * view) {
                    assert_eq!(check_reversed(&reversed, None), Ok(()));
                }
                for standard in each(proj::perspective_infinite(1.0, 1.5, near) * view) {
                    assert!(check_reversed(&standard, None).is_err());
                }
            }
        }
    }

    #[test]
    fn standard_parallel_depth_is_refused_and_reversed_accepted() {
        for view in views() {
            let towards = view.inverse().z_axis.truncate();
            for (near, far) in [(0.1, 100.0), (-20.0, 20.0)] {
                for (matrix, is_reversed) in [
                    (proj::orthographic(-2.0, 2.0, -1.0, 1.0, near, far), false),
                    (proj::orthographic(-2.0, 2.0, -1.0, 1.0, far, near), true),
                ] {
                    for matrix in each(matrix * view) {
                        for towards in [towards, towards_viewer(&matrix)] {
                            assert_eq!(check_reversed(&matrix, Some(towards)).is_ok(), is_reversed);
                        }
                        assert_eq!(check_reversed(&matrix, None), Ok(()), "where the viewer is is not known");
                    }
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_judged_is_accepted() {
        let oblique = {
            let mut matrix = proj::perspective(1.0, 1.5, 0.1, 100.0);
            matrix.x_axis.z = 0.3;
            matrix
        };
        for matrix in [DMat4::ZERO, DMat4::NAN, oblique, DMat4::from_diagonal(glam::DVec4::new(1.0, 1.0, 0.0, 1.0))] {
            assert_eq!(check_reversed(&matrix, Some(DVec3::Z)), Ok(()));
        }
        assert_eq!(check_no_far_plane(&DMat4::ZERO), Ok(()));
    }

    #[test]
    fn far_planes_are_refused() {
        for view in views() {
            for far in [10.0, 1e4, 1e6] {
                let matrix = proj::perspective(1.0, 1.5, far, 0.1) * view;
                let Err(OutlineError::FarPlane { far: found }) = check_no_far_plane(&matrix) else { panic!("{far}") };
                assert!((found / far - 1.0).abs() < 1e-6, "{found} for {far}");
            }
            for matrix in each(proj::perspective_infinite_reverse(1.0, 1.5, 0.1) * view) {
                assert_eq!(check_no_far_plane(&matrix), Ok(()));
            }
            let parallel = proj::orthographic(-2.0, 2.0, -1.0, 1.0, 20.0, -20.0) * view;
            assert!(matches!(check_no_far_plane(&parallel), Err(OutlineError::FarPlane { .. })));
        }
    }

    #[test]
    fn areas_beyond_the_target_are_refused() {
        let size_px = [8, 6];
        for area in [None, Some([0, 0, 8, 6]), Some([7, 5, 1, 1]), Some([8, 6, 0, 0])] {
            assert_eq!(check_area(area, size_px), Ok(()));
        }
        for area in [[0, 0, 9, 6], [1, 0, 8, 6], [0, 6, 1, 1], [u32::MAX, 0, 2, 1]] {
            assert_eq!(check_area(Some(area), size_px), Err(OutlineError::Area { area, size_px }));
        }
    }
}
