//! Checks of the GPU against the reference, and of both against exact solutions.
//!
//! All tolerances for the project's pictures are defined here.

mod image_lines;
mod light;
mod lines;
mod reference;
mod shadow;

pub use reference::{PLACES, Reference, Shot};

use crate::camera::{Camera, Framing};
use crate::compare::{Comparison, ReportRow, Tolerance, compare, html_report, leave_behind};
use crate::cpu::PrimaryHits;
use crate::error::HarnessError;
use crate::executor::{Executor, GpuPolicy, Picture};
use crate::gallery::{painted_camera, painted_scene, still_life_camera};
use crate::picture::Image;
use crate::plan::Plan;
use crate::printed_fins::PrintedLines;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::style::{Lines, Style, style};
use crate::truth::lines::{accuracy, darkness, drawn_centreline, true_lines};
use crate::view::View;
use glam::Vec3;
use npr_imagespace::artist::LineKind as InnerLines;
use npr_mesh::AlphaMode;
use npr_outline::line_style::LineStyle;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};

/// The size of the pictures that are checked, px.
pub const SIZE: (u32, u32) = (640, 360);

/// The largest difference outside the exempt pixels, of 255: two roundings to bytes (lines blend twice) can add up to
/// this.
pub(crate) const SHADING_MAGNITUDE: u8 = 2;
/// The largest difference if a texture is sampled: samplers interpolate with 8 fraction bits.
pub(crate) const TEXTURE_MAGNITUDE: u8 = 4;
/// The largest fraction of the pixels that may be exempt.
pub const EXEMPT_SHARE: f64 = 0.03;
/// Over the whole picture, including exempt pixels, at most [`GROSS_SHARE`] of the pixels may differ by more than this,
/// of 255.
pub(crate) const GROSS_MAGNITUDE: u8 = 16;
/// See [`GROSS_MAGNITUDE`].
pub(crate) const GROSS_SHARE: f64 = 0.005;
/// The distance within which lines agree, px.
pub const WITHIN_PX: f64 = 1.5;
/// The least precision and recall of lines.
pub(crate) const LINE_ACCURACY: f64 = 0.98;

/// The largest fraction of (edge, view) pairs that the plane records may misclassify.
pub(crate) const PLANES_MISCLASSIFIED: f64 = 1e-6;
/// The number of views around a model over which the formats are measured.
pub(crate) const FORMAT_VIEWS: usize = 32;
/// The number of edges above which formats are not measured, to limit the time.
pub(crate) const LARGEST_FORMAT_EDGES: usize = 200_000;
/// The largest relative error of a line's width.
pub(crate) const WIDTH_ERROR: f64 = 0.10;

/// Three views around a model: yaw, pitch in degrees.
pub(crate) const VIEWS: [(f64, f64); 3] = [(30.0, 20.0), (150.0, -10.0), (270.0, 50.0)];

/// A metric of a technique on a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Metric {
    /// The model, or "scene".
    pub model: String,
    /// Yaw and pitch in degrees, or the name of the view.
    pub view: String,
    /// The technique; for pictures, the style.
    pub technique: String,
    /// The name of the metric.
    pub metric: &'static str,
    /// The value.
    pub value: f64,
    /// The limit; `None` if the value is only reported.
    pub limit: Option<Limit>,
    /// Whether the value is within the limit.
    pub pass: bool,
}

/// A bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// At least.
    AtLeast(f64),
    /// At most.
    AtMost(f64),
}

impl Limit {
    /// Whether a value is within the bound.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::AtLeast(limit) => value >= limit,
            Self::AtMost(limit) => value <= limit,
        }
    }
}

/// All metrics.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The executor that rendered the pictures.
    pub executor: String,
    /// Whether a GPU rendered them.
    pub on_device: bool,
    /// The checks that were skipped, and why.
    pub skipped: Vec<String>,
    /// The metrics, in the order of the checks.
    pub metrics: Vec<Metric>,
    /// The report page for failed comparisons, and its pictures.
    pub left_behind: Vec<PathBuf>,
}

impl Report {
    /// Whether every limit holds and at least one check was not skipped.
    pub fn passed(&self) -> bool {
        self.metrics.iter().all(|metric| metric.pass) && !(self.metrics.is_empty() && self.on_device)
    }
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (limit, verdict) = match self.limit {
            None => (String::new(), ""),
            Some(Limit::AtLeast(limit)) => (format!(">= {limit}"), if self.pass { "pass" } else { "FAIL" }),
            Some(Limit::AtMost(limit)) => (format!("<= {limit}"), if self.pass { "pass" } else { "FAIL" }),
        };
        // Wide enough for the names of the known models.
        let Metric { model, view, technique, metric, value, .. } = self;
        write!(f, "{model:22}  {view:12} {technique:15} {metric:44} {value:>10.5}  {limit:10} {verdict}")
    }
}

