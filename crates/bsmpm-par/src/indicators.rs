//! Computes indicators at the end of a run. They show whether the results are reliable. Their definitions are equations
//! (T10.4), (T10.5), (T10.9) and (T10.13) to (T10.16) of the theory manual.

mod force_noise;
mod limits;
mod report;
mod text;

pub use report::{acceptance, description, line};

use crate::log::short;
use crate::record::Recorder;
use crate::setup;
use bsmpm::energy::{EnergyBound, StoredEnergy};
use bsmpm::error::StepError;
use bsmpm::field::pore_water::crossed::CrossedVolumes;
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::{Model, Regime};
use bsmpm::observe::interfaces::{self, InterfaceShift};
use bsmpm::observe::noise::{Noise, relative_pressure_noise};
use bsmpm::observe::quadrature::{self, Defect};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_io::manifest::{Indicator, Summary};
use bsmpm_io::table::Columns;
use bsmpm_scene::{Case, GridAxis, NarrowestOpening};
use std::collections::BTreeMap;

/// Usual root mean square, and usual largest one, of the quadrature defect.
const DEFECT: [f64; 2] = [0.2, 0.8];
/// Usual number of points in an inner cell: fewer than 2 x 2 integrate too little, and no number is too many.
const POINTS: [f64; 2] = [3.0, 1e3];
/// Usual compression with fewer points along an axis of a cell than so many: an elastic bar on 64 cells that its weight
/// compresses by 1, 5, 9, 15, 28 and 52 % has a mean error of its stress of 0.006, 0.3, 0.8, 1.0, 1.0 and 0.6 % with 2,
/// 0.4 and 0.3 % at 28 and 52 % with 3, 0.2 and 0.07 % at 52 % with 4 and 6 points. With fitted volumes it is 0.04 % at
/// most, with 2 or 3 points: no compression is unusual then.
const COMPRESSION: (usize, f64) = (4, 0.1);
/// Usual noise of the pressure about its average and about planes.
const NOISE: [f64; 2] = [0.25, 0.3];
/// Usual closure of energy, and usual numerical loss.
const ENERGY: [f64; 2] = [1e-4, 0.1];
/// Usual growth of energy beyond the work done; the run ends at 0.05.
const GROWTH: f64 = 0.02;
/// Usual part of the water that is lost: a step may leave so much of its own.
const WATER: f64 = 1e-4;
/// Part of the thinnest connected material along which smoothing is usual: of all strain in every step, and of the
/// elastic dilation in proportion to plastic flow, which renews it.
const SMOOTHED: [f64; 2] = [0.1, 1.5];
/// Usual slip of a strip in a step over its motion.
const SLIP: f64 = 0.01;
/// Cells across a footing with fewer of which its load at failure is off by 10 % and more. On clay it was 9 % too large
/// on level ground with 8 cells, 12 and 15 % at the crest of a slope, and with 16 cells 8, 8 and 9 %.
const FOOTING_CELLS: f64 = 10.0;
/// No number of cells is too many.
const MANY_CELLS: f64 = 1e6;

/// Cells by which material may be in a rigid body.
const PENETRATION: f64 = 0.05;
/// Part of the largest reaction with which the face of a grid usually pulls.
const PULL: f64 = 0.05;
/// Largest cells by which a front usually goes back.
const SETBACK: f64 = 1.0;
/// Cells by which points usually move in a step of dynamics, at most: the short collapse in steps of 10 ms, in which
/// they move by one, ends 9 % off.
const ADVANCE: f64 = 0.5;
/// Part of the kinetic energy that points beside fixed faces usually have without moving so.
const BESIDE: f64 = 0.1;
/// Part of the internal forces' work that a background usually takes.
const BACKGROUND: f64 = 0.02;
/// Largest force of the background on a node over the RMS force of the nodes, added over the steps under dead load:
/// 0.013 at most on tied functions; 0.010, 0.015, 0.024 and 0.041 in 10, 20, 40 and 100 steps where a function creeps
/// and displacements are too large by a factor of 1.00, 1.3, 2.0 and 3.3.
const LOAD_SHARE: f64 = 0.015;
/// Usual loss of stiffness in a step. The slope of the README, whose factor of safety is 1.37, has 2 to 3 at a factor
/// of 1.3, 20 to 50 at 1.35 and 1,000 to 30,000 from 1.4 on.
pub(crate) const STIFFNESS_LOSS: f64 = 100.0;

/// Cells by which an interface may leave its C0 line: stress near it is then off by 2 % (RMS), in extremes by three
/// times as much; with fitted volumes by 2 % at a fifth of a cell.
const SHIFT: f64 = 0.02;
const SHIFT_FITTED: f64 = 0.2;
/// The same where permeabilities differ by 3 or more: the flow is off by 2 % up to here, and beyond it, once the first
/// row of points has crossed the line, by 75 % and more.
const SHIFT_WATER: f64 = 0.1;

/// What the state at the end reports.
#[derive(Clone, Debug, PartialEq)]
pub struct IndicatorState {
    defect: Option<Defect>,
    compression: Vec<f64>, // of each material
    noise: Noise,
    energy: Option<Energy>,
    growth: Option<f64>,
    water: Option<f64>, // part of it that was lost
    interfaces: InterfaceShift,
}

