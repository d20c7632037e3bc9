//! A surface point of a footing during a step: its traction and its contribution to the footing's force.

use super::ContactState;
use crate::boundary::coulomb::{ContactReport, Status, ratio};
use crate::boundary::surface::Attachment;
use crate::exact::Exact;
use crate::grid::Contributions;
use crate::tensor::Vector;

/// Lengths of a strip's points of which the largest count.
pub(super) const LENGTHS: usize = 5;
/// Parts of a cell from which on a point that comes back to material has moved on.
pub(super) const FAR: f64 = 0.5;

/// Sums over the points of a strip.
#[derive(Clone, Debug, Default)]
pub(super) struct StripSums {
    pub(super) held: Exact,
    pub(super) given: Exact, // J
    // closed, their normal force, that of those that slide, that times what they slid, dissipated, moved on
    pub(super) contact: [Exact; 6],
}

#[derive(Clone, Debug)]
pub(super) struct StripPoint<const D: usize> {
    pub(super) strip: usize,
    pub(super) point: usize,
    pub(super) place: Vector<D>, // m  of the material at it, from the grid's lower corner
    pub(super) attachment: [Option<Attachment>; D], // per component: where a support holds all of its nodes, the strip does not
    pub(super) area: f64,
    pub(super) penalty: f64,
    pub(super) normal: Option<Vector<D>>,
    pub(super) motion: Vector<D>,
    pub(super) carried: Vector<D>,
    pub(super) state: Option<ContactState<D>>,
}

impl<const D: usize> StripPoint<D> {
    /// The components that the strip and no support holds.
    pub(super) fn own(&self, vector: Vector<D>) -> Vector<D> {
        Vector::from_fn(|component, _| {
            if self.attachment[component].is_some() {
                vector[component]
            } else {
                0.0
            }
        })
    }

    /// The part of a vector that is held.
    pub(super) fn part(&self, vector: Vector<D>) -> Vector<D> {
        let own = self.own(vector);
        if let Some(state) = &self.state {
            return self.own(state.part(&own));
        }
        self.normal.map_or(own, |normal| self.own(normal * normal.dot(&own)))
    }

    /// m  of the material at the point; zero in components that are not held.
    pub(super) fn displacement(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        Vector::from_fn(|component, _| {
            let attachment = self.attachment[component].as_ref();
            attachment.map_or(0.0, |attachment| attachment.displacement::<D>(offsets, u)[component])
        })
    }

    /// m  what the material lags behind the strip.
    pub(super) fn slip(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        self.part(self.motion - self.displacement(offsets, u))
    }

    /// Pa  elastic trial of a point in contact.
    pub(super) fn trial(&self, state: &ContactState<D>, offsets: &[usize], u: &[f64]) -> Vector<D> {
        self.own(state.start(&self.carried) + (self.motion - self.displacement(offsets, u)) * self.penalty)
    }

    /// Pa  on the body at the start of the step.
    pub(super) fn before(&self) -> Vector<D> {
        self.own(self.state.map_or(self.carried, |state| state.before(&self.carried)))
    }

    /// Pa  on the body.
    pub(super) fn traction(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        if let Some(state) = &self.state {
            return self.own(state.traction(&self.trial(state, offsets, u)));
        }
        self.own(self.carried) + self.slip(offsets, u) * self.penalty
    }

    /// N  the mean force of the step; where the point comes off or meets the material, of the part of the step in
    /// which it is on it, as a part of the whole.
    pub(super) fn mean(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let mean = (self.before() + self.traction(offsets, u)) * (0.5 * self.area);
        match &self.state {
            Some(state) => mean * state.share(&self.own(self.carried), &self.trial(state, offsets, u)),
            None => mean,
        }
    }

    /// m  slip, what has slipped in all steps, motion, and of a point in contact less the gap and the gap; what it adds
    /// to the sums. `edge`, m, is that of the shortest cell.
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

    /// Adds a force at the point to the nodes.
    pub(super) fn spread(&self, offsets: &[usize], force: &Vector<D>, out: &mut Contributions) {
        for (component, attachment) in self.attachment.iter().enumerate() {
            let mut along = Vector::<D>::zeros();
            along[component] = force[component];
            if let Some(attachment) = attachment {
                attachment.scatter(offsets, &along, out);
            }
        }
    }

    /// Dense block of beta A N_a N_b in the held direction, over the nodes of the cell.
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
    /// Two of all strips, and where one is in `contact` eight.
    pub(super) fn each(&self, contact: bool) -> impl Iterator<Item = Exact> {
        let of_contact = if contact { &self.contact[..] } else { &[] };
        [&self.held, &self.given].into_iter().chain(of_contact).cloned()
    }
}

/// What the `totals` and the lengths of a strip's points say of its contact.
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
