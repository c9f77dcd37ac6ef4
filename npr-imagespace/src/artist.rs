//! Lines that an artist paints: "The Evolution of a Cartoon Renderer", listings 1 and 4 and the text between.
//!
//! The normals that a material writes to the G-buffer need not be those of its surface. Where they are taken from four
//! directions that no visible surface has, the normal filter draws lines between areas of different directions, at the
//! borders that the artist painted, and between these areas and surfaces with their own normals. Each material has one
//! [`LineKind`]; the filters are the same for all.
//!
//! # The four directions
//!
//! They point away from the eye, 45° from the plane of the screen and equally spaced around the view: (±½, ±½, 1/√2)
//! with z along the view. Error in print: the caption of figure 3 puts 45° between them, which is their angle to the
//! plane; neighbours are 60° and opposite ones 90° apart, so that both are below every threshold in use (cos 60° =
//! 0.5).
//!
//! [`ink_artist_direction`] rotates z to the direction from the eye to a point. All is in view space, where the eye
//! looks down −z and no visible point lies behind it: the shortest rotation from −z is then a continuous function of
//! the point. A world-space G-buffer takes the result through the
//! view's rotation.
//!
//! - Vertex colours ([`LineKind::VertexColor`]): rotated with the vector from the eye to each vertex and interpolated
//!   ([`ArtistRotation::PerVertex`]), or better with that to each pixel ([`ArtistRotation::PerPixel`]). Every visible
//!   normal is 90° and more from that vector, so the four stay 45° and more from all of them, from every side. Where
//!   the corners of a face have different colours, interpolated directions turn gradually from one to the other, and a
//!   large face has no line; the pixel's own vector is applied to the interpolated colour, whose border is a line.
//! - Texture ([`LineKind::Texture`]): red and alpha of the artist's texture pick one of the 2 × 2 palette
//!   ([`ink_artist_texel`], as `texreg2ar` does), rotated once for an object with the vector from the eye to its
//!   centre ([`ArtistRotation::PerObject`]). At a point that is an angle α off that vector the distance to visible
//!   normals is 45° − α, and lines vanish where that is below the filter's threshold: nearer than r / sin(45° − acos t)
//!   to the centre of an object of radius r ([`artist_object_distance`]), 7.1 r for the threshold 0.80 and 4.4 r for
//!   0.85. With the pixel's own vector, which costs a few instructions today, the kind has no such limit.
//!
//! # Alpha-tested materials
//!
//! A pixel whose alpha is below the reference ([`ink_alpha_kept`]) must be discarded from *every* target of the
//! geometry pass, depth included. What lies behind is then what the filters see there, and all of them draw the
//! border of what remains. Alpha must not be blended: half a normal or half a region is another one.

use glam::{Quat, Vec3, Vec4};

/// WGSL of this module: no bindings, no entry points.
pub const ARTIST_WGSL: &str = include_str!("artist.wgsl");

/// Where a material's inner lines come from. Its outline is drawn in any case, by depth and background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LineKind {
    /// Its normals: creases and folds.
    #[default]
    Normals,
    /// Borders of what its vertices are coloured with.
    VertexColor,
    /// Borders in a texture.
    Texture,
    /// Borders of its regions; its normals are stored as no normal.
    Regions,
    /// No inner lines: no normal, and one region for the whole material.
    None,
}

/// The vector from the eye with which [`ink_artist_direction`] rotates the directions of an artist's lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ArtistRotation {
    /// That to the pixel's surface point: not printed, and the most accurate.
    #[default]
    PerPixel,
    /// As printed for vertex colours: that to each vertex, and the rotated directions are interpolated.
    PerVertex,
    /// As printed for textures: that to the middle of the object.
    PerObject,
}

/// Cosine of the angle between the view and each of the four directions: 45°.
const ALONG: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// One of the four directions, with z along the view; of `index` the two lowest bits count, the sign of x and that of
/// y.
pub fn ink_artist_vector(index: u32) -> Vec3 {
    let sign = |bit: u32| if index & bit != 0 { 0.5 } else { -0.5 };
    Vec3::new(sign(1), sign(2), ALONG)
}

/// The display-referred colour that stands for one of the four directions: (direction + 1) / 2.
pub fn artist_color(index: u32) -> Vec3 {
    ink_artist_vector(index) * 0.5 + 0.5
}

/// The index of the direction that a vertex colour means: the nearest.
pub fn ink_artist_index(color: Vec3) -> u32 {
    u32::from(color.x >= 0.5) | u32::from(color.y >= 0.5) << 1
}

/// The index that a texture's colour means: alpha picks the column of the 2 × 2 palette and red the row.
pub fn ink_artist_texel(color: Vec4) -> u32 {
    u32::from(color.w >= 0.5) | u32::from(color.x >= 0.5) << 1
}

/// One of the four directions for a point, in view space (the eye at the origin looks down −z): the vector rotated
/// so that its z points along `eye_to_point`, which may have any length. At the eye and behind it, unrotated.
pub fn ink_artist_direction(index: u32, eye_to_point: Vec3) -> Vec3 {
    // x and y to the right and up as they are seen, z into the picture.
    let vector = ink_artist_vector(index);
    let ahead = Vec3::new(vector.x, vector.y, -vector.z);
    let length = eye_to_point.length();
    if length <= 0.0 || eye_to_point.z >= 0.0 {
        return ahead;
    }
    // The half-angle quaternion of the shortest rotation from −z to the point.
    let to = eye_to_point / length;
    let turn = Quat::from_xyzw(to.y, -to.x, 0.0, 1.0 - to.z).normalize();
    turn * ahead
}

/// Whether a pixel of an alpha-tested material is drawn.
pub fn ink_alpha_kept(alpha: f32, reference: f32) -> bool {
    alpha >= reference
}

/// The distance of an object's centre, in its own radii, below which directions rotated once for the object are within
/// the threshold of a visible normal, so that lines may vanish: 1 / sin(45° − acos t). Infinite where t is cos 45° or
/// less.
pub fn artist_object_distance(normal_cos: f64) -> f64 {
    let spare_rad = std::f64::consts::FRAC_PI_4 - normal_cos.acos();
    if spare_rad > 0.0 { 1.0 / spare_rad.sin() } else { f64::INFINITY }
}
