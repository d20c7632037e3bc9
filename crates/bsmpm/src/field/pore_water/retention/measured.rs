//! Measured retention curve, interpolated by monotone cubics.

/// Rows of suction head (m), effective saturation and relative permeability, starting at saturation. Monotone cubics
/// interpolate (Fritsch and Butland 1984); values are constant beyond the last row.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    pub(super) rows: Vec<[f64; 3]>,
    /// Slopes of both quantities at each row (1/m).
    slopes: Vec<[f64; 2]>,
}

impl MeasuredCurve {
    /// Creates the curve from at least two rows: heads increase from 0, the other values start at 1, do not increase
    /// and are not negative.
    pub fn new(rows: Vec<[f64; 3]>) -> Self {
        let slopes = (0..rows.len())
            .map(|k| [1, 2].map(|of| slope_at(&rows, k, of)))
            .collect();
        Self { rows, slopes }
    }

    /// Returns value and derivative with respect to the head of both quantities at the suction head `s` ≥ 0 (m).
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
            // Hermite cubic in t on [0, 1] with values a, b and slopes da, db: a + da t + square t^2 + cube t^3.
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

/// Returns the slope of column `of` at row `k`: the weighted harmonic mean of the adjacent chords; at the ends the
/// slope of a parabola, limited to keep monotonicity.
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

/// Returns the slope of a parabola at its end, from the lengths a, b and the chords of the two nearest intervals,
/// limited to keep monotonicity.
fn slope_at_end([a, b]: [f64; 2], [near, next]: [f64; 2]) -> f64 {
    let slope = ((2.0 * a + b) * near - a * next) / (a + b);
    slope.clamp(3.0 * near, 0.0)
}
