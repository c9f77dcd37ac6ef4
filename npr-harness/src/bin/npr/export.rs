//! `npr export`.

use crate::loading::{Loading, load};
use crate::paths::{check_output_file, unusable};
use crate::terminal::{one_line, say, tell};
use clap::Args;
use npr_harness::error::HarnessError;
use npr_hatch::files::{check_writable, write_file};
use npr_mesh::SideVisibility;
use npr_mesh::export::{ExportOptions, glb};
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// The model.
    input: PathBuf,
    /// The file, which ends in .glb.
    #[arg(short, long)]
    output: PathBuf,
    /// State for each edge whether it is a line: what the file says of it, and else hard at borders and creases, a
    /// silhouette where the surface bends, hidden where it is flat.
    #[arg(long)]
    edges: bool,
    /// Edges at which the surface turns by more than this are creases, degrees, 0 to 180.
    #[arg(long, value_name = "DEG", default_value_t = 45.0, requires = "edges")]
    crease_angle: f32,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    loading: Loading,
}

pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let Options { input, output, .. } = options;
    options.loading.check([input])?;
    check_output_file(output, &[input])?;
    if !output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb")) {
        return Err(HarnessError::ModelFormat { path: output.clone() });
    }
    let angle_deg = options.crease_angle;
    if !(0.0..=180.0).contains(&angle_deg) {
        let (value, range) = (angle_deg.into(), "0..=180 degrees");
        return Err(HarnessError::Range { what: "a crease's angle", value, range });
    }
    check_writable(output).map_err(unusable(output))?;
    let loaded = load(input, &options.loading)?;
    loaded.warnings.iter().for_each(|warning| tell(&format!("npr: {}", one_line(&warning.to_string()))));
    let edges = options.edges.then(|| angle_deg.to_radians());
    let file = glb(&loaded.meshes, &loaded.objects, &ExportOptions { edges })?;
    write_file(output, &file).map_err(unusable(output))?;
    let sum = |count: fn(&npr_mesh::Model) -> usize| loaded.meshes.iter().map(count).sum::<usize>();
    let stated = |model: &npr_mesh::Model| {
        model.side_visibility.iter().flatten().filter(|side| **side != SideVisibility::Unstated).count()
    };
    let (faces, lines, stated) = (sum(|mesh| mesh.faces.len()), sum(|mesh| mesh.lines.len()), sum(stated));
    let (meshes, objects) = (loaded.meshes.len(), loaded.objects.len());
    if options.json {
        let warnings: Vec<_> = loaded.warnings.iter().map(|w| json!({"text": w.text, "count": w.count})).collect();
        let written = json!({
            "input": input, "output": output, "bytes": file.len(), "meshes": meshes, "objects": objects, "faces": faces,
            "lines": lines, "edges": options.edges, "stated_sides": stated, "warnings": warnings,
        });
        say(format_args!("{written}\n"))?;
    } else {
        let output = output.display();
        say(format_args!(
            "{output}: {} bytes, {meshes} meshes, {objects} objects, {faces} faces, {lines} lines\n",
            file.len()
        ))?;
    }
    Ok(true)
}
