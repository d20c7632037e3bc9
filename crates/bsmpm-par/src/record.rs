//! Computes rows of `history.csv`.

use crate::checkpoint::{BooksForm, Outlet, RecordState, Row};
use bsmpm::energy::{EnergyAccounts, StoredEnergy};
use bsmpm::error::StepError;
use bsmpm::field::pore_water::crossed::CrossedVolumes;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::{self, Part};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::step::StepReport;
use bsmpm::step::outflow::Outflow;
use bsmpm::tensor::Vector;
use bsmpm_scene::model::vector;
use bsmpm_scene::observables::{Aspect, FootingSample, Observable, Sample, displacement_at};
use bsmpm_scene::surfaces::{self, DrainPlace, FootingMonitor};
use bsmpm_scene::{Case, GridSpec, History, HistorySubject, Made, Quantity, Stage};

/// The histories of a run, with the points that they follow.
pub struct Recorder<const D: usize> {
    histories: Vec<History>,
    parts: Vec<Part>,   // the points that each of them counts
    vacant: Vec<usize>, // histories in whose box no point has been yet
    empty: Vec<usize>,  // those in whose box no point was at the last row
    followed: Vec<Option<u64>>,
    reacting: Vec<Option<usize>>, // strip whose force a reaction is
    gauge: Option<FootingMonitor>,
    drains: Vec<DrainPlace>,       // where the physics has each
    crossed: CrossedVolumes,       // water that has left until the last row
    books: Option<EnergyAccounts>, // of energy, opened by the first row
    energy: Vec<f64>,              // J/m, of the last row, in the order of the columns; empty if it is not balanced
    left: Outlet,
    work: Vec<f64>,  // J/m, of every strip; empty where no history wants it
    datum: Vec<Row>, // m, deg: of every history's displacement when they were last set to zero, if they ever were
    moved: Vec<Row>, // m, deg: of what is rigid in the last row, from the start on
    grid: GridSpec,
    lower: Vector<D>,
}

impl<const D: usize> Recorder<D> {
    /// Finds the points nearest to the wanted places.
    pub fn new(case: &Case, points: &Points<D>, halo: &dyn Halo) -> Self {
        let histories = &case.histories;
        let lower = vector::<D, _>(case.grid.lower());
        let lasting = case.lasting();
        let mut followed = Vec::with_capacity(histories.len());
        for (number, history) in histories.iter().enumerate() {
            let comes_later = case.stages.iter().any(|stage| stage.follows.contains(&number));
            let at = followed_place(&history.quantity).filter(|_| !comes_later);
            followed.push(at.and_then(|at| {
                observe::nearest(points, &(vector(at) - lower), |id| !history.lasts || lasting(id), halo)
            }));
        }
        let vacant = (0..histories.len())
            .filter(|&number| histories[number].quantity.counted().within.is_some())
            .collect();
        let state = RecordState {
            followed,
            vacant,
            ..RecordState::default()
        };
        Self::of(case, state)
    }

    /// Goes on with what another one had found; `None` if it was one of other histories.
    pub fn resume(case: &Case, state: &RecordState) -> Option<Self> {
        (state.followed.len() == case.histories.len()).then(|| Self::of(case, state.clone()))
    }

    fn of(case: &Case, state: RecordState) -> Self {
        let reacting = case.histories.iter().map(|history| match history.quantity.subject {
            HistorySubject::Face(face) => surfaces::strip_of_face(case, face),
            _ => None,
        });
        let mut observables = case.histories.iter().map(|history| history.quantity.observable);
        let wants_work = observables.any(|observable| observable == Observable::Work);
        let strips = case.prescribed.len() + usize::from(case.footing.is_some());
        let mut work = state.work;
        work.resize(if wants_work { strips } else { 0 }, 0.0);
        Self {
            work,
            histories: case.histories.clone(),
            parts: parts::<D>(case),
            vacant: state.vacant,
            empty: Vec::new(),
            followed: state.followed,
            reacting: reacting.collect(),
            gauge: FootingMonitor::of(case),
            drains: surfaces::drain_places(case),
            crossed: CrossedVolumes::default(),
            books: state.books.map(|BooksForm(books)| books),
            energy: Vec::new(),
            datum: state.datum,
            moved: vec![Row::new(); case.histories.len()],
            left: state.left,
            grid: case.grid.clone(),
            lower: vector(case.grid.lower()),
        }
    }

    /// What must be known to go on.
    pub fn state(&self) -> RecordState {
        let followed = self.followed.clone();
        let books = self.books.map(BooksForm);
        let vacant = self.vacant.clone();
        let work = self.work.clone();
        let datum = self.datum.clone();
        RecordState {
            followed,
            vacant,
            books,
            left: self.left,
            work,
            datum,
        }
    }

