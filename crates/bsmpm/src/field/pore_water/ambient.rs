//! Hydrostatic pressure below a water level or phreatic line, theory-manual equation (T8.2), and its nodal force
//! (T8.3).

use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::schedule::{between, turns};
use crate::tensor::Vector;

/// Hydrostatic pressure field, given by its level.
#[derive(Clone, Debug, PartialEq)]
pub enum Ambient {
    /// No hydrostatic pressure: the excess pressure is the whole pore pressure.
    None,
    /// Water level: rows of time (s or pseudo-time, increasing) and height above the lower corner of the grid (m);
    /// constant after the last row.
    Level(Vec<(f64, f64)>),
    /// Phreatic line: levels at increasing x, linear in between and horizontal outside.
    Line(Vec<LevelAt>),
}

/// Water level at one x.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelAt {
    /// Coordinate along axis 0 from the lower corner of the grid (m).
    pub x: f64,
    /// Rows of time and height, as in [`Ambient::Level`].
    pub rows: Vec<(f64, f64)>,
}

impl LevelAt {
    /// Returns the height of the level at time `t` (m); `None` without rows.
    fn height(&self, t: f64) -> Option<f64> {
        level(&self.rows, t)
    }
}

impl Ambient {
    /// Returns the height of the water table at `x` (m, along axis 0) and time `t` (m), and its slope along `x` (-).
    pub fn table(&self, x: f64, t: f64) -> Option<(f64, f64)> {
        match self {
            Self::None => None,
            Self::Level(rows) => Some((level(rows, t)?, 0.0)),
            Self::Line(places) => {
                let next = places.partition_point(|place| place.x <= x);
                let Some(before) = next.checked_sub(1).map(|before| &places[before]) else {
                    return Some((places.first()?.height(t)?, 0.0));
                };
                let low = before.height(t)?;
                let Some(after) = places.get(next) else {
                    return Some((low, 0.0));
                };
                let slope = (after.height(t)? - low) / (after.x - before.x);
                Some((low + slope * (x - before.x), slope))
            }
        }
    }

    /// Returns the levels as functions of time: the single one, or those along a phreatic line.
    pub fn levels(&self) -> Vec<&[(f64, f64)]> {
        match self {
            Self::None => Vec::new(),
            Self::Level(rows) => vec![rows],
            Self::Line(places) => places.iter().map(|place| &place.rows[..]).collect(),
        }
    }

    /// Returns the same levels for modification.
    pub fn levels_mut(&mut self) -> Vec<&mut Vec<(f64, f64)>> {
        match self {
            Self::None => Vec::new(),
            Self::Level(rows) => vec![rows],
            Self::Line(places) => places.iter_mut().map(|place| &mut place.rows).collect(),
        }
    }

    /// Returns whether a level changes abruptly in a step.
    pub fn turns(&self, interval: TimeInterval) -> bool {
        self.levels()
            .iter()
            .any(|rows| turns(rows, rows.first().map_or(0.0, |row| row.1), f64::abs, interval))
    }

    /// Returns whether a level rises or falls.
    pub fn moves(&self) -> bool {
        self.levels()
            .iter()
            .any(|rows| rows.windows(2).any(|pair| pair[0].1 != pair[1].1))
    }
}

/// Vertical extent of a material point. The default is a point without extent.
#[derive(Clone, Copy, Debug, Default)]
pub struct Span {
    /// Distance from the point to either end of the subcell that belongs to it (m).
    pub reach: f64,
    /// Volume of the point relative to that of the subcell, which it fills from below (-).
    pub filled: f64,
}

impl Span {
    /// Returns the extent of a point `at` (m) above the lower side of its cell, whose subcells have the height `part`
    /// (m) and the volume ratio `filled`. In the middle of a subcell the point fills it from below, because bodies end
    /// at their surface within cells more often than at their base; `filled` may exceed 1, if the volume of a neighbour
    /// without a point of its own was added. Elsewhere the extent is proportional to the volume.
    pub fn of(at: f64, part: f64, filled: f64) -> Self {
        let row = at / part - 0.5;
        let whole = (row - row.round()).abs() < 1e-6 && (0.5 - 1e-9..=2.0).contains(&filled);
        if whole {
            Self {
                reach: 0.5 * part,
                filled,
            }
        } else {
            Self {
                reach: 0.5 * part * filled,
                filled: 1.0,
            }
        }
    }

    /// Returns the extent for a water table of this slope. It is zero for an inclined table, which often coincides with
    /// the ground surface, along which the points end anyway.
    pub fn under(self, slope: f64) -> Self {
        if slope == 0.0 { self } else { Self::default() }
    }

    /// Returns the fraction of the point below a water table that lies `above` (m) its position.
    pub fn share_below(self, above: f64) -> f64 {
        let Self { reach, filled } = self;
        match reach * filled > 0.0 {
            true => ((above + reach) / (2.0 * reach * filled)).clamp(0.0, 1.0),
            false => f64::from(above > 0.0),
        }
    }
}

/// Returns the height at time `t` from rows of time and height; `None` without rows.
fn level(rows: &[(f64, f64)], t: f64) -> Option<f64> {
    let (first, last) = rows.first().zip(rows.last())?;
    Some(between(rows, first.1, t).unwrap_or(last.1))
}

/// Hydrostatic pressure field at one time.
#[derive(Clone, Copy, Debug)]
pub struct StillWater<'a> {
    ambient: &'a Ambient,
    unit_weight: f64, // unit weight at the present fraction of gravity (N/m3)
    t: f64,
}

impl<'a> StillWater<'a> {
    /// Creates the field at time `t` with the `unit_weight` (N/m3) at that time.
    pub fn new(ambient: &'a Ambient, unit_weight: f64, t: f64) -> Self {
        Self {
            ambient,
            unit_weight,
            t,
        }
    }

