//! A surface point of a footing during a step: its traction and its contribution to the footing's force.

use super::ContactState;
use crate::boundary::surface::Attachment;
use crate::exact::Exact;
use crate::grid::Contributions;
use crate::interactions::coulomb::{ContactReport, Status, ratio};
use crate::tensor::Vector;

/// Number of lengths per point of which the largest is reported for the strip.
pub(super) const LENGTHS: usize = 5;
/// Distance, in cell edges, beyond which a point that closes counts as having moved along the base.
pub(super) const FAR: f64 = 0.5;

/// Sums over the points of a strip.
#[derive(Clone, Debug, Default)]
pub(super) struct StripSums {
    pub(super) held: Exact,
    pub(super) given: Exact, // J
    // Closed points, normal force, normal force of sliding points, the same times the slip, dissipation, points moved
    // on.
    pub(super) contact: [Exact; 6],
}

/// A surface point of a strip, attached to the free components of the nodes.
#[derive(Clone, Debug)]
pub(super) struct StripPoint<const D: usize> {
    pub(super) strip: usize,
    pub(super) point: usize,
    pub(super) place: Vector<D>, // m, of the material at the point, from the grid's lower corner
    pub(super) attachment: [Option<Attachment>; D], // per component; `None`: a support prescribes all nodes
    pub(super) area: f64,
    pub(super) penalty: f64,
    pub(super) normal: Option<Vector<D>>,
    pub(super) motion: Vector<D>,
    pub(super) carried: Vector<D>,
    pub(super) state: Option<ContactState<D>>,
}

impl<const D: usize> StripPoint<D> {
    /// Returns the components of a vector that no support prescribes.
    pub(super) fn own(&self, vector: Vector<D>) -> Vector<D> {
        Vector::from_fn(|component, _| {
            if self.attachment[component].is_some() {
                vector[component]
            } else {
                0.0
            }
        })
    }

    /// Returns the part of a vector in the directions that the strip constrains.
    pub(super) fn part(&self, vector: Vector<D>) -> Vector<D> {
        let own = self.own(vector);
        if let Some(state) = &self.state {
            return self.own(state.part(&own));
        }
        self.normal.map_or(own, |normal| self.own(normal * normal.dot(&own)))
    }

    /// Returns the displacement of the material at the point (m); zero in components that a support prescribes.
    pub(super) fn displacement(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        Vector::from_fn(|component, _| {
            let attachment = self.attachment[component].as_ref();
            attachment.map_or(0.0, |attachment| attachment.displacement::<D>(offsets, u)[component])
        })
    }

    /// Returns the motion of the strip relative to the material (m).
    pub(super) fn slip(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        self.part(self.motion - self.displacement(offsets, u))
    }

    /// Returns the elastic trial traction of a point in contact (Pa).
    pub(super) fn trial(&self, state: &ContactState<D>, offsets: &[usize], u: &[f64]) -> Vector<D> {
        self.own(state.start(&self.carried) + (self.motion - self.displacement(offsets, u)) * self.penalty)
    }

    /// Returns the traction on the body at the start of the step (Pa).
    pub(super) fn before(&self) -> Vector<D> {
        self.own(self.state.map_or(self.carried, |state| state.before(&self.carried)))
    }

    /// Returns the traction on the body under `u` (Pa).
    pub(super) fn traction(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        if let Some(state) = &self.state {
            return self.own(state.traction(&self.trial(state, offsets, u)));
        }
        self.own(self.carried) + self.slip(offsets, u) * self.penalty
    }

    /// Returns the mean force of the step (N). For a point that opens or closes, the mean over its time in contact is
    /// multiplied by the share of that time.
    pub(super) fn mean(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let mean = (self.before() + self.traction(offsets, u)) * (0.5 * self.area);
        match &self.state {
            Some(state) => mean * state.share(&self.own(self.carried), &self.trial(state, offsets, u)),
            None => mean,
        }
    }

