//! Chooses round numbers for axes.

/// A range of numbers, such as that which an axis shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// The smallest number.
    pub low: f64,
    /// The largest number.
    pub high: f64,
}

impl ValueRange {
    /// From 0 to 1, where there is nothing to be shown.
    pub(crate) const UNIT: Self = Self::of(0.0, 1.0);

    /// The range between two numbers.
    pub const fn of(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Returns the largest number less the smallest one.
    pub fn length(self) -> f64 {
        self.high - self.low
    }

    /// Returns whether a number lies in the range, its ends included.
    pub fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// The range with `share` of its length added at both ends; one of no length gets some.
    pub(crate) fn padded(self, share: f64) -> Self {
        let Self { low, high } = self;
        let length = self.length();
        let room = if length > 1e-12 * high.abs().max(low.abs()) {
            share * length
        } else {
            high.abs().max(1e-9) / 2.0
        };
        Self::of(low - room, high + room)
    }
}

/// How numbers are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Evenly.
    Linear,
    /// Evenly, with ticks at whole numbers only.
    Whole,
    /// By their logarithms, with ticks at powers of ten; for positive numbers.
    Logarithmic,
}

impl Scale {
    /// Where a number lies in a range: 0 at its lower, 1 at its upper end.
    pub fn share(self, value: f64, range: ValueRange) -> f64 {
        let ValueRange { low, high } = range;
        match self {
            Self::Linear | Self::Whole => (value - low) / (high - low),
            Self::Logarithmic => (value / low).ln() / (high / low).ln(),
        }
    }

    /// At most `count` ticks in a range, but at least two where so many are.
    pub fn ticks(self, range: ValueRange, count: f64) -> Ticks {
        let ValueRange { low, high } = range;
        match self {
            Self::Linear => Ticks::between(low, high, count),
            Self::Whole => Ticks::between(low, high, count.min(high - low)),
            Self::Logarithmic => Ticks::powers(low, high, count),
        }
    }
}

/// The round numbers of an axis and how they are written.
pub(crate) struct Ticks {
    pub values: Vec<f64>,
    form: TickForm,
}

/// How round numbers are written.
#[derive(Clone, Copy)]
enum TickForm {
    /// Divided by a power of 1000.
    Decimal { scale: f64, decimals: usize },
    /// As powers of ten.
    Power,
}

/// Powers of 1000 in the form that a unit takes.
const POWERS: [(i32, &str); 9] = [
    (-12, "10⁻¹²"),
    (-9, "10⁻⁹"),
    (-6, "10⁻⁶"),
    (-3, "10⁻³"),
    (0, ""),
    (3, "10³"),
    (6, "10⁶"),
    (9, "10⁹"),
    (12, "10¹²"),
];

impl Ticks {
    /// At most `count` (but at least two) round numbers between two finite ones: steps of 1, 2 or 5 times a power of
    /// ten.
    pub fn between(low: f64, high: f64, count: f64) -> Self {
        let rough = (high - low) / count.max(2.0);
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|digit| digit * power)
            .into_iter()
            .find(|step| *step >= rough * 0.999);
        let step = step.unwrap_or(10.0 * power);
        let first = (low / step - 1e-6).ceil();
        let steps = ((high / step + 1e-6).floor() - first).clamp(0.0, 100.0) as usize;
        // Adding zero turns the minus zero of a rounded-up fraction into zero.
        let values = (0..=steps).map(|i| (first + i as f64) * step + 0.0).collect();
        let scale = 10_f64.powi(power_of(low.abs().max(high.abs())));
        let decimals = (-(step / scale * 1.001).log10().floor()).clamp(0.0, 12.0) as usize;
        Self {
            values,
            form: TickForm::Decimal { scale, decimals },
        }
    }

    /// At most `count` powers of ten between two positive numbers, whose exponents are multiples of 1, 2, 3, ..
    pub fn powers(low: f64, high: f64, count: f64) -> Self {
        let first = (low.log10() - 1e-6).ceil() as i32;
        let last = (high.log10() + 1e-6).floor() as i32;
        let stride = (f64::from(last - first) / count.max(1.0)).ceil().max(1.0) as i32;
        let exponents = (first..=last).filter(|exponent| exponent % stride == 0);
        Self {
            values: exponents.map(|exponent| 10_f64.powi(exponent)).collect(),
            form: TickForm::Power,
        }
    }

    /// How a number of this axis is written.
    pub fn text(&self, value: f64) -> String {
        let TickForm::Decimal { scale, decimals } = self.form else {
            return power_text(value);
        };
        let text = format!("{:.*}", decimals, value / scale);
        let is_zero = text.trim_start_matches(['-', '0', '.']).is_empty();
        if is_zero {
            "0".to_owned()
        } else {
            text.replace('-', "−")
        }
    }

    /// The axis' label: the quantity with its unit, and the power of ten by which the numbers were divided.
    pub fn label(&self, quantity: &str, unit: &str) -> String {
        let scale = if let TickForm::Decimal { scale, .. } = self.form {
            scale
        } else {
            1.0
        };
        let power = POWERS
            .iter()
            .find(|(power, _)| 10_f64.powi(*power) == scale)
            .map_or("", |(_, text)| text);
        let unit = if unit == "-" { "" } else { unit };
        let prefix = ["", "k", "M", "G"]
            .into_iter()
            .zip(["", "10³", "10⁶", "10⁹"])
            .find(|(_, text)| *text == power);
        if let (Some((prefix, _)), true) = (prefix, unit.starts_with(['P', 'N'])) {
            return format!("{quantity} ({prefix}{unit})");
        }
        match (power.is_empty(), unit.is_empty()) {
            (true, true) => quantity.to_owned(),
            (true, false) => format!("{quantity} ({unit})"),
            (false, true) => format!("{quantity} ({power})"),
            (false, false) => format!("{quantity} ({power} {unit})"),
        }
    }
}

