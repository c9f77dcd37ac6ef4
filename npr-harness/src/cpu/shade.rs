//! What light makes of a hit's own colour. The twin of `gpu/surface_light.wgsl`.

use super::FrameContext;
use super::surface::Footprint;
use crate::rays::Hit;
use crate::style::{PainterShade, Ramp2dSource, RampShade, RampSource, Shade};
use glam::{DVec2, DVec3};
use npr_gooch::{gooch_highlight, gooch_n_dot_l, gooch_over, gooch_r_dot_e, gooch_tone};
use npr_toon::border::toon_border_width;
use npr_toon::half_lambert::toon_half_lambert;
use npr_toon::normal::NormalUse;
use npr_toon::painter::{toon_overbright, toon_reach};
use npr_toon::ramp::toon_ramp;
use npr_toon::row::toon_row;
use npr_toon::source::toon_to_light;
use npr_toon::table::{toon_ramp_2d, toon_table};
use npr_toon::{
    toon_half, toon_n_dot_h, toon_n_dot_h_interpolated, toon_n_dot_l, toon_n_dot_l_interpolated, toon_shade,
};

/// A point of a face as the light falls on it: vectors of any length, towards the viewer's side.
#[derive(Clone, Copy)]
struct Lit {
    normal: DVec3,
    at: DVec3,
    to_eye: DVec3,
}