/// Energy that is not accounted for, and that the algorithm lost, over the largest energy.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Energy {
    closure: f64,
    loss: f64,
}

impl IndicatorState {
    /// Of the points of all ranks at a time, until which these volumes of water have crossed the surface. Collective;
    /// the same on all.
    pub fn of<K: Kinematics<D>, const D: usize>(
        model: &Model<K, D>,
        points: &Points<D>,
        crossed: &CrossedVolumes,
        t: f64,
        recorder: &Recorder<D>,
        budget: Option<EnergyBound>,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let defect = quadrature::defect(model, points, halo);
        let compression = quadrature::compression(points, model.materials.len(), halo);
        let young = model
            .materials
            .iter()
            .map(|material| material.elastic().young)
            .fold(0.0, f64::max);
        let noise = relative_pressure_noise(&model.grid, points, model.weighting, young, halo)?;
        let energy = recorder.books().map(|books| {
            let now = StoredEnergy::of(model, points, t, halo);
            let numbers = [
                books.flows.external.abs(),
                books.flows.plastic,
                books.start,
                now.kinetic + now.elastic,
            ];
            let so_far = budget.map_or(f64::MIN_POSITIVE, |budget| budget.largest);
            let largest = numbers.into_iter().fold(so_far, f64::max);
            Energy {
                closure: books.residual(now).abs() / largest,
                loss: books.flows.numerical() / largest,
            }
        });
        let water = PoreWater::of(model, points, t)
            .and_then(|water| water.balance(crossed, halo))
            .map(f64::abs);
        let interfaces = interfaces::shift(model, points, halo);
        let growth = budget.map(|budget| budget.growth);
        Ok(Self {
            defect,
            compression,
            noise,
            energy,
            growth,
            water,
            interfaces,
        })
    }

    /// The indicators of a run of a case, by name: of what is in it, and of its history, if there is one.
    pub fn indicators(&self, case: &Case, summary: &Summary, history: Option<&Columns>) -> BTreeMap<String, Indicator> {
        let mut all = self.rows();
        let measures = [
            ("force-measure", summary.largest_force_measure),
            ("energy-measure", summary.largest_energy_measure),
            ("water-measure", summary.largest_water_measure),
        ];
        all.extend(
            measures
                .into_iter()
                .filter_map(|(name, value)| Some((name, at_most(1.0, value?)))),
        );
        all.push(("compression", self.compression(case)));
        let slip = summary.largest_slip.map(|value| ("slip", at_most(SLIP, value)));
        let smoothed = summary
            .smoothing_passes
            .map(|passes| ("smoothing-length", smoothing(case, passes)));
        all.extend(slip.into_iter().chain(smoothed).chain(course(case, summary)));
        all.extend(shifts(self.interfaces, case));
        all.extend(
            history
                .and_then(|history| force_noise::of(case, history))
                .map(|noise| ("force-noise", noise)),
        );
        all.extend(
            case.cells_across_footing()
                .map(|cells| ("cells-across-footing", across_footing(cells))),
        );
        all.extend(
            case.opening
                .as_ref()
                .map(|narrowest| ("cells-across-opening", across(narrowest))),
        );
        // JSON has no other numbers.
        all.retain(|(_, indicator)| indicator.value.is_finite());
        let mut judged = BTreeMap::new();
        for (name, indicator) in all {
            let text = text::of(name, case, indicator.value);
            let which = indicator.meaning.clone();
            let limited = indicator.limited(limits::of(name, case), limits::are_accepted(name, case));
            judged.insert(name.to_owned(), report::worded(name, &text, &which, limited));
        }
        judged
    }

    /// The volume that the most compressed material has lost. With enough points any is usual.
    fn compression(&self, case: &Case) -> Indicator {
        let (enough, most) = COMPRESSION;
        let mut largest = 0.0_f64;
        let mut largest_of_coarse = 0.0_f64;
        for body in &case.bodies {
            let lost = self.compression[body.material];
            largest = largest.max(lost);
            if body.points_per_cell < enough && case.solver.quadrature == Quadrature::Points {
                largest_of_coarse = largest_of_coarse.max(lost);
            }
        }
        if largest_of_coarse > most {
            return at_most(most, largest_of_coarse);
        }
        at_most(1.0, largest)
    }

    /// Those of the state alone.
    fn rows(&self) -> Vec<(&'static str, Indicator)> {
        let mut rows = vec![
            ("pressure-noise-average", at_most(NOISE[0], self.noise.about_average)),
            ("pressure-noise-plane", at_most(NOISE[1], self.noise.about_plane)),
        ];
        if let Some(defect) = self.defect {
            rows.push(("quadrature-defect", at_most(DEFECT[0], defect.rms)));
            rows.push(("quadrature-defect-largest", at_most(DEFECT[1], defect.largest)));
            rows.push(("points-per-cell", Indicator::new(defect.points, "-", "", POINTS)));
        }
        if let Some(energy) = self.energy {
            rows.push(("energy-closure", at_most(ENERGY[0], energy.closure)));
            rows.push((
                "energy-loss",
                Indicator::new(energy.loss, "-", "", [-ENERGY[1], ENERGY[1]]),
            ));
        }
        rows.extend(self.growth.map(|growth| ("energy-growth", at_most(GROWTH, growth))));
        rows.extend(self.water.map(|lost| ("water-balance", at_most(WATER, lost))));
        rows
    }
}