/// The metrics, followed by [`Report::summary`].
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "on {}", self.executor)?;
        for metric in &self.metrics {
            writeln!(f, "{metric}")?;
        }
        write!(f, "{}", self.summary())
    }
}

impl Report {
    /// One line each for the skipped checks, the location of pictures, and the number of limits that hold.
    pub fn summary(&self) -> String {
        let skipped = self.skipped.iter().map(|skipped| format!("skipped: {skipped}\n"));
        let left_behind = self.left_behind.iter().map(|path| format!("see {}\n", path.display()));
        let failed = self.metrics.iter().filter(|m| !m.pass).count();
        let limited = self.metrics.iter().filter(|m| m.limit.is_some()).count();
        let verdict = format!("{} passed, {failed} failed\n", limited - failed);
        skipped.chain(left_behind).chain([verdict]).collect()
    }
}

/// The state of a running check.
struct Checker<'a> {
    executor: &'a Executor,
    styles: &'a [Style],
    out: &'a Path,
    tell: &'a dyn Fn(&Metric),
    skipped: Vec<String>,
    metrics: Vec<Metric>,
    rows: Vec<ReportRow>,
}

/// Checks models, loaded with the options `loading`, or the built-in scenes if there are none. With `styles`, only
/// pictures of these styles are checked. `tell` is called with each metric as soon as it is known.
///
/// # Errors
/// [`HarnessError`]; exceeding a limit is not an error.
pub fn run(
    executor: &Executor,
    inputs: &[PathBuf],
    loading: &npr_mesh::LoadOptions,
    styles: &[Style],
    out: &Path,
    tell: &dyn Fn(&Metric),
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Report, HarnessError> {
    let mut checker =
        Checker { executor, styles, out, tell, skipped: Vec::new(), metrics: Vec::new(), rows: Vec::new() };
    if styles.is_empty() {
        checker.widths()?;
        if inputs.is_empty() {
            checker.normals()?;
        }
    }
    let total = inputs.len().max(1) as f64;
    if inputs.is_empty() {
        let scene = Scene::new(npr_mesh::embedded::scene());
        let camera = still_life_camera();
        checker.model("scene", &scene, &[("composed".into(), camera)], &|s| progress(s / 2.0))?;
        if styles.is_empty() {
            checker.borders("scene", "composed", &scene, &camera)?;
            let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
            checker.strokes("scene", "composed", &hits)?;
            checker.shadows("scene", "composed", &hits)?;
        }
        let painted = [("composed".into(), painted_camera())];
        checker.model("painted", &painted_scene(), &painted, &|s| progress(0.5 + s / 2.0))?;
    }
    for (number, input) in inputs.iter().enumerate() {
        let scene = Scene::from(npr_mesh::load(input, loading)?);
        let name = input.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        let views = VIEWS.map(|(yaw, pitch)| {
            let framing = Framing { yaw_rad: yaw.to_radians(), pitch_rad: pitch.to_radians(), ..Framing::default() };
            (format!("{yaw} {pitch}"), Camera::framed(scene.corners(), aspect, &framing))
        });
        checker.model(&name, &scene, &views, &|share| progress((number as f64 + share) / total))?;
        if let (true, Some((view, camera))) = (styles.is_empty(), views.first()) {
            checker.borders(&name, view, &scene, camera)?;
            let hits = PrimaryHits::kept(&scene, View::new(*camera, SIZE), PLACES);
            checker.strokes(&name, view, &hits)?;
            checker.shadows(&name, view, &hits)?;
        }
    }
    checker.finish()
}

/// Checks one scene from the given named views, without [`run`]'s checks of line widths, normals and band borders.
///
/// # Errors
/// [`HarnessError`]; exceeding a limit is not an error.
pub fn scene(
    executor: &Executor,
    name: &str,
    scene: &Scene,
    views: &[(String, Camera)],
    out: &Path,
) -> Result<Report, HarnessError> {
    let tell = &|_: &Metric| {};
    let mut checker =
        Checker { executor, styles: &[], out, tell, skipped: Vec::new(), metrics: Vec::new(), rows: Vec::new() };
    checker.model(name, scene, views, &|_| {})?;
    checker.finish()
}

/// The largest difference allowed outside the exempt pixels, of 255.
pub fn magnitude(plan: &Plan) -> u8 {
    if plan.looks_up || plan.hatch().is_some() { TEXTURE_MAGNITUDE } else { SHADING_MAGNITUDE }
}

/// Whether a picture agrees with its reference.
pub fn agrees(comparison: &Comparison, magnitude: u8) -> bool {
    comparison.passes(&[Tolerance { magnitude, count: 0 }])
        && comparison.exempt_share() <= EXEMPT_SHARE
        && gross_share(comparison) <= GROSS_SHARE
}

fn gross_share(comparison: &Comparison) -> f64 {
    comparison.over_all(GROSS_MAGNITUDE) as f64 / comparison.pixels.max(1) as f64
}

impl Checker<'_> {
    fn model(
        &mut self,
        name: &str,
        scene: &Scene,
        views: &[(String, Camera)],
        progress: &dyn Fn(f64),
    ) -> Result<(), HarnessError> {
        let flat = scene.flattened();
        for (number, (view, camera)) in views.iter().enumerate() {
            let hits = PrimaryHits::kept(scene, View::new(*camera, SIZE), PLACES);
            if !self.styles.is_empty() {
                for style in self.styles {
                    self.picture(name, view, &hits, style)?;
                }
                progress((number + 1) as f64 / views.len() as f64);
                continue;
            }
            let artist = scene.line_kinds.iter().any(|&kind| kind != InnerLines::Normals);
            let of_edges = scene.clip.is_none();
            let wanted = |style: &&&str| match **style {
                "cartoon" | "lines" | "printed-fins" | "gooch" | "two-lights" | "wash" | "wrapped" => of_edges,
                "artist" => artist,
                _ => true,
            };
            // `often` is rendered in every view; the styles of `light`, which differ from those in light, parameters or
            // size, only in the first.
            let often = ["cartoon", "lines", "printed-fins", "ink-image", "artist"];
            let light = ["gooch", "two-lights", "wash", "wrapped", "vertex-light", "printed-bands", "printed-gooch"];
            let once = ["ink-thick", "ink-fine"].iter().chain(light.iter().filter(|_| !artist));
            for name_of_style in often.iter().chain(once.filter(|_| number == 0)).filter(wanted) {
                let style = style(name_of_style).expect("a style of this crate");
                self.picture(name, view, &hits, &style)?;
            }
            if of_edges {
                self.lines(name, view, (scene, &flat), camera)?;
                self.image_lines(name, view, (scene, &flat), camera)?;
            }
            #[cfg(feature = "gpu")]
            if of_edges {
                self.line_finder(name, view, scene, camera)?;
            }
            progress((number + 1) as f64 / views.len() as f64);
        }
        if self.styles.is_empty() { self.formats(name, &flat) } else { Ok(()) }
    }

    fn add(
        &mut self,
        model: &str,
        view: &str,
        technique: &str,
        metric: &'static str,
        value: f64,
        limit: Option<Limit>,
    ) {
        let pass = limit.is_none_or(|limit| limit.holds(value));
        let technique = technique.to_owned();
        let metric = Metric { model: model.into(), view: view.into(), technique, metric, value, limit, pass };
        (self.tell)(&metric);
        self.metrics.push(metric);
    }

    /// The pictures of the hatched styles.
    fn strokes(&mut self, model: &str, view: &str, hits: &PrimaryHits<'_>) -> Result<(), HarnessError> {
        for name in ["hatch", "hatch-planes", "hatch-color", "printed-hatch"] {
            if hits.scene.clip.is_none() {
                self.picture(model, view, hits, &style(name).expect("a style of this crate"))?;
            }
        }
        Ok(())
    }

    /// Compares the GPU's picture with the reference.
    fn picture(&mut self, model: &str, view: &str, hits: &PrimaryHits<'_>, style: &Style) -> Result<(), HarnessError> {
        let technique = style.name.as_str();
        if self.executor.is_cpu() {
            return Ok(());
        }
        let picture = Picture::new(hits.scene, style, hits.view);
        let Some((actual, plan)) = self.render(model, view, technique, &picture)? else { return Ok(()) };
        let magnitude = magnitude(&plan);
        let tolerance = Tolerance { magnitude, count: 0 };
        let mut reference = Reference::new(Shot { hits, style, plan: &plan })?;
        let mut comparison = compare(&reference.image, &actual, &reference.exempt)?;
        if !comparison.passes(&[tolerance]) {
            reference.look_closer()?;
            comparison = compare(&reference.image, &actual, &reference.exempt)?;
        }
        let gross = gross_share(&comparison);
        self.add(
            model,
            view,
            technique,
            "largest difference of 255, not exempt",
            f64::from(comparison.worst),
            Some(Limit::AtMost(f64::from(magnitude))),
        );
        self.add(
            model,
            view,
            technique,
            "share of exempt pixels",
            comparison.exempt_share(),
            Some(Limit::AtMost(EXEMPT_SHARE)),
        );
        self.add(
            model,
            view,
            technique,
            "share of pixels off by over 16 of 255",
            gross,
            Some(Limit::AtMost(GROSS_SHARE)),
        );
        if !agrees(&comparison, magnitude) {
            self.leave(
                &format!("{model}-{view}-{technique}"),
                &reference.image,
                &actual,
                &reference.exempt,
                comparison,
                tolerance,
            )?;
        }
        Ok(())
    }

    /// Renders a picture with its plan. Returns `None` and records a skipped check if the picture exceeds the device's
    /// limits and no device is required.
    fn render(
        &mut self,
        model: &str,
        view: &str,
        technique: &str,
        picture: &Picture<'_>,
    ) -> Result<Option<(Image, Plan)>, HarnessError> {
        let plan = picture.plan(self.executor.capabilities());
        let rendered = plan.and_then(|plan| Ok((self.executor.execute(picture.scene, &plan, &|_| {})?, plan)));
        let error = match rendered {
            Ok(rendered) => return Ok(Some(rendered)),
            Err(error) => error,
        };
        if error.is_device_limit() && GpuPolicy::from_env()? != GpuPolicy::Required {
            self.skipped.push(format!("{technique} of {model} ({view}): {error}"));
            return Ok(None);
        }
        Err(error)
    }

    fn leave(
        &mut self,
        name: &str,
        expected: &Image,
        actual: &Image,
        exempt: &[bool],
        comparison: Comparison,
        tolerance: Tolerance,
    ) -> Result<(), HarnessError> {
        let images = leave_behind(self.out, name, expected, actual, exempt)?;
        self.rows.push(ReportRow { name: name.to_owned(), images, comparison, tolerances: vec![tolerance] });
        Ok(())
    }

    /// Compares lines 1 px wide with the exact visible contours.
    fn lines(
        &mut self,
        model: &str,
        view: &str,
        (scene, flat): (&Scene, &Scene),
        camera: &Camera,
    ) -> Result<(), HarnessError> {
        let look = LineStyle { width_px: [1.0; 5], ink: [0.0, 0.0, 0.0, 1.0] };
        let corrected = one_px_style(Lines::edges(look));
        let printed = one_px_style(Lines::printed(PrintedLines { width_px: 1.0, ..PrintedLines::default() }));
        let truth = true_lines(flat, camera, SIZE, f64::from(corrected.crease_angle_rad));
        // The edges of an alpha-tested face are drawn only where a part of the face is visible, and the edges of the
        // file do not include the border that alpha creates. The exact contours account for neither.
        let exact = !scene.materials().iter().any(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }));
        if !exact {
            self.skipped
                .push(format!("limits on the lines of {model} ({view}): faces cut out by alpha have no exact lines"));
        }
        for (style, technique, limited) in [(corrected, "lines", true), (printed, "printed fins", false)] {
            let picture = Picture::new(scene, &style, View::new(*camera, SIZE));
            let Some((image, _)) = self.render(model, view, technique, &picture)? else { continue };
            let found = accuracy(&truth, &drawn_centreline(&darkness(&image), SIZE.0, SIZE.1), WITHIN_PX);
            let limit = (limited && exact).then_some(Limit::AtLeast(LINE_ACCURACY));
            self.add(model, view, technique, "precision within 1.5 px", found.precision, limit);
            self.add(model, view, technique, "recall within 1.5 px", found.recall, limit);
        }
        Ok(())
    }

    fn finish(self) -> Result<Report, HarnessError> {
        let mut skipped = self.skipped;
        if self.executor.is_cpu() {
            skipped
                .push(format!("every comparison of GPU with CPU, and the line finder: {}", self.executor.describe()));
        }
        let mut left_behind = Vec::new();
        if !self.rows.is_empty() {
            left_behind.push(html_report(self.out, &self.rows)?);
            left_behind.extend(self.rows.into_iter().flat_map(|row| row.images));
        }
        let on_device = !self.executor.is_cpu();
        Ok(Report { executor: self.executor.describe(), on_device, skipped, metrics: self.metrics, left_behind })
    }
}

/// Only lines, black on white.
pub(crate) fn one_px_style(lines: Lines) -> Style {
    Style {
        name: "one-px".into(),
        about: String::new(),
        paper: Vec3::ONE,
        shade: Shade::Paper,
        normals: Default::default(),
        mesh_normals: false,
        lights: vec![Default::default()],
        shadow: None,
        lines,
        crease_angle_rad: 45f32.to_radians(),
        file_edges: true,
    }
}
