//! Measures the loops of a step.

use bsmpm::error::StepError;
use bsmpm::grid::{Shape, transfer};
use bsmpm::interactions::StepInput;
use bsmpm::interactions::free_field::FreeField;
use bsmpm::interactions::state::InteractionState;
use bsmpm::kinematics::{Gradient, Kinematics};
use bsmpm::linear::{LinearSolver, MatrixAssembly};
use bsmpm::model::Model;
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::schedule::TimeInterval;
use bsmpm::step::nodes::GridState;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::{InternalForce, Residual};
use bsmpm::step::stiffness;
use bsmpm::step::trial::DeformationIncrement;
use std::hint::black_box;
use std::time::Instant;

/// Shortest time of one call among those that fit into so many seconds, three at least, s.
pub fn shortest(seconds: f64, mut call: impl FnMut()) -> f64 {
    let begin = Instant::now();
    let mut shortest = f64::INFINITY;
    let mut calls = 0;
    while calls < 3 || begin.elapsed().as_secs_f64() < seconds {
        let start = Instant::now();
        call();
        shortest = shortest.min(start.elapsed().as_secs_f64());
        calls += 1;
    }
    shortest
}

/// A state to measure.
pub struct Bench<'a, K, const D: usize> {
    pub model: &'a Model<K, D>,
    pub points: &'a Points<D>,
    pub state: &'a InteractionState<D>,
    pub halo: &'a dyn Halo,
    /// s  time and step
    pub interval: TimeInterval,
    /// s  for each phase
    pub seconds: f64,
}

impl<K: Kinematics<D>, const D: usize> Bench<'_, K, D> {
    /// Prints a row for every phase, under the displacement `guess` (m, nodal) of the last step: what flowed then flows
    /// on.
    pub fn run(&self, guess: &[f64], solver: &mut dyn LinearSolver) -> Result<(), StepError> {
        let Self {
            model,
            points,
            state,
            halo,
            interval,
            ..
        } = *self;
        let shape = Shape::at(&model.grid, points)?;
        let field = FreeField::after(model, points, state, interval, halo)?;
        let input = StepInput {
            columns: &field.actions,
            ..StepInput::over(interval, state)
        };
        let nodes = GridState::from_points_after(model, &shape, points, input, halo)?;
        let problem = Problem {
            model,
            shape: &shape,
            nodes: &nodes,
            points,
            halo,
        };
        let along = |(c, &guess): (usize, &f64)| match nodes.constraints.prescribed[c] {
            Some(prescribed) => prescribed,
            None if nodes.constraints.free[c] => guess,
            None => 0.0,
        };
        let u: Vec<f64> = guess.iter().enumerate().map(along).collect();
        let traffic = Traffic::of(model);
        self.row("(1) shape functions, sorting apart", None, || {
            drop(black_box(Shape::at(&model.grid, points)))
        });
        self.row("(2) points to nodes", None, || {
            drop(black_box(GridState::from_points(
                model, &shape, points, state, interval, halo,
            )))
        });
        if !field.columns.is_empty() {
            self.row("columns of the free field", None, || {
                drop(black_box(FreeField::after(model, points, state, interval, halo)))
            });
        }
        self.row("(4a) gather of grad u", Some(traffic.gradients), || {
            drop(black_box(transfer::gradients::<K, D, _>(
                &shape,
                &points.x,
                &u,
                |_, grad| grad,
            )))
        });
        if model.stabilisation.averages() {
            self.row("(4c-e) average of F-bar", Some(traffic.average), || {
                drop(black_box(nodes.mean_dilation(model, &shape, points, halo, |_| 1.0)));
            });
        }
        let trial = DeformationIncrement::of(model, &shape, &nodes, points, &u, halo);
        self.row(
            "(4f-i), (5a) constitution in lanes, and scatter of the internal force",
            Some(traffic.force),
            || drop(black_box(InternalForce::of(&problem, &trial).f_int)),
        );
        self.row(
            "(4f-i) constitution point by point, with what a step keeps of it",
            None,
            || {
                for p in 0..points.len() {
                    let _ = black_box(trial.respond(model, points, p).map(|response| response.tau()));
                }
            },
        );
        self.row("(5a) scatter of the internal force", Some(0), || {
            drop(black_box(transfer::divergence::<K, D>(&shape, &points.x, |p| {
                K::flux(&points.sigma.at(p), &points.F.at(p))
            })));
        });
        let whole = traffic.gradients + traffic.average + traffic.force;
        self.row("(4), (5) whole residual, with balance and sums", Some(whole), || {
            drop(black_box(Residual::of(&problem, &u)))
        });
        self.row("(6) stiffness of the patches", None, || {
            stiffness::assemble(&problem, Some(&trial), &mut Nowhere);
        });
        self.row("(6) stiffness, assembled and factorised", None, || {
            drop(black_box(stiffness::factorise(&problem, Some(&trial), solver)));
        });
        let f = Residual::of(&problem, &u).balance.f_oob;
        let mut w = u.clone();
        self.row("(7) solution", Some(0), || drop(black_box(solver.solve(&f, &mut w))));
        Ok(())
    }

    /// `traffic`: bytes a point from and to memory, of what is done in every iteration; 0 if not counted.
    fn row(&self, what: &str, traffic: Option<usize>, call: impl FnMut()) {
        let time = shortest(self.seconds, call) / self.points.len() as f64;
        let [bytes, how_often] = match traffic {
            None => [String::new(), "once a step".into()],
            Some(0) => [String::new(), "every iteration".into()],
            Some(bytes) => [format!("{bytes}"), "every iteration".into()],
        };
        println!("| {what} | {:.1} | {bytes} | {how_often} |", time * 1e9);
    }
}

