//! Assembles linear systems, solves them by PETSc's KSP (Krylov solvers), and checks residuals.

mod choice;
mod cycles;
mod direct;
mod dissection;
mod multigrid;
mod shell;
mod system;
mod tally;

pub use choice::{Choice, SPLINE_MULTIGRID, probe};
pub use tally::{Tallies, Tally};

use crate::halo::MpiHalo;
use crate::stencil::{Numbering, Stencil};
use crate::timers::Timers;
use bsmpm::error::SolveError;
use bsmpm::grid::Grid;
use bsmpm::linear::{Krylov, LinearSolver, MatrixAssembly, SolveReport, Symmetry};
use bsmpm::model::Model;
use bsmpm::nodal::Nodal;
use bsmpm::parallel::Halo;
use cycles::CycleSystem;
use direct::StiffnessOperator;
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use petsc_rs::{Matrix, Petsc};
use shell::{DissectionSystem, ShellSystem};
use std::rc::Rc;
use system::{System, failed};

/// Linear solver of a run, with C unknowns per node of a grid of dimension D. It has one matrix, rebuilt in every step;
/// the pattern and its analysis are kept while the unknowns stay the same.
pub struct KspSolver<'p, const D: usize, const C: usize> {
    petsc: &'p Petsc<'p>,
    choice: Choice,
    halo: Rc<MpiHalo>,
    grid: Grid<D>,
    stencil: Stencil<D, C>,
    free: Vec<bool>,
    numbers: Numbering,                             // empty before PETSc needs it
    own: usize,                                     // number of unknowns of this rank
    shell: Option<Box<dyn ShellSystem<D, C> + 'p>>, // for nested dissection and spline multigrid
    is_sized: bool,                                 // whether the shell system is set up for the present unknowns
    definite: Option<System<'p>>,
    general: Option<System<'p>>,             // for Newton's method
    water: Option<Box<KspSolver<'p, D, 1>>>, // of the pore pressures, if water flows
    tallies: Tallies,
    timers: Rc<Timers>,
}

impl<'p, const D: usize> KspSolver<'p, D, D> {
    /// Creates the solver of a model's displacements and, with transient seepage, of its pore pressures.
    pub fn of_model<K>(
        petsc: &'p Petsc<'p>,
        choice: &Choice,
        model: &Model<K, D>,
        halo: &Rc<MpiHalo>,
        timers: &Rc<Timers>,
    ) -> Self {
        let grid = &model.grid;
        let flows = model.is_coupled();
        let water = flows.then(|| {
            // The functions of degree q - 1 use the numbers of the nodes.
            let stencil = Stencil::lowered(grid);
            Box::new(KspSolver::of(
                petsc,
                choice.clone(),
                stencil,
                grid,
                Rc::clone(halo),
                Rc::clone(timers),
            ))
        });
        Self {
            water,
            ..Self::new(petsc, choice.clone(), grid, Rc::clone(halo), Rc::clone(timers))
        }
    }
}

impl<'p, const D: usize, const C: usize> KspSolver<'p, D, C> {
    /// Creates a solver for a window of the grid.
    pub fn new(petsc: &'p Petsc<'p>, choice: Choice, grid: &Grid<D>, halo: Rc<MpiHalo>, timers: Rc<Timers>) -> Self {
        Self::of(petsc, choice, Stencil::new(grid), grid, halo, timers)
    }

    fn of(
        petsc: &'p Petsc<'p>,
        choice: Choice,
        stencil: Stencil<D, C>,
        grid: &Grid<D>,
        halo: Rc<MpiHalo>,
        timers: Rc<Timers>,
    ) -> Self {
        // If every rank factorises the whole matrix, the result must be bitwise identical on any number of ranks.
        // Otherwise sums depend on the partition anyway.
        let whole = choice.redundant && !choice.dissection;
        let stencil = if whole {
            stencil.by_columns(grid, halo.owned())
        } else {
            stencil
        };
        Self {
            petsc,
            choice,
            halo,
            grid: grid.clone(),
            stencil,
            free: Vec::new(),
            numbers: Vec::new(),
            own: 0,
            shell: None,
            is_sized: false,
            definite: None,
            general: None,
            water: None,
            tallies: Tallies::default(),
            timers,
        }
    }

