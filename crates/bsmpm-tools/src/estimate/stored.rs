//! Cost coefficients of a reference machine, fitted to runs.

use bsmpm_scene::words::LinearSolver;
use bsmpm_scene::{Case, Regime};

use super::sizes::{self, Bytes};
use super::work::Effort;

/// s  of a unit of work, for each point and for each unknown; the latter in a solid of a factor up to [`FACTORISED`],
/// of an incomplete one and of multigrid.
const POINT: f64 = 0.134e-6;
const UNKNOWN: f64 = 0.25e-6;
const POINT_IN_SPACE: f64 = 0.354e-6;
const UNKNOWN_IN_SPACE: [f64; 3] = [1.5e-6, 1e-6, 6e-6];
/// Unknowns of a solid beyond which a factor costs each of them more, as separators are planes.
const FACTORISED: f64 = 8e3;
/// Evaluations of a step: elastic; dynamic; quasi-static and plastic, between those of slopes (9 to 20) and footings
/// (38).
const EVALUATIONS: [f64; 3] = [4.0, 16.0, 25.0];
/// The same in a solid with a factor, an incomplete one, multigrid.
const EVALUATIONS_IN_SPACE: [[f64; 3]; 3] = [[4.0, 10.0, 35.0], [20.0, 30.0, 50.0], [6.0, 27.0, 45.0]];
/// Where water flows: how much more iterations a step takes by turns on both systems, and how much dearer each is.
const FLOWING: [f64; 2] = [1.5, 1.25];
/// s  that a run takes before its first step.
const START: f64 = 0.08;
/// s  of a frame, and of each of its points.
const FRAME: [f64; 2] = [2e-3, 0.7e-6];
/// Factor either way within which such an estimate lies: what iterations take differs that much between scenes.
const BAND: f64 = 4.0;

/// What an estimate is made from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredEstimate {
    /// of the whole run
    pub work: Effort,
    /// s  of a unit of work, all ranks together
    pub unit: f64,
    /// s  before the first step
    pub start: f64,
    /// s  of a frame
    pub frame: f64,
    /// what is written
    pub bytes: Bytes,
    /// nodal components that the case's own steps solved for, if any was made
    pub unknowns: Option<u64>,
    /// factor either way within which the time is expected
    pub band: f64,
    /// in words
    pub basis: String,
}

impl StoredEstimate {
    /// Processor seconds of the run, all ranks together, with so many frames.
    pub fn seconds(&self, frames: u64) -> f64 {
        self.start + self.unit * self.work.units() + self.frame * frames.saturating_sub(1) as f64
    }
}

/// An estimate from what runs took elsewhere; `speed` is this machine's time over that of the other one.
pub(super) fn guess(case: &Case, ranks: usize, speed: f64) -> StoredEstimate {
    let plastic = case.materials.iter().any(|named| named.material.yields());
    let kind = match (plastic, case.analysis.regime) {
        (false, _) => 0,
        (true, Regime::Dynamic) => 1,
        (true, Regime::QuasiStatic) => 2,
    };
    let sizes = case.estimate(ranks);
    let steps = sizes::steps(case);
    let points = case.points() as f64;
    let evaluations = in_space(case, ranks).map_or(EVALUATIONS, |solver| EVALUATIONS_IN_SPACE[solver])[kind];
    let [more, dearer] = if case.flow.is_some() { FLOWING } else { [1.0; 2] };
    StoredEstimate {
        work: Effort { steps, evaluations: more * evaluations * steps, ..Effort::default() },
        unit: speed * dearer * unit(case, ranks, sizes.active as f64),
        start: speed * START,
        frame: speed * (FRAME[0] + FRAME[1] * points),
        bytes: Bytes::of(case),
        unknowns: None,
        band: BAND,
        basis: "what runs of other cases took elsewhere, scaled by the speed of this machine: too little where steps need Newton's \
                method or contact slides"
            .to_owned(),
    }
}

/// How the linear systems of a solid are solved, as the second index of the coefficients; none in a plane.
fn in_space(case: &Case, ranks: usize) -> Option<usize> {
    let solver = match case.solver.linear_on(ranks) {
        LinearSolver::Direct => 0,
        LinearSolver::IncompleteCholesky => 1,
        LinearSolver::Multigrid | LinearSolver::MultigridCycles | LinearSolver::SplineMultigrid => 2,
    };
    (case.grid.dims() == 3).then_some(solver)
}

/// s  of a unit of work with so many unknowns.
fn unit(case: &Case, ranks: usize, unknowns: f64) -> f64 {
    let points = case.points() as f64;
    let Some(solver) = in_space(case, ranks) else {
        return POINT * points + UNKNOWN * unknowns;
    };
    let dearer = if solver == 0 {
        (unknowns / FACTORISED).max(1.0)
    } else {
        1.0
    };
    POINT_IN_SPACE * points + UNKNOWN_IN_SPACE[solver] * dearer * unknowns
}

/// How much dearer a unit of work becomes where the body spreads to so many times the nodes: that of the points does
/// not.
pub(super) fn spread(case: &Case, ranks: usize, unknowns: Option<u64>, nodes: f64) -> f64 {
    let unknowns = unknowns.unwrap_or(case.estimate(ranks).active) as f64;
    unit(case, ranks, nodes * unknowns) / unit(case, ranks, unknowns)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Measured CPU seconds lie in the band that is reported.
    #[test]
    fn solids_took_what_is_reported_of_them() {
        let column = include_str!("../../../../cases/round_column.toml");
        let footing = include_str!("../../../../cases/square_footing.toml");
        let short = "analysis.end=0.05";
        let runs: [(&str, &[&str], f64); 5] = [
            (column, &[], 18.0),
            (column, &["grid.cell=0.05", short], 5.6),
            (column, &["grid.cell=0.025", "analysis.end=0.1"], 390.0),
            (footing, &[], 16.9),
            (footing, &["material.clay.poisson=0.3"], 11.5),
        ];
        for (text, set, took) in runs {
            let set: Vec<String> = set.iter().map(ToString::to_string).collect();
            let case = Case::from_text("solid", text, &set).unwrap();
            let reported = guess(&case, 1, 1.0).seconds(sizes::frames(&case, sizes::steps(&case)));
            println!("{set:?}: {reported:.1} s for {took}");
            assert!(
                (1.0 / BAND..BAND).contains(&(reported / took)),
                "{set:?}: {reported} s for {took}"
            );
        }
    }
}
