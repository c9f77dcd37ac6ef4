//! A cost model of the CPU and of a software adapter, to choose between them.
//!
//! Both run on the same cores, so the number of cores hardly matters. An adapter has a fixed cost for opening the
//! device and compiling pipelines, but a lower cost per pixel. Ray casting builds a hierarchy over the faces, which
//! takes as long as uploading them.
//!
//! The numbers were measured on two cores with Mesa 22.3's lavapipe, over the built-in styles, models of 12 to 4.4
//! million faces and pictures of 320 × 180 to 2560 × 1440 px. They predict which of the two is faster, not the time on
//! another machine. `cargo bench -p npr-harness --bench orbit` compares the two.

use crate::image_lines::InkScale;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shadow::ShadowMethod;
use crate::style::Style;

/// The expected time for pictures of a scene on either executor, ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// On the CPU, once per scene: building the hierarchy, part of which overlaps other work.
    hierarchy_ms: f64,
    /// On the CPU: all pictures.
    rays_ms: f64,
    /// On a software adapter: all pictures and their preparation.
    adapter_ms: f64,
}

/// Opening and closing the device of a software adapter that has been found.
const OPEN_MS: f64 = 20.0;
/// Compiling a picture's pipelines, without compute shaders, and drawing its first pixel.
const PIPELINES_MS: f64 = 45.0;
/// Per face: building the hierarchy; the scan for lines; the upload.
const HIERARCHY_MS: f64 = 8e-5;
const SCAN_MS: f64 = 5e-6;
const UPLOAD_MS: f64 = 9e-5;

/// The time per sample, on the CPU and on a software adapter.
struct PerSample {
    cpu_ms: f64,
    adapter_ms: f64,
}

/// Lighting and edge lines.
const LIT: PerSample = PerSample { cpu_ms: 1.25e-4, adapter_ms: 3.5e-5 };
/// Additional time for strokes.
const HATCHED: PerSample = PerSample { cpu_ms: 3.5e-5, adapter_ms: 1.3e-4 };
/// Additional time for shadow volumes or shadow rays.
const SHADOWED: PerSample = PerSample { cpu_ms: 9e-5, adapter_ms: 1.2e-4 };
/// Image-space lines from the picture's geometry pass, per pixel of the ink.
const INKED: PerSample = PerSample { cpu_ms: 5e-5, adapter_ms: 1e-5 };
/// Image-space lines with a separate geometry pass, per pixel of the ink.
const INKED_SEPARATELY: PerSample = PerSample { cpu_ms: 1.35e-4, adapter_ms: 4e-5 };

impl Work {
    /// The work for one picture.
    ///
    /// `samples` is the number of samples along each axis of a pixel.
    pub fn new(scene: &Scene, style: &Style, size: (u32, u32), samples: u32) -> Self {
        Self::sequence(scene, style, size, samples, 1)
    }

    /// The work for a number of frames rendered with the same resources, where anything may move but the meshes are
    /// constant.
    pub fn sequence(scene: &Scene, style: &Style, (width, height): (u32, u32), samples: u32, frames: u32) -> Self {
        let pixels = f64::from(width) * f64::from(height);
        let (faces, frames) = (scene.face_count() as f64, f64::from(frames));
        let count = pixels * f64::from(samples).powi(2);
        let ink = style.lines.image.map(|ink| ink.scale);
        let volumes = style.shadow.is_some_and(|shadow| shadow.method == ShadowMethod::Volumes);
        let parts = [
            (LIT, count),
            (HATCHED, if matches!(style.shade, Shade::Hatch(_)) { count } else { 0.0 }),
            (SHADOWED, if volumes { count } else { 0.0 }),
            (INKED, if ink == Some(InkScale::One) && samples == 1 { pixels } else { 0.0 }),
            (
                INKED_SEPARATELY,
                match ink {
                    Some(InkScale::Half) => pixels / 4.0,
                    Some(InkScale::Double) => pixels * 4.0,
                    Some(InkScale::One) if samples > 1 => pixels,
                    Some(InkScale::One) | None => 0.0,
                },
            ),
        ];
        let sum = |of: fn(&PerSample) -> f64| parts.iter().map(|(part, count)| of(part) * count).sum::<f64>();
        Self {
            hierarchy_ms: HIERARCHY_MS * faces,
            rays_ms: frames * (SCAN_MS * faces + sum(|part| part.cpu_ms)),
            adapter_ms: PIPELINES_MS + UPLOAD_MS * faces + frames * sum(|part| part.adapter_ms),
        }
    }

    /// Adds pictures of the same scene, each with its own pipelines.
    pub fn and(self, other: Self) -> Self {
        Self {
            hierarchy_ms: self.hierarchy_ms.max(other.hierarchy_ms),
            rays_ms: self.rays_ms + other.rays_ms,
            adapter_ms: self.adapter_ms + other.adapter_ms,
        }
    }

    /// Whether the CPU is expected to be at least as fast as a software adapter.
    pub fn is_sooner_on_cpu(&self) -> bool {
        self.cpu_ms() <= self.software_adapter_ms()
    }

    /// The expected time on the CPU, ms.
    pub fn cpu_ms(&self) -> f64 {
        self.hierarchy_ms + self.rays_ms
    }

    /// The expected time on a software adapter, including opening it, ms.
    pub fn software_adapter_ms(&self) -> f64 {
        OPEN_MS + self.adapter_ms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::style;

    fn sooner_on_cpu(scene: &Scene, name: &str, size: (u32, u32), frames: u32) -> bool {
        Work::sequence(scene, &style(name).expect("a style of this crate"), size, 1, frames).is_sooner_on_cpu()
    }

    /// Measured times of whole processes, CPU against adapter: 9 and 83 ms; 356 and 429; 609 and 276; 459 and 195; for
    /// a frame of a sequence 94 and 27.
    #[test]
    fn what_was_sooner_when_measured_is_taken() {
        let scene = Scene::new(npr_mesh::embedded::scene());
        assert!(sooner_on_cpu(&scene, "toon", (320, 180), 1));
        assert!(sooner_on_cpu(&scene, "hatch", (1280, 720), 1));
        assert!(!sooner_on_cpu(&scene, "ink-thick", (1280, 720), 1));
        assert!(!sooner_on_cpu(&scene, "cartoon", (2560, 1440), 1));
        assert!(!sooner_on_cpu(&scene, "cartoon", (1280, 720), 60));
    }

    #[test]
    fn pictures_add_up_and_the_hierarchy_is_built_once() {
        let scene = Scene::new(npr_mesh::embedded::scene());
        let cartoon = style("cartoon").expect("a style of this crate");
        let one = Work::new(&scene, &cartoon, (640, 360), 1);
        let two = one.and(one);
        approx::assert_relative_eq!(two.cpu_ms(), 2.0 * one.cpu_ms() - one.hierarchy_ms);
        approx::assert_relative_eq!(two.software_adapter_ms(), 2.0 * one.software_adapter_ms() - OPEN_MS);
        let finer = Work::new(&scene, &cartoon, (640, 360), 2);
        assert!((finer.rays_ms - 4.0 * one.rays_ms).abs() < 4.0 * SCAN_MS * scene.face_count() as f64);
    }
}