    /// Returns the outcomes of the solves so far.
    pub fn tallies(&self) -> Tallies {
        let water = self.water.as_ref().and_then(|water| water.tallies.definite.clone());
        Tallies {
            water,
            ..self.tallies.clone()
        }
    }

    /// Continues the counts of a former solver of the run.
    pub fn count_on(&mut self, tallies: Tallies) {
        if let Some(water) = &mut self.water {
            water.tallies.definite.clone_from(&tallies.water);
        }
        self.tallies = tallies;
    }

    /// Numbers the free components: those of rank 0 first, by node. All ranks that share a node have the same number
    /// for it. Collective.
    fn number(&mut self) {
        let free = &self.free;
        let owned = self.halo.owned().places::<C>();
        let numbered = numbered::<C>(&self.choice, free);
        self.own = owned.clone().filter(|&component| numbered(component)).count();
        let count = self.own as u64;
        let mut before = 0_u64;
        self.halo
            .world()
            .exclusive_scan_into(&count, &mut before, SystemOperation::sum());
        let mut next = if self.petsc.rank() == 0 { 0 } else { before };
        let mut numbers = vec![0.0; free.len()]; // one more than the number: 0 is none
        for component in owned.filter(|&component| numbered(component)) {
            next += 1;
            numbers[component] = next as f64;
        }
        self.halo.update_ghosts(&mut numbers, C);
        self.numbers = numbers
            .iter()
            .map(|&number| (number > 0.0).then(|| number as usize - 1))
            .collect();
    }

    /// Passes the values to PETSc, and the pattern if the unknowns have changed. Collective.
    fn build(&mut self, symmetry: Symmetry) -> petsc_rs::Result<()> {
        if self.numbers.len() != self.free.len() {
            self.number();
        }
        let halo = Rc::clone(&self.halo);
        self.stencil.complete(|sums| halo.assemble_ghosts(sums));
        let values = self.stencil.entries(&self.numbers, &self.free);
        let place = match symmetry {
            Symmetry::Definite => &mut self.definite,
            Symmetry::General => &mut self.general,
        };
        let system = match place {
            Some(system) => system,
            none => {
                let block = if self.choice.whole_nodes() { C } else { 1 };
                let pattern = (&self.numbers, &self.free[..]);
                let mut matrix = if self.petsc.ranks() == 1 {
                    // All rows are complete and in order: PETSc need not sort them and uses half of the memory.
                    let (starts, columns) = self.stencil.rows_of(self.own, pattern.0, pattern.1);
                    Matrix::from_csr(self.petsc, self.own, block, &starts, &columns, &values)?
                } else {
                    let places = self.stencil.coordinates(pattern.0, pattern.1);
                    Matrix::from_coo(self.petsc, self.own, block, &places.rows, &places.columns)?
                };
                if block > 1 && C == D {
                    matrix.set_rigid_body_modes(&places_of::<D, C>(&self.grid, &self.halo, &self.numbers))?;
                }
                none.insert(System::new(self.petsc, &self.choice, symmetry, matrix)?)
            }
        };
        system.matrix.set_values(&values)?;
        system.ksp.set_operator(&system.matrix)?;
        let tally = match symmetry {
            Symmetry::Definite => &mut self.tallies.definite,
            Symmetry::General => &mut self.tallies.general,
        };
        let outcome = system.ksp.set_up();
        tally
            .get_or_insert_with(|| Tally::of(&system.ksp, None))
            .failure(&outcome);
        outcome
    }

