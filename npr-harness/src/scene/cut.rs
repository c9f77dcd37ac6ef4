//! The lines along which alpha cuts faces: where alpha passes the cutoff, as segments on the faces.
//!
//! Alpha is that of the texture's largest level, interpolated as a texture lookup interpolates it, times the material's
//! factor and the vertex colours. Its border is found by marching squares over the texture's grid (Maple 2003, "Geometric
//! design and space planning using the marching squares and marching cube algorithms") in each face, clipped to the face.
//! Adjacent faces share the grid, so that lines continue over their edges.

use crate::texture::wrapped;
use glam::{DMat2, DVec2, DVec3};
use npr_mesh::edges::Edge;
use npr_mesh::{AlphaMode, Model, Texture};

/// The most cells of the grid that are looked at in a mesh, and the most segments that are kept. Beyond, the grid is made
/// coarser.
const MOST_CELLS: f64 = (1 << 24) as f64;
const MOST_SEGMENTS: usize = 1 << 19;

/// Faces with larger coordinates in the texture's grid have no cut lines: the texture repeats more often there than f32
/// tells apart.
const FARTHEST_TEXEL: f64 = (1 << 30) as f64;

/// The cut lines of a mesh.
#[derive(Clone, Debug, Default)]
pub struct CutLines {
    /// The segments, as edges with one face.
    pub edges: Vec<Edge>,
    /// The distance of the grid's points, texels: 1, or more where there would be too many.
    pub step: u32,
}

/// A segment on a face, in barycentric weights.
type Segment = [DVec3; 2];

/// Finds the cut lines of a model, and adds their ends to its vertices.
pub(super) fn cut_lines(model: &mut Model) -> CutLines {
    let cutoff = |face: usize| match model.materials[model.face_material[face] as usize].alpha_mode {
        AlphaMode::Mask { cutoff } => Some(f64::from(cutoff)),
        _ => None,
    };
    if !model.materials.iter().any(|material| matches!(material.alpha_mode, AlphaMode::Mask { .. })) {
        return CutLines::default();
    }
    let faces: Vec<(usize, CutFace<'_>)> = (0..model.faces.len())
        .filter_map(|number| Some((number, CutFace::new(model, number, cutoff(number)?)?)))
        .collect();
    let cells: f64 = faces.iter().map(|(_, face)| face.cells()).sum();
    let mut step = (cells / MOST_CELLS).sqrt().ceil().clamp(1.0, f64::from(1 << 20)) as u32;
    let segments = loop {
        let mut found: Vec<(usize, Segment)> = Vec::new();
        for (number, face) in &faces {
            face.march(step, &mut |segment| found.push((*number, segment)));
            if found.len() > MOST_SEGMENTS {
                break;
            }
        }
        if found.len() <= MOST_SEGMENTS || step >= 1 << 20 {
            found.truncate(MOST_SEGMENTS);
            break found;
        }
        step *= 2;
    };
    let edges = segments.into_iter().filter_map(|(face, ends)| add_segment(model, face, ends)).collect();
    CutLines { edges, step }
}

/// Adds the ends of a segment to the vertices; `None` if they round to one position.
fn add_segment(model: &mut Model, face: usize, ends: Segment) -> Option<Edge> {
    let corners = model.faces[face].map(|vertex| vertex as usize);
    let [a, b, c] = corners.map(|vertex| model.positions[vertex].as_dvec3());
    let positions = ends.map(|weights| (a * weights.x + b * weights.y + c * weights.z).as_vec3());
    if positions[0] == positions[1] {
        return None;
    }
    let first = model.positions.len() as u32;
    for position in positions {
        model.positions.push(position);
        // No face has these vertices; their further attributes are those of a corner.
        model.normals.extend(model.normals.get(corners[0]).copied());
        model.uvs.extend(model.uvs.get(corners[0]).copied());
        model.colors.extend(model.colors.get(corners[0]).copied());
    }
    Some(Edge::boundary([first, first + 1], face as u32))
}

/// A face of a material with a cutoff.
struct CutFace<'a> {
    texture: Option<&'a Texture>,
    /// The corners in the texture's grid: texels, with whole numbers at the centres of texels, or at their corners if the
    /// texture is not interpolated.
    corners: [DVec2; 3],
    /// From a point of the grid, relative to the first corner, to the weights of the second and the third.
    weights: DMat2,
    /// The corners' alpha without the texture.
    alphas: DVec3,
    cutoff: f64,
}

