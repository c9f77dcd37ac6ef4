//! Errors of configurations on the scene at hand, for budgets of errors.

use super::{light, lines, strokes};
use crate::budget::{Configuration, Measure};
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::picture::Image;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::style::{Lines, Style};
use crate::truth::lines::TrueLines;
use crate::variant::{Part, Setup};
use crate::view::View;
use std::collections::HashMap;

/// The largest picture in which colours are measured, px: their truth takes 64 samples a pixel. Larger pictures are scaled
/// down, in which errors at borders weigh more. Strokes are measured in the whole picture.
const TONE_SIZE: (u32, u32) = (480, 270);

/// A measure, the executor that draws, and the variants that it depends on.
type Key = (Measure, String, Vec<(Part, &'static str)>);

/// Measures configurations of a scene in a view. What they have in common is measured once.
pub struct Survey<'a> {
    scene: &'a Scene,
    view: View,
    style: &'a Style,
    executors: &'a [Executor],
    /// The largest picture in which colours are measured, px.
    tone_size: (u32, u32),
    /// Whether the executor of a configuration draws, instead of the CPU, which draws alike.
    on_its_executor: bool,
    known: HashMap<Key, f64>,
    lines: Option<TrueLines>,
    light: Option<Image>,
    strokes: Option<Vec<strokes::Window>>,
    #[cfg(feature = "gpu")]
    shadows: Option<crate::truth::shadows::States>,
}

impl<'a> Survey<'a> {
    /// Nothing is measured yet.
    ///
    /// - `style`: as it is asked for;
    /// - `executors`: those that configurations name.
    pub fn new(scene: &'a Scene, view: View, style: &'a Style, executors: &'a [Executor]) -> Self {
        Self {
            scene,
            view: View { samples: 1, ..view },
            style,
            executors,
            tone_size: TONE_SIZE,
            on_its_executor: false,
            known: HashMap::new(),
            lines: None,
            light: None,
            strokes: None,
            #[cfg(feature = "gpu")]
            shadows: None,
        }
    }

    /// The same, measured in whole and on the executor of each configuration: to check what a survey found.
    pub fn in_full(self) -> Self {
        Self { tone_size: (u32::MAX, u32::MAX), on_its_executor: true, ..self }
    }

    /// An error of a configuration, 0..=1; 0 for what its style does not have.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn measure(&mut self, configuration: &Configuration, measure: Measure) -> Result<f64, HarnessError> {
        let cpu = Executor::Cpu { why: None };
        let executors = self.executors;
        let own = executors.iter().find(|executor| executor.name() == configuration.executor).unwrap_or(&cpu);
        // The CPU makes the pictures of lines and tones, which an adapter makes alike.
        let executor = if self.on_its_executor || measure == Measure::Shadows { own } else { &cpu };
        let key = (measure, executor.name(), configuration.of_measure(measure));
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let error = self.error(&configuration.setup, executor, measure)?;
        self.known.insert(key, error);
        Ok(error)
    }

    /// An error of a setup on an executor, 0..=1; 0 for what its style does not have.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn error(&mut self, setup: &Setup, executor: &Executor, measure: Measure) -> Result<f64, HarnessError> {
        match measure {
            Measure::Lines => self.lines(setup, executor),
            Measure::Tone => self.tone(setup, executor),
            Measure::Shadows => self.shadows(setup, executor),
        }
    }

    fn lines(&mut self, setup: &Setup, executor: &Executor) -> Result<f64, HarnessError> {
        if setup.style.lines == Lines::NONE {
            return Ok(0.0);
        }
        let truth = self.lines.get_or_insert_with(|| lines::asked_of_style(self.scene, &self.view, self.style));
        lines::error_of_style(executor, self.scene, self.view, setup, truth)
    }

    /// The size in which colours are measured, px.
    fn tone_size(&self) -> (u32, u32) {
        let scale = (f64::from(self.tone_size.0) / f64::from(self.view.size.0))
            .min(f64::from(self.tone_size.1) / f64::from(self.view.size.1))
            .min(1.0);
        let scaled = |side: u32| ((f64::from(side) * scale).round() as u32).max(1);
        (scaled(self.view.size.0), scaled(self.view.size.1))
    }

    fn tone(&mut self, setup: &Setup, executor: &Executor) -> Result<f64, HarnessError> {
        match &setup.style.shade {
            Shade::Paper => Ok(0.0),
            Shade::Hatch(_) => {
                let truth = match self.strokes.take() {
                    Some(truth) => truth,
                    None => strokes::truth(self.scene, &self.view, self.style)?,
                };
                let truth = self.strokes.insert(truth);
                strokes::error_of_style(executor, self.scene, self.view, setup, truth)
            }
            _ => {
                let view = View { size: self.tone_size(), ..self.view };
                let bare = |style: &Style| Style { lines: Lines::NONE, shadow: None, ..style.clone() };
                let truth = match self.light.take() {
                    Some(truth) => truth,
                    None => light::truth(self.scene, &view, &bare(self.style))?,
                };
                let truth = self.light.insert(truth);
                let view = View { samples: setup.samples, ..view };
                let style = bare(&setup.style);
                let image = executor.render(&Picture::new(self.scene, &style, view), &|_| {})?;
                Ok(light::differences(&image, truth)[0] / 255.0)
            }
        }
    }

    #[cfg(not(feature = "gpu"))]
    fn shadows(&mut self, _setup: &Setup, _executor: &Executor) -> Result<f64, HarnessError> {
        Ok(0.0)
    }

    #[cfg(feature = "gpu")]
    fn shadows(&mut self, setup: &Setup, executor: &Executor) -> Result<f64, HarnessError> {
        use crate::truth::shadows::{ShadowShot, States, states_on_device};
        // The CPU follows the rays that are the truth.
        let (Some(shadow), Executor::Gpu(context)) = (setup.style.shadow, executor) else { return Ok(0.0) };
        let shot = ShadowShot { name: "", light: self.style.lights[0], camera: self.view.camera };
        let size = self.view.size;
        let truth = match self.shadows.take() {
            Some(truth) => truth,
            None => States::by_rays(self.scene, &shot, size, glam::DVec2::ZERO)?,
        };
        let truth = self.shadows.insert(truth);
        match states_on_device(context, self.scene, &shot, shadow.method, None, size) {
            Ok(states) => Ok(states.difference(truth).share),
            // It cannot be made this way.
            Err(HarnessError::ShadowMapLight { .. } | HarnessError::ParallelVolumes) => Ok(1.0),
            Err(error) => Err(error),
        }
    }
}