    /// Sets up the preconditioner of the stiffness, which is not assembled. Collective.
    fn set_up_shell(&mut self) -> Result<(), SolveError> {
        let shell = match &mut self.shell {
            Some(shell) => shell,
            none if self.choice.dissection => {
                let system = DissectionSystem::new(self.petsc, &self.choice).map_err(failed)?;
                none.insert(Box::new(system))
            }
            none => {
                let system = CycleSystem::<D, C>::new(self.petsc, &self.choice).map_err(failed)?;
                none.insert(Box::new(system))
            }
        };
        if !self.is_sized {
            let owned = self.halo.owned().places::<C>();
            shell
                .resize(owned.filter(|&component| self.free[component]).collect())
                .map_err(failed)?;
            self.is_sized = true;
        }
        self.with_shell(|shell, matrix, tally| shell.set_up(matrix, tally))
    }

    /// Calls `act` with the system whose matrix is not assembled, its operator, and its tally.
    fn with_shell<T>(
        &mut self,
        act: impl FnOnce(&mut dyn ShellSystem<D, C>, StiffnessOperator<'_, D, C>, &mut Tally) -> Result<T, SolveError>,
    ) -> Result<T, SolveError> {
        let shell = self.shell.as_mut().ok_or_else(missing)?;
        let matrix = StiffnessOperator {
            halo: &self.halo,
            grid: &self.grid,
            stencil: &self.stencil,
            free: &self.free,
            unknowns: &[],
            timers: &self.timers,
        };
        let tally = self.tallies.definite.get_or_insert_with(|| shell.tally());
        act(&mut **shell, matrix, tally)
    }

    /// Solves the assembled system with `by` and returns the nodal solution. Collective.
    fn solve_assembled(
        &mut self,
        by: impl FnOnce(&mut System<'p>, &[f64], &mut Tally) -> Result<(usize, Vec<f64>), SolveError>,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, SolveError> {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("linear solve");
        let unknowns = self.unknowns();
        let own: Vec<f64> = unknowns
            .iter()
            .map(|&at| if self.free[at] { rhs[at] } else { 0.0 })
            .collect();
        let tally = self.tallies.definite.get_or_insert_default();
        let (iterations, mut x) = by(self.definite.as_mut().ok_or_else(missing)?, &own, tally)?;
        if self.choice.is_rough() {
            // At nodes with a fixed component, coarse functions also move this component.
            x.iter_mut()
                .zip(&unknowns)
                .filter(|(_, at)| !self.free[**at])
                .for_each(|(x, _)| *x = 0.0);
        }
        spread::<C>(&self.halo, &unknowns, &x, solution);
        Ok(SolveReport {
            iterations,
            ..SolveReport::default()
        })
    }

    /// Returns the components of this rank's unknowns, in the order of their numbers.
    fn unknowns(&self) -> Vec<usize> {
        self.halo
            .owned()
            .places::<C>()
            .filter(|&component| self.numbers[component].is_some())
            .collect()
    }
}

/// Returns a predicate for the components of a window that have a matrix row: the free ones, or, for multigrid of
/// PETSc, all components of nodes with a free one.
fn numbered<const C: usize>(choice: &Choice, free: &[bool]) -> impl Fn(usize) -> bool {
    let whole = choice.whole_nodes();
    move |component| {
        if whole {
            free[Nodal::<C>::of(Nodal::<C>::node(component))].contains(&true)
        } else {
            free[component]
        }
    }
}

/// Returns the positions of this rank's nodes with rows (m), as Greville abscissae: with these as coefficients, the
/// splines reproduce linear fields exactly.
fn places_of<const D: usize, const C: usize>(grid: &Grid<D>, halo: &MpiHalo, numbers: &Numbering) -> Vec<f64> {
    let with_rows = halo.owned().nodes().filter(|node| numbers[node * C].is_some());
    with_rows
        .flat_map(|node| {
            let node = grid.node_at(node);
            (0..D).map(move |axis| grid.axes()[axis].greville(node[axis]))
        })
        .collect()
}

/// Fills a nodal array with the values of this rank's unknowns, and with zeros elsewhere, and exchanges shared nodes.
/// One exchange with the neighbours.
fn spread<const C: usize>(halo: &MpiHalo, unknowns: &[usize], values: &[f64], nodal: &mut [f64]) {
    nodal.fill(0.0);
    for (&component, value) in unknowns.iter().zip(values) {
        nodal[component] = *value;
    }
    halo.update_ghosts(nodal, C);
}

fn missing() -> SolveError {
    SolveError::Failed("no matrix was assembled".into())
}

impl<const D: usize, const C: usize> MatrixAssembly for KspSolver<'_, D, C> {
    fn reinit(&mut self, free: &[bool]) {
        let mut changed = [f64::from(self.free != free)];
        self.halo.all_reduce_max(&mut changed);
        if changed[0] > 0.0 {
            (self.free, self.numbers) = (free.to_vec(), Numbering::new());
            (self.is_sized, self.definite, self.general) = (false, None, None);
            self.stencil.keep(|node| free[Nodal::<C>::of(node)].contains(&true));
        }
        self.shell.iter_mut().for_each(|shell| shell.outdate());
        self.stencil.clear();
    }

    fn add_block(&mut self, first_node: usize, block: &[f64]) {
        self.stencil.add(first_node, block);
    }

    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]) {
        self.stencil.add_among(nodes, block);
    }

    fn add_diagonal(&mut self, diagonal: &[f64]) {
        for node in self.halo.owned().nodes() {
            for component in 0..C {
                self.stencil
                    .add_diagonal(node, component, diagonal[Nodal::<C>::at(node, component)]);
            }
        }
    }
}

