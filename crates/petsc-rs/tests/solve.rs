//! Tests of this crate, as one MPI program for any number of ranks. Every rank executes all tests. `cargo test -p
//! petsc-rs` uses one rank; for more, start the built program with `mpirun -n N`.

mod support;

use mpi::environment::Universe;
use petsc_rs::{Error, Ksp, Matrix, NormType, Petsc, Symmetry, Tolerances, Vector};
use support::classes::classes;
use support::shell::{panics, shell_failures, shell_pc};
use support::{Captured, enter_directory_with_petscrc, prepare_environment};

/// Rows on each rank.
const LOCAL: usize = 40;

type Check = (&'static str, fn(&Petsc) -> Result<(), String>);

const CHECKS: &[Check] = &[
    ("options come from the caller only", options),
    ("vectors: slices, inserts, norms", vectors),
    ("COO and CSR give the same matrix", coo_equals_csr),
    ("MUMPS Cholesky, new values, kept factor", direct),
    ("conjugate gradients", iterative),
    ("PETSc's own Cholesky", serial_cholesky),
    ("a singular matrix is an error, and leaves no trace", singular),
    ("NaN on the right-hand side", not_a_number),
    ("every kind of failure has its class", classes),
    ("refused arguments are errors on every rank", refused),
    ("PETSc's errors are values and print nothing", silent),
    ("rigid body modes", rigid_body_modes),
    ("an operator known by its product", product),
    ("a preconditioner of the caller's own", shell_pc),
    ("its failures are KSP's", shell_failures),
    ("its panics go on behind PETSc", panics),
];

fn main() {
    prepare_environment();
    let universe = mpi::initialize().expect("MPI starts once");
    let mut failures = vec![];
    let mut report = |name: &str, outcome: Result<(), String>| {
        failures.extend(outcome.err().map(|why| format!("FAILED {name}: {why}")));
    };
    report("start, end and start again", restart(&universe));
    enter_directory_with_petscrc();
    let captured = Captured::begin();
    let petsc = Petsc::initialize(&universe, &["-petsc_rs_misspelt", "1"]).expect("PETSc starts");
    for (name, check) in CHECKS {
        report(name, check(&petsc));
    }
    drop(petsc);
    let printed = captured.end();
    let quiet = expect(printed.is_empty(), &format!("printed: {printed}"));
    report("nothing is printed from start to end", quiet);
    let all = CHECKS.len() + 2;
    let failed = failures.len();
    failures.iter().for_each(|line| println!("{line}"));
    println!("{} passed, {failed} failed", all - failed);
    if failed > 0 {
        // Without MPI_Finalize, which could wait for ranks that stopped elsewhere.
        std::process::exit(1);
    }
}

fn expect(holds: bool, why: &str) -> Result<(), String> {
    if holds { Ok(()) } else { Err(why.to_owned()) }
}

fn text(error: Error) -> String {
    error.to_string()
}

/// 1-D Poisson matrix, `scale` (-1, 2, -1), as entries of this rank's rows: (rows, columns, values).
fn entries(petsc: &Petsc, scale: f64) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let from = petsc.rank() * LOCAL;
    let n = petsc.ranks() * LOCAL;
    let mut rows = vec![];
    let mut columns = vec![];
    let mut values = vec![];
    for row in from..from + LOCAL {
        for column in row.saturating_sub(1)..(row + 2).min(n) {
            rows.push(row);
            columns.push(column);
            values.push(if row == column { 2.0 * scale } else { -scale });
        }
    }
    (rows, columns, values)
}

fn poisson<'p>(petsc: &'p Petsc) -> Result<Matrix<'p>, String> {
    let (rows, columns, values) = entries(petsc, 1.0);
    let mut matrix = Matrix::from_coo(petsc, LOCAL, 1, &rows, &columns).map_err(text)?;
    matrix.set_values(&values).map_err(text)?;
    matrix.set_symmetry(Symmetry::PositiveDefinite).map_err(text)?;
    Ok(matrix)
}

