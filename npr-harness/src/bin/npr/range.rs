//! Ranges of arguments.

use npr_harness::error::HarnessError;

pub fn checked(what: &'static str, value: f64, low: f64, high: f64, range: &'static str) -> Result<f64, HarnessError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(HarnessError::Range { what, value, range }) }
}
