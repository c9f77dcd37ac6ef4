//! The flags of all commands that load models.

use crate::paths;
use crate::terminal::spinner;
use clap::Args;
use npr_harness::error::{HarnessError, PathRole};
use npr_harness::suggest::nearest;
use npr_mesh::weld::Weld;
use npr_mesh::{Limits, LoadOptions, Loaded};
use std::path::{Path, PathBuf};

/// The names that [`limit_mut`] accepts.
const LIMITS: [&str; 10] = [
    "file-bytes",
    "vertices",
    "faces",
    "repeated",
    "polygon-corners",
    "nodes",
    "instances",
    "displacements",
    "texels",
    "texels-in-all",
];

#[derive(Args, Clone, Default)]
pub struct Loading {
    /// A folder in which textures, materials and buffers of a model may lie besides the model's own folder.
    #[arg(long, value_name = "DIR")]
    asset_root: Option<PathBuf>,
    /// Accept larger files, or smaller ones only: file-bytes, vertices, faces, repeated, polygon-corners, nodes,
    /// instances, displacements, texels or texels-in-all, and how many at most. May be repeated.
    #[arg(long, value_name = "NAME=NUMBER", value_parser = parse_limit)]
    limit: Vec<(String, u64)>,
    /// Take vertices within this distance, in units of the file, for one vertex where edges and missing normals are found;
    /// 0: only those at equal positions. By default those that only the rounding of coordinates separates, and for
    /// `inspect` those at equal positions.
    #[arg(long, value_name = "DISTANCE", value_parser = parse_weld)]
    weld: Option<f32>,
}

impl Loading {
    /// Checks that models and folders exist before anything is read.
    pub fn check(&self, models: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<(), HarnessError> {
        for model in models {
            paths::check_file(PathRole::Model, model.as_ref())?;
        }
        match &self.asset_root {
            Some(root) => paths::check_directory(PathRole::AssetRoot, root),
            None => Ok(()),
        }
    }

    /// The rule of `--weld`, if given.
    pub fn weld(&self) -> Option<Weld> {
        self.weld.map(|distance| if distance > 0.0 { Weld::Within(distance) } else { Weld::Exact })
    }

    pub fn options(&self) -> LoadOptions {
        let mut limits = Limits::default();
        for (name, most) in &self.limit {
            if let Some(limit) = limit_mut(&mut limits, name) {
                *limit = *most;
            }
        }
        LoadOptions {
            limits,
            asset_root: self.asset_root.clone(),
            weld: self.weld().unwrap_or_default(),
            ..LoadOptions::default()
        }
    }
}

fn limit_mut<'a>(limits: &'a mut Limits, name: &str) -> Option<&'a mut u64> {
    Some(match name {
        "file-bytes" => &mut limits.file_bytes,
        "vertices" => &mut limits.vertices,
        "faces" => &mut limits.faces,
        "repeated" => &mut limits.repeated,
        "polygon-corners" => &mut limits.polygon_corners,
        "nodes" => &mut limits.nodes,
        "instances" => &mut limits.instances,
        "displacements" => &mut limits.displacements,
        "texels" => &mut limits.texels,
        "texels-in-all" => &mut limits.texels_in_all,
        _ => return None,
    })
}

fn parse_limit(text: &str) -> Result<(String, u64), String> {
    let (name, number) = text.split_once('=').ok_or("expected NAME=NUMBER, such as vertices=200000000")?;
    if limit_mut(&mut Limits::default(), name).is_none() {
        let nearest = nearest(name, LIMITS).map(|nearest| format!("did you mean {nearest:?}? "));
        return Err(format!("{name:?} is no limit ({}there are: {})", nearest.unwrap_or_default(), LIMITS.join(", ")));
    }
    let number = number.parse().map_err(|_| format!("{number:?} is not a whole number"))?;
    Ok((name.to_owned(), number))
}

fn parse_weld(text: &str) -> Result<f32, String> {
    let distance: f32 = text.parse().map_err(|_| format!("{text:?} is not a number"))?;
    if distance.is_finite() && distance >= 0.0 { Ok(distance) } else { Err("a distance is 0 or more".into()) }
}

pub fn load(path: &Path, loading: &Loading) -> Result<Loaded, HarnessError> {
    let bar = spinner(&format!("reading {}", path.display()));
    let loaded = npr_mesh::load(path, &loading.options())?;
    bar.finish_and_clear();
    Ok(loaded)
}
