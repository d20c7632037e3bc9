//! Fuzzes B-splines on any valid knots.

use crate::draw;
use arbitrary::{Result, Unstructured};
use bsmpm::grid::KnotVector;

/// Cells at most.
const CELLS: usize = 12;
/// Part of the partition of unity that rounding may take.
const UNITY: f64 = 4.0 * f64::EPSILON;

/// Knots, then places.
pub fn target(data: &[u8]) {
    // What the bytes are too few for is no input.
    let _ = draw(&mut Unstructured::new(data));
}

fn draw(u: &mut Unstructured<'_>) -> Result<()> {
    let order = u.int_in_range(0..=4)?;
    let Ok(axis) = axis(u, order)? else { return Ok(()) };
    assert!((1..=3).contains(&order) && axis.length() > 0.0 && axis.length().is_finite());
    while !u.is_empty() {
        let x = place(u, &axis)?;
        match axis.order() {
            1 => check::<2>(&axis, x),
            2 => check::<3>(&axis, x),
            _ => check::<4>(&axis, x),
        }
    }
    Ok(())
}

fn axis(u: &mut Unstructured<'_>, order: usize) -> Result<std::result::Result<KnotVector, bsmpm::error::GridError>> {
    let cells = u.int_in_range(0..=CELLS)?;
    Ok(match u.int_in_range(0..=3)? {
        0 => KnotVector::uniform(draw::size(u, -9.0, 9.0)?, cells, order),
        1 => KnotVector::uniform(draw::bits(u)?, cells, order),
        2 => {
            let mut at = draw::signed(u, -6.0, 6.0)?;
            let mut breakpoints = vec![at];
            for _ in 0..cells {
                at += draw::size(u, -6.0, 6.0)?;
                breakpoints.push(at);
            }
            KnotVector::graded(&breakpoints, order)
        }
        _ => {
            let breakpoints: Vec<f64> = (0..=cells).map(|_| draw::bits(u)).collect::<Result<_>>()?;
            KnotVector::graded(&breakpoints, order)
        }
    })
}

/// Anywhere, or at a knot and beside it.
fn place(u: &mut Unstructured<'_>, axis: &KnotVector) -> Result<f64> {
    let knot = axis.breakpoint(u.int_in_range(0..=axis.cells())?);
    Ok(match u.int_in_range(0..=4)? {
        0 => knot,
        1 => knot.next_up(),
        2 => knot.next_down(),
        3 => draw::fraction(u)? * axis.length(),
        _ => draw::bits(u)?,
    })
}

/// Σ N = 1, N ≥ 0, Σ dN/dx = 0 against their sizes, Σ N_i ξ_i = x; outside there are none.
fn check<const W: usize>(axis: &KnotVector, x: f64) {
    let Some(cell) = axis.cell_of(x) else {
        assert!(!(0.0..=axis.length()).contains(&x), "no cell at {x} of {axis:?}");
        return;
    };
    let last = cell + 1 == axis.cells();
    let from = axis.breakpoint(cell);
    let to = axis.breakpoint(cell + 1);
    assert!(
        from <= x && (x < to || (last && x == to)),
        "{x} in cell {cell} of {axis:?}"
    );
    let (N, dN) = axis.basis::<W>(x, cell);
    assert!(N.iter().all(|N| *N >= 0.0), "{N:?} at {x} of {axis:?}");
    let sum: f64 = N.iter().sum();
    assert!(
        (sum - 1.0).abs() <= UNITY,
        "the sum is 1 + {:e} at {x} of {axis:?}",
        sum - 1.0
    );
    let slopes = dN.map(|slope| slope * (to - from));
    let sum = slopes.iter().sum::<f64>();
    let size = slopes.iter().map(|slope| slope.abs()).sum::<f64>();
    assert!(dN.iter().all(|slope| slope.is_finite()), "{dN:?} at {x} of {axis:?}");
    assert!(
        size.is_finite() && sum.abs() <= UNITY * size,
        "{dN:?} at {x} of {axis:?}"
    );
    let place: f64 = N.iter().enumerate().map(|(a, N)| N * axis.greville(cell + a)).sum();
    assert!(
        (place - x).abs() <= 4.0 * UNITY * axis.length(),
        "Greville: {place} at {x} of {axis:?}"
    );
}
