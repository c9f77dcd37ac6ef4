//! The flags of the view.

use crate::range::checked;
use crate::terminal::tell;
use clap::{Args, ValueEnum};
use glam::{DVec3, DVec4};
use npr_harness::camera::Framing;
use npr_harness::error::HarnessError;
use npr_harness::outliers;
use npr_harness::scene::Scene;
use npr_harness::style::Style;
use npr_mesh::{Loaded, UpAxis, Warning};

#[derive(Args)]
pub struct FramingOptions {
    /// Around the model, degrees to the right from the side of +Z.
    #[arg(long, default_value_t = 30.0, allow_negative_numbers = true)]
    yaw: f64,
    /// Above the horizon, degrees, -90 to 90.
    #[arg(long, default_value_t = 20.0, allow_negative_numbers = true)]
    pitch: f64,
    /// Turns the camera clockwise about its viewing direction, degrees.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    roll: f64,
    /// 1 fits the whole model, 2 is twice as far away.
    #[arg(long, default_value_t = 1.0)]
    distance: f64,
    /// Between the upper and the lower border, degrees.
    #[arg(long, default_value_t = 35.0, conflicts_with = "ortho")]
    fov: f64,
    /// A parallel view.
    #[arg(long)]
    ortho: bool,
    /// The axis of the file that points up: x, y, z, -x, -y or -z. The model is turned so that it points up in the picture;
    /// with z, the side of -Y comes to the front.
    #[arg(long, value_name = "AXIS", default_value = "y", value_parser = parse_up, allow_hyphen_values = true)]
    up: UpAxis,
    /// The point of the file in the middle of the picture, which is that of the model otherwise.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    target: Option<DVec3>,
    /// What the picture fits: everything, or the model without small parts far away from it, which a warning names.
    #[arg(long, value_enum, default_value = "all")]
    fit: Fit,
    /// Catch shadows on a plane under the model, in styles with shadows. Where it is lit it is paper.
    #[arg(long)]
    ground: bool,
}

/// What the picture fits.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Fit {
    /// All faces.
    All,
    /// All but outliers.
    Inliers,
}

fn parse_up(text: &str) -> Result<UpAxis, String> {
    Ok(match text.to_ascii_lowercase().trim_start_matches('+') {
        "x" => UpAxis::X,
        "y" => UpAxis::Y,
        "z" => UpAxis::Z,
        "-x" => UpAxis::NegativeX,
        "-y" => UpAxis::NegativeY,
        "-z" => UpAxis::NegativeZ,
        _ => return Err("expected x, y, z, -x, -y or -z".into()),
    })
}

fn parse_point(text: &str) -> Result<DVec3, String> {
    let point = <[f64; 3]>::try_from(numbers(text)?).map_err(|_| "expected three numbers: X,Y,Z")?;
    let point = DVec3::from(point);
    if point.is_finite() { Ok(point) } else { Err("no point".into()) }
}

/// Numbers with commas between them.
pub fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |part: &str| part.trim().parse::<f64>().map_err(|_| format!("{part:?} is not a number"));
    text.split(',').map(number).collect()
}

/// The farthest target, in radii of what is framed, from its middle. Farther away the model would be less than a pixel.
const FARTHEST_TARGET: f64 = 1e6;

impl FramingOptions {
    /// The direction of the view and its size. The target needs the scene: [`Self::of_scene`].
    pub fn checked(&self, style: &Style) -> Result<Framing, HarnessError> {
        if self.ground && style.shadow.is_none() {
            tell(&format!(
                "npr: warning: --ground shows nothing: no light of the style {:?} casts shadows",
                style.name
            ));
        }
        Ok(Framing {
            yaw_rad: checked("yaw", self.yaw, -1e6, 1e6, "-1e6..=1e6 degrees")?.to_radians(),
            pitch_rad: checked("pitch", self.pitch, -90.0, 90.0, "-90..=90 degrees")?.to_radians(),
            roll_rad: checked("roll", self.roll, -1e6, 1e6, "-1e6..=1e6 degrees")?.to_radians(),
            distance: checked("distance", self.distance, 1e-3, 1e3, "0.001..=1000")?,
            fov_y_rad: if self.ortho {
                None
            } else {
                Some(checked("field of view", self.fov, 1.0, 170.0, "1..=170 degrees")?.to_radians())
            },
            target: None,
        })
    }

    /// Turns a file's model so that its axis points up.
    pub fn turn(&self, loaded: &mut Loaded) {
        self.up.turn(&mut loaded.meshes, loaded.objects.iter_mut().map(|object| &mut object.world_from_mesh));
    }

    /// A plane of the file, in the scene's space.
    pub fn plane(&self, scene: &Scene, plane: DVec4) -> DVec4 {
        scene.plane_here(self.up.turned(plane.truncate()).extend(plane.w))
    }

    /// Sets what of a scene is framed, and whether there is a ground; returns what there is to warn of.
    pub fn apply(&self, scene: &mut Scene) -> Result<Vec<Warning>, HarnessError> {
        scene.ground = self.ground;
        let mut warnings = Vec::new();
        if let Some(outliers) = outliers::find(scene) {
            let found = outliers.describe(scene, self.up);
            let advice = match self.fit {
                Fit::All => "--fit inliers frames the rest",
                Fit::Inliers => "only the rest is framed",
            };
            warnings.push(format!("{found}: {advice}").into());
            if self.fit == Fit::Inliers {
                scene.set_subject(Some(outliers.rest));
            }
        }
        if let Some(target) = self.target_in(scene) {
            let radius = if scene.radius() > 0.0 { scene.radius() } else { 1.0 };
            let radii = target.distance(scene.middle()) / radius;
            let what = "the target's distance from the middle of the model";
            checked(what, radii, 0.0, FARTHEST_TARGET, "0..=1e6 radii of the model")?;
        }
        Ok(warnings)
    }

    fn target_in(&self, scene: &Scene) -> Option<DVec3> {
        self.target.map(|target| scene.place_here(self.up.turned(target)))
    }

    /// The framing of a scene.
    pub fn of_scene(&self, framing: &Framing, scene: &Scene) -> Framing {
        Framing { target: self.target_in(scene), ..*framing }
    }
}
