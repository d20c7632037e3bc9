//! Writes the files of a run on rank 0.

mod first;
mod restart;
mod stiffness;

use crate::cli::Arguments;
use crate::restart::FreshStart;
use bsmpm::control::AcceptedStep;
use bsmpm::error::Measures;
use bsmpm::method::Criteria;
use bsmpm::method::Method;
use bsmpm::method::QuasiNewton;
use bsmpm::step::{Counts, StepReport};
use bsmpm_io::Error;
use bsmpm_io::checkpoint::Store;
use bsmpm_io::directory::{HISTORY, OutputDirectory};
use bsmpm_io::failure::{FAILURE, FailureReport};
use bsmpm_io::frame::Parts;
use bsmpm_io::frames::{COLLECTION, Frames};
use bsmpm_io::manifest::{self, BackgroundShares, Manifest, Status};
use bsmpm_io::residuals::{self, Iterate, RESIDUALS};
use bsmpm_io::steps::{STEPS, StepRow};
use bsmpm_io::table::{Cell, CsvTable, TableColumn};
use bsmpm_ranks::simulation::Cost;
use bsmpm_scene::Case;
use bsmpm_scene::surfaces;

/// The open files of a run, and what its manifest will say.
pub struct RunWriter {
    directory: OutputDirectory,
    manifest: Manifest,
    columns: Vec<TableColumn>,
    history: CsvTable,
    steps: CsvTable,
    residuals: Option<CsvTable>, // if the case asks for it
    water_flows: bool,           // they have a column of it
    profiles: Vec<CsvTable>,
    frames: Frames,
    store: Option<Store>, // once there is a checkpoint
    news: Vec<String>,    // warnings of this start
    has_gaps: bool,       // a table was begun again
    keep: u64,
    end: f64,
    dt: f64,
    criteria: Criteria,
    faces: Vec<(usize, f64)>, // of every support, the axis it is normal to, and the sign of its push along it
    least_reaction: f64,      // N, below which a reaction is none
    judges_stiffness: bool,   // time is none, and no motion is prescribed
    begins_with_stress: bool, // which the first step may redistribute
    whole: f64,               // that forces and works are multiplied with
}

/// Headings of the tables.
struct Headings {
    history: Vec<TableColumn>,
    steps: Vec<TableColumn>,
    residuals: Option<Vec<TableColumn>>,       // if the case asks for them
    profiles: Vec<(String, Vec<TableColumn>)>, // with the names of the files
}

/// Raises the largest value `so_far` to `value`, where that is larger.
fn raise(so_far: &mut Option<f64>, value: f64) {
    *so_far = Some(so_far.map_or(value, |so_far| so_far.max(value)));
}

fn residual_method(method: Method) -> residuals::ResidualMethod {
    match method {
        Method::QuasiNewton(QuasiNewton::Multisecant) => residuals::ResidualMethod::Multisecant,
        Method::QuasiNewton(QuasiNewton::Broyden) => residuals::ResidualMethod::Broyden,
        Method::Newton => residuals::ResidualMethod::Newton,
    }
}

impl Headings {
    fn of(case: &Case, columns: &[TableColumn]) -> Self {
        let time = if case.analysis.kind.is_timeless() { "-" } else { "s" };
        let first = [TableColumn::new("step", "-"), TableColumn::new("time", time)];
        let mut profiles = Vec::new();
        for profile in &case.profiles {
            let columns = profile.columns();
            let columns = columns
                .iter()
                .map(|column| TableColumn::new(&column.name, &column.unit));
            profiles.push((profile.file(), first.iter().cloned().chain(columns).collect()));
        }
        let residuals = case
            .output
            .residuals
            .then(|| Iterate::columns(time, case.flow.is_some()));
        Self {
            history: first.iter().chain(columns).cloned().collect(),
            steps: StepRow::columns(time).into(),
            residuals,
            profiles,
        }
    }
}

