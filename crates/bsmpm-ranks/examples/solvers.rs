//! Measures linear solvers on the stiffness of an elastic square (NU: Poisson's ratio, CELLS: cells per side):
//! `mpirun -n 2 solvers direct|mumps|redundant|gamg NU CELLS [PETSc options]`

use bsmpm::grid::{Grid, KnotVector};
use bsmpm::linear::{LinearSolver, Symmetry};
use bsmpm::parallel::Halo;
use bsmpm_ranks::halo::MpiHalo;
use bsmpm_ranks::launch;
use bsmpm_ranks::linear::{Choice, KspSolver};
use bsmpm_ranks::signals::Requests;
use bsmpm_ranks::slab::Slabs;
use bsmpm_ranks::timers::Timers;
use mpi::topology::SimpleCommunicator;
use petsc_rs::Petsc;
use std::process::ExitCode;
use std::rc::Rc;

/// Solves whose mean is reported.
const SOLVES: usize = 50;

/// A panic on one rank ends all of them.
fn end(world: &SimpleCommunicator, reason: &str) -> ! {
    eprintln!("solvers: {reason}");
    launch::abort(world, 1)
}

fn main() -> ExitCode {
    let universe = match launch::start(end) {
        Ok(universe) => universe,
        Err(failure) => panic!("{failure}"),
    };
    let arguments: Vec<String> = std::env::args().collect();
    let [_, method, nu, cells, further @ ..] = &arguments[..] else {
        panic!("solvers METHOD NU CELLS [PETSc options]")
    };
    let nu: f64 = nu.parse().expect("Poisson's ratio");
    let cells: usize = cells.parse().expect("cells along an edge");
    let choice = match method.as_str() {
        "gamg" => choice(method, "cg", "gamg", None),
        "mumps" | "redundant" => choice(method, "preonly", "cholesky", Some("mumps".into())),
        _ => choice(method, "preonly", "cholesky", None),
    };
    let options: Vec<&str> = choice
        .options()
        .into_iter()
        .chain(further.iter().map(String::as_str))
        .collect();
    let petsc = Petsc::initialize(&universe, &options).expect("PETSc starts");
    let slabs = Slabs::cut(&vec![1.0; cells], petsc.ranks()).expect("fewer ranks than columns");
    let axis = || KnotVector::uniform(1.0 / cells as f64, cells, 2).expect("an axis");
    let grid = Grid::new([axis(), axis()])
        .expect("a grid")
        .window(slabs.columns(petsc.rank()));
    let timers = Rc::new(Timers::default());
    let requests = Rc::new(Requests::of_signals().expect("signals"));
    let halo = MpiHalo::new(universe.world(), &slabs, &grid, Rc::clone(&timers), requests);
    let halo = Rc::new(halo);
    let mut solver = KspSolver::<2, 2>::new(&petsc, choice, &grid, Rc::clone(&halo), timers);
    measure(
        &mut solver,
        &grid,
        &*halo,
        nu,
        &format!("{method} {nu} {cells} x{}", petsc.ranks()),
    );
    ExitCode::SUCCESS
}

fn choice(method: &str, ksp: &str, pc: &str, factor: Option<String>) -> Choice {
    let dissection = method == "direct";
    let redundant = method == "redundant";
    Choice {
        dissection,
        ksp: ksp.into(),
        pc: pc.into(),
        factor,
        redundant,
        applications: 0,
    }
}

