//! The ways to make a picture of a style.

use super::Measure;
use super::table::{Amounts, CostTable, ShadeKey};
use crate::scene::Scene;
use crate::shade::Shade;
use crate::variant::{Part, Setup, Variant};
use crate::view::View;
use std::borrow::Cow;

/// The name for a part that no variant can replace, and that stays as the style defines it.
const AS_GIVEN: &str = "as the style has it";

/// A way to make a picture, and what is expected of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The executor.
    pub executor: String,
    /// The style and the samples.
    pub setup: Setup,
    /// The variant of each part that the style has.
    pub variants: Vec<(Part, &'static str)>,
    /// What each part adds to a frame, ms: light or strokes first, which are the frame without the others.
    pub costs_ms: Vec<(Part, f64)>,
    /// The expected time of a frame, ms, as the machine was when the table was measured.
    pub cost_ms: f64,
    /// The same in multiples of the plain pass of the table's first executor.
    pub cost_plain: f64,
    /// The expected errors.
    pub errors: Vec<(Measure, f64)>,
}

impl Configuration {
    /// The sum of the expected errors in their units ([`Measure::unit`]).
    pub fn total_error(&self) -> f64 {
        self.errors.iter().map(|(measure, error)| error / measure.unit()).sum()
    }

    /// The variants of the parts that an error depends on: configurations in which they are the same err equally.
    pub fn of_measure(&self, measure: Measure) -> Vec<(Part, &'static str)> {
        let parts: &[Part] = match measure {
            Measure::Lines => &[Part::Lines, Part::Samples],
            Measure::Tone => &[Part::Light, Part::Strokes, Part::Samples],
            Measure::Shadows => &[Part::Shadows],
        };
        self.variants.iter().filter(|(part, _)| parts.contains(part)).copied().collect()
    }
}

/// All combinations of variants and executors for a picture whose cost is in the table, cheapest first. Variants that a
/// plan must not choose ([`Variant::in_budget`]) are excluded.
pub fn configurations(scene: &Scene, setup: &Setup, view: &View, table: &CostTable) -> Vec<Configuration> {
    let pixels = f64::from(view.size.0) * f64::from(view.size.1);
    let faces = scene.face_count() as f64;
    let amounts = |samples: u32| Amounts { samples: pixels * f64::from(samples * samples), faces };
    let Some(first) = table.executors.first() else { return Vec::new() };
    let lambert = Some(ShadeKey::Lambert);
    let Some(plain_ms) = table.ms(first, Part::Light, PER_PIXEL, lambert, 1, &amounts(1)) else { return Vec::new() };
    let mut all = Vec::new();
    for (variants, setup) in setups(setup) {
        let shade = ShadeKey::of(&setup.style.shade);
        let on_surface = if matches!(setup.style.shade, Shade::Hatch(_)) { Part::Strokes } else { Part::Light };
        let amounts = amounts(setup.samples);
        // The costs and errors of the most similar variant stand for a part that stays as the style defines it.
        let known = |part, variant| cost_name(part, if variant == AS_GIVEN { as_given(part) } else { variant }, &setup);
        let shade_of = |part| (part == on_surface).then_some(shade);
        for executor in &table.executors {
            let cost = |&(part, variant): &(Part, &'static str)| {
                let variant = known(part, variant);
                Some((part, table.ms(executor, part, &variant, shade_of(part), setup.samples, &amounts)?))
            };
            let paid = variants.iter().filter(|(part, _)| *part != Part::Samples);
            let Some(costs_ms) = paid.map(cost).collect::<Option<Vec<_>>>() else { continue };
            let cost_ms: f64 = costs_ms.iter().map(|(_, ms)| ms).sum();
            // The CPU follows the rays that are the truth.
            let is_exact = |measure| measure == Measure::Shadows && executor == "cpu";
            let error = |&(part, variant): &(Part, &'static str)| {
                let measure = Measure::of_part(part)?;
                let error = table.error(part, &known(part, variant), shade_of(part), setup.samples)?;
                Some((measure, if is_exact(measure) { 0.0 } else { error }))
            };
            let mut errors: Vec<(Measure, f64)> = variants.iter().filter_map(error).collect();
            errors.sort_by_key(|(measure, _)| *measure);
            all.push(Configuration {
                executor: executor.clone(),
                setup: setup.clone(),
                variants: variants.clone(),
                costs_ms,
                cost_ms,
                cost_plain: cost_ms / plain_ms,
                errors,
            });
        }
    }
    all.sort_by(|a, b| a.cost_plain.total_cmp(&b.cost_plain));
    all
}

/// The name of light per pixel.
pub(crate) const PER_PIXEL: &str = "per pixel";

/// The variant whose costs and errors stand for a part that is left as the style has it.
fn as_given(part: Part) -> &'static str {
    match part {
        Part::Lines => "image, 64 bits",
        Part::Shadows => "volumes",
        Part::Light => PER_PIXEL,
        Part::Strokes => "six tones",
        Part::Samples => "1 sample",
    }
}

/// The name under which a table has a variant: lines in the image cost more, and err otherwise, where a disc widens them.
pub(crate) fn cost_name<'a>(part: Part, variant: &'a str, setup: &Setup) -> Cow<'a, str> {
    let is_dilated = setup.style.lines.image.is_some_and(|ink| ink.dilation.is_some());
    if part == Part::Lines && is_dilated { format!("{variant}, dilated").into() } else { variant.into() }
}

/// Every combination of variants of the parts that a setup has.
fn setups(setup: &Setup) -> Vec<(Vec<(Part, &'static str)>, Setup)> {
    let mut all = vec![(Vec::new(), setup.clone())];
    for part in [Part::Light, Part::Strokes, Part::Lines, Part::Shadows, Part::Samples] {
        let mut more = Vec::new();
        for (variants, setup) in &all {
            let chosen = |variant: &Variant| Some((variant.name, (variant.apply)(setup)?));
            let ways = part.variants();
            let mut found: Vec<_> = ways.iter().filter(|variant| variant.in_budget).filter_map(chosen).collect();
            if found.is_empty() {
                if !has(part, setup) {
                    more.push((variants.clone(), setup.clone()));
                    continue;
                }
                found.push((AS_GIVEN, setup.clone()));
            }
            for (name, setup) in found {
                more.push(([variants.as_slice(), &[(part, name)]].concat(), setup));
            }
        }
        all = more;
    }
    all
}

/// Whether a setup has a part.
fn has(part: Part, setup: &Setup) -> bool {
    let is_hatched = matches!(setup.style.shade, Shade::Hatch(_));
    match part {
        Part::Lines => setup.style.lines != crate::style::Lines::NONE,
        Part::Light => !is_hatched,
        Part::Strokes => is_hatched,
        Part::Shadows => setup.style.shadow.is_some(),
        Part::Samples => true,
    }
}

/// The configurations that no other one beats in both expected cost and [`Configuration::total_error`], by cost.
pub fn front_of(all: &[Configuration]) -> Vec<Configuration> {
    let mut front: Vec<Configuration> = Vec::new();
    for configuration in all {
        if front.last().is_none_or(|last| configuration.total_error() < last.total_error()) {
            front.push(configuration.clone());
        }
    }
    front
}
