//! Times and content of frames and profiles.

use super::Run;
use crate::gather::{FrameMoment, GatheredFrame};
use crate::{launch, profile};
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::kinematics::Kinematics;
use bsmpm::observe;
use bsmpm::observe::projection::projected_pressure;
use bsmpm::tensor::Vector;
use bsmpm_io::exit;
use bsmpm_io::frame::Parts;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_scene::model::vector;
use bsmpm_scene::observables::{FrameField, PointSample};
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
        let step = self.simulation.steps();
        let time = self.simulation.time();
        for number in 0..self.case.profiles.len() {
            let profile = &self.case.profiles[number];
            if !wanted(self, profile) {
                continue;
            }
            let Simulation {
                model, points, halo, ..
            } = &self.simulation;
            let rows = profile::rows(profile, model, self.case.grid.lower(), time, points, &**halo);
            let ledger = self.ledger.as_mut();
            let written = ledger.map_or(Ok(()), |ledger| ledger.profile(number, step, time, &rows));
            self.require(written);
        }
    }

    /// Names of what the frames' fields number, where frames have fields on request.
    pub(super) fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        let case = &self.case;
        let mut names = Vec::new();
        if !case.output.fields.is_empty() {
            let materials = case.materials.iter().map(|material| material.name.clone());
            names.push(("material", materials.collect()));
        }
        if case.output.fields.contains(&FrameField::Body) {
            let bodies = case.bodies.iter().map(|body| body.name.clone().unwrap_or_default());
            names.push((FrameField::Body.field(), bodies.collect()));
        }
        names
    }

    /// The projected pressure of the points, where frames have it. Collective.
    fn projected_pressure(&self) -> Option<Vec<f64>> {
        let Simulation {
            model, points, halo, ..
        } = &self.simulation;
        let projected = self
            .case
            .output
            .projected_pressure
            .then(|| projected_pressure(model, points, &**halo));
        projected
            .transpose()
            .unwrap_or_else(|error| launch::end(&self.universe.world(), exit::BUG, &error))
    }

    /// The flux of `water` at the points, where frames have it; else empty. Collective.
    fn fluxes(&self, water: Option<PoreWater<'_, D>>) -> Vec<Vector<D>> {
        let Simulation { model, halo, .. } = &self.simulation;
        let flows = water.filter(|_| self.case.output.fields.contains(&FrameField::Flux));
        let fluxes = flows.map(|water| water.fluxes::<K>(&model.grid, &**halo)).transpose();
        fluxes
            .unwrap_or_else(|error| launch::end(&self.universe.world(), exit::BUG, &error))
            .unwrap_or_default()
    }

    pub(super) fn frame(&mut self) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("frames");
        let begin = Instant::now();
        let step = self.simulation.steps();
        let time = self.simulation.time();
        let world = self.universe.world();
        let Simulation { model, points, .. } = &self.simulation;
        let projected = self.projected_pressure();
        let moment = FrameMoment {
            step,
            time,
            lower: observe::in_space(&vector::<D, _>(self.case.grid.lower())),
        };
        let names = self.names();
        let fields = &self.case.output.fields;
        let bodies = if fields.contains(&FrameField::Body) {
            self.case.ids()
        } else {
            Vec::new()
        };
        let water = PoreWater::of(model, points, time);
        let fluxes = self.fluxes(water);
        let sample = PointSample {
            points,
            materials: &model.materials,
            bodies: &bodies,
            water,
            fluxes: &fluxes,
        };
        let mut frame = GatheredFrame::new(&world, sample, fields, projected.as_deref(), moment);
        let written = match &mut self.ledger {
            Some(ledger) => {
                let head = frame.head();
                let points = frame.points();
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