impl RunWriter {
    /// A new run in a directory that is held.
    pub fn open(
        held: OutputDirectory,
        beginning: &FreshStart,
        arguments: &Arguments,
        case: &Case,
        ranks: usize,
        columns: Vec<TableColumn>,
    ) -> Result<Self, Error> {
        let mut manifest = first::manifest(arguments, case, ranks);
        [HISTORY, STEPS, COLLECTION]
            .iter()
            .for_each(|file| manifest.name_output(file));
        if case.output.residuals {
            manifest.name_output(RESIDUALS);
        }
        case.profiles
            .iter()
            .for_each(|profile| manifest.name_output(&profile.file()));
        manifest.warnings.extend(
            held.note()
                .map(str::to_owned)
                .into_iter()
                .chain(beginning.warnings.clone()),
        );
        manifest.restarts.clone_from(&beginning.restarts);
        let directory = held.claim(beginning.existing, &manifest)?;
        let headings = Headings::of(case, &columns);
        let path = directory.path();
        let residuals = headings
            .residuals
            .map(|headings| CsvTable::create(&path.join(RESIDUALS), &headings));
        let profiles = headings
            .profiles
            .iter()
            .map(|(file, headings)| CsvTable::create(&path.join(file), headings));
        Ok(Self {
            profiles: profiles.collect::<Result<_, _>>()?,
            residuals: residuals.transpose()?,
            water_flows: case.flow.is_some(),
            history: CsvTable::create(&path.join(HISTORY), &headings.history)?,
            steps: CsvTable::create(&path.join(STEPS), &headings.steps)?,
            frames: Frames::create(path)?,
            store: None,
            news: manifest.warnings.clone(),
            has_gaps: false,
            keep: case.output.checkpoint.keep,
            end: case.analysis.end,
            dt: case.analysis.dt,
            criteria: bsmpm_scene::model::criteria(case),
            faces: bsmpm_scene::model::faces(case, 0.0),
            least_reaction: bsmpm_scene::model::least_reaction(case),
            judges_stiffness: case.analysis.kind.is_timeless() && !case.has_prescribed_motion(),
            begins_with_stress: case.initial.is_some(),
            whole: case.geometry.whole(),
            directory,
            manifest,
            columns,
        })
    }

    /// Goes on with what holds the bodies from the time `t` on.
    pub fn begin_stage(&mut self, case: &Case, t: f64) {
        self.faces = bsmpm_scene::model::faces(case, t);
    }

