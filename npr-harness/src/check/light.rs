//! Band borders, and the three uses of normals, against supersampled references.

use super::Checker;
use crate::camera::Camera;
use crate::error::HarnessError;
use crate::scene::Scene;
use crate::truth::bands::{band_accuracy, white};
use crate::truth::normal_use::normal_use_errors;
use npr_toon::Bands;
use npr_toon::normal::NormalUse;

/// The picture size for band borders, px; a picture 16 times finer must fit into memory.
const BORDER_SIZE: (u32, u32) = (320, 180);
/// The picture size for uses of normals, px.
const NORMALS_SIZE: (u32, u32) = (480, 270);

impl Checker<'_> {
    /// Measures the default bands on a white model. Reported without limits, because they depend on how rough a model
    /// is.
    pub(super) fn borders(
        &mut self,
        model: &str,
        view: &str,
        scene: &Scene,
        camera: &Camera,
    ) -> Result<(), HarnessError> {
        let white = Scene::new(white(scene.flattened().single().model()));
        let all = band_accuracy(&white, camera, BORDER_SIZE, &Bands::default(), 1)?;
        for (technique, found) in ["borders", "borders, no crease near"].into_iter().zip(all) {
            if found.pixels == 0 {
                self.skipped.push(format!("{technique} of {model} ({view}): no pixel is near one"));
                continue;
            }
            self.add(model, view, technique, "RMSE, antialiased over hard", found.rmse_ratio(), None);
            self.add(model, view, technique, "flicker, antialiased over hard", found.excess_ratio(), None);
            self.add(model, view, technique, "change a step, antialiased over hard", found.change_ratio(), None);
        }
        Ok(())
    }

    /// Measures the teapot, from coarse to fine tessellations.
    pub(super) fn normals(&mut self) -> Result<(), HarnessError> {
        for error in normal_use_errors(NORMALS_SIZE)? {
            let technique = match error.normals {
                NormalUse::PerVertex => "light per vertex".to_owned(),
                NormalUse::Interpolated => "as interpolated".to_owned(),
                NormalUse::PerPixel => "unit normals".to_owned(),
                NormalUse::PerFace => "light per face".to_owned(),
                NormalUse::PerSubdividedFace(divisions) => format!("light per face of {divisions} divisions"),
            };
            let view = format!("{} a patch", error.segments);
            for (metric, value) in [
                ("bands: RMSE of 255", error.rmse[0]),
                ("bands: largest error of 255", error.worst[0]),
                ("Gooch: RMSE of 255", error.rmse[1]),
                ("Gooch: largest error of 255", error.worst[1]),
            ] {
                self.add("teapot", &view, &technique, metric, value * 255.0, None);
            }
        }
        Ok(())
    }
}
