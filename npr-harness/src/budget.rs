//! A plan by budget: the cheapest way to make a picture within an error, or the most accurate within a time.
//!
//! A style leaves open how its parts are made ([`crate::variant`]), with how many samples, and on which executor. A
//! [`CostTable`] says what each way costs and how far it errs; the laboratory fills it by measurements on a machine, and
//! it is plain data. [`configurations`] lists every way to make a picture with its expected cost and errors, the cheapest
//! first; [`within`] chooses among them.
//!
//! # Costs
//!
//! A frame's time is taken to be a sum over its parts: surfaces with their light or strokes, and what lines and shadows
//! add. Each is linear in the number of samples and of faces ([`Cost`]). Times are compared as multiples of a plain pass,
//! light without bands or lines, since machines differ, and one machine from minute to minute.
//!
//! # Errors
//!
//! Expected errors are means over the scenes of the calibration. Those of a given scene differ, most of all for lines,
//! so a budget of errors takes a function that measures a configuration on the scene at hand.

mod configuration;
mod table;

pub use configuration::{Configuration, configurations, front_of};
pub(crate) use configuration::{PER_PIXEL, cost_name};
pub use table::{Amounts, Cost, CostTable, Entry, Expected, ShadeKey};

use crate::error::HarnessError;
use crate::shade::Shade;
use crate::style::{Lines, Style};
use crate::variant::Part;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// An error measure of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// 1 − F1 of the lines within 1.5 px, against the exact visible ones.
    Lines,
    /// The root mean square error of the surfaces' colours against 64 samples a pixel, or of the mean tone of strokes in
    /// windows of 16 px; of a range of 1.
    Tone,
    /// The share of the pixels that are lit or shadowed wrongly, against shadow rays.
    Shadows,
}

impl Measure {
    /// All measures.
    pub const ALL: [Self; 3] = [Self::Lines, Self::Tone, Self::Shadows];

    /// The error measure of a part; `None` for samples, whose effect is part of the tone's error.
    pub fn of_part(part: Part) -> Option<Self> {
        match part {
            Part::Lines => Some(Self::Lines),
            Part::Light | Part::Strokes => Some(Self::Tone),
            Part::Shadows => Some(Self::Shadows),
            Part::Samples => None,
        }
    }

    /// The name, as in `--max-error`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Tone => "tone",
            Self::Shadows => "shadows",
        }
    }

    /// The error that counts as much as one unit of any other measure where errors are added up: about what can just be
    /// seen.
    pub fn unit(self) -> f64 {
        match self {
            Self::Lines => 0.02,
            Self::Tone => 0.01,
            Self::Shadows => 0.001,
        }
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The largest errors that are allowed, by measure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaxErrors(pub Vec<(Measure, f64)>);

impl FromStr for MaxErrors {
    type Err = String;

    /// `lines=0.02,tone=0.01`.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut all: Vec<(Measure, f64)> = Vec::new();
        for part in text.split(',') {
            let names = || Measure::ALL.map(Measure::name).join(", ");
            let (name, value) = part.split_once('=').ok_or_else(|| {
                format!("{part:?} is no budget: a measure and its error, such as lines=0.02 ({})", names())
            })?;
            let measure = Measure::ALL
                .into_iter()
                .find(|measure| measure.name() == name.trim())
                .ok_or_else(|| format!("{:?} is no measure: {}", name.trim(), names()))?;
            let error = value.trim().parse::<f64>().ok().filter(|error| (0.0..=1.0).contains(error));
            let error = error
                .ok_or_else(|| format!("{:?} is no error of {name}, which is a number from 0 to 1", value.trim()))?;
            if all.iter().any(|(known, _)| *known == measure) {
                return Err(format!("{measure} is given twice"));
            }
            all.push((measure, error));
        }
        Ok(Self(all))
    }
}

/// A time that a frame may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaxTime {
    /// Ms on the machine of the cost table, as it was when the table was filled.
    Ms(f64),
    /// Multiples of the plain pass of the table's first executor.
    Plain(f64),
}

