//! Tests of user-defined preconditioners of PETSc's KSP: calls, failures and panics.

use crate::{LOCAL, expect, poisson, text, wavy};
use petsc_rs::{Error, Ksp, Matrix, PcFailure, Petsc, ShellPc, SolveInfo, Tolerances, Vector};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Solves exactly with the Poisson matrix by MUMPS; fails when it is asked to.
struct Inner<'p> {
    ksp: Ksp<'p>,
    b: Vector<'p>,
    x: Vector<'p>,
    calls: [usize; 2], // of set_up and of apply
    failures: [Option<PcFailure>; 2],
    panics: [bool; 2],
}

impl<'p> Inner<'p> {
    fn new(petsc: &'p Petsc, matrix: &Matrix<'p>) -> Result<Self, String> {
        let ksp = crate::solver(petsc, matrix, ["preonly", "cholesky", "mumps"])?;
        let b = wavy(petsc)?;
        let x = wavy(petsc)?;
        Ok(Self {
            ksp,
            b,
            x,
            calls: [0; 2],
            failures: [None; 2],
            panics: [false; 2],
        })
    }

    fn called(&mut self, which: usize) -> Result<(), PcFailure> {
        self.calls[which] += 1;
        assert!(!self.panics[which], "wanted");
        self.failures[which].map_or(Ok(()), Err)
    }
}

impl ShellPc for Inner<'_> {
    fn set_up(&mut self) -> Result<(), PcFailure> {
        self.called(0)
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), PcFailure> {
        self.called(1)?;
        self.b.copy_from(r).unwrap();
        self.ksp.solve(&self.b, &mut self.x).unwrap();
        self.x.copy_to(z).unwrap();
        Ok(())
    }
}

/// A solver with a shell operator and preconditioner.
fn outer<'p>(petsc: &'p Petsc, method: &str) -> Result<Ksp<'p>, String> {
    let set = || {
        let mut ksp = Ksp::new(petsc)?;
        ksp.set_type(method)?;
        ksp.set_pc_shell("inner")?;
        ksp.set_from_options()?;
        ksp.set_shell_operator(LOCAL)?;
        ksp.set_tolerances(Tolerances {
            relative: 1e-11,
            absolute: 0.0,
            max_iterations: 50,
        })?;
        Ok(ksp)
    };
    set().map_err(text)
}

/// y = A x, counted.
fn times<'a>(petsc: &'a Petsc, matrix: &'a Matrix<'_>, count: &'a mut usize) -> impl FnMut(&[f64], &mut [f64]) {
    move |x, y| {
        *count += 1;
        let mut from = Vector::new(petsc, LOCAL).unwrap();
        let mut to = Vector::new(petsc, LOCAL).unwrap();
        from.copy_from(x).unwrap();
        matrix.mult(&from, &mut to).unwrap();
        to.copy_to(y).unwrap();
    }
}

fn solve(
    ksp: &mut Ksp,
    product: &mut petsc_rs::Product<'_>,
    pc: &mut dyn ShellPc,
    b: &Vector,
    x: &mut Vector,
) -> petsc_rs::Result<SolveInfo> {
    let mut right = vec![0.0; LOCAL];
    b.copy_to(&mut right)?;
    let info = ksp.solve_with_pc(product, pc, |b| b.copy_from_slice(&right))?;
    ksp.solution(|solution| x.copy_from(solution))??;
    Ok(info)
}

fn relative_residual(petsc: &Petsc, matrix: &Matrix, b: &Vector, x: &Vector) -> Result<f64, String> {
    let mut r = Vector::new(petsc, LOCAL).map_err(text)?;
    matrix.residual(b, x, &mut r).map_err(text)?;
    Ok(r.norm().map_err(text)? / b.norm().map_err(text)?)
}

