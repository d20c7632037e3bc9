//! One rank without MPI and PETSc, for the program's `setup`.

/// The choice of the linear solver, by PETSc's names.
pub mod ksp {
    /// See `bsmpm_par::ksp::Choice`.
    #[derive(Clone, Debug)]
    #[allow(dead_code)] // there is one solver here
    pub struct Choice {
        pub ksp: String,
        pub pc: String,
        pub factor: Option<String>,
        pub redundant: bool,
    }
}

/// A scene on its one rank.
pub mod simulation {
    use crate::solver::Skyline;
    use bsmpm::error::{SolveError, StepError};
    use bsmpm::initial::{self, Equilibrium};
    use bsmpm::kinematics::Kinematics;
    use bsmpm::model::Model;
    use bsmpm::points::Points;
    use bsmpm::seam::{Alone, Krylov, LinearSolver, Symmetry};
    use bsmpm::step::{Counts, Report, step};
    use bsmpm::tensor::{Symmetric, Vector};
    use std::marker::PhantomData;

    /// See `bsmpm_par::simulation::StartStress`.
    pub enum StartStress<'a, const D: usize> {
        /// Pa  by material and position
        Given(&'a dyn Fn(u16, &Vector<D>) -> Symmetric),
        /// linear elastic equilibrium
        Elastic,
    }

    /// See `bsmpm_par::simulation::Simulation`.
    pub struct Simulation<'p, K, const D: usize> {
        /// the scene
        pub model: Model<K, D>,
        /// all points
        pub points: Points<D>,
        /// m  nodal displacement that the next step starts from
        pub guess: Vec<f64>,
        halo: Alone,
        solver: Trusted,
        program: PhantomData<&'p ()>,
    }

    impl<K: Kinematics<D>, const D: usize> Simulation<'_, K, D> {
        /// A run at time 0.
        pub fn new(model: Model<K, D>, mut points: Points<D>) -> Self {
            points.sort_by_cell(&model.grid);
            points.surface = model.boundary.surface();
            let (nodes, solver) = (model.grid.nodes(), Trusted(Skyline::new(&model.grid)));
            Self { model, points, guess: vec![0.0; nodes * D], halo: Alone { nodes }, solver, program: PhantomData }
        }

        /// See `bsmpm_par::simulation::Simulation::stress`.
        pub fn stress(&mut self, start: StartStress<'_, D>) -> Result<Equilibrium, StepError> {
            match start {
                StartStress::Given(sigma) => initial::set_stress(&self.model, &mut self.points, sigma),
                StartStress::Elastic => {
                    initial::set_elastic(&self.model, &mut self.points, (&self.halo, &mut self.solver))?
                }
            }
            initial::balance(&self.model, &self.points, &self.halo)
        }

        /// One attempt at one step from `t` on.
        pub fn step(&mut self, t: f64, dt: f64) -> Result<Report, StepError> {
            let mut counts = Counts::default();
            step(&self.model, &mut self.points, &mut self.guess, (t, dt), (&self.halo, &mut self.solver), &mut counts)
        }
    }

    /// The direct solver with what the seam demands of it: solutions are finite.
    struct Trusted(Skyline);

    impl LinearSolver for Trusted {
        fn begin(&mut self, free: &[bool]) {
            self.0.begin(free);
        }
        fn add(&mut self, first_node: usize, block: &[f64]) {
            self.0.add(first_node, block);
        }
        fn add_among(&mut self, nodes: &[usize], block: &[f64]) {
            self.0.add_among(nodes, block);
        }
        fn add_diagonal(&mut self, diagonal: &[f64]) {
            self.0.add_diagonal(diagonal);
        }
        fn finish(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
            self.0.finish(symmetry)
        }
        fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<usize, SolveError> {
            let iterations = self.0.solve(rhs, solution)?;
            finite(solution).map(|()| iterations)
        }
        fn solve_with(
            &mut self,
            product: &mut dyn FnMut(&[f64], &mut [f64]),
            relative: f64,
            rhs: &[f64],
            solution: &mut [f64],
        ) -> Result<Krylov, SolveError> {
            let krylov = self.0.solve_with(product, relative, rhs, solution)?;
            finite(solution).map(|()| krylov)
        }
    }

    fn finite(solution: &[f64]) -> Result<(), SolveError> {
        if solution.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(SolveError::NotFinite) }
    }
}