impl<const D: usize, const C: usize> LinearSolver for KspSolver<'_, D, C> {
    fn matrix(&mut self) -> &mut dyn MatrixAssembly {
        self
    }

    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        if symmetry == Symmetry::Definite && self.choice.shell().is_some() {
            return self.set_up_shell();
        }
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("factorisation");
        self.build(symmetry).map_err(failed)
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        if self.choice.shell().is_some() {
            return self.with_shell(|shell, matrix, tally| shell.solve(matrix, rhs, solution, tally));
        }
        match self.choice.is_rough() {
            true => self.solve_assembled(System::approach, rhs, solution),
            false => self.solve_assembled(System::solve, rhs, solution),
        }
    }

    fn is_rough(&self) -> bool {
        self.choice.is_rough()
    }

    fn solve_to(&mut self, relative: f64, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        if self.choice.shell().is_some() {
            return self.with_shell(|shell, matrix, tally| shell.solve_to(relative, matrix, rhs, solution, tally));
        }
        match self.choice.is_rough() {
            true => self.solve_assembled(
                |system, rhs, tally| system.solve_to(relative, rhs, tally),
                rhs,
                solution,
            ),
            false => self.solve(rhs, solution),
        }
    }

    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("linear solve");
        let unknowns = self.unknowns();
        let halo = Rc::clone(&self.halo);
        let own: Vec<f64> = unknowns
            .iter()
            .map(|&at| if self.free[at] { rhs[at] } else { 0.0 })
            .collect();
        let mut nodal = vec![0.0; rhs.len()];
        let mut image = vec![0.0; rhs.len()];
        let free = &self.free;
        let system = self.general.as_mut().ok_or_else(missing)?;
        let tally = self.tallies.general.get_or_insert_default();
        let (krylov, x) = system.solve_with(
            &mut |x, y| {
                spread::<C>(&halo, &unknowns, x, &mut nodal);
                nodal
                    .iter_mut()
                    .zip(free)
                    .for_each(|(value, &free)| *value *= f64::from(u8::from(free)));
                product(&nodal, &mut image);
                for ((y, x), &component) in y.iter_mut().zip(x).zip(&unknowns) {
                    *y = if free[component] { image[component] } else { *x };
                }
            },
            relative,
            &own,
            tally,
        )?;
        spread::<C>(&self.halo, &unknowns, &x, solution);
        Ok(krylov)
    }

    fn second_field(&mut self) -> Option<&mut dyn LinearSolver> {
        self.water.as_deref_mut().map(|water| water as &mut dyn LinearSolver)
    }
}
