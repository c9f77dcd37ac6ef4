//! The gallery: every style on the built-in scene, and artist-controlled lines on a scene that has them.

mod figure_10;
mod painted;

pub(crate) use figure_10::{figure_10, figure_10_styles};
pub use painted::{painted_camera, painted_scene};

use crate::camera::{Camera, Projection};
use crate::error::HarnessError;
use crate::executor::{Backend, CpuReason, Executor, Picture, Rendered, Work};
use crate::scene::Scene;
use crate::style::styles;
use crate::view::View;
use glam::DVec3;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The size of the pictures, px.
pub const SIZE: (u32, u32) = (960, 540);

/// A picture of the gallery.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The path of the file.
    pub path: PathBuf,
    /// A description.
    pub about: String,
    /// Its passes.
    pub passes: Vec<&'static str>,
    /// The time from planning to the picture in memory.
    pub time_ms: f64,
    /// The reason why the CPU rendered it, if the GPU could not.
    pub why_cpu: Option<CpuReason>,
}

/// The camera for which the built-in scene is composed.
pub fn still_life_camera() -> Camera {
    Camera {
        eye: DVec3::new(3.0, 6.2, 14.0),
        target: DVec3::new(0.7, 1.0, 0.9),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: 31f64.to_radians() },
        near: 0.1,
    }
}

/// The work for all pictures.
pub fn work() -> Work {
    let still_life = Scene::new(npr_mesh::embedded::scene());
    let pictures = styles().into_iter().map(|style| (style, SIZE));
    let panels = figure_10_styles().into_iter().map(|style| (style, (SIZE.0 / 2, SIZE.1 / 2)));
    pictures
        .chain(panels)
        .fold(Work::default(), |work, (style, size)| work.and(Work::new(&still_life, &style, size, 1)))
}

/// Renders all styles into `dir`, which is created if necessary. Pictures that the GPU cannot render are rendered on
/// the CPU if `backend` and the environment allow it.
///
/// # Errors
/// [`HarnessError`].
pub fn render(
    executor: &mut Executor,
    backend: Backend,
    dir: &Path,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Vec<Row>, HarnessError> {
    std::fs::create_dir_all(dir).map_err(|source| HarnessError::Write { path: dir.to_owned(), source })?;
    let still_life = (Scene::new(npr_mesh::embedded::scene()), still_life_camera());
    let painted = (painted_scene(), painted_camera());
    let styles = styles();
    let pictures = (styles.len() + 1) as f64;
    let mut rows = Vec::new();
    for (number, style) in styles.iter().enumerate() {
        let start = Instant::now();
        let asks_artists = style.lines.image.is_some_and(|ink| ink.artist.is_some());
        let (scene, camera) = if asks_artists { &painted } else { &still_life };
        let share_of = |within: f64| progress((number as f64 + within) / pictures);
        let picture = Picture::new(scene, style, View::new(*camera, SIZE));
        let Rendered { image, plan, why_cpu } = executor.render_with_fallback(backend, &picture, &share_of)?;
        let time_ms = start.elapsed().as_secs_f64() * 1e3;
        let path = dir.join(format!("{}.png", style.name));
        image.save_png(&path)?;
        let passes = plan.passes.iter().map(|reason| reason.pass).collect();
        rows.push(Row { path, about: style.about.clone(), passes, time_ms, why_cpu });
    }
    let start = Instant::now();
    let (scene, camera) = &still_life;
    let share = |within: f64| progress((styles.len() as f64 + within) / pictures);
    let (image, why_cpu) = figure_10(executor, backend, scene, camera, SIZE, &share)?;
    let time_ms = start.elapsed().as_secs_f64() * 1e3;
    let path = dir.join("figure-10.png");
    image.save_png(&path)?;
    let about = "how shadow outlines come about: hatching, normals negated in shadow, shadows, colours".to_owned();
    rows.push(Row { path, about, passes: vec!["four pictures"], time_ms, why_cpu });
    Ok(rows)
}

/// The rows as an aligned table.
pub fn table(rows: &[Row]) -> String {
    let widest = rows.iter().map(|row| row.path.display().to_string().len()).max().unwrap_or(0);
    let mut text = String::new();
    for row in rows {
        let path = row.path.display().to_string();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{path:widest$}  {:>7.1} ms  {}", row.time_ms, row.about);
        let _ = writeln!(text, "{:widest$}              {}", "", row.passes.join("; "));
        if let Some(why) = &row.why_cpu {
            let _ = writeln!(text, "{:widest$}              on the CPU: {why}", "");
        }
    }
    text
}
