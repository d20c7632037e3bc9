//! Rounds numbers for messages.

/// Returns a number rounded to four digits.
pub(crate) fn brief(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}
