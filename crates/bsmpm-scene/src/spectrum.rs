//! Finds the frequency below which 95 % of the energy of a prescribed motion or load lies. Cells must resolve waves of
//! this frequency.
//!
//! The energies of the Fourier components of the velocity (without its mean) are summed from the lowest frequency
//! upwards.

use realfft::RealFftPlanner;

/// Part of the energy that lies below the frequency.
pub(crate) const SHARE: f64 = 0.95;

/// Samples of a run, at least and at most.
const SAMPLES: [f64; 2] = [256.0, 65536.0];

/// Energy over that of the mean up to which it is round-off.
const ROUND_OFF: f64 = 1e-20;

/// What the numbers of an input are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InputKind {
    /// A force, or a share of one; it keeps its last value.
    Force,
    /// A displacement; it keeps its last value.
    Motion,
    /// An acceleration; zero after the last row.
    Acceleration,
}

/// Numbers at times (s, increasing), linear between, and zero at time 0 unless a row says otherwise.
#[derive(Clone, Debug)]
pub(crate) struct Signal {
    /// What the numbers are.
    pub kind: InputKind,
    /// s, and the numbers, as many in each row
    pub rows: Vec<(f64, Vec<f64>)>,
}

impl Signal {
    /// Hz  frequency below which [`SHARE`] of its energy lies in a run until `end`, s; `None` of what makes no wave.
    pub(crate) fn frequency(&self, end: f64) -> Option<f64> {
        let intervals = self.rows.windows(2).map(|pair| pair[1].0 - pair[0].0);
        let first = self.rows.first().map(|row| row.0).filter(|t| *t > 0.0);
        let shortest = intervals.chain(first).fold(f64::INFINITY, f64::min);
        let samples = (end / shortest).ceil().clamp(SAMPLES[0], SAMPLES[1]) as usize;
        let step = end / samples as f64;
        let mut energy = vec![0.0; samples + 1];
        for number in 0..self.rows.first()?.1.len() {
            add_energy(self.velocity(number, samples, step), &mut energy);
        }
        let total: f64 = energy[1..].iter().sum();
        let mut sum = 0.0;
        let place = energy[1..].iter().position(|part| {
            sum += part;
            sum >= SHARE * total
        });
        // What is constant leaves round-off besides its mean.
        let place = place.filter(|_| total > ROUND_OFF * energy[0])?;
        Some((place + 1) as f64 / (2.0 * end))
    }

    /// The velocity of one of the numbers, up to a factor, in the middle of each interval between samples.
    fn velocity(&self, number: usize, samples: usize, step: f64) -> Vec<f64> {
        let values: Vec<f64> = (0..=samples).map(|k| self.at(number, k as f64 * step)).collect();
        let means = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let mut sum = 0.0;
        let integrals = means.clone().map(|mean| {
            sum += mean;
            sum - 0.5 * mean
        });
        match self.kind {
            InputKind::Force => means.collect(),
            InputKind::Motion => values.windows(2).map(|pair| pair[1] - pair[0]).collect(),
            InputKind::Acceleration => integrals.collect(),
        }
    }

    /// A number at the time `t`, s.
    fn at(&self, number: usize, t: f64) -> f64 {
        let next = self.rows.partition_point(|row| row.0 < t);
        let Some((until, to)) = self.rows.get(next).map(|row| (row.0, row.1[number])) else {
            let last = self.rows.last().map_or(0.0, |row| row.1[number]);
            return if self.kind == InputKind::Acceleration {
                0.0
            } else {
                last
            };
        };
        let before = next.checked_sub(1).map(|before| &self.rows[before]);
        let (since, from) = before.map_or((0.0, 0.0), |row| (row.0, row.1[number]));
        if until > since {
            from + (to - from) * (t - since) / (until - since)
        } else {
            to
        }
    }
}

/// Adds |V(f)|² at the frequencies k/(2 end) of a velocity of so many samples, continued by its mirror image.
fn add_energy(mut velocity: Vec<f64>, energy: &mut [f64]) {
    velocity.extend(velocity.clone().into_iter().rev());
    let transform = RealFftPlanner::new().plan_fft_forward(velocity.len());
    let mut spectrum = transform.make_output_vec();
    // It fails where lengths differ only.
    if transform.process(&mut velocity, &mut spectrum).is_ok() {
        energy
            .iter_mut()
            .zip(&spectrum)
            .for_each(|(sum, value)| *sum += value.norm_sqr());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn signal(kind: InputKind, end: f64, dt: f64, value: impl Fn(f64) -> f64) -> Signal {
        let count = (end / dt).round() as usize;
        let rows = (0..=count)
            .map(|k| k as f64 * dt)
            .map(|t| (t, vec![value(t)]))
            .collect();
        Signal { kind, rows }
    }

    /// Each with a cosine as its velocity, which its mirror image continues smoothly.
    #[test]
    fn a_harmonic_has_its_own_frequency_whatever_it_is() {
        let value = |kind: InputKind, x: f64| match kind {
            InputKind::Force => x.cos(),
            InputKind::Motion => x.sin(),
            InputKind::Acceleration => -x.sin(),
        };
        for kind in [InputKind::Force, InputKind::Motion, InputKind::Acceleration] {
            let found = signal(kind, 4.0, 0.005, |t| value(kind, TAU * 5.0 * t))
                .frequency(4.0)
                .unwrap();
            assert!((found - 5.0).abs() <= 0.13, "{kind:?}: {found} Hz"); // one interval of the transform
        }
    }

    /// The spectrum of the velocity of a Ricker pulse of the frequency f is x² exp(-x²) with x = f'/f, and of its
    /// energy x⁴ exp(-2 x²), 95 % of which lie below x = 1.664 (quadrature).
    #[test]
    fn a_ricker_pulse_has_the_frequency_of_its_closed_form() {
        let pulse = |t: f64| {
            let x = (0.5 * TAU * 8.0 * (t - 0.3)).powi(2);
            (1.0 - 2.0 * x) * (-x).exp()
        };
        let found = signal(InputKind::Force, 1.0, 0.001, pulse).frequency(4.0).unwrap();
        assert!((found / (1.664 * 8.0) - 1.0).abs() < 0.02, "{found} Hz");
    }

    /// A load that grows over a tenth of the run is a slow one; one that grows at once has the odd harmonics of a step.
    #[test]
    fn a_load_that_stays_is_no_fast_wave() {
        let row = |t: f64| Signal {
            kind: InputKind::Force,
            rows: vec![(t, vec![1.0])],
        };
        assert!(row(1.0).frequency(10.0).unwrap() <= 0.5);
        assert!(row(10.0).frequency(10.0).unwrap() <= 0.2);
        let steady = Signal {
            kind: InputKind::Motion,
            rows: vec![(10.0, vec![0.3])],
        };
        assert_eq!(steady.frequency(1.0), None);
        let nothing = Signal {
            kind: InputKind::Motion,
            rows: vec![(1.0, vec![0.0])],
        };
        assert_eq!(nothing.frequency(2.0), None);
    }
}