pub fn shell_pc(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let b = wavy(petsc)?;
    let mut x = wavy(petsc)?;
    for (method, wanted, products) in [("preonly", "CONVERGED_ITS", 0), ("cg", "CONVERGED_RTOL", 1)] {
        let mut inner = Inner::new(petsc, &matrix)?;
        let mut ksp = outer(petsc, method)?;
        let mut count = 0;
        expect(
            ksp.type_name().map_err(text)?.as_deref() == Some(method),
            "the method's name",
        )?;
        expect(
            ksp.pc_type_name().map_err(text)?.as_deref() == Some("shell"),
            "the preconditioner's name",
        )?;
        let mut product = times(petsc, &matrix, &mut count);
        for (set_ups, solves) in [(1, 1), (1, 2), (2, 3)] {
            if set_ups == 2 {
                ksp.shell_operator_changed().map_err(text)?;
            }
            x.fill(0.0).map_err(text)?;
            let info = solve(&mut ksp, &mut product, &mut inner, &b, &mut x).map_err(text)?;
            expect(info.iterations == 1, &format!("{method}: {info:?}"))?;
            let (reason, name) = ksp.converged_reason().map_err(text)?;
            expect(
                reason == info.reason && name == wanted,
                &format!("{method}: {name} {info:?}"),
            )?;
            let left = relative_residual(petsc, &matrix, &b, &x)?;
            expect(left < 1e-10, &format!("{method} leaves {left:e}"))?;
            let calls = inner.calls;
            expect(
                calls[0] == set_ups && calls[1] >= solves,
                &format!("{method}: {calls:?} calls"),
            )?;
        }
        drop(product);
        expect(
            count >= 3 * products && (products > 0 || count == 0),
            &format!("{method}: {count} products"),
        )?;
    }
    Ok(())
}

/// Failures at set-up and in an application, of all ranks or the last one only, end the solve and leave no trace.
pub fn shell_failures(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let b = wavy(petsc)?;
    let mut x = wavy(petsc)?;
    for method in ["preonly", "cg"] {
        for (which, failure, says) in [
            (0, PcFailure::ZeroPivot, "zero pivot"),
            (1, PcFailure::ZeroPivot, "zero pivot"),
            (1, PcFailure::Other, ""),
        ] {
            let mut inner = Inner::new(petsc, &matrix)?;
            let mut ksp = outer(petsc, method)?;
            let mut count = 0;
            let mut product = times(petsc, &matrix, &mut count);
            inner.failures[which] = Some(failure);
            match solve(&mut ksp, &mut product, &mut inner, &b, &mut x) {
                Err(Error::Diverged { reason: -11, name, .. }) if name.contains(says) => {}
                other => return Err(format!("{method}, {failure:?} in call {which}: {other:?}")),
            }
            let calls = inner.calls;
            expect(calls[which] == 1, &format!("{method}: {calls:?}"))?;
            inner.failures[which] = None;
            solve(&mut ksp, &mut product, &mut inner, &b, &mut x).map_err(text)?;
            let left = relative_residual(petsc, &matrix, &b, &x)?;
            expect(left < 1e-10, &format!("{method} leaves {left:e} after a failure"))?;
            expect(inner.calls[0] == 2, "what failed is built again")?;
        }
        // One rank alone: none may go on, whichever notices. Its set-up calls nothing collective.
        let mut inner = Inner::new(petsc, &matrix)?;
        let mut ksp = outer(petsc, method)?;
        let mut count = 0;
        let last = petsc.rank() + 1 == petsc.ranks();
        inner.failures[0] = last.then_some(PcFailure::Other);
        let mut product = times(petsc, &matrix, &mut count);
        let verdict = solve(&mut ksp, &mut product, &mut inner, &b, &mut x);
        let right = match &verdict {
            Err(Error::Diverged { reason: -11, .. }) => true,
            Err(Error::OtherRank) => !last,
            _ => false,
        };
        expect(
            right && inner.calls == [1, 0],
            &format!("{method}, one rank: {verdict:?} {:?}", inner.calls),
        )?;
    }
    Ok(())
}

pub fn panics(petsc: &Petsc) -> Result<(), String> {
    let matrix = poisson(petsc)?;
    let b = wavy(petsc)?;
    let mut x = wavy(petsc)?;
    std::panic::set_hook(Box::new(|_| ()));
    let mut ends = vec![];
    for which in [0, 1] {
        let mut inner = Inner::new(petsc, &matrix)?;
        let mut ksp = outer(petsc, "preonly")?;
        let mut count = 0;
        inner.panics[which] = true;
        let mut product = times(petsc, &matrix, &mut count);
        let attempt = || solve(&mut ksp, &mut product, &mut inner, &b, &mut x).map(|_| ());
        let end = catch_unwind(AssertUnwindSafe(attempt));
        ends.push(
            end.err()
                .and_then(|panic| panic.downcast_ref::<&str>().map(|text| (*text).to_owned())),
        );
    }
    let _ = std::panic::take_hook();
    expect(
        ends.iter().all(|end| end.as_deref() == Some("wanted")),
        &format!("{ends:?}"),
    )?;
    // Without what is lent, PETSc receives of an error instead of calling nothing.
    let mut ksp = outer(petsc, "preonly")?;
    let verdict = ksp.solve(&b, &mut x);
    expect(
        matches!(verdict, Err(Error::Petsc { .. })),
        &format!("nothing is lent: {verdict:?}"),
    )
}
