//! The polylines of an OBJ file.

use super::lines::{number, words_of};
use crate::Model;
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// Line segments with vertices of their own.
pub(super) struct Polylines {
    positions: Vec<[f32; 3]>,
    /// Per vertex, or empty.
    colors: Vec<Vec3>,
    segments: Vec<[u32; 2]>,
}

impl Polylines {
    /// Reads the vertices that `segments`, as indices of the text's `v` lines, use.
    pub fn read(text: &[u8], segments: &[[u32; 2]]) -> Self {
        let mut read = Self { positions: Vec::new(), colors: Vec::new(), segments: Vec::new() };
        if segments.is_empty() {
            return read;
        }
        let mut vertex_of: HashMap<u32, u32> = HashMap::new();
        for &index in segments.iter().flatten() {
            let fresh = vertex_of.len() as u32;
            vertex_of.entry(index).or_insert(fresh);
        }
        read.positions.resize(vertex_of.len(), [f32::NAN; 3]);
        read.segments = segments.iter().map(|segment| segment.map(|index| vertex_of[&index])).collect();
        let is_vertex = |line: &&[u8]| matches!(line, [b'v', space, ..] if space.is_ascii_whitespace());
        for (index, line) in (0u32..).zip(text.split(|b| *b == b'\n').filter(is_vertex)) {
            let Some(&vertex) = vertex_of.get(&index) else { continue };
            let numbers: Vec<f32> = words_of(line).skip(1).map(|word| number(word).unwrap_or(f32::NAN)).collect();
            let Some(&position) = numbers.first_chunk::<3>() else { continue };
            let weight = if numbers.len() == 4 { numbers[3] } else { 1.0 };
            read.positions[vertex as usize] = position.map(|x| x / weight);
            if let Some(&[r, g, b]) = numbers.get(3..).and_then(|rest| rest.first_chunk::<3>()) {
                read.colors.resize(read.positions.len(), Vec3::ONE);
                read.colors[vertex as usize] = Vec3::new(r, g, b);
            }
        }
        read
    }

    pub fn positions(&self) -> impl Iterator<Item = &[f32; 3]> {
        self.positions.iter()
    }

    /// Adds the segments and their vertices to a model, with missing normals.
    pub fn add_to(self, model: &mut Model) {
        let first = model.positions.len();
        let vertices = first + self.positions.len();
        model.positions.extend(self.positions.iter().map(|p| Vec3::from_array(*p)));
        model.normals.resize(vertices, Vec3::ZERO);
        if !model.uvs.is_empty() {
            model.uvs.resize(vertices, Vec2::ZERO);
        }
        if !model.colors.is_empty() || !self.colors.is_empty() {
            model.colors.resize(first, Vec4::ONE);
            let finite = |color: &Vec3| if color.is_finite() { *color } else { Vec3::ONE };
            model.colors.extend(self.colors.iter().map(|color| finite(color).extend(1.0)));
            model.colors.resize(vertices, Vec4::ONE);
        }
        model.lines.extend(self.segments.iter().map(|segment| segment.map(|vertex| vertex + first as u32)));
    }
}