fn wavy<'p>(petsc: &'p Petsc) -> Result<Vector<'p>, String> {
    let mut vector = Vector::new(petsc, LOCAL).map_err(text)?;
    let range = vector.owned_range();
    let values: Vec<f64> = range.map(|i| (i as f64 * 0.7).sin() + 1.0).collect();
    vector.copy_from(&values).map_err(text)?;
    Ok(vector)
}

fn solver<'p>(petsc: &'p Petsc, matrix: &Matrix<'p>, names: [&str; 3]) -> Result<Ksp<'p>, String> {
    let [method, preconditioner, package] = names;
    let set = || {
        let mut ksp = Ksp::new(petsc)?;
        ksp.set_operator(matrix)?;
        ksp.set_type(method)?;
        ksp.set_pc_type(preconditioner)?;
        if !package.is_empty() {
            ksp.set_factor_solver(package)?;
        }
        ksp.set_from_options()?;
        Ok(ksp)
    };
    set().map_err(text)
}

/// Solves and demands a relative residual below 1e-10; returns the iterations.
fn solve_well(petsc: &Petsc, ksp: &mut Ksp, matrix: &Matrix) -> Result<usize, String> {
    let b = wavy(petsc)?;
    let mut x = Vector::new(petsc, LOCAL).map_err(text)?;
    let mut r = Vector::new(petsc, LOCAL).map_err(text)?;
    let info = ksp.solve(&b, &mut x).map_err(text)?;
    matrix.residual(&b, &x, &mut r).map_err(text)?;
    let relative = r.norm().map_err(text)? / b.norm().map_err(text)?;
    expect(relative < 1e-10, &format!("relative residual {relative:e}"))?;
    Ok(info.iterations)
}

fn restart(universe: &Universe) -> Result<(), String> {
    let (major, minor, _) = petsc_rs::version();
    expect((major, minor) >= (3, 18), "version")?;
    expect([32, 64].contains(&petsc_rs::petsc_int_bits()), "bits")?;
    let petsc = Petsc::initialize(universe, &[]).map_err(text)?;
    let second = Petsc::initialize(universe, &[]).err();
    expect(matches!(second, Some(Error::Unsupported(_))), "second start")?;
    drop(petsc);
    drop(Petsc::initialize(universe, &[]).map_err(text)?);
    Ok(())
}

fn options(petsc: &Petsc) -> Result<(), String> {
    let unused = petsc.unused_options().map_err(text)?;
    expect(unused == ["petsc_rs_misspelt"], &format!("{unused:?}"))?;
    petsc.set_option("-late_one", None).map_err(text)?;
    let unused = petsc.unused_options().map_err(text)?;
    expect(unused.contains(&"late_one".into()), &format!("{unused:?}"))
}

fn vectors(petsc: &Petsc) -> Result<(), String> {
    let mut v = Vector::new(petsc, LOCAL).map_err(text)?;
    let n = petsc.ranks() * LOCAL;
    expect(v.global_len() == n && v.local_len() == LOCAL, "lengths")?;
    expect(v.owned_range().start == petsc.rank() * LOCAL, "range")?;
    v.insert(&[0, n - 1], &[3.0, 4.0]).map_err(text)?;
    expect(v.norm().map_err(text)? == 5.0, "norm")?;
    expect(v.norm_max().map_err(text)? == 4.0, "largest magnitude")?;
    let mut w = Vector::new(petsc, LOCAL).map_err(text)?;
    w.fill(2.0).map_err(text)?;
    w.add_scaled(-1.0, &v).map_err(text)?;
    let product = w.dot(&v).map_err(text)?;
    expect(product == -11.0, &format!("product {product}"))?;
    let mut short = [0.0; LOCAL - 1];
    let length = w.copy_to(&mut short).err();
    expect(matches!(length, Some(Error::Length { .. })), "short slice")
}

