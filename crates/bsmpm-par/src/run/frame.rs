//! Times and content of frames and profiles.

use super::Run;
use crate::gather::{self, Around, FrameMoment, Gathering};
use crate::{launch, profile};
use bsmpm::kinematics::Kinematics;
use bsmpm::observe::projection::projected_pressure;
use bsmpm::water::observed::PoreWater;
use bsmpm_io::exit;
use bsmpm_io::frame::Parts;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_scene::model::vector;
use bsmpm_scene::words::FrameField;
use bsmpm_scene::{Every, Profile};
use std::rc::Rc;
use std::time::Instant;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    pub(super) fn wants_frame(&self, time: f64) -> bool {
        let every =
            matches!(self.case.output.every, Some(Every::Steps(n)) if self.simulation.steps().is_multiple_of(n));
        every || self.frame_times.iter().any(|wanted| self.is_now(*wanted, time))
    }

    /// The schedule hits wanted times to the bit, unless two of them are closer than a millionth of a step.
    pub(super) fn is_now(&self, wanted: f64, time: f64) -> bool {
        (wanted - time).abs() <= 1e-6 * self.case.analysis.dt
    }

    /// Rows of the profiles that are wanted now. Collective.
    pub(super) fn profile(&mut self, wanted: impl Fn(&Self, &Profile) -> bool) {
        let (step, time) = (self.simulation.steps(), self.simulation.time());
        for number in 0..self.case.profiles.len() {
            let profile = &self.case.profiles[number];
            if !wanted(self, profile) {
                continue;
            }
            let Simulation {
                model, points, halo, ..
            } = &self.simulation;
            let rows = profile::rows(profile, (model, self.case.grid.lower(), time), points, &**halo);
            let ledger = self.ledger.as_mut();
            let written = ledger.map_or(Ok(()), |ledger| ledger.profile(number, (step, time), &rows));
            self.require(written);
        }
    }

    /// Names of what the frames' fields number, where frames have fields on request.
    pub(super) fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        let case = &self.case;
        let materials = case.materials.iter().map(|material| material.name.clone()).collect();
        let bodies = || {
            case.bodies
                .iter()
                .map(|body| body.name.clone().unwrap_or_default())
                .collect()
        };
        let of_bodies = case
            .output
            .fields
            .contains(&FrameField::Body)
            .then(|| (FrameField::Body.field(), bodies()));
        let of_materials = (!case.output.fields.is_empty()).then_some(("material", materials));
        of_materials.into_iter().chain(of_bodies).collect()
    }

    pub(super) fn frame(&mut self) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("frames");
        let begin = Instant::now();
        let (step, time) = (self.simulation.steps(), self.simulation.time());
        let world = self.universe.world();
        let Simulation {
            model, points, halo, ..
        } = &self.simulation;
        let projected = self
            .case
            .output
            .projected_pressure
            .then(|| projected_pressure(model, points, &**halo));
        let projected = projected
            .transpose()
            .unwrap_or_else(|error| launch::end(&world, exit::BUG, &error));
        let moment = FrameMoment {
            step,
            time,
            lower: gather::spatial(&vector::<D, _>(self.case.grid.lower())),
        };
        let (names, fields) = (self.names(), &self.case.output.fields);
        let bodies = if fields.contains(&FrameField::Body) {
            self.case.ids()
        } else {
            Vec::new()
        };
        let water = PoreWater::of(model, points, time);
        let flows = water.filter(|_| fields.contains(&FrameField::Flux));
        let fluxes = flows.map(|water| water.fluxes::<K>(&model.grid, &**halo)).transpose();
        let fluxes = fluxes
            .unwrap_or_else(|error| launch::end(&world, exit::BUG, &error))
            .unwrap_or_default();
        let around = Around {
            materials: &model.materials,
            bodies: &bodies,
            water,
            fluxes: &fluxes,
            fields,
        };
        let mut frame = Gathering::new(&world, (points, around), projected.as_deref(), moment);
        let written = match &mut self.ledger {
            Some(ledger) => {
                let (head, points) = (frame.head(), frame.points());
                ledger.manifest().frame_units = frame.units(self.case.geometry.volume_unit());
                ledger.manifest().frame_names = names
                    .iter()
                    .map(|(field, names)| ((*field).to_owned(), names.clone()))
                    .collect();
                let names: Vec<_> = names
                    .into_iter()
                    .map(|(field, names)| (format!("{field}_names"), names))
                    .collect();
                ledger.frame(Parts {
                    head,
                    points,
                    names: &names,
                    next: &mut || frame.block(),
                })
            }
            None => {
                while frame.block().is_some() {}
                Ok(())
            }
        };
        self.require(written);
        self.last_frame = Some(step);
        self.saving.frame_took(begin.elapsed());
    }
}
