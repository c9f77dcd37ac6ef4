//! The lights of a style, and their positions in a scene.

use crate::camera::Camera;
use crate::scene::{FARTHEST, Scene};
use glam::{DVec4, Vec3};
use npr_toon::source::{Light, LightKind, aggregate};

/// The coordinate frame of a light's direction or position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightFrame {
    /// The viewer's axes: x to the right, y up and z towards the eye. Positions are relative to the centre of the
    /// model's bounding box, in units of half its diagonal, so a light works for any model and view.
    #[default]
    View,
    /// The model's own axes and units.
    World,
}

/// A light of a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StyleLight {
    /// Its direction or position, its colour and its brightness.
    pub light: Light,
    /// The frame of its direction or position.
    pub frame: LightFrame,
}

impl StyleLight {
    /// A white light over the viewer's left shoulder, which lights any model from any view.
    pub const KEY: Self = Self {
        light: Light {
            place: LightKind::Directional { to_light: Vec3::new(-0.5, 0.7, 0.6) },
            color: Vec3::ONE,
            brightness: 1.0,
        },
        frame: LightFrame::View,
    };
}

impl Default for StyleLight {
    fn default() -> Self {
        Self::KEY
    }
}

/// The lights of a style in scene space. More than `most` are replaced by one that approximates them ([`aggregate`] at
/// the centre of the model's bounding box). Directions are unit vectors, or zero where two lights cancel out.
pub fn lights_in_world(lights: &[StyleLight], most: usize, scene: &Scene, camera: &Camera) -> Vec<Light> {
    let lights: Vec<Light> = lights.iter().map(|light| in_world(light, scene, camera)).collect();
    if lights.len() <= most {
        return lights;
    }
    let one = aggregate(&lights, scene.middle());
    vec![Light {
        place: LightKind::Directional { to_light: one.to_light.as_vec3() },
        color: one.color.as_vec3(),
        brightness: one.brightness as f32,
    }]
}

/// The light that casts shadows, which is the first: a point with w = 1, or the unit direction to it with w = 0, in
/// scene space.
pub fn casting_light(lights: &[StyleLight], scene: &Scene, camera: &Camera) -> DVec4 {
    lights.first().map_or(DVec4::ZERO, |light| match in_world(light, scene, camera).place {
        LightKind::Directional { to_light } => to_light.as_dvec3().normalize_or_zero().extend(0.0),
        LightKind::Positional { position } => position.as_dvec3().extend(1.0),
    })
}

fn in_world(StyleLight { light, frame }: &StyleLight, scene: &Scene, camera: &Camera) -> Light {
    let [right, up, back] = camera.axes();
    let turned = |v: Vec3| match frame {
        LightFrame::View => right * f64::from(v.x) + up * f64::from(v.y) + back * f64::from(v.z),
        LightFrame::World => v.as_dvec3(),
    };
    let place = match light.place {
        LightKind::Directional { to_light } => {
            LightKind::Directional { to_light: turned(to_light).normalize_or_zero().as_vec3() }
        }
        LightKind::Positional { position } => {
            let position = match frame {
                LightFrame::View => scene.middle() + turned(position) * scene.radius(),
                LightFrame::World => scene.place_here(position.as_dvec3()),
            };
            // The clamp keeps the position representable as f32 on the GPU; farther away it makes no visible
            // difference.
            LightKind::Positional { position: position.clamp_length_max(FARTHEST).as_vec3() }
        }
    };
    Light { place, ..*light }
}
