//! Measured retention curve, interpolated by monotone cubics.

/// Rows of suction head, m, effective saturation and relative permeability, from the full soil on, with cubics between
/// that rise nowhere (Fritsch and Butland 1984); constant beyond the last row.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    pub(super) rows: Vec<[f64; 3]>,
    /// 1/m  of both at each row
    slopes: Vec<[f64; 2]>,
}

impl MeasuredCurve {
    /// Of rows whose heads rise from 0, and whose others fall from 1, or stay, without going below 0; at least two.
    pub fn new(rows: Vec<[f64; 3]>) -> Self {
        let slopes = (0..rows.len())
            .map(|k| [1, 2].map(|of| slope_at(&rows, k, of)))
            .collect();
        Self { rows, slopes }
    }

    /// Value and derivative by the head of both, under the suction head `s`, m, not negative.
    pub(super) fn at(&self, s: f64) -> [[f64; 2]; 2] {
        let above = self.rows.partition_point(|row| row[0] <= s);
        let Some(to) = self.rows.get(above) else {
            let last = self.rows[self.rows.len() - 1];
            return [[last[1], 0.0], [last[2], 0.0]];
        };
        let from = &self.rows[above - 1];
        let length = to[0] - from[0];
        let t = (s - from[0]) / (to[0] - from[0]);
        [0, 1].map(|of| {
            let a = from[of + 1];
            let b = to[of + 1];
            let da = self.slopes[above - 1][of] * length;
            let db = self.slopes[above][of] * length;
            let square = 3.0 * (b - a) - 2.0 * da - db;
            let cube = 2.0 * (a - b) + da + db;
            [
                a + t * (da + t * (square + t * cube)),
                (da + t * (2.0 * square + 3.0 * t * cube)) / length,
            ]
        })
    }
}

/// Slope of column `of` at row `k`: the harmonic mean of its neighbours', weighed by their lengths; at the ends the
/// parabola's, where that keeps the sense.
fn slope_at(rows: &[[f64; 3]], k: usize, of: usize) -> f64 {
    let length = |k: usize| rows[k + 1][0] - rows[k][0];
    let chord = |k: usize| (rows[k + 1][of] - rows[k][of]) / length(k);
    match (k, rows.len() - 1 - k) {
        (0, 1) => chord(0),
        (1, 0) => chord(0),
        (0, _) => slope_at_end([length(0), length(1)], [chord(0), chord(1)]),
        (_, 0) => slope_at_end([length(k - 1), length(k - 2)], [chord(k - 1), chord(k - 2)]),
        _ => {
            let a = chord(k - 1);
            let b = chord(k);
            if a * b <= 0.0 {
                return 0.0;
            }
            let wa = length(k - 1) + 2.0 * length(k);
            let wb = 2.0 * length(k - 1) + length(k);
            (wa + wb) / (wa / a + wb / b)
        }
    }
}

/// Slope of a parabola at its end, of the lengths a, b and the chords of the two intervals next to it; limited so that
/// it keeps the sense.
fn slope_at_end([a, b]: [f64; 2], [near, next]: [f64; 2]) -> f64 {
    let slope = ((2.0 * a + b) * near - a * next) / (a + b);
    slope.clamp(3.0 * near, 0.0)
}