    /// Returns the pressure p_a at `x` (m, from the lower corner of the grid): the unit weight times the depth below
    /// the water table; 0 above it (Pa).
    pub fn pressure<const D: usize>(&self, x: &Vector<D>) -> f64 {
        let table = self.ambient.table(x[0], self.t);
        table.map_or(0.0, |(height, _)| self.unit_weight * (height - x[D - 1]).max(0.0))
    }

    /// Returns the force of hydrostatic pressure on point `p` of the extent `span` (N): -J V0 grad p_a over the part
    /// below the water table. Unless the mass of the point `follows` its water content, the weight of water that the
    /// pores have taken in or released is included.
    pub fn force<const D: usize>(&self, points: &Points<D>, p: usize, span: Span, follows: bool) -> Vector<D> {
        let x = &points.x[p];
        let mut force = Vector::zeros();
        let Some((height, slope)) = self.ambient.table(x[0], self.t) else {
            return force;
        };
        let below = span.under(slope).share_below(height - x[D - 1]);
        if below > 0.0 {
            let volume = points.volume[p] * below;
            if slope != 0.0 {
                force[0] = -self.unit_weight * slope * volume * points.F.at(p).determinant();
            }
            let weighed = if follows { points.F.at(p).determinant() } else { 1.0 };
            force[D - 1] = self.unit_weight * volume * weighed;
        }
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::Seed;

    /// A line of places and heights that stays.
    fn line(places: &[(f64, f64)]) -> Ambient {
        Ambient::Line(
            places
                .iter()
                .map(|&(x, height)| LevelAt {
                    x,
                    rows: vec![(0.0, height)],
                })
                .collect(),
        )
    }

    #[test]
    fn a_line_moves_from_one_to_another() {
        let moving = Ambient::Line(vec![
            LevelAt {
                x: 0.0,
                rows: vec![(0.0, 1.0), (4.0, 3.0)],
            },
            LevelAt {
                x: 2.0,
                rows: vec![(2.0, 5.0), (4.0, 1.0)],
            },
        ]);
        let at = |x: f64, t: f64| moving.table(x, t).unwrap();
        assert_eq!(
            [at(0.0, 2.0), at(1.0, 2.0), at(3.0, 2.0)],
            [(2.0, 1.5), (3.5, 1.5), (5.0, 0.0)]
        );
        assert_eq!(
            [at(1.0, 0.0), at(1.0, 3.0), at(1.0, 9.0)],
            [(3.0, 2.0), (2.75, 0.25), (2.0, -1.0)]
        );
        assert!(moving.moves() && !line(&[(0.0, 1.0), (2.0, 3.0)]).moves());
    }

    /// An infinite slope of 20 degrees whose water table is its surface: what a point weighs and what the water does to
    /// it, along the slope and normal to it, give tan phi/tan beta (1 - gamma_w/(gamma cos^2 beta)).
    #[test]
    fn seepage_along_a_slope_lowers_its_factor_of_safety() {
        let beta = 20.0_f64.to_radians();
        let phi = 35.0_f64.to_radians();
        let line = line(&[(0.0, 0.0), (100.0, 100.0 * beta.tan())]);
        let x = Vector::<2>::new(50.0, 10.0);
        let v = Vector::<2>::zeros();
        let seed = Seed {
            id: 0,
            material: 0,
            x,
            volume: 0.25,
            mass: 0.25 * 20.0 / 9.81,
            v,
        };
        let points = Points::<2>::from_seeds([seed], false);
        let weight = Vector::<2>::new(0.0, -9.81) * points.mass[0];
        let acts = weight + StillWater::new(&line, 9.81, 0.0).force(&points, 0, Span::default(), false);
        let down = Vector::<2>::new(-beta.cos(), -beta.sin());
        let into = Vector::<2>::new(beta.sin(), -beta.cos());
        let factor = phi.tan() * acts.dot(&into) / acts.dot(&down);
        assert!((factor - 0.8552).abs() < 5e-5, "{factor}");
        assert!((factor - phi.tan() / beta.tan() * (1.0 - 9.81 / (20.0 * beta.cos().powi(2)))).abs() < 1e-12);
    }

    #[test]
    fn a_table_is_linear_between_its_rows_and_level_beyond_them() {
        let line = line(&[(1.0, 2.0), (3.0, 6.0), (4.0, 5.0)]);
        let at = |x: f64| line.table(x, 7.0);
        assert_eq!(
            [at(0.0), at(1.0), at(2.0)],
            [Some((2.0, 0.0)), Some((2.0, 2.0)), Some((4.0, 2.0))]
        );
        assert_eq!(
            [at(3.5), at(4.0), at(9.0)],
            [Some((5.5, -1.0)), Some((5.0, 0.0)), Some((5.0, 0.0))]
        );
        let path = Ambient::Level(vec![(1.0, 8.0), (3.0, 4.0)]);
        let at = |t: f64| path.table(0.0, t);
        assert_eq!(
            [at(0.0), at(2.0), at(5.0)],
            [Some((8.0, 0.0)), Some((6.0, 0.0)), Some((4.0, 0.0))]
        );
        assert_eq!(Ambient::None.table(1.0, 1.0), None);
    }

    #[test]
    fn pressure_is_that_of_the_depth_straight_below_the_table() {
        let line = line(&[(0.0, 2.0), (2.0, 4.0)]);
        let water = StillWater::new(&line, 10.0, 0.0);
        let at = |x: f64, y: f64| water.pressure(&Vector::<2>::new(x, y));
        assert_eq!(
            [at(1.0, 1.0), at(1.0, 3.0), at(1.0, 3.5), at(5.0, 0.0)],
            [20.0, 0.0, 0.0, 40.0]
        );
    }
}
