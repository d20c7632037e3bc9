//! History quantities of supports, footings, contact and rigid bodies.

use super::Recorder;
use bsmpm::boundary::{ContactReport, RigidReport};
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::step::StepReport;
use bsmpm_scene::surfaces;
use bsmpm_scene::words::Measurement;
use bsmpm_scene::{Face, Quantity};

impl<const D: usize> Recorder<D> {
    /// A quantity of the footing; 0 without one, and before the first step.
    pub(super) fn footing(&self, quantity: &Quantity, t: f64, report: &StepReport) -> f64 {
        let strip = report.strips.first();
        let Some(gauge) = &self.gauge else { return 0.0 };
        match quantity {
            Quantity::Penetration => gauge.penetration(t),
            Quantity::FootingPressure => strip.map_or(0.0, |strip| gauge.pressure(strip)),
            Quantity::FootingForce => strip.map_or(0.0, |strip| gauge.force(strip)),
            _ => strip.map_or(0.0, surfaces::relative_slip),
        }
    }

    /// A quantity of a strip; zero before the first step.
    pub(super) fn strip(&self, number: usize, measured: Measurement, report: &StepReport) -> Vec<f64> {
        let strip = report.strips.get(number);
        match measured {
            Measurement::Reaction => strip.map_or_else(|| vec![0.0; D], |strip| strip.force.clone()),
            Measurement::Moment => vec![strip.map_or(0.0, |strip| strip.moment)],
            Measurement::Work => vec![self.work.get(number).copied().unwrap_or(0.0)],
            measured => contact(measured, strip.and_then(|strip| strip.contact), report.dt),
        }
    }

    /// Force of what holds a face on the body; zero where there is nothing, and before the first step.
    pub(super) fn reaction<K: Kinematics<D>>(
        &self,
        number: usize,
        model: &Model<K, D>,
        face: Face,
        report: &StepReport,
    ) -> Vec<f64> {
        if let Some(strip) = self.reacting[number].and_then(|strip| report.strips.get(strip)) {
            return strip.force.clone();
        }
        let supports = model.boundary.supports.iter().zip(&report.reactions);
        let mut at_face = supports.filter(|(support, _)| support.axis == face.axis && support.upper == face.upper);
        at_face.next().map_or_else(|| vec![0.0; D], |(_, force)| force.clone())
    }
}

/// What a face in contact did.
pub(super) fn at_face<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    face: Face,
    report: &StepReport,
) -> Option<ContactReport> {
    let supports = &model.boundary.supports;
    let mut contacts = report.contacts.iter().copied();
    contacts.find(|found| {
        let support = &supports[found.support];
        support.axis == face.axis && support.upper == face.upper
    })
}

/// A quantity of a face or strip in contact in a step of the length `dt`; zero before the first step.
pub(super) fn contact(measured: Measurement, found: Option<ContactReport>, dt: f64) -> Vec<f64> {
    let found = found.unwrap_or_default();
    let [slip_rate, power] = [found.slip, found.dissipated].map(|sum| if dt > 0.0 { sum / dt } else { 0.0 });
    match measured {
        Measurement::Contact => vec![found.closed, found.sliding],
        Measurement::Gap => found.gap.to_vec(),
        Measurement::SlipRate => vec![slip_rate],
        _ => vec![power],
    }
}

/// A quantity of a rigid body; before the first step that of the start.
pub(super) fn rigid<K: Kinematics<D>, const D: usize>(
    what: Measurement,
    body: usize,
    t: f64,
    model: &Model<K, D>,
    report: &StepReport,
) -> Vec<f64> {
    let found = report.rigid.get(body).copied().unwrap_or_else(|| {
        let body = &model.boundary.rigid[body];
        RigidReport {
            moved: body.on_path(t),
            velocity: body.at_rest().velocity,
            ..RigidReport::default()
        }
    });
    match what {
        Measurement::RigidForce => found.force.as_slice()[..D].to_vec(),
        Measurement::RigidMoment => vec![found.force[2]],
        Measurement::RigidDisplacement => found.moved.as_slice()[..D].to_vec(),
        Measurement::RigidRotation => vec![found.moved[2].to_degrees()],
        Measurement::RigidVelocity => found.velocity.as_slice()[..D].to_vec(),
        Measurement::RigidSlip => vec![found.slipped],
        Measurement::RigidWork => vec![found.work],
        _ => vec![found.gap],
    }
}