    /// Follows points of the bodies that a stage has placed, and sets displacements to zero where it wants that.
    pub fn begin_stage(&mut self, case: &Case, stage: &Stage, points: &Points<D>, halo: &dyn Halo) {
        let taken = case.taken_by(stage);
        let placed = case.placed_by(stage);
        self.followed
            .iter_mut()
            .filter(|followed| followed.is_some_and(&taken))
            .for_each(|lost| *lost = None);
        for &number in &stage.follows {
            if let Some(at) = followed_place(&self.histories[number].quantity) {
                self.followed[number] = observe::nearest(points, &(vector(at) - self.lower), &placed, halo);
            }
        }
        if stage.resets_displacements {
            let mut datum = Vec::with_capacity(self.histories.len());
            for (number, history) in self.histories.iter().enumerate() {
                let Quantity { observable, subject } = &history.quantity;
                datum.push(match (subject, self.followed[number]) {
                    (HistorySubject::Place { at, .. }, Some(id)) if *observable == Observable::Displacement => {
                        displacement_at(*at, self.lower, id, points, halo).to_vec()
                    }
                    _ if observable.has(Aspect::RigidMotion) => self.moved[number].clone(),
                    _ => vec![0.0; D],
                });
            }
            self.datum = datum;
        }
    }

    /// Enters what has left the grid; the histories that have lost their point by it, which read 0 from now on.
    pub fn let_out(&mut self, outflow: &Outflow, points: &Points<D>, halo: &dyn Halo) -> Vec<String> {
        let [before, after] = outflow.stored;
        self.exchange(before, after);
        self.left.points += outflow.points;
        self.left.mass += outflow.mass;
        let mut lost = Vec::new();
        for (followed, history) in self.followed.iter_mut().zip(&self.histories) {
            if followed.is_some_and(|id| observe::at_point(points, id, halo, |_| [1.0]) == [0.0]) {
                *followed = None;
                lost.push(history.name.clone());
            }
        }
        lost
    }

    /// Whether the number of every column of the last row is one: means and places of no point are none.
    pub fn reported(&self) -> Vec<bool> {
        let mut reported = Vec::new();
        for (number, history) in self.histories.iter().enumerate() {
            let is_reported = history.quantity.observable.has(Aspect::Sum) || !self.empty.contains(&number);
            reported.extend(std::iter::repeat_n(is_reported, history.columns().len()));
        }
        reported
    }

    /// Names of the histories in whose box no point has been yet, if there are any.
    pub fn vacant(&self) -> Option<String> {
        let names: Vec<&str> = self
            .vacant
            .iter()
            .map(|&number| &*self.histories[number].name)
            .collect();
        (!names.is_empty()).then(|| names.join(", "))
    }

    /// What has left the grid so far.
    pub fn left(&self) -> Outlet {
        self.left
    }

    /// Enters what a stage has changed the energy of the points by.
    pub fn exchange(&mut self, before: StoredEnergy, after: StoredEnergy) {
        self.books.iter_mut().for_each(|books| books.exchange(before, after));
    }

    /// The books of energy, if they are kept.
    pub fn books(&self) -> Option<&EnergyAccounts> {
        self.books.as_ref()
    }

    /// Heading and unit of every column.
    pub fn columns(&self) -> Vec<bsmpm_io::table::TableColumn> {
        let columns = self.histories.iter().flat_map(History::columns);
        columns
            .map(|column| bsmpm_io::table::TableColumn::new(&column.name, &column.unit))
            .collect()
    }

    /// The body's front (m) in a row, if it is recorded.
    pub fn front(&self, row: &[f64]) -> Option<f64> {
        let at = self
            .histories
            .iter()
            .position(|history| history.quantity.observable == Observable::Front)?;
        let column: usize = self.histories[..at].iter().map(|history| history.columns().len()).sum();
        Some(row.get(column)? / self.histories[at].factor()).filter(|front| front.is_finite())
    }

    /// The row of the state at time `t`; `report` is that of the step that led to it, empty at the start.
    pub fn row<K: Kinematics<D>>(
        &mut self,
        model: &Model<K, D>,
        points: &Points<D>,
        crossed: &CrossedVolumes,
        t: f64,
        report: &StepReport,
        halo: &dyn Halo,
    ) -> Result<Vec<f64>, StepError> {
        self.crossed.clone_from(crossed);
        if model.balances_energy {
            self.energy = self.balance_energy(model, points, t, report, halo);
        }
        self.work
            .iter_mut()
            .zip(&report.strips)
            .for_each(|(sum, strip)| *sum += strip.work);
        let boxes = (0..self.parts.len()).filter(|&number| matches!(self.parts[number], Part::Within(..)));
        self.empty = boxes
            .filter(|&number| !observe::is_occupied(points, &self.parts[number], halo))
            .collect();
        self.vacant.retain(|number| self.empty.contains(number));
        let mut row = Vec::new();
        for (number, history) in self.histories.iter().enumerate() {
            let mut values = self.values(number, model, points, t, report, halo)?;
            if history.quantity.observable.has(Aspect::RigidMotion) {
                self.moved[number].clone_from(&values);
                let datum = self.datum.get(number).into_iter().flatten();
                values.iter_mut().zip(datum).for_each(|(value, datum)| *value -= datum);
            }
            row.extend(values.iter().map(|value| history.factor() * value));
        }
        Ok(row)
    }