    /// Returns the slip, the total slip, the motion, the negative gap and the gap (m; gaps are 0 without contact), and
    /// adds the point to the `sums`. `edge` is the shortest cell edge (m).
    pub(super) fn lengths(&self, offsets: &[usize], u: &[f64], edge: f64, sums: &mut StripSums) -> [f64; LENGTHS] {
        let motion = self.part(self.motion).norm();
        let after = self.traction(offsets, u);
        let slip = self.slip(offsets, u).norm();
        let accumulated = after.norm() / self.penalty;
        let Some(state) = &self.state else {
            return [slip, accumulated, motion, 0.0, 0.0];
        };
        let trial = self.trial(state, offsets, u);
        let slid = self.own(state.slid(&trial, self.penalty));
        let gap = state.gap(&trial, self.penalty);
        let pushed = state.pressure(&trial).max(0.0) * self.area;
        let is_closed = state.status != Status::Open;
        let far = state.moved_on(&self.carried, self.penalty) > FAR * edge;
        let friction_work = self.mean(offsets, u).dot(&slid);
        let sliding = if slid.norm() > 0.0 { pushed } else { 0.0 };
        let each = [
            f64::from(u8::from(is_closed)),
            pushed,
            sliding,
            pushed * slid.norm(),
            friction_work,
            f64::from(u8::from(far)),
        ];
        sums.contact
            .iter_mut()
            .zip(each)
            .for_each(|(sum, value)| sum.add(value));
        [slip, accumulated, motion, -gap, gap]
    }

    /// Adds a force at the point (N) to the nodes.
    pub(super) fn spread(&self, offsets: &[usize], force: &Vector<D>, out: &mut Contributions) {
        for (component, attachment) in self.attachment.iter().enumerate() {
            let mut along = Vector::<D>::zeros();
            along[component] = force[component];
            if let Some(attachment) = attachment {
                attachment.scatter(offsets, &along, out);
            }
        }
    }

    /// Returns the first node of the cell and its dense block beta A N_a N_b in the constrained directions, row-major;
    /// `None` for an open point.
    pub(super) fn block(&self, size: usize) -> Option<(usize, Vec<f64>)> {
        if self.state.is_some_and(|state| state.status == Status::Open) {
            return None;
        }
        let first = self.attachment.iter().flatten().next()?.first_node();
        let directions: [Vector<D>; D] = std::array::from_fn(|j| {
            let mut unit = Vector::zeros();
            unit[j] = self.penalty * self.area;
            self.part(unit)
        });
        let order = size * D;
        let functions = (0..order).map(|row| {
            let attachment = self.attachment[row % D].as_ref();
            attachment.map_or(0.0, |attachment| attachment.N()[row / D])
        });
        let N: Vec<f64> = functions.collect();
        let places = (0..order * order).map(|at| [at / order, at % order]);
        let block = places.map(|[i, j]| N[i] * N[j] * directions[j % D][i % D]);
        Some((first, block.collect()))
    }
}

impl StripSums {
    /// Returns two sums without contact, eight if any strip has `contact`.
    pub(super) fn each(&self, contact: bool) -> impl Iterator<Item = Exact> {
        let of_contact = if contact { &self.contact[..] } else { &[] };
        [&self.held, &self.given].into_iter().chain(of_contact).cloned()
    }
}

/// Assembles the contact results of a strip from the sums and the largest lengths of its points.
pub(super) fn contact_report(strip: usize, totals: &[f64], lengths: &[f64]) -> ContactReport {
    let [held, _, closed, pushed, sliding, slid, dissipated] = std::array::from_fn(|k| totals[k]);
    ContactReport {
        support: strip,
        nodes: held as usize,
        closed: ratio(closed, held),
        sliding: ratio(sliding, pushed),
        slip: ratio(slid, pushed),
        dissipated,
        gap: if held > 0.0 {
            [-lengths[3], lengths[4]]
        } else {
            [0.0; 2]
        },
    }
}
