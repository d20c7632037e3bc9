//! Fits lines to displacement curves before and after failure, which intersect at the failure load.

/// The branch after failure: from this many times the elastic displacement ..
pub(crate) const BENT: f64 = 5.0;
/// .. to this many times; so early that the geometry has not changed yet.
pub(crate) const FALLEN: f64 = 20.0;

/// `y = at_zero + slope x`
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FittedLine {
    pub at_zero: f64,
    pub slope: f64,
}

impl FittedLine {
    pub fn through(a: [f64; 2], b: [f64; 2]) -> Self {
        let slope = (b[1] - a[1]) / (b[0] - a[0]);
        Self {
            at_zero: a[1] - slope * a[0],
            slope,
        }
    }

    /// The line of least squares; level through a single place.
    pub fn fitted(places: &[[f64; 2]]) -> Option<Self> {
        let count = places.len() as f64;
        let mut mean = [0.0; 2];
        for [x, y] in places {
            mean[0] += x / count;
            mean[1] += y / count;
        }
        let product: f64 = places.iter().map(|[x, y]| (x - mean[0]) * (y - mean[1])).sum();
        let square: f64 = places.iter().map(|[x, _]| (x - mean[0]).powi(2)).sum();
        let slope = if square > 0.0 { product / square } else { 0.0 };
        (!places.is_empty()).then_some(Self {
            at_zero: mean[1] - slope * mean[0],
            slope,
        })
    }

    /// The y of an x.
    pub fn at(&self, x: f64) -> f64 {
        self.at_zero + self.slope * x
    }

    /// The x of a y.
    pub fn reaches(&self, y: f64) -> f64 {
        (y - self.at_zero) / self.slope
    }
}
