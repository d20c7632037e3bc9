//! State of a run from which the value of an observable is computed.

use super::place::{FollowedPoint, at_surface, section};
use super::subject::{Face, HistorySubject};
use crate::grid::{GridSpec, vector};
use bsmpm::boundary::Support;
use bsmpm::error::StepError;
use bsmpm::field::pore_water::crossed::CrossedVolumes;
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::interactions::coulomb::ContactReport;
use bsmpm::interactions::rigid::RigidReport;
use bsmpm::interactions::strip::{StripContact, StripReport};
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::{self, Part, Section};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::step::StepReport;
use bsmpm::tensor::Vector;

/// State of a run for one history.
pub struct Sample<'a, K, const D: usize> {
    /// The case as the steps use it.
    pub model: &'a Model<K, D>,
    /// Material points of this rank.
    pub points: &'a Points<D>,
    /// Time (s).
    pub t: f64,
    /// Report of the step that led to the state; empty at the start.
    pub report: &'a StepReport,
    /// Ranks.
    pub halo: &'a dyn Halo,
    /// Grid of the case.
    pub grid: &'a GridSpec,
    /// Lower corner of the grid (m).
    pub lower: Vector<D>,
    /// What the history is of.
    pub subject: &'a HistorySubject,
    /// Points that the history counts.
    pub part: &'a Part,
    /// Id of the point that the history follows, if any.
    pub followed: Option<u64>,
    /// Displacement when displacements were last set to zero (m), if they were.
    pub datum: Option<&'a [f64]>,
    /// Number of the footing or prescribed motion that holds the face of the history, if any.
    pub holding_strip: Option<usize>,
    /// Values of the footing; 0 without one.
    pub footing: FootingSample,
    /// Work of the history's footing or prescribed motion since the start (J/m).
    pub work: f64,
    /// Water that has left the ground through the history's drain (m3/m).
    pub drained: f64,
    /// Volumes of water that have crossed the surface so far.
    pub crossed: &'a CrossedVolumes,
    /// Mass that has left the grid (kg/m).
    pub outflow: f64,
    /// Where the energy is, and where it went (J/m), in the order of the columns; empty if it is not balanced.
    pub energy: &'a [f64],
}

/// Values of the footing.
#[derive(Clone, Copy, Debug, Default)]
pub struct FootingSample {
    /// Mean normal pressure on the base (Pa).
    pub pressure: f64,
    /// Force of the soil against the motion (N/m).
    pub force: f64,
    /// Downward displacement (m).
    pub penetration: f64,
    /// Largest slip in the step, divided by the displacement in the step (-).
    pub slip: f64,
}

/// Displacement (m) of the place that the point `id` is the nearest one to, since the start; `lower` is the grid's
/// corner. Zero where there is no such point.
pub fn displacement_at<const D: usize>(
    at: [f64; 3],
    lower: Vector<D>,
    id: u64,
    points: &Points<D>,
    halo: &dyn Halo,
) -> [f64; D] {
    let place = vector(at) - lower;
    observe::at_point(points, id, halo, |p| observe::displacement(points, p, &place).into())
}

/// Whether a support is that of a face.
fn is_at<const D: usize>(support: &Support<D>, face: Face) -> bool {
    support.axis == face.axis && support.upper == face.upper
}

/// Unit normal of a face, towards the material.
fn inward<const D: usize>(face: Face) -> Vector<D> {
    let sign = if face.upper { -1.0 } else { 1.0 };
    Vector::from_fn(|axis, _| if axis == face.axis { sign } else { 0.0 })
}