fn coo_equals_csr(petsc: &Petsc) -> Result<(), String> {
    let (rows, columns, values) = entries(petsc, 1.0);
    let first = petsc.rank() * LOCAL;
    let starts: Vec<usize> = (first..=first + LOCAL)
        .map(|row| rows.partition_point(|&r| r < row))
        .collect();
    let mut csr = Matrix::from_csr(petsc, LOCAL, 1, &starts, &columns, &values).map_err(text)?;
    let coo = poisson(petsc)?;
    let x = wavy(petsc)?;
    let mut y = wavy(petsc)?;
    let mut z = wavy(petsc)?;
    coo.mult(&x, &mut y).map_err(text)?;
    expect(coo.entries() == csr.entries(), "entries")?;
    for factor in [1.0, 4.0] {
        if factor != 1.0 {
            csr.set_values(&entries(petsc, factor).2).map_err(text)?;
        }
        csr.mult(&x, &mut z).map_err(text)?;
        z.add_scaled(-factor, &y).map_err(text)?;
        expect(z.norm().map_err(text)? == 0.0, "products differ")?;
    }
    // Element by element: entries repeat, and the last of a rank lies in the next rank's row too.
    let n = petsc.ranks() * LOCAL;
    let mut rows = vec![];
    let mut columns = vec![];
    let mut values = vec![];
    for element in first..first + LOCAL {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            rows.push((element + i) % n);
            columns.push((element + j) % n);
            values.push(if i == j { 1.0 } else { -1.0 });
        }
    }
    let mut ring = Matrix::from_coo(petsc, LOCAL, 1, &rows, &columns).map_err(text)?;
    ring.set_values(&values).map_err(text)?;
    ring.mult(&x, &mut z).map_err(text)?;
    z.add_scaled(-1.0, &y).map_err(text)?;
    // The ring couples first and last entry, which the line does not: z differs in these two only.
    let inside = |z: &[f64], from: usize| {
        let ends = |i: &usize| ![0, n - 1].contains(&(from + i));
        (0..z.len()).filter(ends).map(|i| z[i].abs()).fold(0.0, f64::max)
    };
    let most = z.read(|z| inside(z, first)).map_err(text)?;
    expect(most < 1e-14, &format!("element sums differ by {most:e}"))
}

fn direct(petsc: &Petsc) -> Result<(), String> {
    let mut matrix = poisson(petsc)?;
    let mut ksp = solver(petsc, &matrix, ["preonly", "cholesky", "mumps"])?;
    solve_well(petsc, &mut ksp, &matrix)?;
    matrix.set_values(&entries(petsc, 3.0).2).map_err(text)?;
    solve_well(petsc, &mut ksp, &matrix)?;
    ksp.set_reuse_preconditioner(true).map_err(text)?;
    matrix.set_values(&entries(petsc, 6.0).2).map_err(text)?;
    let stale = solve_well(petsc, &mut ksp, &matrix);
    expect(stale.is_err(), "the old factor was not kept")
}

fn iterative(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let mut ksp = solver(petsc, &matrix, ["cg", "bjacobi", ""])?;
    let mut tolerances = Tolerances {
        relative: 1e-11,
        absolute: 0.0,
        max_iterations: 1000,
    };
    ksp.set_tolerances(tolerances).map_err(text)?;
    ksp.set_norm(NormType::Unpreconditioned).map_err(text)?;
    solve_well(petsc, &mut ksp, &matrix)?;
    ksp.set_pc_type("none").map_err(text)?;
    tolerances.max_iterations = 2;
    ksp.set_tolerances(tolerances).map_err(text)?;
    let b = wavy(petsc)?;
    let mut x = wavy(petsc)?;
    match ksp.solve(&b, &mut x) {
        Err(Error::Diverged {
            reason: -3,
            iterations: 2,
            name,
        }) => expect(name == "DIVERGED_ITS", &name),
        other => Err(format!("too few iterations: {other:?}")),
    }
}

