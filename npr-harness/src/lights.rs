//! The lights of a style, and their positions in a scene.

use crate::camera::Camera;
use crate::error::HarnessError;
use crate::scene::{FARTHEST, Object, Scene};
use glam::{DVec3, DVec4, Vec3};
use npr_toon::source::{Light, LightKind, aggregate, combined_color};

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

/// Two lights of a style that one or several objects have.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPair {
    /// Their indices in the style.
    pub numbers: [usize; 2],
    /// The lights, in scene space.
    pub lights: [Light; 2],
    /// Their combined colour.
    pub color: DVec3,
}

/// The two lights of each object, of the lights of a style: the distinct pairs, and per object the index of its pair.
///
/// *The Evolution of a Cartoon Renderer* has two lights for each mesh and does not say which. Here an object has those that
/// were set for it, else the two of greatest importance to it, in the order of the style; of equals the first. The importance
/// of a light is its brightness times the luminance of its colour (Rec. 709, of display-referred components), for a lamp
/// divided by 1 + (d / r)², where d is its distance from the middle of the object's box and r the radius of the scene as it
/// was made. This falloff only chooses; it does not dim light. With `shadows`, the first light, which casts them, is always
/// an object's first.
///
/// # Errors
/// [`HarnessError::ObjectLights`] for an object whose lights the style does not have, or whose first is not the one that
/// casts shadows.
pub(crate) fn light_pairs(
    lights: &[Light],
    scene: &Scene,
    shadows: bool,
) -> Result<(Vec<LightPair>, Vec<u32>), HarnessError> {
    for (object, named) in scene.objects().iter().map(Object::lights).enumerate() {
        let Some(named) = named else { continue };
        let fault = |fault| Err(HarnessError::ObjectLights { object, lights: named, fault });
        if named.into_iter().any(|light| light >= lights.len()) {
            return fault("the style has fewer");
        }
        if shadows && named[0] != 0 {
            return fault("the first has to be the style's first, which casts shadows");
        }
    }
    let (mut pairs, mut of_objects) = (Vec::<LightPair>::new(), Vec::new());
    for (object, mesh) in scene.placed_objects() {
        let chosen = || {
            let (low, high) = mesh.bounds().unwrap_or_default();
            most_important(lights, object.point(low.midpoint(high)), scene.reference_radius(), shadows)
        };
        let numbers = object.lights().unwrap_or_else(chosen);
        let known = pairs.iter().position(|pair| pair.numbers == numbers);
        let index = known.unwrap_or_else(|| {
            let lights = numbers.map(|light| lights[light]);
            pairs.push(LightPair { numbers, lights, color: combined_color(&lights) });
            pairs.len() - 1
        });
        of_objects.push(index as u32);
    }
    Ok((pairs, of_objects))
}

/// The two lights of greatest importance at a place, in ascending order. There are at least two.
fn most_important(lights: &[Light], at: DVec3, radius: f64, keeps_first: bool) -> [usize; 2] {
    let importance = |light: &Light| {
        let nearness = match light.place {
            LightKind::Directional { .. } => 1.0,
            LightKind::Positional { position } => {
                let distance = position.as_dvec3().distance(at) / radius.max(f64::MIN_POSITIVE);
                1.0 / (1.0 + distance * distance)
            }
        };
        f64::from(light.brightness) * light.color.as_dvec3().dot(DVec3::new(0.2126, 0.7152, 0.0722)) * nearness
    };
    let mut order: Vec<(usize, f64)> = lights.iter().map(importance).enumerate().collect();
    // The sort is stable, so that of equals the first comes first.
    order.sort_by(|a, b| (keeps_first && b.0 == 0).cmp(&(keeps_first && a.0 == 0)).then(b.1.total_cmp(&a.1)));
    let mut numbers = [order[0].0, order[1].0];
    numbers.sort_unstable();
    numbers
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
