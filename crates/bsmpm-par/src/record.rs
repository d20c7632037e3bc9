//! Rows of `history.csv`: the quantities that the case asks for, in the case's own coordinates.

use bsmpm::error::StepError;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::{self, noise};
use bsmpm::points::Points;
use bsmpm::seam::Halo;
use bsmpm::tensor::Vector;
use bsmpm_scene::{Face, History, Quantity};

/// Place of the vertical normal stress among XX YY ZZ XY YZ XZ.
const VERTICAL: usize = 1;

/// The histories of a run, with the points that they follow.
pub struct Recorder {
    histories: Vec<History>,
    followed: Vec<Option<u64>>,
    lower: Vector<2>,
}

impl Recorder {
    /// Finds the points nearest to the wanted places; `lower` is the grid's lower corner in the case's coordinates (m).
    pub fn new(histories: &[History], lower: [f64; 2], points: &Points<2>, halo: &dyn Halo) -> Self {
        let lower = Vector::from(lower);
        let follow = |history: &History| match history.quantity {
            Quantity::Displacement { at } | Quantity::Velocity { at } | Quantity::Stress { at } => {
                observe::nearest(points, &(Vector::from(at) - lower), halo)
            }
            _ => None,
        };
        Self { histories: histories.to_vec(), followed: histories.iter().map(follow).collect(), lower }
    }

    /// Heading and unit of every column.
    pub fn columns(&self) -> Vec<bsmpm_io::table::Column> {
        let columns = self.histories.iter().flat_map(History::columns);
        columns.map(|column| bsmpm_io::table::Column::new(&column.name, &column.unit)).collect()
    }

    /// The row of the present state; `reactions` are the supports' forces by component, empty at the start.
    pub fn row<K: Kinematics<2>>(
        &self,
        model: &Model<K, 2>,
        points: &Points<2>,
        reactions: &[Vec<f64>],
        halo: &dyn Halo,
    ) -> Result<Vec<f64>, StepError> {
        let mut row = Vec::new();
        for (history, followed) in self.histories.iter().zip(&self.followed) {
            let values = self.values(&history.quantity, *followed, model, points, reactions, halo)?;
            row.extend(values.iter().map(|value| history.scale * value));
        }
        Ok(row)
    }

    fn values<K: Kinematics<2>>(
        &self,
        quantity: &Quantity,
        followed: Option<u64>,
        model: &Model<K, 2>,
        points: &Points<2>,
        reactions: &[Vec<f64>],
        halo: &dyn Halo,
    ) -> Result<Vec<f64>, StepError> {
        let id = followed.unwrap_or(u64::MAX);
        Ok(match quantity {
            Quantity::Runout { percentile } if *percentile < 100.0 => {
                vec![self.lower[0] + observe::percentile(points, 0, *percentile, halo)]
            }
            Quantity::Runout { .. } => vec![self.lower[0] + observe::farthest(points, 0, halo)],
            Quantity::Front => vec![self.lower[0] + observe::front(&model.grid, points, halo)],
            Quantity::Height => vec![self.lower[1] + observe::farthest(points, 1, halo)],
            Quantity::MaxDisplacement => vec![observe::largest_displacement(points, halo)],
            Quantity::Mass => vec![observe::mass(points, halo)],
            Quantity::Momentum => observe::momentum(points, halo).as_slice().to_vec(),
            Quantity::Reaction { face } => reaction(model, *face, reactions),
            Quantity::Displacement { .. } => observe::at_point(points, id, halo, |p| points.u[p].into()).to_vec(),
            Quantity::Velocity { .. } => {
                let velocity = |p: usize| points.motion.as_ref().map_or([0.0; 2], |motion| motion.v[p].into());
                observe::at_point(points, id, halo, velocity).to_vec()
            }
            Quantity::Stress { .. } => {
                let [xx, yy, zz, xy, ..] = observe::at_point(points, id, halo, |p| points.sigma[p].0);
                vec![xx, yy, zz, xy]
            }
            Quantity::StressNoise => {
                let noise = noise::stress_noise(&model.grid, points, model.weighting, VERTICAL, halo)?;
                vec![noise.about_average, noise.about_plane]
            }
        })
    }
}

/// Force of the support at `face` on the body; zero where there is none.
fn reaction<K: Kinematics<2>>(model: &Model<K, 2>, face: Face, reactions: &[Vec<f64>]) -> Vec<f64> {
    let supports = model.boundary.supports.iter().zip(reactions);
    let mut at_face = supports.filter(|(support, _)| support.axis == face.axis && support.upper == face.upper);
    at_face.next().map_or_else(|| vec![0.0; 2], |(_, force)| force.clone())
}
