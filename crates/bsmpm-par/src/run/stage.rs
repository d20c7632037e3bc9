//! Begins a stage, which changes bodies, loads, boundaries or materials. At this time, history rows and frames show the
//! state before the change, checkpoints the state after it.

use super::Run;
use crate::launch;
use bsmpm::energy::StoredEnergy;
use bsmpm::error::StepError;
use bsmpm::kinematics::Kinematics;
use bsmpm_io::exit;
use bsmpm_io::manifest::ManifestStage;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_scene::words::Word;
use bsmpm_scene::{Stage, model};

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Begins the stages of the time `t`.
    pub(super) fn begin_stages(&mut self, t: f64) -> Result<(), StepError> {
        let stages: Vec<Stage> = self.case.stages_at(t).cloned().collect();
        stages.iter().try_for_each(|stage| self.begin_stage(stage))
    }

    fn begin_stage(&mut self, stage: &Stage) -> Result<(), StepError> {
        let before = self.stored(stage.at);
        let next = model::model_at(&self.case, stage.at);
        let next = next.unwrap_or_else(|error| launch::end(&self.universe.world(), exit::BUG, &error));
        let taken = self.case.taken_by(stage);
        let idle = self.case.idle_before(stage.at);
        if stage.exchanges() {
            self.simulation.exchange(next)?;
        }
        let [removed, added] = self.simulation.begin_stage(
            taken,
            |columns| model::placed::<K, D>(&self.case, stage, columns),
            &idle,
        );
        if !stage.only_resets() {
            self.simulation.hold()?;
        }
        if stage.resets_displacements {
            self.simulation.points.reset_displacements();
        }
        let Simulation { points, halo, .. } = &self.simulation;
        self.recorder.begin_stage(&self.case, stage, points, &**halo);
        if let (Some(before), Some(after)) = (before, self.stored(stage.at)) {
            self.recorder.exchange(before, after);
        }
        self.tell_stage(stage, removed, added);
        Ok(())
    }

    /// The energy at `t`, where it is balanced. Collective.
    fn stored(&self, t: f64) -> Option<StoredEnergy> {
        let Simulation {
            model, points, halo, ..
        } = &self.simulation;
        model
            .balances_energy
            .then(|| StoredEnergy::of(model, points, t, &**halo))
    }

    /// Says and notes what a stage has changed, with the numbers of points that it has `removed` and `added`.
    fn tell_stage(&mut self, stage: &Stage, removed: u64, added: u64) {
        let step = self.simulation.steps();
        let time = self.simulation.time();
        let name = stage.name.as_deref().map_or(String::new(), |name| format!(" {name}"));
        let materials = &self.case.materials;
        let exchanged: Vec<String> = stage
            .materials
            .iter()
            .map(|&(from, to)| format!("{} follows {}", materials[from].name, materials[to].name))
            .collect();
        let faces: Vec<String> = stage
            .faces
            .iter()
            .map(|of| format!("{} is {}", of.face.side(self.case.geometry).word(), of.support.word()))
            .collect();
        let [applied, released] = [&stage.apply, &stage.release]
            .map(|list| list.iter().map(|(name, _)| name.clone()).collect::<Vec<String>>());
        let strength_reduction = stage.strength_reduction;
        let changes = [
            (removed > 0).then(|| format!("{removed} material points removed")),
            (added > 0).then(|| format!("{added} material points added")),
            (!applied.is_empty()).then(|| format!("{} applied", applied.join(", "))),
            (!released.is_empty()).then(|| format!("{} released", released.join(", "))),
            (!faces.is_empty()).then(|| faces.join(", ")),
            (!exchanged.is_empty()).then(|| exchanged.join(", ")),
            strength_reduction.map(|factor| format!("strength divided by {factor}")),
            stage.rests.then(|| "the water is at rest".to_owned()),
            stage
                .resets_displacements
                .then(|| "displacements set to zero".to_owned()),
        ];
        let changes: Vec<String> = changes.into_iter().flatten().collect();
        self.log.line(
            "stage",
            &format!("Stage{name} at t = {}: {}.", self.moment(time), changes.join(", ")),
        );
        if let Some(ledger) = &mut self.ledger {
            let name = stage.name.clone();
            let reset = stage.resets_displacements;
            let changes = ManifestStage {
                name,
                step,
                time,
                removed,
                added,
                applied,
                released,
                faces,
                exchanged,
                strength_reduction,
                reset,
            };
            ledger.manifest().stages.push(changes);
            ledger.begin_stage(&self.case, stage.at);
        }
    }
}
