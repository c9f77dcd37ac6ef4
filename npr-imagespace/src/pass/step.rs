//! One step of dilation or erosion, and n of them by ping-pong: see [`crate::morphology`] for what they do.
//!
//! Outside the picture there is paper for a dilation and ink for an erosion.

use super::fullscreen::{Bound, Fullscreen, Output, flag};
use super::target::{InkTarget, PassTarget, check_ink, texture_size_px};
use crate::ImageSpaceError;
use crate::composite::Composite;
use crate::morphology::{Kernel, Operation};

pub(super) const STEP: &[(&str, &str)] = &[("pass/step.wgsl", include_str!("step.wgsl"))];

/// One step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The largest ink of the kernel's pixels: [`crate::morphology::dilate`].
    Dilate(Kernel),
    /// The smallest: [`crate::morphology::erode`].
    Erode(Kernel),
    /// [`crate::morphology::ink_dilate_soft_cross`].
    SoftCross,
    /// [`crate::morphology::ink_dilate_soft_diagonal`].
    SoftDiagonal {
        /// From 0.25, softest, to 1, hard; finite and not negative.
        threshold: f32,
    },
    /// [`crate::morphology::ink_dilate_soft_diagonal_printed`], clamped by the target.
    SoftDiagonalPrinted {
        /// As in [`Step::SoftDiagonal`].
        threshold: f32,
    },
}

impl Step {
    /// The form's number in the WGSL, whether it erodes, what its kernel is and the threshold.
    fn form(self) -> (u8, bool, Kernel, f32) {
        match self {
            Self::Dilate(kernel) => (0, false, kernel, 0.0),
            Self::Erode(kernel) => (0, true, kernel, 0.0),
            Self::SoftCross => (1, false, Kernel::Cross, 0.0),
            Self::SoftDiagonal { threshold } => (2, false, Kernel::Diagonal, threshold),
            Self::SoftDiagonalPrinted { threshold } => (3, false, Kernel::Diagonal, threshold),
        }
    }
}

/// The pipeline of one step.
#[derive(Debug)]
pub struct StepPass {
    draw: Fullscreen,
}

impl StepPass {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// If a threshold is negative or not finite; [`ImageSpaceError::SrgbPicture`], [`ImageSpaceError::PictureFormat`].
    pub fn new(device: &wgpu::Device, step: Step, target: InkTarget) -> Result<Self, ImageSpaceError> {
        target.check(device)?;
        let (form, eroding, kernel, threshold) = step.form();
        if !(threshold >= 0.0 && threshold.is_finite()) {
            return Err(ImageSpaceError::StepThreshold { threshold });
        }
        let constants = [
            ("form", f64::from(form)),
            flag("eroding", eroding),
            flag("diagonal", kernel != Kernel::Cross),
            flag("cross_taps", kernel != Kernel::Diagonal),
            ("threshold", f64::from(threshold)),
        ];
        let draw = Fullscreen::new(device, "step", STEP, &[Bound::Float], &constants, Output::Ink(target));
        Ok(Self { draw })
    }

    /// Records the step over `ink`, of format [`super::INK_FORMAT`] and the target's size, and another texture than the
    /// target.
    ///
    /// # Errors
    /// If a texture is not as [`crate::pass`] says.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        ink: &wgpu::TextureView,
        target: &PassTarget<'_>,
    ) -> Result<(), ImageSpaceError> {
        let size = self.draw.check(target)?;
        check_ink(ink, Some(size))?;
        self.draw.record(device, encoder, &[wgpu::BindingResource::TextureView(ink)], target);
        Ok(())
    }
}

/// The hard steps of a kernel, n at a time.
#[derive(Debug)]
pub struct PingPong {
    dilate: Fullscreen,
    erode: Fullscreen,
}

impl PingPong {
    /// Makes the pipelines.
    pub fn new(device: &wgpu::Device, kernel: Kernel) -> Self {
        let hard = |step| StepPass::new(device, step, InkTarget::Ink).expect("hard steps have no threshold").draw;
        Self { dilate: hard(Step::Dilate(kernel)), erode: hard(Step::Erode(kernel)) }
    }

    /// Records `steps` steps of an operation, [`crate::morphology::ping_pong`], alternating between two ink pictures of
    /// one size. The first of them holds the ink to begin with, and both are overwritten. Returns which of the two
    /// holds the result: 0 or 1.
    ///
    /// # Errors
    /// If a texture is not as [`crate::pass`] says.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        operation: Operation,
        steps: u32,
        ink: [&wgpu::TextureView; 2],
    ) -> Result<usize, ImageSpaceError> {
        check_ink(ink[0], None)?;
        check_ink(ink[1], Some(texture_size_px(ink[0])))?;
        // The bind groups for all steps.
        let groups = |draw: &Fullscreen| {
            ink.map(|from| draw.group(device, &[wgpu::BindingResource::TextureView(from)], &Composite::Multiply))
        };
        let mut from = 0;
        for eroding in operation.halves() {
            let draw = if eroding { &self.erode } else { &self.dilate };
            let groups = groups(draw);
            for _ in 0..steps {
                draw.draw(encoder, &groups[from], ink[1 - from], None);
                from = 1 - from;
            }
        }
        Ok(from)
    }
}