    /// The quantity of a history.
    fn values<K: Kinematics<D>>(
        &self,
        number: usize,
        model: &Model<K, D>,
        points: &Points<D>,
        t: f64,
        report: &StepReport,
        halo: &dyn Halo,
    ) -> Result<Vec<f64>, StepError> {
        let Quantity { observable, subject } = &self.histories[number].quantity;
        let work = match subject {
            HistorySubject::Strip(strip) => self.work.get(*strip).copied().unwrap_or(0.0),
            _ => 0.0,
        };
        let drained = match subject {
            HistorySubject::Drain(Some(drain)) => self.drained(*drain),
            _ => self.crossed.out(),
        };
        observable.values(&Sample {
            model,
            points,
            t,
            report,
            halo,
            grid: &self.grid,
            lower: self.lower,
            subject,
            part: &self.parts[number],
            followed: self.followed[number],
            datum: self.datum.get(number).map(Vec::as_slice),
            holding_strip: self.reacting[number],
            footing: self.footing(t, report),
            work,
            drained,
            crossed: &self.crossed,
            outflow: self.left.mass,
            energy: &self.energy,
        })
    }

    /// Values of the footing; 0 without one, and before the first step.
    fn footing(&self, t: f64, report: &StepReport) -> FootingSample {
        let Some(gauge) = &self.gauge else {
            return FootingSample::default();
        };
        let strip = report.strips.first();
        FootingSample {
            pressure: strip.map_or(0.0, |strip| gauge.pressure(strip)),
            force: strip.map_or(0.0, |strip| gauge.force(strip)),
            penetration: gauge.penetration(t),
            slip: strip.map_or(0.0, surfaces::relative_slip),
        }
    }

    /// m3/m  out of a drain so far, by its number in the file.
    fn drained(&self, drain: usize) -> f64 {
        let crossed = &self.crossed;
        let found = match self.drains.get(drain) {
            Some(DrainPlace::Face(number)) => crossed.faces.get(*number),
            Some(DrainPlace::Surface(number)) => crossed.drains.get(*number),
            None => None,
        };
        found.copied().unwrap_or(0.0)
    }

    /// Where the energy is and went, in the order of the quantity's columns, with the step of `report` entered.
    fn balance_energy<K: Kinematics<D>>(
        &mut self,
        model: &Model<K, D>,
        points: &Points<D>,
        t: f64,
        report: &StepReport,
        halo: &dyn Halo,
    ) -> Vec<f64> {
        let now = StoredEnergy::of(model, points, t, halo);
        let books = self.books.get_or_insert_with(|| EnergyAccounts::open(now));
        if let Some(step) = report.energy {
            books.flows += step;
        }
        let flows = books.flows;
        let parts = [
            flows.transfer,
            flows.integration,
            flows.smoothing,
            flows.artificial_stiffness,
            flows.penalty,
        ];
        let whole = [
            now.kinetic,
            now.elastic,
            flows.plastic,
            flows.external,
            flows.numerical(),
        ];
        whole.into_iter().chain(parts).chain([books.residual(now)]).collect()
    }
}

/// The place of a history that follows the point nearest to it.
fn followed_place(quantity: &Quantity) -> Option<[f64; 3]> {
    match quantity.subject {
        HistorySubject::Place { at, surface: false } => Some(at),
        _ => None,
    }
}

/// The points that every history counts.
fn parts<const D: usize>(case: &Case) -> Vec<Part> {
    // Bodies are counted for those alone who name one.
    let mut ids = None;
    let origin = vector::<D, _>(case.grid.lower());
    let mut parts = Vec::with_capacity(case.histories.len());
    for history in &case.histories {
        let counted = history.quantity.counted();
        let made = match counted.made {
            Made::All => Part::Whole,
            Made::Material(number) => Part::Material(number),
            Made::Body(number) => Part::Ids(ids.get_or_insert_with(|| case.ids())[number].clone()),
        };
        let Some(corners) = counted.within else {
            parts.push(made);
            continue;
        };
        let corners = corners.map(|corner| {
            let from_origin = vector::<D, _>(corner) - origin;
            std::array::from_fn(|axis| if axis < D { from_origin[axis] } else { 0.0 })
        });
        parts.push(Part::Within(Box::new(made), corners));
    }
    parts
}