    /// Warnings of this start, which are still to be reported.
    pub fn news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }

    /// Whether a table lacks the steps before.
    pub fn has_gaps(&self) -> bool {
        self.has_gaps
    }

    /// Notes, if that is possible, that the run ends because its files could not be written.
    pub fn abandon(&mut self, exit_code: u8) {
        self.manifest.finish(Status::Failed, exit_code);
        // On a full disk this cannot be written, either.
        let _ = self.end_frames(true);
        let _ = self.manifest.write(self.directory.path());
    }

    /// What `run.json` says; written when the next file is.
    pub fn manifest(&mut self) -> &mut Manifest {
        &mut self.manifest
    }

    /// Where the run is written.
    pub fn path(&self) -> &std::path::Path {
        self.directory.path()
    }

    /// A row of `history.csv`; the checks whose time this is take their value, or none where a column's is not
    /// `is_reported`.
    pub fn history(&mut self, step: u64, time: f64, row: &[f64], is_reported: &[bool]) -> Result<(), Error> {
        let mut cells = vec![Cell::Int(step), Cell::Float(time)];
        cells.extend(row.iter().map(|&value| Cell::Float(value)));
        for check in &mut self.manifest.checks {
            if (check.at.unwrap_or(self.end) - time).abs() <= 1e-6 * self.dt {
                let column = self.columns.iter().position(|column| column.name == check.quantity);
                check.value = column.filter(|&column| is_reported[column]).map(|column| row[column]);
            }
        }
        self.history.row(&cells)
    }

    /// The rows of a profile at a time.
    pub fn profile(&mut self, number: usize, step: u64, time: f64, rows: &[Vec<f64>]) -> Result<(), Error> {
        for row in rows {
            let mut cells = vec![Cell::Int(step), Cell::Float(time)];
            cells.extend(row.iter().map(|&value| Cell::Float(value)));
            self.profiles[number].row(&cells)?;
        }
        Ok(())
    }

    /// A row of `steps.csv`, its share of the totals, and the rows of its iterations where they are wanted.
    pub fn step(&mut self, number: u64, accepted: &AcceptedStep, cost: Cost, wall: f64) -> Result<(), Error> {
        let report = &accepted.report;
        self.manifest.summary.steps = number;
        self.attempts(accepted.rejected.len(), accepted.counts);
        if self.manifest.ranks > 1 {
            self.manifest
                .balance
                .get_or_insert_default()
                .enter(cost.imbalance, cost.is_cut_again);
        }
        self.manifest.summary.newton_steps += u64::from(report.newton_iterations > 0);
        self.measures(number, report);
        self.stiffness(number, accepted);
        self.reactions(report);
        let slips = report
            .strips
            .iter()
            .filter(|strip| strip.motion > 0.0)
            .map(surfaces::relative_slip);
        let largest = slips.chain(self.manifest.summary.largest_slip).reduce(f64::max);
        self.manifest.summary.largest_slip = largest;
        let accumulated = report.strips.iter().map(|strip| strip.accumulated);
        let largest = accumulated
            .chain(self.manifest.summary.largest_accumulated_slip)
            .reduce(f64::max);
        self.manifest.summary.largest_accumulated_slip = largest;
        self.sizes(report);
        let row = StepRow {
            step: number,
            time: accepted.t,
            dt: accepted.dt,
            iterations: report.iterations as u64,
            residual: report.force,
            linear_iterations: accepted.counts.linear_iterations as u64,
            cutbacks: accepted.rejected.len() as u64,
            active_nodes: report.active_nodes as u64,
            wall,
            newton_iterations: report.newton_iterations as u64,
            evaluations: accepted.counts.evaluations as u64,
            products: accepted.counts.products as u64,
            factorisations: accepted.counts.factorisations as u64,
            reductions: cost.reductions,
            messages: cost.messages,
            bytes: cost.bytes,
            imbalance: cost.imbalance,
        };
        self.steps.row(&row.cells())?;
        self.end_frames(false)?;
        self.residuals(number, accepted)
    }

    fn sizes(&mut self, report: &StepReport) {
        let sizes = &mut self.manifest.sizes;
        sizes.insert("active_nodes".into(), report.active_nodes as u64);
        sizes.insert("unknowns".into(), report.unknowns as u64);
        if let Some(water) = &report.water {
            sizes.insert("water_unknowns".into(), water.unknowns as u64);
        }
        let artificial = report.artificial_stiffness;
        let most = [
            ("most_massless_nodes", report.massless_nodes),
            (
                "most_background_cells",
                artificial.map_or(0, |stiffness| stiffness.cells),
            ),
            ("most_tied_functions", report.tied_functions),
            ("most_untied_functions", report.untied_functions),
        ];
        for (name, count) in most {
            let most = sizes.entry(name.into()).or_default();
            *most = (*most).max(count as u64);
        }
    }

    /// What a step reports of how far its state can be trusted. A state without a direction from it was accepted as
    /// balanced to round-off, or far below the tolerance; one that settled, by its forces alone.
    fn measures(&mut self, number: u64, report: &StepReport) {
        let criteria = self.criteria;
        let summary = &mut self.manifest.summary;
        if let Some(passes) = &mut summary.smoothing_passes {
            *passes += report.smoothed;
        }
        raise(&mut summary.largest_advance, report.advance);
        let penetrations = report.rigid.iter().map(|rigid| rigid.penetration);
        summary.deepest_penetration = penetrations.chain(summary.deepest_penetration).reduce(f64::max);
        summary.settled_steps += u64::from(report.settled);
        summary.last_background = None;
        if let Some(stiffness) = &report.artificial_stiffness {
            let soft = stiffness.work * self.whole;
            let all = stiffness.internal_work * self.whole;
            let internal = summary.internal_work.unwrap_or(0.0) + all;
            summary.background_work = Some(summary.background_work.unwrap_or(0.0) + soft);
            summary.internal_work = Some(internal);
            // The forces of a single step may nearly vanish.
            let scale = all.max(internal / number as f64);
            let work = if soft == 0.0 { 0.0 } else { soft / scale };
            summary.last_background = Some(BackgroundShares { work });
        }
        if let Some(share) = report.artificial_stiffness.and_then(|stiffness| stiffness.force_share) {
            summary.background_forces = Some(summary.background_forces.unwrap_or(0.0) + share);
        }
        if let Some((excess, turnover)) = report.beside_fixed.zip(report.turnover.as_ref()) {
            summary.beside_fixed = Some(summary.beside_fixed.unwrap_or(0.0) + excess * self.whole);
            summary.kinetic = Some(summary.kinetic.unwrap_or(0.0) + turnover.stored.kinetic * self.whole);
        }
        // Where statuses of contacts were corrected, histories go on from search to search: the last alone judges.
        if let Some(last) = report.judged.filter(|_| !report.settled) {
            raise(&mut summary.largest_force_measure, last.force / criteria.force);
            raise(&mut summary.largest_energy_measure, last.energy / criteria.energy);
            if let Some(water) = last.water {
                raise(&mut summary.largest_water_measure, water / criteria.second_field());
            }
        }
    }

    /// The largest forces of the supports: supports hold both ways, which soil at a wall does not.
    fn reactions(&mut self, report: &StepReport) {
        let summary = &mut self.manifest.summary;
        for (&(axis, push), force) in self.faces.iter().zip(&report.reactions) {
            let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
            let pull = if size > self.least_reaction {
                (-push * force[axis]).max(0.0)
            } else {
                0.0
            };
            let [size, pull] = [size, pull].map(|force| force * self.whole);
            raise(&mut summary.largest_reaction, size);
            raise(&mut summary.largest_pull, pull);
        }
    }

    /// Where the body's front is, m, and how far it is behind the farthest one.
    pub fn front(&mut self, front: f64) {
        let summary = &mut self.manifest.summary;
        let farthest = summary.farthest_front.map_or(front, |so_far| so_far.max(front));
        summary.farthest_front = Some(farthest);
        raise(&mut summary.largest_front_setback, farthest - front);
    }

    /// The rows of `residuals.csv`, if there is one.
    fn residuals(&mut self, step: u64, accepted: &AcceptedStep) -> Result<(), Error> {
        let Some(table) = &mut self.residuals else {
            return Ok(());
        };
        let report = &accepted.report;
        let flows = self.water_flows;
        let mut row = Iterate {
            step,
            time: accepted.t,
            iteration: 0,
            method: None,
            energy: f64::NAN,
            force: f64::NAN,
            water: f64::NAN,
        };
        for &Measures {
            energy,
            force,
            water,
            method,
        } in &report.history
        {
            row = Iterate {
                iteration: row.iteration + 1,
                method: Some(residual_method(method)),
                energy,
                force,
                water: water.unwrap_or(f64::NAN),
                ..row
            };
            table.row(&row.cells(flows))?;
        }
        if report.history.last().is_none_or(|last| last.force != report.force) {
            row = Iterate {
                iteration: row.iteration + 1,
                method: None,
                energy: f64::NAN,
                force: report.force,
                water: report.water.as_ref().map_or(f64::NAN, |water| water.measure),
                ..row
            };
            table.row(&row.cells(flows))?;
        }
        Ok(())
    }

    /// Adds the work of attempts, of which so many led to a cut, to the totals.
    pub fn attempts(&mut self, cuts: usize, counts: Counts) {
        let summary = &mut self.manifest.summary;
        summary.cutbacks += cuts as u64;
        summary.iterations += counts.iterations as u64;
        summary.linear_iterations += counts.linear_iterations as u64;
        summary.residual_evaluations += counts.evaluations as u64;
        summary.products += counts.products as u64;
        summary.factorisations += counts.factorisations as u64;
    }

    /// A frame; the manifest names it before it is there.
    pub fn frame(&mut self, parts: Parts<'_>) -> Result<(), Error> {
        self.manifest.name_output(&Frames::file(parts.head.step));
        let ended = self.frames.begin(parts, &self.manifest)?;
        self.manifest.complete(ended);
        Ok(())
    }

    /// Notes frames that have got their names; of all of them, if it is to `wait`.
    fn end_frames(&mut self, wait: bool) -> Result<(), Error> {
        let ended = self.frames.ended(wait)?;
        self.manifest.complete(ended);
        Ok(())
    }

    /// Writes the manifest as it is, when nobody else does.
    fn write_manifest(&mut self) -> Result<(), Error> {
        self.end_frames(true)?;
        self.manifest.write(self.directory.path())
    }

    /// `failure.json`, and what the manifest says of it.
    pub fn failure(&mut self, report: &FailureReport) -> Result<(), Error> {
        self.manifest.name_output(FAILURE);
        self.manifest.failure = Some(manifest::ManifestFailure {
            step: report.step,
            time: report.time,
            reason: report.attempts.last().cloned().unwrap_or_default(),
            residuals: report.history.iter().map(|measures| measures.energy).collect(),
            worst: report.worst.first().cloned(),
            loose: report.loose.clone(),
        });
        report.write(self.directory.path())
    }

    /// Notes how the run ended, and sizes and hashes of all files; writes the manifest for the last time.
    pub fn close(&mut self, status: Status, exit_code: u8) -> Result<(), Error> {
        self.end_frames(true)?;
        self.manifest.finish(status, exit_code);
        self.manifest.seal(self.directory.path())?;
        self.write_manifest()
    }

    /// Decides the checks of a run that reached its end; true if all passed.
    pub fn judge(&mut self) -> bool {
        for check in &mut self.manifest.checks {
            check.passed = check.value.is_some_and(|value| {
                check.min.is_none_or(|min| value >= min) && check.max.is_none_or(|max| value <= max)
            });
        }
        self.manifest.checks.iter().all(|check| check.passed)
    }
}