/// Bytes of a point that the passes of an iteration read and write, each array once a pass.
struct Traffic {
    gradients: usize,
    average: usize,
    force: usize,
}

impl Traffic {
    fn of<K: Kinematics<D>, const D: usize>(model: &Model<K, D>) -> Self {
        let number = size_of::<f64>();
        let width = model.grid.order() + 1;
        let functions = 2 * D * width;
        let tensor = D * K::Gradient::SLOPES;
        // Without functions of their own averages read the rows with the derivatives between.
        let averaging = if model.stabilisation.lowers() {
            D * (width - 1)
        } else {
            functions
        };
        let averages = model.stabilisation.averages();
        let mean = usize::from(averages);
        Self {
            gradients: number * (functions + tensor),
            average: if averages {
                number * (tensor + 1 + 2 * averaging + 1)
            } else {
                0
            },
            force: number * (2 * tensor + mean + 1 + functions) + size_of::<u16>(),
        }
    }
}

/// Bytes of a point in memory at rest, and with its shape functions and two trial states.
pub fn bytes<K: Kinematics<D>, const D: usize>(mut points: Points<D>, model: &Model<K, D>) -> String {
    let rest = points.memory();
    let width = model.grid.order() + 1;
    let averaged = model.stabilisation.averages();
    let lowered = model.stabilisation.lowers();
    let flows = model.is_coupled();
    let shape = D * (2 * width + if lowered { width - 1 } else { 0 });
    // Two trial states: that of the iteration, and the next one while it is judged.
    let trial = 2 * (D * K::Gradient::SLOPES + usize::from(averaged) + usize::from(flows));
    format!("{rest}; {}", rest + size_of::<f64>() * (shape + trial))
}

/// A matrix that forgets what it is given.
struct Nowhere;

impl MatrixAssembly for Nowhere {
    fn reinit(&mut self, _free: &[bool]) {}
    fn add_block(&mut self, _first_node: usize, block: &[f64]) {
        black_box(block);
    }
    fn add_block_among(&mut self, _nodes: &[usize], block: &[f64]) {
        black_box(block);
    }
    fn add_diagonal(&mut self, diagonal: &[f64]) {
        black_box(diagonal);
    }
}
