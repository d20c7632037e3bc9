//! Changes the active domain of a run and its partition among the ranks.

use super::{LOOK, Simulation};
use crate::halo::MpiHalo;
use crate::linear::KspSolver;
use crate::load;
use crate::migrate::{self, GridPartition};
use crate::slab::Slabs;
use bsmpm::grid::Grid;
use bsmpm::kinematics::Kinematics;
use bsmpm::parallel::Halo;
use std::ops::Range;
use std::rc::Rc;

impl<K: Kinematics<D>, const D: usize> Simulation<'_, K, D> {
    /// Returns the range of columns of the whole grid whose points belong to this rank's slab.
    pub(super) fn columns(&self) -> Range<usize> {
        let slab = self.slabs.place(self.libraries.petsc.rank()).0;
        let own = self.slabs.columns(self.libraries.petsc.rank());
        let end = if slab + 1 == self.slabs.slabs() {
            self.model.grid.axes()[0].cells()
        } else {
            own.end
        };
        if slab == 0 { 0..end } else { own.start..end }
    }

    /// Partitions the grid again if this pays until the next check. Each of the steps until then is assumed to take
    /// `evaluations` evaluations. The rule uses counts only, so runs are repeatable. Returns whether the partition
    /// changed. Collective.
    pub(super) fn balance(&mut self, evaluations: u64) -> bool {
        let grid = &self.model.grid;
        let mut counts = load::points_by_column(grid, &self.points);
        self.halo.all_reduce_sum(&mut counts);
        let Some(better) = load::cut(grid, &counts, self.slabs.slabs()) else {
            return false;
        };
        let (better, loads) = if self.slabs.parts().is_empty() {
            let loads = [&self.slabs, &better]
                .map(|slabs| largest(load::of_slabs(&counts, slabs, grid.layer_nodes(), grid.order())));
            (better, loads)
        } else {
            let Some((better, counts)) = self.parted(grid, better) else {
                return false;
            };
            let mut now = [load::of_rank(self.points.len(), grid.nodes())];
            self.halo.all_reduce_max(&mut now);
            let loads = [now[0], largest(load::of_parts(&counts, &better, grid))];
            (better, loads)
        };
        if !load::pays(loads[0], loads[1], LOOK * evaluations) {
            return false;
        }
        self.recut(self.model.grid.clone(), better);
        true
    }

    /// Divides each slab into as many parts as the present slabs have, by the number of points. Returns the slabs with
    /// their parts and the points of all ranks by row. One reduction.
    fn parted(&self, grid: &Grid<D>, slabs: Slabs) -> Option<(Slabs, Vec<f64>)> {
        let mut counts = load::points_by_row(grid, &slabs, &self.points);
        self.halo.all_reduce_sum(&mut counts);
        let parted = load::parted(grid, slabs, &counts, self.slabs.parts_of_slab())?;
        Some((parted, counts))
    }

    /// Extends the active domain to the points of all ranks, and partitions it. Collective.
    pub(super) fn make_room(&mut self) {
        let occupied = self.model.grid.occupied(&self.points.x);
        let ends = occupied.map(|ranges| ranges.map(|range| [-(range.start as f64), range.end as f64]));
        let mut ends = ends.unwrap_or([[f64::NEG_INFINITY; 2]; D]);
        self.halo.all_reduce_max(ends.as_flattened_mut());
        let occupied = ends.map(|[start, end]| -start as usize..end as usize);
        let grid = self
            .model
            .grid
            .with_room(&occupied, [self.slabs.slabs(), self.slabs.parts_of_slab()]);
        let mut counts = load::points_by_column(&grid, &self.points);
        self.halo.all_reduce_sum(&mut counts);
        let slabs = load::cut(&grid, &counts, self.slabs.slabs());
        let slabs = match slabs {
            Some(slabs) if !self.slabs.parts().is_empty() => self.parted(&grid, slabs).map(|(parted, _)| parted),
            slabs => slabs,
        };
        if let Some(slabs) = slabs {
            self.recut(grid, slabs);
        }
    }

    /// Changes to another active domain and partition. Collective.
    fn recut(&mut self, grid: Grid<D>, slabs: Slabs) {
        let timers = Rc::clone(&self.timers);
        let world = self.libraries.universe.world();
        let (from, guess) = migrate::across(&self.model.grid, &grid, &self.stepper.guess, D);
        self.model.grid = grid.window_of(slabs.cells(self.libraries.petsc.rank(), grid.room()));
        let old = GridPartition {
            slabs: &self.slabs,
            window: &from,
        };
        let new = GridPartition {
            slabs: &slabs,
            window: &self.model.grid,
        };
        self.stepper.guess = migrate::nodal(&world, timers.traffic(), old, new, &guess, D);
        migrate::points(&world, timers.traffic(), &slabs, &self.model.grid, &mut self.points);
        self.slabs = slabs;
        let requests = Rc::clone(self.halo.requests());
        let halo = MpiHalo::new(world, &self.slabs, &self.model.grid, Rc::clone(&timers), requests);
        self.halo = Rc::new(halo);
        let halo = Rc::clone(&self.halo);
        let tallies = self.solver.tallies();
        self.solver = KspSolver::of_model(self.libraries.petsc, &self.choice, &self.model, &halo, &timers);
        self.solver.count_on(tallies);
    }
}

fn largest(loads: Vec<f64>) -> f64 {
    loads.into_iter().fold(0.0, f64::max)
}