impl<'a> CutFace<'a> {
    /// `None` if the face has no extent in the texture.
    fn new(model: &'a Model, number: usize, cutoff: f64) -> Option<Self> {
        let material = &model.materials[model.face_material[number] as usize];
        let texture =
            material.texture.map(|texture| &model.textures[texture as usize]).filter(|_| !model.uvs.is_empty());
        let vertices = model.faces[number].map(|vertex| vertex as usize);
        let corners = match texture {
            Some(texture) => {
                let size = DVec2::new(texture.width.into(), texture.height.into());
                let offset = if texture.smooth { 0.5 } else { 0.0 };
                vertices.map(|vertex| model.uvs[vertex].as_dvec2() * size - offset)
            }
            // Alpha is linear over the face: the grid is one cell.
            None => [DVec2::ZERO, DVec2::X, DVec2::Y],
        };
        let axes = DMat2::from_cols(corners[1] - corners[0], corners[2] - corners[0]);
        let is_near = |corner: &DVec2| corner.is_finite() && corner.abs().max_element() <= FARTHEST_TEXEL;
        let is_good = corners.iter().all(is_near) && axes.determinant().abs() > 1e-12;
        let factor = f64::from(material.base_color.w);
        let alpha = |vertex: usize| factor * model.colors.get(vertex).map_or(1.0, |color| f64::from(color.w));
        is_good.then(|| Self {
            texture,
            corners,
            weights: axes.inverse(),
            alphas: DVec3::from_array(vertices.map(alpha)),
            cutoff,
        })
    }

    /// About how many cells of the grid the face has.
    fn cells(&self) -> f64 {
        let [a, b, c] = self.corners;
        (b - a).perp_dot(c - a).abs() / 2.0 + a.distance(b) + b.distance(c) + c.distance(a)
    }

    /// The barycentric weights of a point of the grid, which may lie outside the face.
    fn barycentric(&self, point: DVec2) -> DVec3 {
        let weights = self.weights * (point - self.corners[0]);
        DVec3::new(1.0 - weights.x - weights.y, weights.x, weights.y)
    }

    /// The texture's alpha at a point of the grid.
    fn texel(&self, x: i64, y: i64) -> f64 {
        let Some(texture) = self.texture else { return 1.0 };
        let x = wrapped(x as f64, texture.width, texture.wrap[0]);
        let y = wrapped(y as f64, texture.height, texture.wrap[1]);
        let at = 4 * (y as usize * texture.width as usize + x as usize);
        f64::from(texture.rgba8[at + 3]) / 255.0
    }

