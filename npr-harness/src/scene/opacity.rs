//! Which materials hide what is behind them and cast shadows: by their alpha, not by their mode.
//!
//! A surface hides and casts where its alpha is at least [`HIDES_FROM`]. A blended material whose alpha is 1 everywhere,
//! and a cut-out of which nothing is cut, are opaque materials; that is decided once, when a mesh is prepared.

use npr_mesh::{AlphaMode, Material, Model, Texture};

/// From this alpha on, a blended surface hides lines behind it and casts shadows.
pub(crate) const HIDES_FROM: f64 = 0.5;

/// Which part of a material's faces hides what is behind them and casts shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hides {
    /// None of it: its alpha is below 0.5 everywhere.
    Nothing,
    /// Where its alpha is at least its threshold.
    Partly,
    /// All of it.
    Everything,
}

impl Hides {
    /// Of a material, from the least and the greatest alpha of its faces.
    fn new(material: &Material, (least, greatest): (f32, f32)) -> Self {
        let threshold = match threshold(material) {
            Some(threshold) => threshold,
            None => return Self::Everything,
        };
        match (f64::from(least) >= threshold, f64::from(greatest) >= threshold) {
            (true, _) => Self::Everything,
            (false, true) => Self::Partly,
            (false, false) => Self::Nothing,
        }
    }

    /// Of a material of some models' faces.
    pub(crate) fn of_material(
        material: &Material,
        textures: &[Texture],
        faces: impl Iterator<Item = (f32, f32)>,
    ) -> Self {
        if material.alpha_mode == AlphaMode::Opaque {
            return Self::Everything;
        }
        let of_vertices = faces.fold((f32::INFINITY, f32::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let of_vertices = if of_vertices.0 > of_vertices.1 { (1.0, 1.0) } else { of_vertices };
        Self::new(material, alpha_range(material, textures, of_vertices))
    }
}

/// The alpha from which a material's faces hide and cast; `None` for an opaque one.
pub(crate) fn threshold(material: &Material) -> Option<f64> {
    match material.alpha_mode {
        AlphaMode::Opaque => None,
        AlphaMode::Mask { cutoff } => Some(f64::from(cutoff)),
        AlphaMode::Blend => Some(HIDES_FROM),
    }
}

/// The least and the greatest alpha that a material can have: factor × texture × vertex colour.
fn alpha_range(material: &Material, textures: &[Texture], of_vertices: (f32, f32)) -> (f32, f32) {
    let of_texture = match material.texture {
        Some(texture) => {
            let alphas = textures[texture as usize].rgba8.chunks_exact(4).map(|texel| texel[3]);
            let (least, greatest) =
                alphas.fold((255, 0), |(low, high): (u8, u8), alpha| (low.min(alpha), high.max(alpha)));
            (f32::from(least) / 255.0, f32::from(greatest) / 255.0)
        }
        None => (1.0, 1.0),
    };
    let factor = material.base_color.w;
    (factor * of_texture.0 * of_vertices.0, factor * of_texture.1 * of_vertices.1)
}

/// The least and the greatest vertex alpha of the faces of a material; 1 without vertex colours or faces.
pub(crate) fn vertex_alphas(model: &Model, material: u32) -> (f32, f32) {
    if model.colors.is_empty() {
        return (1.0, 1.0);
    }
    let faces = model.faces.iter().zip(&model.face_material).filter(|&(_, &of)| of == material);
    let alphas = faces.flat_map(|(face, _)| face.map(|vertex| model.colors[vertex as usize].w));
    let (least, greatest) =
        alphas.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), alpha| (low.min(alpha), high.max(alpha)));
    if least > greatest { (1.0, 1.0) } else { (least, greatest) }
}

/// The mode of a material that is drawn as it looks: opaque where the least alpha leaves nothing to blend or to cut.
pub(crate) fn settled(material: &Material, textures: &[Texture], of_vertices: (f32, f32)) -> AlphaMode {
    // Looks at the texture's texels only where the mode asks for it.
    let least = || alpha_range(material, textures, of_vertices).0;
    match material.alpha_mode {
        AlphaMode::Blend if least() >= 1.0 => AlphaMode::Opaque,
        AlphaMode::Mask { cutoff } if least() >= cutoff => AlphaMode::Opaque,
        mode => mode,
    }
}

/// Settles the modes of a model's materials. Those that no face uses become opaque, so that no picture depends on them.
pub(crate) fn settle(model: &mut Model) {
    if model.materials.iter().all(|material| material.alpha_mode == AlphaMode::Opaque) {
        return;
    }
    let mut used = vec![false; model.materials.len()];
    model.face_material.iter().for_each(|&material| used[material as usize] = true);
    for (number, used) in (0u32..).zip(used) {
        let material = &model.materials[number as usize];
        let mode = match used {
            true => settled(material, &model.textures, vertex_alphas(model, number)),
            false => AlphaMode::Opaque,
        };
        model.materials[number as usize].alpha_mode = mode;
    }
}
