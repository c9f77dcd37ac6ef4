//! Shadows: pictures of the styles that have them, and shadow states of pixels against shadow rays.

use super::Checker;
use crate::cpu::PrimaryHits;
use crate::error::HarnessError;
use crate::style::style;

/// The largest fraction of the pixels whose shadow state may differ from that of shadow rays.
#[cfg(feature = "gpu")]
const STATES_SHARE: f64 = 1e-3;
/// The largest distance of such a pixel from a shadow edge, px.
#[cfg(feature = "gpu")]
const STATES_PX: f64 = 2.0;

impl Checker<'_> {
    /// Checks the pictures of the styles with shadows.
    pub(super) fn shadows(&mut self, model: &str, view: &str, hits: &PrimaryHits<'_>) -> Result<(), HarnessError> {
        for name in ["toon-shadow", "hatch-shadow", "shadow-lines", "normals", "printed-shadow"] {
            self.picture(model, view, hits, &style(name).expect("a style of this crate"))?;
        }
        #[cfg(feature = "gpu")]
        self.shadow_states(model, hits.scene)?;
        Ok(())
    }

    /// Checks eight lights and views, two of them with the eye in shadow.
    #[cfg(feature = "gpu")]
    fn shadow_states(&mut self, model: &str, scene: &crate::scene::Scene) -> Result<(), HarnessError> {
        use super::{Limit, SIZE};
        use crate::executor::Executor;
        use crate::shadow::ShadowMethod;
        use crate::truth::shadows::{States, eye_is_in_shadow, farthest_px, shots, states_on_device};
        use glam::DVec2;
        let Executor::Gpu(context) = self.executor else { return Ok(()) };
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        let exact = !scene.casts_by_alpha();
        if !exact {
            self.skipped
                .push(format!("limits on the shadow states of {model}: alpha decides what casts, by a shadow map"));
        }
        for shot in shots(scene, aspect) {
            let reference = States::by_rays(scene, &shot, SIZE, DVec2::ZERO)?;
            let actual = states_on_device(context, scene, &shot, ShadowMethod::Volumes, None, SIZE)?;
            let found = actual.difference(&reference);
            let farthest = farthest_px(scene, &shot, &actual, &reference)?;
            let inside = if eye_is_in_shadow(scene, &shot) { "shadow, eye in" } else { "shadow" };
            let limit = |most| exact.then_some(Limit::AtMost(most));
            self.add(model, shot.name, inside, "share of pixels in another state", found.share, limit(STATES_SHARE));
            self.add(model, shot.name, inside, "farthest of them from an edge, px", farthest, limit(STATES_PX));
        }
        Ok(())
    }
}
