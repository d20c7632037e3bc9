//! Tests that each solver reports the right failure for defective linear systems. If a solver wrongly reports success,
//! the residual must show the failure.

use crate::{LOCAL, entries, expect, poisson, solver, text, wavy};
use petsc_rs::{Error, Ksp, Matrix, Petsc, Tolerances, Vector};

/// How a solve ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// KSPConvergedReason
    Diverged(i32),
    /// so on another rank
    OtherRank,
    /// it is called a success, and the residual is small
    Solved,
    /// it is called a success, and the residual is not
    Untrue,
}
use End::{Diverged, OtherRank, Solved, Untrue};

const SOLVERS: [[&str; 3]; 3] = [
    ["cg", "jacobi", ""],
    ["gmres", "bjacobi", ""],
    ["preonly", "cholesky", "mumps"],
];

/// What is done to the entry of a row and a column.
type Fault = fn(usize, usize, f64) -> f64;

const NAN: Fault = |row, column, value| if (row, column) == (7, 7) { f64::NAN } else { value };
const ZERO: Fault = |row, column, value| if row == 7 || column == 7 { 0.0 } else { value };
const INDEFINITE: Fault = |row, column, value| if row == column && row % 3 == 0 { -value } else { value };
const NONE: Fault = |_, _, value| value;

/// With at most so many iterations, what each of the solvers comes to on one rank. Jacobi takes a zero of the diagonal
/// for a one, and conjugate gradients then converge to what is no solution. On one rank ILU of this matrix is exact.
const TABLE: [(&str, Fault, usize, [End; 3]); 4] = [
    ("not a number", NAN, 1000, [Diverged(-9), Diverged(-9), Untrue]),
    ("zero row", ZERO, 1000, [Untrue, Diverged(-5), Diverged(-11)]),
    ("indefinite", INDEFINITE, 1000, [Diverged(-8), Solved, Solved]),
    ("one iteration", NONE, 1, [Diverged(-3), Solved, Solved]),
];

pub fn classes(petsc: &Petsc) -> Result<(), String> {
    let mut wrong = Vec::new();
    for (what, fault, most, expected) in TABLE {
        for (names, expected) in SOLVERS.into_iter().zip(expected) {
            let mut matrix = poisson(petsc)?;
            let (rows, columns, values) = entries(petsc, 1.0);
            let spoilt: Vec<f64> = (0..values.len())
                .map(|k| fault(rows[k], columns[k], values[k]))
                .collect();
            matrix.set_values(&spoilt).map_err(text)?;
            let mut ksp = solver(petsc, &matrix, names)?;
            let tolerances = Tolerances {
                relative: 1e-10,
                absolute: 0.0,
                max_iterations: most,
            };
            ksp.set_tolerances(tolerances).map_err(text)?;
            let found = end(petsc, &mut ksp, &matrix)?;
            // On several ranks other blocks are factorised, and which class comes first may differ; none is a success
            // that is not.
            let right = petsc.ranks() > 1 && matches!(found, Diverged(_) | OtherRank) || found == expected;
            if !right {
                wrong.push(format!("{what}, {}: {found:?}, not {expected:?}", names[0]));
            }
        }
    }
    expect(wrong.is_empty(), &wrong.join("; "))
}

fn end(petsc: &Petsc, ksp: &mut Ksp, matrix: &Matrix) -> Result<End, String> {
    let b = wavy(petsc)?;
    let mut x = Vector::new(petsc, LOCAL).map_err(text)?;
    let mut r = Vector::new(petsc, LOCAL).map_err(text)?;
    match ksp.solve(&b, &mut x) {
        Err(Error::Diverged { reason, .. }) => return Ok(Diverged(reason)),
        Err(Error::OtherRank) => return Ok(OtherRank),
        other => other.map_err(text)?,
    };
    matrix.residual(&b, &x, &mut r).map_err(text)?;
    let relative = r.norm().map_err(text)? / b.norm().map_err(text)?;
    Ok(if relative < 1e-6 { Solved } else { Untrue })
}
