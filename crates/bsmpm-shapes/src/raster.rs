//! Terrain between two rasters of heights (top and base), with bilinear interpolation.

use crate::error::RasterError;

/// Parts of the spacing by which posts may miss their places: rounding of what wrote them.
const ROUNDING: f64 = 1e-3;

/// A body between heights at the points of a regular grid, the top, and a base below them. Heights are interpolated
/// bilinearly between the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// m  the first post
    lower: [f64; 2],
    /// m  between posts, along x and y
    spacing: [f64; 2],
    /// posts along x and y, at least two each
    count: [usize; 2],
    /// m  of every post, x running fastest
    top: Vec<f64>,
    /// m  the same, nowhere above it
    base: Vec<f64>,
}

impl Raster {
    /// Places of the posts along an axis, m.
    pub(super) fn posts(&self, axis: usize) -> Vec<f64> {
        (0..self.count[axis])
            .map(|k| self.lower[axis] + self.spacing[axis] * k as f64)
            .collect()
    }

    /// Returns the body below the points `[x, y, z]` (m), in any order, and above a level (m).
    ///
    /// # Errors
    /// If the points are not those of a regular grid, or are below the level.
    pub fn new(rows: &[[f64; 3]], level: f64) -> Result<Self, RasterError> {
        if rows.len() < 4 {
            return Err(RasterError::TooFew);
        }
        let places = [0, 1].map(|axis| {
            let mut along: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
            along.sort_by(f64::total_cmp);
            along
        });
        let ends = places.each_ref().map(|along| [along[0], along[along.len() - 1]]);
        let spacing = places.each_ref().map(|along| {
            let far = (along[along.len() - 1] - along[0]).max(f64::MIN_POSITIVE);
            let steps = along.windows(2).map(|pair| pair[1] - pair[0]);
            steps.filter(|step| *step > 1e-6 * far).fold(f64::INFINITY, f64::min)
        });
        if spacing.iter().any(|step| !step.is_finite()) {
            return Err(RasterError::TooFew);
        }
        let count = [0, 1].map(|axis| ((ends[axis][1] - ends[axis][0]) / spacing[axis]).round() as usize + 1);
        if count[0].saturating_mul(count[1]) != rows.len() {
            return Err(RasterError::Irregular {
                rows: rows.len(),
                spacing,
                count,
            });
        }
        let spacing = [0, 1].map(|axis| (ends[axis][1] - ends[axis][0]) / (count[axis] - 1) as f64);
        let mut top = vec![f64::NAN; rows.len()];
        for row in rows {
            let part = [0, 1].map(|axis| (row[axis] - ends[axis][0]) / spacing[axis]);
            let post = part.map(|part| part.round() as usize);
            let is_off = (0..2).any(|axis| (part[axis] - part[axis].round()).abs() > ROUNDING);
            let place = post[1] * count[0] + post[0];
            let at = [row[0], row[1]];
            if is_off {
                return Err(RasterError::OffGrid { at });
            }
            if !top[place].is_nan() {
                return Err(RasterError::Repeated { at });
            }
            top[place] = row[2];
        }
        let base = vec![level; top.len()];
        Self {
            lower: [ends[0][0], ends[1][0]],
            spacing,
            count,
            top,
            base,
        }
        .checked()
    }

    /// Returns the body between the top of this one and the top of another one at the same points.
    ///
    /// # Errors
    /// If the points are not the same, or the top is below the base.
    pub fn on(self, base: Self) -> Result<Self, RasterError> {
        let has_same_posts = (0..2).all(|axis| {
            let off = (self.lower[axis] - base.lower[axis]).abs() + (self.spacing[axis] - base.spacing[axis]).abs();
            off <= ROUNDING * self.spacing[axis]
        });
        if self.count != base.count || !has_same_posts {
            return Err(RasterError::DifferentPoints);
        }
        Self { base: base.top, ..self }.checked()
    }

    /// Returns the first point (m) in x and y.
    pub fn lower(&self) -> [f64; 2] {
        self.lower
    }

    /// Returns the distance of the points along x and y (m).
    pub fn spacing(&self) -> [f64; 2] {
        self.spacing
    }

    /// Returns the number of points along x and y, at least two each.
    pub fn count(&self) -> [usize; 2] {
        self.count
    }

    /// Returns the height of the top at each point (m), x running fastest.
    pub fn top(&self) -> &[f64] {
        &self.top
    }

    fn checked(self) -> Result<Self, RasterError> {
        let mut posts = self.top.iter().zip(&self.base).enumerate();
        if let Some((post, (top, base))) = posts.find(|(_, (top, base))| top < base) {
            let at = [post % self.count[0], post / self.count[0]];
            return Err(RasterError::TopBelowBase {
                at: [0, 1].map(|axis| self.lower[axis] + at[axis] as f64 * self.spacing[axis]),
                top: *top,
                base: *base,
            });
        }
        if self.top == self.base {
            return Err(RasterError::NoVolume);
        }
        Ok(self)
    }

