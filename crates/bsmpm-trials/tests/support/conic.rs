//! Solves second-order cone programs for limit analysis, with Clarabel (Goulart and Chen, 2024).

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, SecondOrderConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus};
use std::ops::{Add, AddAssign, Mul, Sub};

/// Of constraints and of the cost, relative.
const TOLERANCE: f64 = 1e-7;

/// Variables with factors, and a constant.
#[derive(Clone, Debug, Default)]
pub struct Sum {
    terms: Vec<(usize, f64)>,
    constant: f64,
}

impl Sum {
    pub fn constant(constant: f64) -> Self {
        Self {
            constant,
            ..Self::default()
        }
    }

    pub fn is_zero(&self) -> bool {
        self.terms.is_empty() && self.constant == 0.0
    }

    pub fn value(&self, variables: &[f64]) -> f64 {
        self.terms.iter().fold(self.constant, |sum, &(variable, factor)| {
            sum + factor * variables[variable]
        })
    }
}

impl Add<&Sum> for &Sum {
    type Output = Sum;

    fn add(self, other: &Sum) -> Sum {
        Sum {
            terms: [&self.terms[..], &other.terms].concat(),
            constant: self.constant + other.constant,
        }
    }
}

impl Sub<&Sum> for &Sum {
    type Output = Sum;

    fn sub(self, other: &Sum) -> Sum {
        self + &(other * -1.0)
    }
}

impl Mul<f64> for &Sum {
    type Output = Sum;

    fn mul(self, factor: f64) -> Sum {
        let terms = self.terms.iter().filter(|_| factor != 0.0);
        let terms = terms.map(|&(variable, value)| (variable, factor * value)).collect();
        Sum {
            terms,
            constant: factor * self.constant,
        }
    }
}

impl AddAssign<Sum> for Sum {
    fn add_assign(&mut self, other: Sum) {
        self.terms.extend(other.terms);
        self.constant += other.constant;
    }
}

impl std::iter::Sum for Sum {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), |mut sum, part| {
            sum += part;
            sum
        })
    }
}

/// The least cost of variables under constraints.
#[derive(Default)]
pub struct Program {
    costs: Vec<f64>,
    zero: Vec<Sum>,
    positive: Vec<Sum>,
    cones: Vec<Vec<Sum>>,
}

impl Program {
    /// A new variable, and what a unit of it costs.
    pub fn variable(&mut self, cost: f64) -> Sum {
        self.costs.push(cost);
        Sum {
            terms: vec![(self.costs.len() - 1, 1.0)],
            constant: 0.0,
        }
    }

    /// What the variables of a sum cost besides.
    pub fn cost(&mut self, sum: &Sum) {
        for &(variable, factor) in &sum.terms {
            self.costs[variable] += factor;
        }
    }

    pub fn zero(&mut self, sum: Sum) {
        if !sum.is_zero() {
            self.zero.push(sum);
        }
    }

    /// No less than zero.
    pub fn positive(&mut self, sum: Sum) {
        self.positive.push(sum);
    }

    /// The first one is no less than the length of the vector of the others.
    pub fn cone(&mut self, sums: Vec<Sum>) {
        self.cones.push(sums);
    }

    /// The least cost, and the variables that have it.
    pub fn minimum(self) -> (f64, Vec<f64>) {
        let mut cones = vec![ZeroConeT(self.zero.len()), NonnegativeConeT(self.positive.len())];
        cones.extend(self.cones.iter().map(|sums| SecondOrderConeT(sums.len())));
        let rows = || {
            self.zero
                .iter()
                .chain(&self.positive)
                .chain(self.cones.iter().flatten())
        };
        let right: Vec<f64> = rows().map(|sum| sum.constant).collect();
        let mut places = [Vec::new(), Vec::new()];
        let mut values = Vec::new();
        for (row, sum) in rows().enumerate() {
            for &(variable, factor) in &sum.terms {
                places[0].push(row);
                places[1].push(variable);
                values.push(-factor);
            }
        }
        let [at, column] = places;
        let columns = self.costs.len();
        let matrix = CscMatrix::new_from_triplets(right.len(), columns, at, column, values);
        let none = CscMatrix::zeros((columns, columns));
        let solver = DefaultSolver::new(&none, &self.costs, &matrix, &right, &cones, settings());
        let mut solver = solver.expect("a program that is sound");
        solver.solve();
        assert_eq!(solver.solution.status, SolverStatus::Solved);
        (solver.solution.obj_val, solver.solution.x)
    }
}

fn settings() -> DefaultSettings<f64> {
    let mut settings = DefaultSettingsBuilder::default();
    // tractions that agree around a node say a thing twice: with the default shift, 1e-8, such programs are not solved
    settings.static_regularization_constant(1e-7);
    settings
        .tol_feas(TOLERANCE)
        .tol_gap_abs(TOLERANCE)
        .tol_gap_rel(TOLERANCE)
        .verbose(false);
    settings.build().expect("settings that are sound")
}