/// A = P + a term that couples every row with the first one of its rank, which P does not hold.
fn product(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let times = |x: &[f64], y: &mut [f64]| {
        let mut from = Vector::new(petsc, LOCAL).unwrap();
        let mut to = Vector::new(petsc, LOCAL).unwrap();
        from.copy_from(x).unwrap();
        matrix.mult(&from, &mut to).unwrap();
        to.copy_to(y).unwrap();
        y.iter_mut().for_each(|y| *y += 0.1 * x[0]);
    };
    let wanted: Vec<f64> = (0..LOCAL).map(|i| 1.0 + (i as f64).sin()).collect();
    let mut right = vec![0.0; LOCAL];
    times(&wanted, &mut right);
    let mut b = Vector::new(petsc, LOCAL).map_err(text)?;
    let mut x = Vector::new(petsc, LOCAL).map_err(text)?;
    b.copy_from(&right).map_err(text)?;
    let mut ksp = Ksp::new(petsc).map_err(text)?;
    ksp.set_operator(&matrix).map_err(text)?;
    ksp.set_type("fgmres").map_err(text)?;
    ksp.set_pc_type("redundant").map_err(text)?;
    let tight = Tolerances {
        relative: 1e-12,
        absolute: 0.0,
        max_iterations: 100,
    };
    ksp.set_tolerances(tight).map_err(text)?;
    let error = |x: &Vector| x.read(|x| x.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
    for _ in 0..2 {
        let info = ksp.solve_with(&mut { times }, &b, &mut x).map_err(text)?;
        expect(
            info.reason > 0 && info.iterations <= petsc.ranks() + 2,
            &format!("{info:?}"),
        )?;
        let worst = error(&x).map_err(text)?;
        expect(worst < 1e-8, &format!("off by {worst:e}"))?;
    }
    ksp.set_tolerances(Tolerances {
        max_iterations: 1,
        ..tight
    })
    .map_err(text)?;
    let info = ksp.solve_with(&mut { times }, &b, &mut x).map_err(text)?;
    expect(
        info.reason < 0 && info.iterations == 1,
        &format!("stopped early: {info:?}"),
    )
}

fn serial_cholesky(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let mut ksp = solver(petsc, &matrix, ["preonly", "cholesky", "petsc"])?;
    match petsc.ranks() {
        1 => solve_well(petsc, &mut ksp, &matrix).map(|_| ()),
        _ => expect(ksp.set_up().is_err(), "a serial package took the matrix"),
    }
}

fn singular(petsc: &Petsc) -> Result<(), String> {
    let mut matrix = poisson(petsc)?;
    let (rows, columns, mut values) = entries(petsc, 1.0);
    for k in 0..values.len() {
        if rows[k] == 7 || columns[k] == 7 {
            values[k] = 0.0;
        }
    }
    let mut packages = vec!["mumps"];
    if petsc.ranks() == 1 {
        packages.push("petsc");
    }
    for package in packages {
        let mut ksp = solver(petsc, &matrix, ["preonly", "cholesky", package])?;
        ksp.set_up().map_err(text)?;
        matrix.set_values(&values).map_err(text)?;
        let b = wavy(petsc)?;
        let mut x = wavy(petsc)?;
        let failures = [ksp.set_up().err(), ksp.solve(&b, &mut x).err()];
        for failure in failures {
            let right = matches!(failure, Some(Error::Diverged { reason: -11, .. }));
            expect(right, &format!("{package}: {failure:?}"))?;
        }
        matrix.set_values(&entries(petsc, 1.0).2).map_err(text)?;
        solve_well(petsc, &mut ksp, &matrix)?;
    }
    Ok(())
}

/// A factorisation calls it a success and gives NaN; an iteration says -9.
fn not_a_number(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let mut b = wavy(petsc)?;
    let mut x = wavy(petsc)?;
    b.insert(&[3], &[f64::NAN]).map_err(text)?;
    let mut ksp = solver(petsc, &matrix, ["preonly", "cholesky", "mumps"])?;
    let verdict = ksp.solve(&b, &mut x);
    let finite = x.norm().map_err(text)?.is_finite();
    expect(verdict.is_err() || !finite, &format!("direct: {verdict:?}"))?;
    let mut ksp = solver(petsc, &matrix, ["cg", "jacobi", ""])?;
    match ksp.solve(&b, &mut x) {
        Err(Error::Diverged { reason: -9, .. }) => Ok(()),
        other => Err(format!("iterative: {other:?}")),
    }
}

/// Rank 0 is refused for the reason, the others learn of it instead of waiting.
fn refused(petsc: &Petsc) -> Result<(), String> {
    let n = petsc.ranks() * LOCAL;
    let first = petsc.rank() == 0;
    let bad = if first { n } else { 0 };
    let coo = Matrix::from_coo(petsc, LOCAL, 1, &[0], &[bad]).err();
    let right = match &coo {
        Some(Error::OutOfRange { index, bound, .. }) => first && (*index, *bound) == (n, n),
        other => !first && *other == Some(Error::OtherRank),
    };
    expect(right, &format!("index out of range: {coo:?}"))?;

    let mut matrix = poisson(petsc)?;
    let expected = matrix.entries();
    let length = matrix.set_values(&vec![1.0; expected - usize::from(first)]);
    expect(length.is_err(), "too few values")?;
    let mut b = Vector::new(petsc, LOCAL - usize::from(first)).map_err(text)?;
    expect(b.insert(&[n], &[1.0]).is_err(), "insert out of range")?;
    let mut x = wavy(petsc)?;
    let mut ksp = Ksp::new(petsc).map_err(text)?;
    expect(ksp.solve(&b, &mut x).is_err(), "no operator")?;
    ksp.set_operator(&matrix).map_err(text)?;
    expect(ksp.solve(&b, &mut x).is_err(), "short right-hand side")?;
    expect(matrix.mult(&x, &mut b).is_err(), "short product")?;
    let odd = Matrix::from_coo(petsc, LOCAL, 3, &[], &[]).err();
    expect(matches!(odd, Some(Error::Length { .. })), "broken block")?;
    for (starts, columns) in [
        ([0, 2, 2], vec![1, 0]),
        ([0, 3, 2], vec![0, 1]),
        ([1, 2, 2], vec![0, 1]),
        ([0, 1, 9], vec![0, 1]),
    ] {
        let values = vec![1.0; columns.len()];
        let csr = Matrix::from_csr(petsc, 2, 1, &starts, &columns, &values);
        expect(csr.is_err(), &format!("CSR {starts:?} {columns:?}"))?;
    }
    let huge = Vector::new(petsc, usize::MAX / 64).err();
    let refused = matches!(huge, Some(Error::TooLarge { .. }));
    expect(refused || petsc_rs::petsc_int_bits() == 64, "2^58 entries")
}

fn silent(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let mut ksp = Ksp::new(petsc).map_err(text)?;
    match ksp.set_type("no_such_method") {
        Err(Error::Petsc { message, trace, .. }) => {
            expect(message.contains("no_such_method"), &message)?;
            expect(trace[0].contains("KSPSetType"), &trace[0])?;
        }
        other => return Err(format!("{other:?}")),
    }
    let mut ksp = solver(petsc, &matrix, ["preonly", "cholesky", "no_such_package"])?;
    expect(ksp.set_up().is_err(), "a package that is not there")?;
    let mut ksp = solver(petsc, &matrix, ["cg", "jacobi", ""])?;
    let package = ksp.set_factor_solver("mumps").err();
    expect(matches!(package, Some(Error::Unsupported(_))), "jacobi factor")?;
    let nul = ksp.set_options_prefix("a\0b").err();
    expect(nul == Some(Error::Nul("a\0b".into())), "NUL byte")?;
    let petsc_says = ksp.set_tolerances(Tolerances {
        relative: 2.0,
        absolute: 0.0,
        max_iterations: 1,
    });
    expect(petsc_says.is_err(), "relative tolerance of 2")
}

fn rigid_body_modes(petsc: &Petsc) -> Result<(), String> {
    let (rows, columns, values) = entries(petsc, 1.0);
    let mut matrix = Matrix::from_coo(petsc, LOCAL, 2, &rows, &columns).map_err(text)?;
    matrix.set_values(&values).map_err(text)?;
    let from = petsc.rank() * LOCAL;
    let coordinates: Vec<f64> = (from..from + LOCAL).map(|i| (i * i) as f64).collect();
    matrix.set_rigid_body_modes(&coordinates).map_err(text)?;
    let short = matrix.set_rigid_body_modes(&coordinates[1..]);
    expect(short.is_err(), "too few coordinates")
}