    pub(crate) fn moved(mut self, by: [f64; 3]) -> Self {
        (0..2).for_each(|axis| self.lower[axis] += by[axis]);
        let heights = self.top.iter_mut().chain(&mut self.base);
        heights.for_each(|height| *height += by[2]);
        self
    }

    /// Lower and upper corner of the cuboid around it.
    pub(crate) fn bounds(&self) -> [[f64; 3]; 2] {
        let [x, y] = [0, 1].map(|axis| self.lower[axis] + (self.count[axis] - 1) as f64 * self.spacing[axis]);
        let low = self.base.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.top.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        [[self.lower[0], self.lower[1], low], [x, y, high]]
    }

    /// m³, exact of what is bilinear
    pub(crate) fn volume(&self) -> f64 {
        let [columns, rows] = self.count;
        let thick = |x: usize, y: usize| self.top[y * columns + x] - self.base[y * columns + x];
        let sums = (0..rows - 1).map(|y| {
            let cells = (0..columns - 1)
                .map(|x| 0.25 * (thick(x, y) + thick(x + 1, y) + thick(x, y + 1) + thick(x + 1, y + 1)));
            cells.sum::<f64>()
        });
        sums.sum::<f64>() * self.spacing[0] * self.spacing[1]
    }

    /// What it covers of the vertical line at a place.
    pub(crate) fn vertical(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let part = [0, 1].map(|axis| (at[axis] - self.lower[axis]) / self.spacing[axis]);
        if (0..2).any(|axis| part[axis] < 0.0 || part[axis] >= (self.count[axis] - 1) as f64) {
            return None;
        }
        let [x, y] = part.map(|part| part.floor() as usize);
        let [s, t] = [part[0] - x as f64, part[1] - y as f64];
        let ends = [&self.base, &self.top].map(|heights| {
            let [south, north] = [y, y + 1].map(|y| {
                let posts = &heights[y * self.count[0] + x..];
                (1.0 - s) * posts[0] + s * posts[1]
            });
            (1.0 - t) * south + t * north
        });
        (ends[0] < ends[1]).then_some(ends)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(height: impl Fn(f64, f64) -> f64) -> Vec<[f64; 3]> {
        let posts = (0..5).flat_map(|x| (0..4).map(move |y| [10.0 + 0.5 * f64::from(x), -1.0 + f64::from(y)]));
        posts.map(|[x, y]| [x, y, height(x, y)]).collect()
    }

    #[test]
    fn what_is_bilinear_is_exact() {
        let top = |x: f64, y: f64| 3.0 + 0.1 * x - 0.2 * y + 0.05 * x * y;
        let raster = Raster::new(&rows(top), 0.5).unwrap();
        assert_eq!(raster.vertical([10.0, -1.0]), Some([0.5, top(10.0, -1.0)]));
        for at in [[10.3, 0.2], [11.9, 1.7]] {
            let [base, found] = raster.vertical(at).unwrap();
            assert!((found - top(at[0], at[1])).abs() < 1e-12 && base == 0.5);
        }
        assert_eq!(
            (raster.vertical([12.0, 0.0]), raster.vertical([10.1, -1.1])),
            (None, None)
        );
        // The mean of x is 11, of y 0.5, of x y 5.5.
        assert!((raster.volume() - 6.0 * (2.5 + 1.1 - 0.1 + 0.05 * 5.5)).abs() < 1e-12);
        let slide = Raster::new(&rows(|x, y| top(x, y) + (x - 10.5).max(0.0)), 0.0)
            .unwrap()
            .on(raster)
            .unwrap();
        assert_eq!(slide.vertical([10.2, 0.0]), None);
        assert!((slide.volume() - 3.0 * 1.125).abs() < 1e-9, "{}", slide.volume());
        let moved = slide.clone().moved([1.0, 2.0, 3.0]);
        assert!((moved.volume() - slide.volume()).abs() < 1e-9);
        assert!((moved.bounds()[0][2] - slide.bounds()[0][2] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_raster_is_refused() {
        let error = |rows: &[[f64; 3]], level: f64| Raster::new(rows, level).unwrap_err();
        let mut posts = rows(|_, _| 1.0);
        let below = RasterError::TopBelowBase {
            at: [10.0, -1.0],
            top: 1.0,
            base: 2.0,
        };
        assert_eq!(error(&posts, 2.0), below);
        assert_eq!(error(&posts, 1.0), RasterError::NoVolume);
        posts[7][0] += 0.1;
        let irregular = error(&posts, 0.0);
        assert!(
            matches!(irregular, RasterError::Irregular { rows: 20, .. }),
            "{irregular:?}"
        );
        let mut twice = rows(|_, _| 1.0);
        twice[3] = twice[2];
        assert_eq!(error(&twice, 0.0), RasterError::Repeated { at: [10.0, 1.0] });
        let line = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        assert_eq!(error(&line, 0.0), RasterError::TooFew);
    }
}
