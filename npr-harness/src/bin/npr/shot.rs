//! What is to be drawn, as arguments: the model, the style, the view.

use crate::backend::BackendName;
use crate::framing::{FramingOptions, numbers};
use crate::loading::{Loading, load};
use crate::range::checked;
use crate::style::{known_style, style_file};
use crate::terminal::{one_line, tell};
use clap::Args;
use glam::{DVec3, DVec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::error::HarnessError;
use npr_harness::executor::Backend;
use npr_harness::picture_limits::{MEMORY_BYTES, MOST_SAMPLES, check_picture};
use npr_harness::scene::Scene;
use npr_harness::style::Style;
use npr_harness::view::View;
use npr_imagespace::artist::LineKind;
use npr_mesh::{Loaded, Warning, pn_triangles};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct ShotOptions {
    /// The model.
    pub input: PathBuf,
    /// One of `npr styles`, or a file.toml (see `npr style`).
    #[arg(long, default_value = "cartoon")]
    pub style: String,
    /// Width and height, px.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    pub size: (u32, u32),
    /// Where the picture is made.
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendName,
    #[command(flatten)]
    framing: FramingOptions,
    /// Samples per pixel along each axis: 2 or more smooth what has no line on it.
    #[arg(long, default_value_t = 1)]
    samples: u32,
    /// What the picture may take of memory while it is made, GiB.
    #[arg(long, value_name = "GIB", default_value_t = MEMORY_BYTES as f64 / f64::from(1 << 30))]
    max_memory: f64,
    /// Round a coarse model: each edge is cut into so many pieces, on the curves that its normals ask for.
    #[arg(long, default_value_t = 1)]
    segments: u32,
    /// Show only where x NX + y NY + z NZ + D >= 0.
    #[arg(long, value_name = "NX,NY,NZ,D", value_parser = parse_plane, allow_hyphen_values = true)]
    clip: Option<DVec4>,
    /// Where a material's inner lines come from, in styles that ask (`artist`): normals, vertex-colors, texture, regions
    /// or none. May be repeated.
    #[arg(long, value_name = "MATERIAL=KIND", value_parser = parse_line_kind)]
    inner_lines: Vec<(String, LineKind)>,
    #[command(flatten)]
    loading: Loading,
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let number = |part: &str| part.parse::<u32>().map_err(|_| format!("{part:?} is not a number of pixels"));
    let (width, height) = text.split_once(['x', 'X']).ok_or("expected WIDTHxHEIGHT, such as 1280x720")?;
    Ok((number(width)?, number(height)?))
}

fn parse_plane(text: &str) -> Result<DVec4, String> {
    let plane = <[f64; 4]>::try_from(numbers(text)?).map_err(|_| "expected four numbers: NX,NY,NZ,D")?;
    let plane = DVec4::from(plane);
    if plane.is_finite() && plane.truncate() != DVec3::ZERO { Ok(plane) } else { Err("no plane".into()) }
}

fn parse_line_kind(text: &str) -> Result<(String, LineKind), String> {
    let (material, kind) = text.rsplit_once('=').ok_or("expected MATERIAL=KIND")?;
    let kind = match kind {
        "normals" => LineKind::Normals,
        "vertex-colors" => LineKind::VertexColor,
        "texture" => LineKind::Texture,
        "regions" => LineKind::Regions,
        "none" => LineKind::None,
        other => return Err(format!("{other:?} is none of normals, vertex-colors, texture, regions, none")),
    };
    Ok((material.to_owned(), kind))
}

pub fn elapsed_ms(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// Arguments that are within their ranges.
pub struct Shot<'a> {
    pub style: Style,
    pub backend: Backend,
    pub samples: u32,
    pub memory_bytes: u64,
    size: (u32, u32),
    framing: Framing,
    options: &'a FramingOptions,
}

/// A model, ready to be drawn.
pub struct Prepared {
    pub scene: Scene,
    pub warnings: Vec<Warning>,
    pub loaded_ms: f64,
    pub prepared_ms: f64,
}

impl ShotOptions {
    /// The files that are read, apart from those that a model names.
    pub fn inputs(&self) -> Vec<&Path> {
        [Some(&*self.input), style_file(&self.style)].into_iter().flatten().collect()
    }

    /// Checks everything that can be checked without the model.
    pub fn check(&self) -> Result<Shot<'_>, HarnessError> {
        let most = f64::from(MOST_SAMPLES);
        let samples = checked("samples", f64::from(self.samples), 1.0, most, "1..=64")? as u32;
        let memory = checked("memory", self.max_memory, 0.0, 1e6, "0..=1e6 GiB")? * f64::from(1 << 30);
        self.loading.check([&self.input])?;
        let style = known_style(&self.style)?;
        let framing = self.framing.checked(&style)?;
        let backend = Backend::from(self.backend);
        // The executor depends on the model, but a picture too large for either is rejected at once.
        check_picture(&style, self.size, samples, backend == Backend::Gpu, memory as u64)?;
        checked("segments", f64::from(self.segments), 1.0, 1024.0, "1..=1024")?;
        Ok(Shot {
            style,
            backend,
            samples,
            memory_bytes: memory as u64,
            size: self.size,
            framing,
            options: &self.framing,
        })
    }

    /// Loads the model, and says what there is to warn of.
    pub fn prepare(&self) -> Result<Prepared, HarnessError> {
        let start = Instant::now();
        let mut loaded = load(&self.input, &self.loading)?;
        self.framing.turn(&mut loaded);
        let loaded_ms = elapsed_ms(start);
        let warn = |warnings: &[Warning]| {
            for warning in warnings {
                tell(&format!("npr: {}", one_line(&format!("{}: warning: {warning}", self.input.display()))));
            }
        };
        warn(&loaded.warnings);
        let start = Instant::now();
        let Loaded { mut meshes, objects, warnings, weld } = loaded;
        if self.segments > 1 {
            for mesh in &mut meshes {
                *mesh = pn_triangles::tessellate(mesh, self.segments)?;
            }
        }
        let mut scene = Scene::with_objects_welded(meshes, objects, weld)?;
        // Meshes may have the same to say.
        let mut of_edges: Vec<Warning> = Vec::new();
        for text in scene.meshes().iter().flat_map(|mesh| mesh.edges().warnings()) {
            match of_edges.iter_mut().find(|known| known.text == text) {
                Some(known) => known.count += 1,
                None => of_edges.push(text.into()),
            }
        }
        warn(&of_edges);
        let of_framing = self.framing.apply(&mut scene)?;
        warn(&of_framing);
        let warnings = [warnings, of_edges, of_framing].concat();
        scene.clip = self.clip.map(|plane| self.framing.plane(&scene, plane));
        for (material, kind) in &self.inner_lines {
            scene.set_line_kind(material, *kind)?;
        }
        Ok(Prepared { scene, warnings, loaded_ms, prepared_ms: elapsed_ms(start) })
    }
}

impl Shot<'_> {
    /// The view of a scene.
    pub fn view(&self, scene: &Scene) -> View {
        let (width, height) = self.size;
        let framing = self.options.of_scene(&self.framing, scene);
        let camera = Camera::framed(scene.framed_corners(), f64::from(width) / f64::from(height), &framing);
        View { samples: self.samples, ..View::new(camera, self.size) }
    }
}
