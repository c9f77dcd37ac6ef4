//! The formats of models.

use std::path::Path;

/// A format with an enabled loader.
#[derive(Clone, Copy)]
pub(super) enum Format {
    #[cfg(feature = "obj")]
    Obj,
    #[cfg(feature = "gltf")]
    Gltf,
    #[cfg(feature = "ply")]
    Ply,
    #[cfg(feature = "stl")]
    Stl,
}

impl Format {
    /// The format of a file extension in any case, or of a name that is an extension.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension().or_else(|| path.file_name())?.to_str()?.to_ascii_lowercase();
        match ending.trim_start_matches('.') {
            #[cfg(feature = "obj")]
            "obj" => Some(Self::Obj),
            #[cfg(feature = "gltf")]
            "gltf" | "glb" => Some(Self::Gltf),
            #[cfg(feature = "ply")]
            "ply" => Some(Self::Ply),
            #[cfg(feature = "stl")]
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }
}
