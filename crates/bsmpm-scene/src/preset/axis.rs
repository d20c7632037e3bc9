//! Places the grid lines (breakpoints) of a preset along one axis, equally spaced or graded.

/// Parts of a cell by which a place may miss a grid line: rounding.
pub(super) const ON_LINE: f64 = 1e-6;

/// Breakpoints along an axis at most: more are the author's to ask for.
pub(super) const MOST: f64 = 1e5;

/// A range of an axis in which cells are small.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fine {
    /// m
    pub lower: f64,
    /// m
    pub upper: f64,
    /// m  edge of a cell
    pub cell: f64,
}

/// Cells along an axis before they are made to fit between places that are given.
pub(super) struct Spacing {
    /// m  edge of a cell away from all fine ranges
    pub cell: f64,
    /// edge of a cell over that of the next smaller one beside a fine range
    pub growth: f64,
    pub fine: Vec<Fine>,
}

impl Spacing {
    /// m  Edge of a cell that starts at `x`. Half-way along a cell its edge is what a fine range wants there, which
    /// grows linearly with the distance: then neighbours are as `growth` to one.
    fn cell(&self, x: f64) -> f64 {
        let half = (self.growth - 1.0) / (self.growth + 1.0);
        let wanted = self.fine.iter().map(|range| {
            let ahead = (range.cell + 2.0 * half * (range.lower - x)) / (1.0 + half);
            let behind = (range.cell + 2.0 * half * (x - range.upper)) / (1.0 - half);
            range.cell.max(ahead).max(behind)
        });
        wanted.fold(self.cell, f64::min)
    }

    /// m  Breakpoints from the one end of an axis to the other, with one at every wanted place that is half a cell from
    /// those before it in the list, and from the ends; `None` for too many.
    pub(super) fn breakpoints(&self, [lower, upper]: [f64; 2], wanted: &[f64]) -> Option<Vec<f64>> {
        let mut fixed = vec![lower, upper];
        for &at in wanted.iter().filter(|at| (lower..=upper).contains(*at)) {
            if fixed.iter().all(|other| (at - other).abs() >= 0.5 * self.cell(at)) {
                fixed.push(at);
            }
        }
        fixed.sort_by(f64::total_cmp);
        let mut breakpoints = vec![lower];
        for pair in fixed.windows(2) {
            let inner = if self.fine.is_empty() {
                self.equal(pair)?
            } else {
                self.growing(pair)?
            };
            breakpoints.extend(inner.into_iter().chain([pair[1]]));
        }
        ((breakpoints.len() as f64) <= MOST).then_some(breakpoints)
    }

    /// m  breakpoints of equal cells between two places
    fn equal(&self, pair: &[f64]) -> Option<Vec<f64>> {
        let length = pair[1] - pair[0];
        let cells = (length / self.cell).round().max(1.0);
        (cells <= MOST).then(|| {
            let numbers = 1..cells as usize;
            numbers.map(|k| pair[0] + length * (k as f64 / cells)).collect()
        })
    }

    /// m  breakpoints of growing and shrinking cells between two places, all stretched alike to fit
    fn growing(&self, pair: &[f64]) -> Option<Vec<f64>> {
        let length = pair[1] - pair[0];
        let mut ends = vec![0.0];
        while ends[ends.len() - 1] < length {
            let last = ends[ends.len() - 1];
            ends.push(last + self.cell(pair[0] + last));
            if ends.len() as f64 > MOST {
                return None;
            }
        }
        let last = ends.len() - 1;
        if last > 1 && ends[last] - length > 0.5 * (ends[last] - ends[last - 1]) {
            ends.pop();
        }
        let whole = ends.pop()?;
        Some(
            ends.get(1..)?
                .iter()
                .map(|end| pair[0] + length * (end / whole))
                .collect(),
        )
    }
}