impl FrameContext<'_> {
    /// The display-referred colour of a hit whose own is `base`.
    pub(super) fn shaded(&self, hit: &Hit, base: DVec3, x: u32, y: u32) -> DVec3 {
        let in_shadow = self.shadow_at(hit).dark;
        let here = self.light(hit, hit.barycentric, in_shadow);
        let widths = || {
            let Footprint { along_x, along_y, .. } = self.footprint(hit, x, y);
            // The whole block of pixels as in shadow, or not: a shadow's border is no border of bands.
            let at = |weights| self.light(hit, weights, in_shadow) - here;
            let (dx, dy) = (at(along_x), at(along_y));
            DVec2::new(toon_border_width(dx.x, dy.x), toon_border_width(dx.y, dy.y))
        };
        let tinted = base * self.light_color;
        match &self.style.shade {
            Shade::Paper => self.style.paper.as_dvec3(),
            Shade::Lambert { ambient } => {
                let ambient = f64::from(*ambient);
                tinted * (ambient + (1.0 - ambient) * here.x.max(0.0))
            }
            Shade::Toon(bands) => {
                let width = if bands.antialias { widths() } else { DVec2::ZERO };
                toon_shade(bands, tinted, here.x, width.x, here.y, width.y)
            }
            Shade::Ramp(RampShade { ramp: RampSource::Stops(ramp), .. }) => {
                tinted * toon_ramp(ramp, here.x, widths().x)
            }
            Shade::Ramp(RampShade { ramp: RampSource::Image(row), .. }) => tinted * toon_row(row, here.x),
            Shade::Painter(PainterShade { ramp, light_scale, .. }) => {
                let shade = match ramp {
                    Ramp2dSource::Ramps(ramps) => toon_ramp_2d(ramps, here, widths()),
                    Ramp2dSource::Image(table) => toon_table(table, here),
                };
                toon_overbright(base * shade, self.light_color, f64::from(*light_scale))
            }
            Shade::Gooch(model) => {
                let tone = gooch_tone(model, base, here.x);
                gooch_over(model, tone, gooch_highlight(model, here.x, here.y))
            }
            Shade::Hatch(_) => {
                let strokes = self.strokes.as_ref().expect("a hatched style has strokes");
                self.hatch(hit, base, here.x, in_shadow, x, y, strokes)
            }
            Shade::Normals => self.normal_color(hit),
        }
    }

    /// What a shade is looked up with, before it is: how far the light reaches, or what half-Lambert makes of that, and
    /// beside it N·H; the reach of two lights; for Gooch N·L and R·E. In a cast shadow as if the surface were turned away
    /// from the light as far as it is turned towards it.
    fn light(&self, hit: &Hit, weights: [f64; 3], in_shadow: bool) -> DVec2 {
        let mut found = match self.style.normals {
            NormalUse::PerPixel => {
                let surface = self.interpolate(hit, weights);
                self.light_at(&Lit { normal: surface.normal, at: surface.at, to_eye: surface.to_eye })
            }
            NormalUse::Interpolated => self.light_interpolated(&self.corners(hit), weights),
            NormalUse::PerVertex => {
                self.corners(hit).iter().zip(weights).map(|(corner, weight)| self.light_at(corner) * weight).sum()
            }
        };
        if in_shadow {
            let second = if matches!(self.style.shade, Shade::Painter(_)) { found.y } else { -1.0 };
            found = DVec2::new(-found.x.abs(), second);
        }
        match &self.style.shade {
            Shade::Ramp(RampShade { half_lambert: Some(how), .. }) => DVec2::new(toon_half_lambert(how, found.x), 0.0),
            _ => found,
        }
    }

    /// How far the light reaches at the corners of a hit's face.
    pub(super) fn lit_corners(&self, hit: &Hit) -> [f64; 3] {
        self.corners(hit).map(|corner| self.light_at(&corner).x)
    }

    fn corners(&self, hit: &Hit) -> [Lit; 3] {
        let eye = self.camera.homogeneous_eye();
        self.scene.model.faces[hit.face as usize].map(|v| {
            let normal = self.scene.model.normals[v as usize].as_dvec3();
            let at = self.scene.model.positions[v as usize].as_dvec3();
            Lit { normal: if hit.front { normal } else { -normal }, at, to_eye: eye.truncate() - at * eye.w }
        })
    }

    /// Whether N·H is looked at.
    fn has_highlight(&self) -> bool {
        matches!(&self.style.shade, Shade::Toon(bands) if bands.highlight.is_some())
    }

    fn light_at(&self, lit: &Lit) -> DVec2 {
        let Some(first) = self.lights.first() else { return DVec2::ZERO };
        let to_light = toon_to_light(first.place, lit.at);
        if matches!(self.style.shade, Shade::Gooch(_)) {
            let r_dot_e = gooch_r_dot_e(lit.normal, to_light, lit.to_eye);
            return DVec2::new(gooch_n_dot_l(lit.normal, to_light), r_dot_e);
        }
        let reach = toon_reach(toon_n_dot_l(lit.normal, to_light), f64::from(first.brightness));
        let second = if let Some(second) = self.lights.get(1) {
            let to_light = toon_to_light(second.place, lit.at);
            toon_reach(toon_n_dot_l(lit.normal, to_light), f64::from(second.brightness))
        } else if self.has_highlight() {
            toon_n_dot_h(lit.normal, to_light, lit.to_eye)
        } else {
            0.0
        };
        DVec2::new(reach, second)
    }

    /// Of unit vectors at the corners, interpolated and multiplied as they are.
    fn light_interpolated(&self, corners: &[Lit; 3], weights: [f64; 3]) -> DVec2 {
        let Some(first) = self.lights.first() else { return DVec2::ZERO };
        let mean = |of: &dyn Fn(&Lit) -> DVec3| -> DVec3 {
            corners.iter().zip(weights).map(|(corner, weight)| of(corner) * weight).sum()
        };
        let normal = mean(&|lit| lit.normal.normalize_or_zero());
        let to_light = mean(&|lit| toon_to_light(first.place, lit.at));
        let n_dot_l = toon_n_dot_l_interpolated(normal, to_light);
        if matches!(self.style.shade, Shade::Gooch(_)) {
            let to_eye = mean(&|lit| lit.to_eye.normalize_or_zero());
            return DVec2::new(n_dot_l, 2.0 * n_dot_l * normal.dot(to_eye) - to_light.dot(to_eye));
        }
        let second = if let Some(second) = self.lights.get(1) {
            let to_light = mean(&|lit| toon_to_light(second.place, lit.at));
            toon_reach(toon_n_dot_l_interpolated(normal, to_light), f64::from(second.brightness))
        } else if self.has_highlight() {
            let half = mean(&|lit| toon_half(toon_to_light(first.place, lit.at), lit.to_eye));
            toon_n_dot_h_interpolated(normal, half)
        } else {
            0.0
        };
        DVec2::new(toon_reach(n_dot_l, f64::from(first.brightness)), second)
    }
}