impl MaxErrors {
    /// Checks that the style has the part that each measure applies to.
    ///
    /// # Errors
    /// [`HarnessError::NothingErrs`].
    pub fn check(&self, style: &Style) -> Result<(), HarnessError> {
        let has = |measure: Measure| match measure {
            Measure::Lines => style.lines != Lines::NONE,
            Measure::Tone => style.shade != Shade::Paper,
            Measure::Shadows => style.shadow.is_some(),
        };
        match self.0.iter().find(|(measure, _)| !has(*measure)) {
            Some((measure, _)) => Err(HarnessError::NothingErrs { style: style.name.clone(), measure: measure.name() }),
            None => Ok(()),
        }
    }
}

/// A budget.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Budget {
    /// The largest errors.
    pub max_errors: MaxErrors,
    /// The longest time.
    pub max_time: Option<MaxTime>,
}

/// A choice, and what lies beside it.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The configuration that was chosen.
    pub chosen: Configuration,
    /// The errors that were measured for it on the scene, of those that the budget bounds.
    pub measured: Vec<(Measure, f64)>,
    /// The next cheaper one that is not less accurate for its cost, by expected errors.
    pub cheaper: Option<Configuration>,
    /// The next more accurate one, by expected errors.
    pub better: Option<Configuration>,
    /// The number of configurations there are.
    pub of: usize,
}

/// Chooses among configurations that are sorted by cost: within a budget of errors the cheapest, otherwise, within a
/// budget of time, the one with the least sum of expected errors in their units.
///
/// `measure` finds an error of a configuration on the scene.
///
/// # Errors
/// [`HarnessError::NoSuchSpeed`] and [`HarnessError::NoSuchAccuracy`] where nothing is within the budget, and those of
/// `measure`.
pub fn within(
    all: &[Configuration],
    budget: &Budget,
    mut measure: impl FnMut(&Configuration, Measure) -> Result<f64, HarnessError>,
) -> Result<Choice, HarnessError> {
    let plain_ms = |configuration: &Configuration| configuration.cost_ms / configuration.cost_plain;
    let fits = |configuration: &&Configuration| match budget.max_time {
        None => true,
        Some(MaxTime::Plain(most)) => configuration.cost_plain <= most,
        Some(MaxTime::Ms(most)) => configuration.cost_ms <= most,
    };
    let fitting: Vec<&Configuration> = all.iter().filter(fits).collect();
    let Some(cheapest) = all.first() else { return Err(HarnessError::NoConfiguration) };
    if fitting.is_empty() {
        let asked_plain = match budget.max_time {
            Some(MaxTime::Plain(most)) => most,
            Some(MaxTime::Ms(most)) => most / plain_ms(cheapest),
            None => f64::INFINITY,
        };
        return Err(HarnessError::NoSuchSpeed {
            asked_plain,
            least_plain: cheapest.cost_plain,
            least_ms: cheapest.cost_ms,
        });
    }
    let choice = |chosen: &Configuration, measured| {
        let front = front_of(all);
        let cheaper = front.iter().rev().find(|other| other.cost_plain < chosen.cost_plain);
        let better = front
            .iter()
            .find(|other| other.total_error() < chosen.total_error() && other.cost_plain >= chosen.cost_plain);
        Choice { chosen: chosen.clone(), measured, cheaper: cheaper.cloned(), better: better.cloned(), of: all.len() }
    };
    if budget.max_errors.0.is_empty() {
        let best =
            fitting.iter().min_by(|a, b| a.total_error().total_cmp(&b.total_error())).expect("there is one that fits");
        return Ok(choice(best, Vec::new()));
    }
    // The least that any configuration errs in the first measure that is not kept to.
    let mut least: Vec<(Measure, f64)> = Vec::new();
    'all: for configuration in &fitting {
        let mut measured = Vec::new();
        for &(of, most) in &budget.max_errors.0 {
            let error = measure(configuration, of)?;
            if error > most {
                match least.iter_mut().find(|(known, _)| *known == of) {
                    Some((_, least)) => *least = least.min(error),
                    None => least.push((of, error)),
                }
                continue 'all;
            }
            measured.push((of, error));
        }
        return Ok(choice(configuration, measured));
    }
    let (measure, least) = least.first().copied().expect("something was not kept to");
    let asked = budget.max_errors.0.iter().find(|(of, _)| *of == measure).map_or(0.0, |(_, most)| *most);
    Err(HarnessError::NoSuchAccuracy { measure: measure.name(), asked, least, in_time: budget.max_time.is_some() })
}

#[cfg(test)]
mod tests;