/// A power of ten as such: `10⁻⁸`.
fn power_text(value: f64) -> String {
    let exponent = format!("{:.0}", value.log10());
    if exponent == "0" {
        "1".to_owned()
    } else {
        "10".chars().chain(exponent.chars().map(superscript)).collect()
    }
}

/// Returns a digit or a minus as a superscript.
fn superscript(digit: char) -> char {
    match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        other => other
            .to_digit(10)
            .and_then(|digit| char::from_u32('⁰' as u32 + digit))
            .unwrap_or(other),
    }
}

/// The power of 1000, as one of ten, that brings numbers up to `largest` to a form without rows of zeros.
fn power_of(largest: f64) -> i32 {
    if largest <= 0.0 || !largest.is_finite() || (1e-2..1e5).contains(&largest) {
        return 0;
    }
    let last = POWERS[POWERS.len() - 1].0;
    // Small numbers read better as 0.25 thousandths than as 250 millionths.
    let lift = if largest < 1.0 { 1.0 } else { 0.0 };
    (((largest.log10() + lift) / 3.0).floor() as i32 * 3).clamp(-last, last)
}

/// The smallest and largest of finite numbers, if there are any.
pub(crate) fn range(values: impl IntoIterator<Item = f64>) -> Option<ValueRange> {
    let mut range: Option<ValueRange> = None;
    for value in values.into_iter().filter(|value| value.is_finite()) {
        range = Some(match range {
            None => ValueRange::of(value, value),
            Some(ValueRange { low, high }) => ValueRange::of(value.min(low), value.max(high)),
        });
    }
    range
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_written_without_noise() {
        let texts = |low, high, count| {
            let ticks = Ticks::between(low, high, count);
            ticks.values.iter().map(|&value| ticks.text(value)).collect::<Vec<_>>()
        };
        assert_eq!(texts(0.0, 0.55, 6.0), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(texts(-1.9, 0.1, 5.0), ["−1.5", "−1.0", "−0.5", "0"]);
        assert_eq!(texts(0.0, 2.5e-4, 5.0), ["0", "0.05", "0.10", "0.15", "0.20", "0.25"]);
        assert_eq!(texts(0.0, 3e6, 3.0), ["0", "1", "2", "3"]);
        assert_eq!(Ticks::between(0.0, 2.5e-4, 5.0).label("Step", "s"), "Step (10⁻³ s)");
        assert_eq!(Ticks::between(0.0, 1.0, 5.0).label("Iterations", "-"), "Iterations");
        assert_eq!(Ticks::between(0.0, 3e5, 5.0).label("Pressure", "Pa"), "Pressure (kPa)");
        assert_eq!(Ticks::between(0.0, 3e6, 5.0).label("Force", "N/m"), "Force (MN/m)");
    }

    #[test]
    fn logarithmic_axes_have_powers_of_ten_and_whole_ones_no_fractions() {
        let texts = |scale: Scale, low, high, count| {
            let ticks = scale.ticks(ValueRange::of(low, high), count);
            ticks.values.iter().map(|&value| ticks.text(value)).collect::<Vec<_>>()
        };
        assert_eq!(
            texts(Scale::Logarithmic, 3e-4, 20.0, 9.0),
            ["10⁻³", "10⁻²", "10⁻¹", "1", "10¹"]
        );
        assert_eq!(
            texts(Scale::Logarithmic, 1e-17, 3.0, 6.0),
            ["10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "1"]
        );
        assert_eq!(texts(Scale::Whole, 0.8, 4.2, 9.0), ["1", "2", "3", "4"]);
        assert_eq!(texts(Scale::Linear, 0.8, 2.2, 9.0)[0], "0.8");
        let share = Scale::Logarithmic.share(1e-4, ValueRange::of(1e-8, 1.0));
        assert!((share - 0.5).abs() < 1e-14, "{share}");
    }

    #[test]
    fn a_range_of_no_length_still_makes_an_axis() {
        for value in [0.0, 1e-30, -5.0, 1e12] {
            let ValueRange { low, high } = ValueRange::of(value, value).padded(0.05);
            assert!(low < value && value < high);
            assert!(Ticks::between(low, high, 5.0).values.len() >= 2, "{value}");
        }
    }
}
