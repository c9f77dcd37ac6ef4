//! The ground of a plan.

use super::{Plan, Reason};
use crate::ground::{GROUND, GroundPlan};
use crate::scene::Scene;

impl Plan {
    /// The ground, if there is one.
    pub fn ground(&self) -> Option<&GroundPlan> {
        self.shadow.as_ref().and_then(|shadow| shadow.ground.as_ref())
    }

    /// Says why there is a ground, or why there is none although the scene asks for it.
    pub(super) fn explain_ground(&mut self, scene: &Scene) {
        if !scene.ground {
            return;
        }
        let why_not = match &self.shadow {
            None => "the picture shows no shadows",
            Some(shadow) if shadow.ground.is_none() => "the light that casts shadows is not above it",
            Some(_) => {
                let why = "shadows fall on a plane under the model".to_owned();
                return self.passes.push(Reason { pass: GROUND, why });
            }
        };
        self.left_out.push(Reason { pass: GROUND, why: why_not.to_owned() });
    }
}
