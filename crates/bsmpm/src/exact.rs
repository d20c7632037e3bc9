//! Exact sums of floating-point numbers, bitwise identical in any order. The accumulator is a long integer of many
//! 64-bit words (Kulisch and Miranker, 1986; Neal, 2015).

use std::ops::{AddAssign, SubAssign};

/// Digits of 32 bits from the smallest to the largest float, with headroom for 2^31 terms.
const DIGITS: usize = 68;
/// Number of integers of a sum, which ranks add up.
pub const WORDS: usize = DIGITS + 1;
/// Bits of a digit.
const BITS: u32 = 32;

/// Unrounded sum of up to 2^31 floats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exact {
    words: [i64; WORDS], // signed digits, and the number of terms that were not finite
}

impl Default for Exact {
    fn default() -> Self {
        Self::ZERO
    }
}

impl Exact {
    /// Empty sum.
    pub const ZERO: Self = Self { words: [0; WORDS] };

    /// Adds a float.
    #[inline]
    pub fn add(&mut self, number: f64) {
        if number == 0.0 {
            return;
        }
        let bits = number.to_bits();
        let exponent = (bits >> 52) as u32 & 0x7ff;
        if exponent == 0x7ff {
            self.words[DIGITS] += 1;
            return;
        }
        let fraction = bits & ((1 << 52) - 1);
        // A normal number is (2^52 + fraction) 2^(exponent - 1) units of 2^-1074, a subnormal one fraction units.
        let (significand, shift) = if exponent == 0 {
            (fraction, 0)
        } else {
            (fraction | 1 << 52, exponent - 1)
        };
        // The shifted significand has at most 53 + 31 = 84 bits, so it spans three digits of 32 bits.
        let digit = (shift / BITS) as usize;
        let spread = u128::from(significand) << (shift % BITS);
        let sign = if number.is_sign_negative() { -1 } else { 1 };
        for (k, word) in self.words[digit..digit + 3].iter_mut().enumerate() {
            *word += sign * i64::from((spread >> (BITS * k as u32)) as u32);
        }
    }

    /// Returns the sum, rounded to the nearest float; NaN if a term was not finite. A change of units by powers of two
    /// does not change the digits.
    pub fn value(&self) -> f64 {
        if self.words[DIGITS] != 0 {
            return f64::NAN;
        }
        let mut digits = [0_i64; DIGITS];
        let mut carry = 0;
        for (digit, word) in digits.iter_mut().zip(&self.words) {
            let sum = word + carry;
            (*digit, carry) = (sum & 0xffff_ffff, sum >> BITS);
        }
        if carry < 0 {
            return -self.negated().value();
        }
        // The highest nonzero digit and the two below it contain at least 65 bits.
        let Some(top) = digits.iter().rposition(|&digit| digit != 0) else {
            return 0.0;
        };
        let leading = (0..3).rev().fold(0_u128, |sum, k| {
            let place = (top + k).checked_sub(2);
            sum << BITS | place.map_or(0, |place| digits[place] as u128)
        });
        // The remaining digits decide only if the others lie exactly between two floats.
        let rest = digits[..top.saturating_sub(2)].iter().any(|&digit| digit != 0);
        let leading = leading | u128::from(rest);
        let exponent = (top as i32 - 2) * BITS as i32 - 1074;
        // Two factors, because 2^exponent alone may underflow.
        leading as f64 * 2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent - exponent / 2)
    }

    fn negated(&self) -> Self {
        let mut negated = Self::ZERO;
        negated -= self;
        negated
    }

    /// Returns the integers of the sum, to be added to those of other ranks.
    pub fn words(&self) -> &[i64; WORDS] {
        &self.words
    }

    /// Creates the sum from its integers.
    ///
    /// # Panics
    /// If there are not [`WORDS`] of them.
    pub fn of_words(words: &[i64]) -> Self {
        Self {
            words: words.try_into().expect("as many words as a sum has"),
        }
    }
}

impl AddAssign<&Exact> for Exact {
    fn add_assign(&mut self, other: &Exact) {
        self.words
            .iter_mut()
            .zip(&other.words)
            .for_each(|(sum, word)| *sum += word);
    }
}

impl SubAssign<&Exact> for Exact {
    fn sub_assign(&mut self, other: &Exact) {
        // A sum with terms that are not finite stays NaN.
        let none = self.words[DIGITS].max(other.words[DIGITS]);
        self.words
            .iter_mut()
            .zip(&other.words)
            .for_each(|(sum, word)| *sum -= word);
        self.words[DIGITS] = none;
    }
}

impl Extend<f64> for Exact {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, numbers: I) {
        numbers.into_iter().for_each(|number| self.add(number));
    }
}

impl FromIterator<f64> for Exact {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut sum = Self::default();
        sum.extend(numbers);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(numbers: &[f64]) -> f64 {
        numbers.iter().copied().collect::<Exact>().value()
    }

    #[test]
    fn single_floats_come_back_as_they_are() {
        let edges = [
            0.0,
            1.0,
            -1.0,
            0.1,
            -3.7e-200,
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            5e-324,
            -5e-324,
            4.1e-311,
        ];
        for number in edges {
            assert_eq!(value(&[number]), number, "{number:e}");
        }
    }

    #[test]
    fn what_cancels_leaves_what_is_left() {
        assert_eq!(value(&[1e300, 1.0, -1e300]), 1.0);
        assert_eq!(value(&[1e-300, 1e16, 1.0, -1e16, -1.0]), 1e-300);
        assert_eq!(value(&[0.1, 0.2, -0.1, -0.2]), 0.0);
        assert_eq!(value(&[-1e16, -1.0, 1e16]), -1.0);
    }

    #[test]
    fn the_order_and_the_parts_change_no_bit() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let mantissa = (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
            mantissa * 2.0_f64.powi((seed % 120) as i32 - 60)
        };
        let numbers: Vec<f64> = (0..5000).map(|_| random()).collect();
        let whole: Exact = numbers.iter().copied().collect();
        let backwards: Exact = numbers.iter().rev().copied().collect();
        let mut parts = [0; WORDS];
        for part in numbers.chunks(617) {
            let part: Exact = part.iter().copied().collect();
            parts.iter_mut().zip(part.words()).for_each(|(sum, word)| *sum += word);
        }
        assert_eq!(whole, backwards);
        assert_eq!(whole, Exact::of_words(&parts));
        let plain: f64 = numbers.iter().sum();
        let size: f64 = numbers.iter().map(|number| number.abs()).sum();
        assert!((whole.value() - plain).abs() <= 1e-12 * size);
    }

    #[test]
    fn a_power_of_two_changes_no_digit() {
        let numbers: Vec<f64> = (1..400)
            .map(|k| (f64::from(k) * 0.37).sin() / f64::from(k * k))
            .collect();
        let sum = value(&numbers);
        for power in -200..200 {
            let unit = 2.0_f64.powi(power);
            let scaled: Vec<f64> = numbers.iter().map(|number| number * unit).collect();
            assert_eq!(value(&scaled), sum * unit, "2^{power}");
        }
        // Half way but for the smallest rest, whose digit is far below.
        assert_eq!(value(&[1.0, f64::EPSILON / 2.0, 1e-200]), 1.0 + f64::EPSILON);
        assert_eq!(value(&[1.0, f64::EPSILON / 2.0]), 1.0);
    }

    #[test]
    fn no_number_stays_none() {
        assert!(value(&[1.0, f64::NAN]).is_nan());
        assert!(value(&[f64::INFINITY, f64::NEG_INFINITY]).is_nan());
        assert!(value(&[f64::MAX, f64::MAX]).is_infinite());
    }
}