/// A value without a unit that is usual from 0 to `most`.
fn at_most(most: f64, value: f64) -> Indicator {
    Indicator::new(value, "-", "", [0.0, most])
}

/// The part of a whole; 0 of any for no part.
fn share(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// Those of all steps together that need no more than their totals.
fn course(case: &Case, summary: &Summary) -> impl Iterator<Item = (&'static str, Indicator)> {
    // Elastic bodies without weight are meant to hang on planes of symmetry; soil is not.
    let has_soil = case
        .bodies
        .iter()
        .any(|body| case.materials[body.material].material.yields());
    let may_come_off = has_soil || case.gravity.is_some();
    let pull = summary
        .largest_pull
        .zip(summary.largest_reaction)
        .filter(|_| may_come_off);
    let pull = pull.map(|(pull, largest)| ("support-pull", at_most(PULL, share(pull, largest))));
    let setback = summary.largest_front_setback.map(|setback| {
        let usual = [0.0, SETBACK * case.grid.axes[0].longest()];
        ("front-setback", Indicator::new(setback, "m", "", usual))
    });
    let [background, load_share] = of_background(case, summary);
    let loss = summary.largest_stiffness_loss.map(|loss| {
        let state = match summary.failed_at {
            Some(t) => format!("the ground failed at t = {}", short(t)),
            None => "the ground has not failed".to_owned(),
        };
        (
            "stiffness-loss",
            Indicator::new(loss, "-", &state, [0.0, STIFFNESS_LOSS]),
        )
    });
    let cell = case
        .grid
        .axes
        .iter()
        .map(GridAxis::shortest)
        .fold(f64::INFINITY, f64::min);
    let advance = summary
        .largest_advance
        .filter(|_| case.analysis.regime == Regime::Dynamic);
    let advance = advance.map(|advance| ("step-advance", at_most(ADVANCE, advance / cell)));
    let beside = summary.beside_fixed.zip(summary.kinetic).map(|(excess, all)| {
        (
            "wall-velocity",
            Indicator::new(share(excess, all), "-", "", [-BESIDE, BESIDE]),
        )
    });
    let penetration = summary
        .deepest_penetration
        .map(|depth| ("rigid-penetration", at_most(PENETRATION, depth)));
    [
        pull,
        setback,
        background,
        load_share,
        loss,
        advance,
        beside,
        penetration,
    ]
    .into_iter()
    .flatten()
}

/// Share of the artificial stiffness in the work: over all steps, or, if a limit load is read at the end of the run,
/// in the last step; and its force under dead load. None without an artificial stiffness.
fn of_background(case: &Case, summary: &Summary) -> [Option<(&'static str, Indicator)>; 2] {
    let load = summary
        .background_forces
        .map(|shares| ("background-load-share", at_most(LOAD_SHARE, shares)));
    let part = match case.limit_load {
        Some(_) => summary.last_background.map(|shares| shares.work),
        None => {
            let part = summary.background_work.zip(summary.internal_work);
            part.map(|(soft, all)| if soft == 0.0 { 0.0 } else { soft / all })
        }
    };
    [part.map(|part| ("background-work", at_most(BACKGROUND, part))), load]
}

/// How far interfaces have left their grid lines.
fn shifts(found: InterfaceShift, case: &Case) -> impl Iterator<Item = (&'static str, Indicator)> {
    let most = if case.solver.quadrature == Quadrature::Fitted {
        SHIFT_FITTED
    } else {
        SHIFT
    };
    let stress = found.stress.map(|moved| ("interface-shift", at_most(most, moved)));
    let water = found
        .water
        .map(|moved| ("permeability-shift", at_most(SHIFT_WATER, moved)));
    stress.into_iter().chain(water)
}

/// Cells across a footing.
fn across_footing(cells: f64) -> Indicator {
    Indicator::new(cells, "-", "", [FOOTING_CELLS, MANY_CELLS])
}

/// Cells across the hole or notch that has the fewest.
fn across(narrowest: &NarrowestOpening) -> Indicator {
    let NarrowestOpening { path, cells, least, .. } = narrowest;
    let which = format!("`{path}` ({} m wide)", narrowest.brief_width());
    Indicator::new(*cells, "-", &which, [*least, MANY_CELLS])
}

/// How far so many passes of smoothing have reached.
fn smoothing(case: &Case, passes: f64) -> Indicator {
    let part = match case.stabilisation {
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => SMOOTHED[1],
        _ => SMOOTHED[0],
    };
    Indicator::new(
        setup::smoothing_length(case, passes),
        "m",
        "",
        [0.0, part * case.thinnest()],
    )
}
