//! Axes: from values to positions, and the values that are marked.

use super::Axis;
use super::canvas::text_width;

/// The room for values that are not positive on a logarithmic axis, px.
const ZERO_ROOM_PX: f64 = 34.0;

/// Maps values to positions along an axis.
#[derive(Clone, Debug)]
pub struct Scale {
    logarithmic: bool,
    /// The smallest and the largest value shown, as their logarithms on a logarithmic axis.
    range: (f64, f64),
    /// Their positions, px.
    positions: (f64, f64),
    /// The position of the values that are not positive.
    pub zero: Option<f64>,
}

/// A marked value.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Its position, px.
    pub at: f64,
    /// Its text.
    pub text: String,
}

impl Scale {
    /// A scale for values, between two positions in px. Values that are not finite are ignored.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>, (start, end): (f64, f64)) -> Self {
        let finite: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let has_zero = axis.logarithmic && finite.iter().any(|value| *value <= 0.0);
        let shown = finite.iter().filter(|value| !axis.logarithmic || **value > 0.0);
        let shown = shown.map(|value| if axis.logarithmic { value.log10() } else { *value });
        let (low, high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = match (low.is_finite(), axis.logarithmic) {
            (false, true) => (-1.0, 0.0),
            (false, false) => (0.0, 1.0),
            (true, _) => (low, high),
        };
        // A single value is in the middle.
        let extent =
            if high > low { high - low } else { [low.abs().max(1.0) * 0.2, 0.3][usize::from(axis.logarithmic)] };
        let margin = if high > low { 0.06 * extent } else { extent };
        // Errors and times start at zero where zero is near.
        let starts_at_zero = !axis.logarithmic && low >= 0.0 && low <= 0.5 * high;
        let range = (if starts_at_zero { 0.0 } else { low - margin }, high + margin);
        let direction = (end - start).signum();
        let positions = (if has_zero { start + ZERO_ROOM_PX * direction } else { start }, end);
        let zero = has_zero.then_some(start + 0.4 * ZERO_ROOM_PX * direction);
        Self { logarithmic: axis.logarithmic, range, positions, zero }
    }

    /// The position of a value, px.
    pub fn at(&self, value: f64) -> f64 {
        let value = match (self.logarithmic, value > 0.0) {
            (false, _) => value,
            (true, true) => value.log10(),
            (true, false) => return self.zero.unwrap_or(self.positions.0),
        };
        let ((low, high), (start, end)) = (self.range, self.positions);
        let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
        start + share * (end - start)
    }

    /// Whether a value lies within what is shown.
    pub fn shows(&self, value: f64) -> bool {
        if self.logarithmic && value <= 0.0 {
            return self.zero.is_some() && value.is_finite();
        }
        let value = if self.logarithmic { value.log10() } else { value };
        value >= self.range.0 && value <= self.range.1
    }

    /// The values that are marked, without those whose texts would touch: along the axis a text is as long as it is
    /// wide, or with `stacked` as high as it is.
    pub fn ticks(&self, size_px: f64, stacked: bool) -> Vec<Tick> {
        let length = |text: &str| if stacked { size_px * 1.3 } else { text_width(text, size_px, false) + size_px };
        let most = ((self.positions.1 - self.positions.0).abs() / if stacked { 36.0 } else { 60.0 }).max(2.0);
        let values =
            if self.logarithmic { logarithmic_ticks(self.range, most) } else { linear_ticks(self.range, most) };
        let zero = self.zero.map(|at| Tick { at, text: "0".into() });
        let mut ticks: Vec<Tick> = zero.into_iter().collect();
        // Narrow ranges take more digits to tell the values apart.
        let texts = |digits| values.iter().map(|value| number_of_digits(*value, digits)).collect::<Vec<_>>();
        let are_distinct = |texts: &Vec<String>| texts.windows(2).all(|pair| pair[0] != pair[1]);
        let texts = (DIGITS..=MOST_DIGITS).map(texts).find(are_distinct).unwrap_or_else(|| texts(MOST_DIGITS));
        for (value, text) in values.iter().zip(texts) {
            let tick = Tick { at: self.at(*value), text };
            let fits = |other: &Tick| (other.at - tick.at).abs() >= 0.5 * (length(&other.text) + length(&tick.text));
            if ticks.iter().all(fits) {
                ticks.push(tick);
            }
        }
        ticks
    }
}

/// Round values at equal distances.
fn linear_ticks((low, high): (f64, f64), most: f64) -> Vec<f64> {
    let rough = (high - low) / most;
    let decade = 10f64.powf(rough.log10().floor());
    // From the step that there is room for downwards, until there are some ticks.
    let steps = [10.0, 5.0, 2.0, 1.0, 0.5, 0.2].map(|multiple| multiple * decade);
    let ticks = |step: f64| {
        let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        (first..=last).map(|n| n as f64 * step).collect::<Vec<_>>()
    };
    let fits = steps.iter().rposition(|step| *step >= rough).unwrap_or(0);
    steps[fits..].iter().map(|step| ticks(*step)).find(|ticks| ticks.len() >= 3).unwrap_or_default()
}

/// 1, 2 and 5, or 1 and 3, times the powers of ten, or only some of these, whichever there is room for; round values at
/// equal distances where the range is smaller than that. `low` and `high` are logarithms.
fn logarithmic_ticks((low, high): (f64, f64), most: f64) -> Vec<f64> {
    let powers = low.floor() as i32 - 1..=high.ceil() as i32;
    let within = |value: &f64| (low..=high).contains(&value.log10());
    let multiples = |set: &[f64]| -> Vec<f64> {
        powers.clone().flat_map(|p| set.iter().map(move |m| m * 10f64.powi(p))).filter(within).collect()
    };
    for set in [&[1.0, 2.0, 5.0][..], &[1.0, 3.0], &[1.0]] {
        let ticks = multiples(set);
        if ticks.len() as f64 <= most {
            if ticks.len() >= 3 {
                return ticks;
            }
            break;
        }
    }
    let decades = high - low;
    if decades < 1.5 {
        return linear_ticks((10f64.powf(low), 10f64.powf(high)), most);
    }
    let stride = (decades / most).ceil().max(1.0) as i32;
    powers.filter(|p| p.rem_euclid(stride) == 0).map(|p| 10f64.powi(p)).filter(within).collect()
}

/// Significant digits of numbers.
const DIGITS: usize = 4;
/// Those that an f64 has.
const MOST_DIGITS: usize = 15;

/// A number in few digits: with a power of ten where it is very large or small.
pub fn number(value: f64) -> String {
    number_of_digits(value, DIGITS)
}

/// A number in at most so many significant digits.
fn number_of_digits(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { value.to_string() };
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let (factor, power) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = power.parse().unwrap_or(0);
    let without_zeros = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    let text = if (-3..5).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        without_zeros(&format!("{value:.decimals$}"))
    } else {
        // The font has no superscript minus.
        format!("{}e{power}", without_zeros(factor))
    };
    text.replace('-', "−")
}
