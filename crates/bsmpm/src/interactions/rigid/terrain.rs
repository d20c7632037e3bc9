//! Rigid terrain in 3-D: a raster of heights with bilinear interpolation.

use crate::tensor::Vector;

/// Number of fixed-point iterations for the foot of the perpendicular.
const SEARCHES: usize = 3;

/// Raster of heights. Outside the raster, the heights at its rim continue horizontally.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// Position of the first raster point (m), from the grid's lower corner.
    pub lower: [f64; 2],
    /// Spacing of the raster (m).
    pub spacing: [f64; 2],
    /// Number of raster points along x and y, at least two each.
    pub count: [usize; 2],
    /// Heights (m), x running fastest.
    pub heights: Vec<f64>,
}

impl Terrain {
    /// Returns the index of the last raster point before a position along an axis, and the fraction of the spacing
    /// beyond it.
    fn post(&self, axis: usize, at: f64) -> (usize, f64) {
        let last = (self.count[axis] - 1) as f64;
        let part = ((at - self.lower[axis]) / self.spacing[axis]).clamp(0.0, last);
        let post = (part as usize).min(self.count[axis] - 2);
        (post, part - post as f64)
    }

    /// Interpolates bilinearly between the values `of` the raster points.
    fn between(&self, [x, y]: [f64; 2], of: impl Fn([usize; 2]) -> f64) -> f64 {
        let (i, s) = self.post(0, x);
        let (j, t) = self.post(1, y);
        let [row, next] = [j, j + 1].map(|j| (1.0 - s) * of([i, j]) + s * of([i + 1, j]));
        (1.0 - t) * row + t * next
    }

    /// Returns the height of a raster point (m).
    fn height_at(&self, [i, j]: [usize; 2]) -> f64 {
        self.heights[j * self.count[0] + i]
    }

    /// Returns the height (m) at a position (m from the grid's lower corner).
    pub fn height(&self, at: [f64; 2]) -> f64 {
        self.between(at, |post| self.height_at(post))
    }

    /// Returns the slope along an axis. Central differences at the raster points are interpolated bilinearly, so that
    /// normals are continuous where the heights have a kink.
    fn slope(&self, at: [f64; 2], axis: usize) -> f64 {
        let far = self.lower[axis] + (self.count[axis] - 1) as f64 * self.spacing[axis];
        if at[axis] < self.lower[axis] || at[axis] > far {
            return 0.0;
        }
        self.between(at, |post| {
            let mut before = post;
            before[axis] = post[axis].saturating_sub(1);
            let mut after = post;
            after[axis] = (post[axis] + 1).min(self.count[axis] - 1);
            let apart = (after[axis] - before[axis]) as f64 * self.spacing[axis];
            (self.height_at(after) - self.height_at(before)) / apart
        })
    }

    /// Returns the distance (m) of a position (m from the grid's lower corner) and the unit normal at the foot of its
    /// perpendicular.
    pub(super) fn nearest<const D: usize>(&self, x: &Vector<D>) -> (f64, Vector<D>) {
        let mut foot = [x[0], x[1]];
        let mut found = (0.0, Vector::zeros());
        for _ in 0..SEARCHES {
            let height = self.height(foot);
            let slopes = [0, 1].map(|axis| self.slope(foot, axis));
            let size = (1.0 + slopes[0].powi(2) + slopes[1].powi(2)).sqrt();
            let normal = Vector::<D>::from_fn(|k, _| if k + 1 == D { 1.0 } else { -slopes[k] } / size);
            // Distance from the tangential plane at the foot.
            let from = Vector::<D>::from_fn(|k, _| if k + 1 == D { x[k] - height } else { x[k] - foot[k] });
            found = (normal.dot(&from), normal);
            foot = [0, 1].map(|axis| x[axis] - found.0 * normal[axis]);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(height: impl Fn(f64, f64) -> f64) -> Terrain {
        let posts = (0..11 * 11).map(|k| [(k % 11) as f64 * 0.5, (k / 11) as f64 * 0.5]);
        Terrain {
            lower: [0.0; 2],
            spacing: [0.5; 2],
            count: [11; 2],
            heights: posts.map(|[x, y]| height(x, y)).collect(),
        }
    }

    #[test]
    fn of_a_plane_distance_and_normal_are_exact() {
        let plane = of(|x, y| 1.0 + 0.5 * x - 0.25 * y);
        let normal = Vector::<3>::new(-0.5, 0.25, 1.0).normalize();
        for (at, distance) in [([2.2, 3.1], 0.3), ([1.0, 2.5], -0.2), ([2.5, 2.5], 0.0)] {
            let foot = Vector::<3>::new(at[0], at[1], 1.0 + 0.5 * at[0] - 0.25 * at[1]);
            let found = plane.nearest(&(foot + normal * distance));
            assert!((found.0 - distance).abs() < 1e-14 && (found.1 - normal).norm() < 1e-14);
        }
    }

    #[test]
    fn beyond_the_posts_the_surface_is_level() {
        let found = of(|x, y| 1.0 + 0.5 * x - 0.25 * y).nearest(&Vector::<3>::new(7.0, 2.0, 3.5));
        assert!((found.0 - 0.5 / (1.0_f64 + 0.0625).sqrt()).abs() < 1e-14, "{}", found.0);
        assert!(found.1[0] == 0.0 && found.1[1] > 0.2, "along x alone: {}", found.1);
    }

    #[test]
    fn of_a_bowl_the_foot_is_found() {
        // z = r2/10 about (2.5, 2.5): from a place on a normal, in a raster that is a chord of it.
        let bowl = of(|x, y| ((x - 2.5).powi(2) + (y - 2.5).powi(2)) / 10.0);
        let foot = Vector::<3>::new(3.5, 2.5, 0.1);
        let normal = Vector::<3>::new(-0.2, 0.0, 1.0).normalize();
        let found = bowl.nearest(&(foot + normal * 0.6));
        assert!((found.0 - 0.6).abs() < 1e-3, "{}", found.0);
        assert!((found.1 - normal).norm() < 1e-2, "{}", found.1);
    }
}
