//! What a chart is, and what it is measured with.

use super::table::Row;
use crate::camera::{Camera, Framing};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::measure::Rounds;
use crate::scene::Scene;
use std::path::Path;

/// A chart.
#[derive(Clone, Copy)]
pub struct Chart {
    /// The name, in kebab case: also that of its files.
    pub name: &'static str,
    /// A heading.
    pub title: &'static str,
    /// The error on the axis: the first of a row's errors.
    pub error: &'static str,
    /// What is measured, against what, in a sentence or two.
    pub about: &'static str,
    /// The choices of the API that it shows beside those of [`crate::variant::Variant::choices`].
    pub choices: &'static [&'static str],
    /// Measures it.
    pub run: fn(&Lab<'_>) -> Result<Vec<Row>, HarnessError>,
}

/// A scene that charts measure, and its view.
pub struct Subject {
    /// The name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The camera.
    pub camera: Camera,
}

impl Subject {
    /// A scene, framed.
    pub fn framed(name: &str, scene: Scene, size: (u32, u32), framing: &Framing) -> Self {
        let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), framing);
        Self { name: name.to_owned(), scene, camera }
    }
}

/// What charts measure with.
pub struct Lab<'a> {
    /// The executors, the reference of the time axis first.
    pub executors: &'a [Executor],
    /// The scenes.
    pub subjects: &'a [Subject],
    /// The size of the pictures, px.
    pub size: (u32, u32),
    /// How often.
    pub rounds: Rounds,
    /// Called with each variant that an executor cannot render, and the reason.
    pub skipped: &'a dyn Fn(&str),
    /// Called with the fraction done, 0..=1.
    pub progress: &'a (dyn Fn(f64) + Sync),
}

/// The built-in scenes: smooth, angular, and a still life of both. The first `count` of them.
pub fn built_in_subjects(size: (u32, u32), count: usize) -> Vec<Subject> {
    use npr_mesh::embedded;
    let turned = |yaw_deg: f64, pitch_deg: f64| Framing {
        yaw_rad: yaw_deg.to_radians(),
        pitch_rad: pitch_deg.to_radians(),
        ..Framing::default()
    };
    let still_life = || Subject {
        name: "still life".into(),
        scene: Scene::new(embedded::scene()),
        camera: crate::gallery::still_life_camera(),
    };
    let mut subjects = vec![
        Subject::framed("teapot", Scene::new(embedded::teapot(12)), size, &turned(30.0, 20.0)),
        still_life(),
        Subject::framed("torus", Scene::new(embedded::torus(1.0, 0.4, 96, 48)), size, &turned(20.0, 35.0)),
    ];
    subjects.truncate(count);
    subjects
}

/// Models as subjects, in the default view.
///
/// # Errors
/// Those of [`npr_mesh::load`].
pub fn subject_of_file(
    path: &Path,
    loading: &npr_mesh::LoadOptions,
    size: (u32, u32),
) -> Result<Subject, HarnessError> {
    let scene = Scene::from(npr_mesh::load(path, loading)?);
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Subject::framed(&name, scene, size, &Framing::default()))
}