fn measure(solver: &mut dyn LinearSolver, grid: &Grid<2>, halo: &dyn Halo, nu: f64, name: &str) {
    let free: Vec<bool> = (0..grid.nodes() * 2).map(|c| grid.node_at(c / 2)[c % 2] > 0).collect();
    let blocks: Vec<Vec<f64>> = (0..grid.cells()).map(|cell| stiffness(grid, cell, nu)).collect();
    let mut spent = Vec::new();
    for _ in 0..2 {
        let mut start = 0.0;
        let matrix = solver.matrix();
        matrix.reinit(&free);
        for (cell, block) in blocks.iter().enumerate() {
            matrix.add_block(grid.first_node(&grid.cell_at(cell)), block);
        }
        start += cpu_seconds();
        solver.factorise(Symmetry::Definite).expect("a factorisation");
        spent.push(cpu_seconds() - start);
    }
    let before = grid.layers().start * grid.layer_nodes() * 2;
    let rhs: Vec<f64> = (0..free.len())
        .map(|c| {
            if free[c] {
                ((before + c) as f64 * 0.618).sin() + f64::from(u8::from(c % 2 == 1))
            } else {
                0.0
            }
        })
        .collect();
    let mut x = vec![0.0; free.len()];
    let start = cpu_seconds();
    let first = solver.solve(&rhs, &mut x).expect("a solution");
    spent.push(cpu_seconds() - start);
    let start = cpu_seconds();
    for _ in 0..SOLVES {
        solver.solve(&rhs, &mut x).expect("a solution");
    }
    spent.push((cpu_seconds() - start) / SOLVES as f64);
    let mut unknowns = [halo.owned().places::<2>().filter(|&c| free[c]).count() as f64];
    halo.all_reduce_sum(&mut unknowns);
    halo.all_reduce_max(&mut spent);
    let memory = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = memory
        .lines()
        .find(|line| line.starts_with("VmHWM"))
        .unwrap_or_default();
    if before == 0 {
        let [factor, again, trial, solve] = spent[..] else {
            unreachable!()
        };
        println!(
            "{name}: {} unknowns, first {factor:.4}, again {again:.4}, first solution {trial:.4} s ({} factorisations more, \
             leaves {:.1e}), solve {solve:.4} s, {} iterations {peak}",
            unknowns[0],
            first.factorisations,
            first.residual.unwrap_or(f64::NAN),
            first.iterations
        );
    }
}

/// Elastic stiffness of a full cell, E = 1 Pa, by 3 x 3 Gauss points.
fn stiffness(grid: &Grid<2>, cell: usize, nu: f64) -> Vec<f64> {
    let lame = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let shear = 0.5 / (1.0 + nu);
    let gauss = [
        (-0.6_f64.sqrt(), 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (0.6_f64.sqrt(), 5.0 / 9.0),
    ];
    let at = grid.cell_at(cell);
    let (corner, size) = grid.cell_box(&at);
    let mut block = vec![0.0; 18 * 18];
    for ((x, wx), (y, wy)) in gauss.iter().flat_map(|x| gauss.iter().map(move |y| (x, y))) {
        let place = [
            corner[0] + size[0] * (1.0 + x) / 2.0,
            corner[1] + size[1] * (1.0 + y) / 2.0,
        ];
        let (nx, dx) = grid.axes()[0].basis::<3>(place[0], at[0]);
        let (ny, dy) = grid.axes()[1].basis::<3>(place[1], at[1]);
        let grad = |a: usize| [dx[a / 3] * ny[a % 3], nx[a / 3] * dy[a % 3]];
        let weight = wx * wy * size[0] * size[1] / 4.0;
        for (entry, value) in block.iter_mut().enumerate() {
            let row = entry / 18;
            let column = entry % 18;
            let a = grad(row / 2);
            let b = grad(column / 2);
            let i = row % 2;
            let j = column % 2;
            let inner = if i == j { a[0] * b[0] + a[1] * b[1] } else { 0.0 };
            *value += weight * (lame * a[i] * b[j] + shear * (inner + a[j] * b[i]));
        }
    }
    block
}

/// CPU time of this process, s.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/schedstat").expect("/proc/self/schedstat");
    let nanoseconds: f64 = text
        .split(' ')
        .next()
        .and_then(|number| number.parse().ok())
        .expect("a number");
    nanoseconds * 1e-9
}
