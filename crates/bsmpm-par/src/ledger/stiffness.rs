//! Indicator `stiffness-loss`, theory-manual equation (T10.15): second-order work of elastic soil divided by the actual
//! second-order work (Hill, 1958). It is 1 in elastic soil.

use super::RunWriter;
use crate::indicators::STIFFNESS_LOSS;
use bsmpm::control::AcceptedStep;
use bsmpm_io::manifest::ManifestStage;

/// Part of the mean rate of displacement in a stage above which a step is judged. Stable ground comes to rest under a
/// constant load: 2 % below its factor of safety the slope of the README moves at 0.13 of the mean rate in the step
/// after its load is applied, and a tenth as far in each step after that.
const LEAST_RATE: f64 = 0.5;
/// Part of all advances of the run above which a step is judged: what the tolerances leave moves less.
const LEAST_ADVANCE: f64 = 1e-3;
/// The largest loss of stiffness: of steps in which no load changes, and of ground that softens.
const MOST_LOSS: f64 = 1e6;

impl RunWriter {
    /// Notes the loss of stiffness in a step. Two kinds of steps are not judged: those that redistribute stress under
    /// constant loads, as the first one with a stress at the start and the one after a change of strength, and those
    /// that move the ground by little.
    pub(super) fn stiffness(&mut self, number: u64, accepted: &AcceptedStep) {
        let report = &accepted.report;
        let Some([elastic, actual]) = report.second_order_works.filter(|_| self.judges_stiffness) else {
            return;
        };
        let stages = &self.manifest.stages;
        let begun: Vec<&ManifestStage> = stages.iter().filter(|stage| stage.step + 1 == number).collect();
        let begins_stage = number == 1 || !begun.is_empty();
        let redistributes = begun
            .iter()
            .any(|stage| stage.strength_reduction.is_some() || !stage.exchanged.is_empty());
        let redistributes = redistributes || number == 1 && self.begins_with_stress;
        let start = stages.last().map_or(0.0, |stage| stage.time);
        let summary = &mut self.manifest.summary;
        // A checkpoint of an older program has no such sums, and small steps would seem large.
        let Some(before) = summary.advances.or((number == 1).then_some(0.0)) else {
            return;
        };
        let advances = before + report.advance;
        let of_stage = if begins_stage {
            0.0
        } else {
            summary.stage_advances.unwrap_or(0.0)
        } + report.advance;
        (summary.advances, summary.stage_advances) = (Some(advances), Some(of_stage));
        let is_fast = report.advance * (accepted.t - start) > LEAST_RATE * of_stage * accepted.dt;
        let is_large = report.advance > LEAST_ADVANCE * advances;
        if redistributes || !is_fast || !is_large || elastic <= 0.0 {
            return;
        }
        let loss = elastic / actual.max(elastic / MOST_LOSS);
        summary.largest_stiffness_loss = Some(summary.largest_stiffness_loss.map_or(loss, |so_far| so_far.max(loss)));
        if loss > STIFFNESS_LOSS && summary.failed_at.is_none() {
            summary.failed_at = Some(accepted.t);
        }
    }
}