impl<K: Kinematics<D>, const D: usize> Sample<'_, K, D> {
    pub(super) fn runout(&self) -> f64 {
        let Self { points, part, halo, .. } = *self;
        let found = match *self.subject {
            HistorySubject::Percentile { percentile, .. } if percentile < 100.0 => {
                observe::percentile(points, part, 0, percentile, halo)
            }
            _ => observe::farthest(points, part, 0, halo),
        };
        self.lower[0] + found
    }

    pub(super) fn height(&self) -> f64 {
        let Self { points, part, halo, .. } = *self;
        let bottom = self.lower[D - 1];
        match *self.subject {
            HistorySubject::Near { at_x: Some(x), .. } => {
                let [x, _] = self.grid.local([x, bottom]);
                bottom + observe::surface(&self.model.grid, points, part, x, halo)
            }
            _ => bottom + observe::farthest(points, part, D - 1, halo),
        }
    }

    pub(super) fn centre_of_mass(&self) -> Vec<f64> {
        let centre = observe::centre_of_mass(self.points, self.part, self.halo).unwrap_or_else(Vector::zeros);
        (self.lower + centre).as_slice().to_vec()
    }

    /// Velocity (m/s) of a point; zero where there is no motion.
    pub(super) fn velocity(&self, p: usize) -> [f64; D] {
        let motion = self.points.motion.as_ref();
        motion.map_or([0.0; D], |motion| motion.v[p].into())
    }

    /// A field at the place of the history; zero where there is nothing.
    pub(super) fn at_place<const C: usize>(&self, field: impl Fn(usize) -> [f64; C]) -> Vec<f64> {
        let Self {
            model, points, halo, ..
        } = *self;
        let (at, surface) = match *self.subject {
            HistorySubject::Place { at, surface } => (vector::<D, _>(at) - self.lower, surface),
            _ => (Vector::zeros(), false),
        };
        if surface {
            return at_surface(model, points, at, field, halo);
        }
        let followed = FollowedPoint::of(self.followed, at, self.grid);
        followed.value(model, points, field, halo).to_vec()
    }

    /// Displacement of the place of the history since the start, or since it was set to zero.
    pub(super) fn displacement(&self) -> Vec<f64> {
        let (Some(id), HistorySubject::Place { at, .. }) = (self.followed, self.subject) else {
            return vec![0.0; D];
        };
        let total = displacement_at(*at, self.lower, id, self.points, self.halo);
        (0..D)
            .map(|axis| total[axis] - self.datum.map_or(0.0, |datum| datum[axis]))
            .collect()
    }

    /// The pore water, if there is any.
    pub(super) fn water(&self) -> Option<PoreWater<'_, D>> {
        PoreWater::of(self.model, self.points, self.t)
    }

    /// A number of the pore water at the place of the history; zero without water.
    pub(super) fn pore_water<'s>(&'s self, number: fn(&PoreWater<'s, D>, usize) -> f64) -> Vec<f64> {
        let water = self.water();
        self.at_place(|p| [water.as_ref().map_or(0.0, |water| number(water, p))])
    }

    /// Darcy velocity (m/s) at the place of the history.
    pub(super) fn flux(&self) -> Result<Vec<f64>, StepError> {
        let water = self.water();
        let fluxes = water
            .map(|water| water.fluxes::<K>(&self.model.grid, self.halo))
            .transpose()?;
        Ok(self.at_place(|p| fluxes.as_ref().map_or([0.0; D], |fluxes| fluxes[p].into())))
    }

    pub(super) fn section_forces(&self) -> Vec<f64> {
        let HistorySubject::Section { lines, round, fixed } = self.subject else {
            return Vec::new();
        };
        let local = lines.iter().map(|line| line.map(|end| vector(end) - self.lower));
        let at_start = Section {
            lines: local.collect(),
            round: *round,
        };
        section::<K, D>(&self.model.grid, self.points, at_start, *fixed, self.halo)
    }

    /// Report of the footing or prescribed motion of the history; `None` before the first step.
    pub(super) fn strip(&self) -> Option<&StripReport> {
        match *self.subject {
            HistorySubject::Strip(number) => self.report.strips.get(number),
            _ => self.holding_strip.and_then(|strip| self.report.strips.get(strip)),
        }
    }

    /// Force of a face, footing or prescribed motion on the body; zero where there is nothing, and before the first
    /// step.
    pub(super) fn reaction(&self) -> Vec<f64> {
        if let Some(strip) = self.strip() {
            return strip.force.clone();
        }
        let HistorySubject::Face(face) = *self.subject else {
            return vec![0.0; D];
        };
        let mut supports = self.model.boundary.supports.iter().zip(&self.report.reactions);
        let found = supports.find(|(support, _)| is_at(support, face));
        found.map_or_else(|| vec![0.0; D], |(_, force)| force.clone())
    }

    /// What a face, footing or prescribed motion in contact did; zero where there is nothing, and before the first
    /// step.
    pub(super) fn contact(&self) -> ContactReport {
        let found = match *self.subject {
            HistorySubject::Face(face) => {
                let supports = &self.model.boundary.supports;
                let mut contacts = self.report.contacts.iter().copied();
                contacts.find(|found| is_at(&supports[found.support], face))
            }
            _ => self.strip().and_then(|strip| strip.contact),
        };
        found.unwrap_or_default()
    }

    /// Tangential part of the reaction, divided by the friction coefficient times the normal part; 0 without pressure
    /// or friction.
    pub(super) fn mobilised_friction(&self) -> f64 {
        let boundary = &self.model.boundary;
        let contact = match *self.subject {
            HistorySubject::Strip(number) => boundary.strips.get(number).and_then(|strip| strip.contact),
            HistorySubject::Face(face) => {
                let mut supports = boundary.supports.iter().filter(|support| is_at(support, face));
                let law = supports.find_map(|support| support.contact);
                law.map(|law| StripContact {
                    law,
                    inward: inward(face),
                })
            }
            _ => None,
        };
        let Some(StripContact { law, inward }) = contact else {
            return 0.0;
        };
        let force = Vector::<D>::from_column_slice(&self.reaction());
        let pressing = force.dot(&inward);
        let limit = law.friction * pressing;
        if limit > 0.0 {
            (force - inward * pressing).norm() / limit
        } else {
            0.0
        }
    }

    /// Rate of a sum over the step; 0 at the start.
    pub(super) fn rate(&self, sum: f64) -> f64 {
        if self.report.dt > 0.0 {
            sum / self.report.dt
        } else {
            0.0
        }
    }

    /// Report of the rigid body of the history; before the first step that of the start.
    pub(super) fn rigid(&self) -> RigidReport {
        let HistorySubject::Rigid(number) = *self.subject else {
            return RigidReport::default();
        };
        self.report.rigid.get(number).copied().unwrap_or_else(|| {
            let body = &self.model.boundary.rigid[number];
            RigidReport {
                moved: body.on_path(self.t),
                velocity: body.at_rest().velocity,
                ..RigidReport::default()
            }
        })
    }
}
