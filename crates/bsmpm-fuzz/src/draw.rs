//! Draws numbers from the fuzzer's bytes.

use arbitrary::{Result, Unstructured};

/// Uniform in 0..=1, both ends included.
pub fn fraction(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(u.arbitrary::<u16>()?) / f64::from(u16::MAX))
}

/// Uniform between two numbers.
pub fn between(u: &mut Unstructured<'_>, lower: f64, upper: f64) -> Result<f64> {
    Ok(lower + (upper - lower) * fraction(u)?)
}

/// Positive, between two powers of ten with even odds for each.
pub fn size(u: &mut Unstructured<'_>, lowest: f64, highest: f64) -> Result<f64> {
    Ok(10.0_f64.powf(between(u, lowest, highest)?))
}

/// Of either sign.
pub fn signed(u: &mut Unstructured<'_>, lowest: f64, highest: f64) -> Result<f64> {
    let size = size(u, lowest, highest)?;
    Ok(if u.arbitrary()? { -size } else { size })
}

/// Any bits, NaN and infinities among them.
pub fn bits(u: &mut Unstructured<'_>) -> Result<f64> {
    u.arbitrary::<u64>().map(f64::from_bits)
}