    /// Calls `add` with each segment within the face.
    fn march(&self, step: u32, add: &mut dyn FnMut(Segment)) {
        let step = f64::from(step);
        let (low, high) = self.corners.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &corner| {
            (low.min(corner / step), high.max(corner / step))
        });
        let is_smooth = self.texture.is_none_or(|texture| texture.smooth);
        for row in low.y.floor() as i64..high.y.ceil().max(low.y.floor() + 1.0) as i64 {
            let Some((from, to)) = self.in_row(row as f64 * step, (row + 1) as f64 * step) else { continue };
            for column in (from / step).floor() as i64..=(to / step).floor() as i64 {
                if is_smooth {
                    self.march_cell(column, row, step, add);
                } else {
                    self.march_texel(column, row, step, add);
                }
            }
        }
    }

    /// The least and the greatest x of the face between two y.
    fn in_row(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let mut found: Option<(f64, f64)> = None;
        let mut add = |x: f64| found = Some(found.map_or((x, x), |(low, high)| (low.min(x), high.max(x))));
        for side in 0..3 {
            let (a, b) = (self.corners[side], self.corners[(side + 1) % 3]);
            if a.y >= from && a.y <= to {
                add(a.x);
            }
            for y in [from, to] {
                if (a.y < y) != (b.y < y) {
                    add(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
                }
            }
        }
        found
    }

    /// The border of alpha in a cell between four points of an interpolated texture.
    fn march_cell(&self, column: i64, row: i64, step: f64, add: &mut dyn FnMut(Segment)) {
        // Around the cell.
        const AROUND: [[i64; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];
        let points = AROUND.map(|[x, y]| DVec2::new((column + x) as f64, (row + y) as f64) * step);
        let texels = AROUND.map(|[x, y]| self.texel((column + x) * step as i64, (row + y) * step as i64));
        // Only if the alpha of the corners is the same can the texture alone tell that nothing is cut.
        let is_even = self.alphas.min_element() == self.alphas.max_element();
        let (least, greatest) = texels.iter().fold((f64::MAX, f64::MIN), |(low, high), &t| (low.min(t), high.max(t)));
        if is_even && (self.alphas.x * least >= self.cutoff || self.alphas.x * greatest < self.cutoff) {
            return;
        }
        let above = |i: usize| texels[i] * self.barycentric(points[i]).dot(self.alphas) - self.cutoff;
        let above = [0, 1, 2, 3].map(above);
        let is_in = above.map(|above| above >= 0.0);
        let mut crossings = [DVec2::ZERO; 4];
        let mut count = 0;
        for side in 0..4 {
            let next = (side + 1) % 4;
            if is_in[side] != is_in[next] {
                crossings[count] = points[side].lerp(points[next], above[side] / (above[side] - above[next]));
                count += 1;
            }
        }
        match count {
            2 => self.clip([crossings[0], crossings[1]], add),
            4 => {
                // A saddle: the middle tells which corners are connected.
                let joins_first = (above.iter().sum::<f64>() >= 0.0) == is_in[0];
                let [a, b, c, d] = crossings;
                let pairs = if joins_first { [[a, b], [c, d]] } else { [[d, a], [b, c]] };
                pairs.into_iter().for_each(|pair| self.clip(pair, add));
            }
            _ => {}
        }
    }

    /// The left and the upper side of a texel that is not interpolated, where they divide what is left from what is cut.
    fn march_texel(&self, column: i64, row: i64, step: f64, add: &mut dyn FnMut(Segment)) {
        let corner = DVec2::new(column as f64, row as f64) * step;
        let texel = |x: i64, y: i64| self.texel(x * step as i64, y * step as i64);
        let is_in = |x: i64, y: i64, at: DVec2| texel(x, y) * self.barycentric(at).dot(self.alphas) >= self.cutoff;
        for (beside, along) in [([column - 1, row], DVec2::Y), ([column, row - 1], DVec2::X)] {
            let middle = corner + along * (0.5 * step);
            if is_in(column, row, middle) != is_in(beside[0], beside[1], middle) {
                self.clip([corner, corner + along * step], add);
            }
        }
    }

    /// Calls `add` with the part of a segment of the grid within the face, if any.
    fn clip(&self, ends: [DVec2; 2], add: &mut dyn FnMut(Segment)) {
        let [a, b] = ends.map(|end| self.barycentric(end));
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for i in 0..3 {
            match (a[i] < 0.0, b[i] < 0.0) {
                (true, true) => return,
                (true, false) => from = from.max(a[i] / (a[i] - b[i])),
                (false, true) => to = to.min(a[i] / (a[i] - b[i])),
                (false, false) => {}
            }
        }
        if from < to {
            add([a.lerp(b, from), a.lerp(b, to)]);
        }
    }
}
