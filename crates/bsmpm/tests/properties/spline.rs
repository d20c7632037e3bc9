//! Tests of one-dimensional B-splines against an independent evaluation.

use crate::support::random::Random;
use bsmpm::grid::KnotVector;

/// Uniform and graded axes, one cell, many cells, cells of very different length, breakpoints of every multiplicity.
fn axes(order: usize) -> Vec<KnotVector> {
    let graded: [&[f64]; 3] = [&[0.0, 0.1, 0.4, 1.0, 1.1, 3.0], &[0.0, 1e-3, 1.0], &[0.0, 2.0]];
    let uniform = [(1.0, 1), (0.1, 7), (1.0 / 3.0, 40)];
    let uniform = uniform.map(|(cell, cells)| KnotVector::uniform(cell, cells, order).unwrap());
    let repeated = (1..=order).map(|copies| KnotVector::graded(&repeated(copies), order).unwrap());
    uniform
        .into_iter()
        .chain(graded.map(|knots| KnotVector::graded(knots, order).unwrap()))
        .chain(repeated)
        .collect()
}

/// Breakpoints of which two neighbours and a later one stand so many times.
fn repeated(copies: usize) -> Vec<f64> {
    let times = |x: f64| if [0.3, 0.4, 1.0].contains(&x) { copies } else { 1 };
    [0.0, 0.3, 0.4, 0.7, 1.0, 1.6]
        .into_iter()
        .flat_map(|x| vec![x; times(x)])
        .collect()
}

#[test]
fn a_breakpoint_of_multiplicity_m_leaves_q_less_m_derivatives_continuous() {
    // Behind and before a knot, by how much the functions and their slopes jump, in units of the cell.
    let jumps = |axis: &KnotVector, x: f64| {
        let before = all(axis, x.next_down());
        let after = all(axis, x);
        let largest = |of: fn(&(f64, f64)) -> f64| {
            before
                .iter()
                .zip(&after)
                .map(|(a, b)| (of(a) - of(b)).abs())
                .fold(0.0, f64::max)
        };
        (largest(|f| f.0), largest(|f| f.1))
    };
    for order in 1..=3 {
        for copies in 1..=order {
            let axis = KnotVector::graded(&repeated(copies), order).unwrap();
            assert_eq!(axis.functions(), 5 + 3 * (copies - 1) + order);
            assert_eq!((0..axis.cells()).filter(|&cell| axis.has_length(cell)).count(), 5);
            for x in [0.3, 0.4, 1.0] {
                let (value, slope) = jumps(&axis, x);
                assert!(value < 1e-13, "order {order}, {copies} copies at {x}: {value:e}");
                assert_eq!(
                    slope > 1.0,
                    copies == order,
                    "order {order}, {copies} copies at {x}: {slope:e}"
                );
                // With q copies one function alone is left on the line, as at the ends of an open knot vector.
                let on_line = all(&axis, x).iter().filter(|f| f.0 > 1e-12).count();
                assert_eq!(on_line == 1, copies == order);
            }
        }
        for torn in [repeated(order + 1), vec![0.0, 0.0, 1.0], vec![0.0, 1.0, 1.0]] {
            assert!(KnotVector::graded(&torn, order).is_err(), "{torn:?}");
        }
    }
}

/// Points inside, on every knot, one step of f64 to either side of it, and both ends.
fn samples(axis: &KnotVector, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let inside = (0..200).map(|_| random.unit() * axis.length());
    let knots = (0..=axis.cells()).map(|i| axis.breakpoint(i));
    let near = knots.flat_map(|x| [x.next_down(), x, x.next_up()]);
    inside
        .chain(near)
        .filter(|x| (0.0..=axis.length()).contains(x))
        .collect()
}

/// All functions of the axis at `x` with their derivatives, zero outside the span.
fn all(axis: &KnotVector, x: f64) -> Vec<(f64, f64)> {
    let cell = axis.cell_of(x).expect("inside");
    let mut found = vec![(0.0, 0.0); axis.functions()];
    let mut write = |N: &[f64], dN: &[f64]| {
        N.iter()
            .zip(dN)
            .enumerate()
            .for_each(|(a, (N, dN))| found[cell + a] = (*N, *dN));
    };
    match axis.order() {
        1 => write(&axis.basis::<2>(x, cell).0, &axis.basis::<2>(x, cell).1),
        2 => write(&axis.basis::<3>(x, cell).0, &axis.basis::<3>(x, cell).1),
        _ => write(&axis.basis::<4>(x, cell).0, &axis.basis::<4>(x, cell).1),
    }
    found
}

/// The plain recursion of Eqs 4, 5 for one function; 0/0 counts as 0, the last span is closed.
fn cox_de_boor(axis: &KnotVector, i: usize, degree: usize, x: f64) -> f64 {
    if degree == 0 {
        let from = axis.knot(i);
        let to = axis.knot(i + 1);
        let closing = x == axis.length() && to == x && from < to;
        return if (from <= x && x < to) || closing { 1.0 } else { 0.0 };
    }
    let part = |numerator: f64, width: f64, N: f64| if width > 0.0 { numerator / width * N } else { 0.0 };
    let left = axis.knot(i);
    let right = axis.knot(i + degree + 1);
    part(
        x - left,
        axis.knot(i + degree) - left,
        cox_de_boor(axis, i, degree - 1, x),
    ) + part(
        right - x,
        right - axis.knot(i + 1),
        cox_de_boor(axis, i + 1, degree - 1, x),
    )
}

/// Eq. 6 on the same recursion.
fn derivative(axis: &KnotVector, i: usize, x: f64) -> f64 {
    let q = axis.order();
    let part = |width: f64, N: f64| if width > 0.0 { q as f64 / width * N } else { 0.0 };
    part(axis.knot(i + q) - axis.knot(i), cox_de_boor(axis, i, q - 1, x))
        - part(
            axis.knot(i + q + 1) - axis.knot(i + 1),
            cox_de_boor(axis, i + 1, q - 1, x),
        )
}

/// Worst of `error` over all orders, axes and samples.
fn worst(error: impl Fn(&KnotVector, f64) -> f64) -> f64 {
    let mut worst = 0.0_f64;
    for order in 1..=3 {
        for (seed, axis) in axes(order).iter().enumerate() {
            for x in samples(axis, seed as u64) {
                worst = worst.max(error(axis, x));
            }
        }
    }
    worst
}

#[test]
fn functions_sum_to_one_and_their_derivatives_to_zero() {
    let unity = worst(|axis, x| (all(axis, x).iter().map(|f| f.0).sum::<f64>() - 1.0).abs());
    let slope = worst(|axis, x| {
        let found = all(axis, x);
        let scale = axis.smallest_cell();
        found.iter().map(|f| f.1).sum::<f64>().abs() * scale
    });
    println!("partition of unity {unity:.1e}, sum of slopes x smallest cell {slope:.1e}");
    assert!(unity <= 1e-14); // measured 4.4e-16
    assert!(slope <= 1e-14); // measured 4.4e-16
}

#[test]
fn functions_are_never_negative() {
    assert_eq!(
        worst(|axis, x| all(axis, x).iter().map(|f| -f.0).fold(0.0, f64::max)),
        0.0
    );
}

#[test]
fn functions_agree_with_the_plain_recursion_of_cox_and_de_boor() {
    let values = worst(|axis, x| {
        let difference = |(i, f): (usize, &(f64, f64))| (f.0 - cox_de_boor(axis, i, axis.order(), x)).abs();
        all(axis, x).iter().enumerate().map(difference).fold(0.0, f64::max)
    });
    let slopes = worst(|axis, x| {
        let difference = |(i, f): (usize, &(f64, f64))| (f.1 - derivative(axis, i, x)).abs() * axis.smallest_cell();
        all(axis, x).iter().enumerate().map(difference).fold(0.0, f64::max)
    });
    println!("values {values:.1e}, slopes x smallest cell {slopes:.1e}");
    assert!(values <= 1e-14); // measured 3.3e-16
    assert!(slopes <= 1e-14); // measured 7.1e-16
}

#[test]
fn derivatives_agree_with_central_differences_inside_a_span() {
    for order in 1..=3 {
        let axis = KnotVector::graded(&[0.0, 0.5, 1.25, 2.0], order).unwrap();
        let mut random = Random::new(order as u64);
        for _ in 0..100 {
            let cell = (random.unit() * 3.0) as usize;
            let step = 1e-5;
            let lower = axis.breakpoint(cell) + step;
            let upper = axis.breakpoint(cell + 1) - step;
            let x = lower + random.unit() * (upper - lower);
            let before = all(&axis, x - step);
            let after = all(&axis, x + step);
            for (i, (_, dN)) in all(&axis, x).into_iter().enumerate() {
                let difference = (after[i].0 - before[i].0) / (2.0 * step);
                assert!(
                    (dN - difference).abs() <= 1e-8,
                    "order {order}, function {i} at {x}: {dN} {difference}"
                );
            }
        }
    }
}

#[test]
fn greville_abscissae_reproduce_the_coordinate() {
    let greville =
        |axis: &KnotVector, i: usize| (1..=axis.order()).map(|k| axis.knot(i + k)).sum::<f64>() / axis.order() as f64;
    let error = worst(|axis, x| {
        let sum: f64 = all(axis, x)
            .iter()
            .enumerate()
            .map(|(i, f)| f.0 * greville(axis, i))
            .sum();
        (sum - x).abs() / axis.length()
    });
    let slope = worst(|axis, x| {
        let sum: f64 = all(axis, x)
            .iter()
            .enumerate()
            .map(|(i, f)| f.1 * greville(axis, i))
            .sum();
        (sum - 1.0).abs() * axis.smallest_cell() / axis.length()
    });
    println!("sum N x = x to {error:.1e}, its slope to {slope:.1e}");
    assert!(error <= 1e-14); // measured 3.3e-16
    assert!(slope <= 1e-14); // measured 5.1e-16
}

#[test]
fn the_first_functions_slopes_at_the_lower_end_are_kept_although_two_values_vanish() {
    let axis = KnotVector::uniform(1.0, 5, 2).unwrap();
    let (N, dN) = axis.basis::<3>(0.0, axis.cell_of(0.0).unwrap());
    assert_eq!((N, dN), ([1.0, 0.0, 0.0], [-2.0, 2.0, 0.0]));
}

#[test]
fn the_upper_end_belongs_to_the_last_cell_and_beyond_there_is_none() {
    for order in 1..=3 {
        for axis in axes(order) {
            let end = axis.length();
            assert_eq!(axis.cell_of(end), Some(axis.cells() - 1));
            assert!((all(&axis, end)[axis.functions() - 1].0 - 1.0).abs() <= 1e-15);
            for outside in [-f64::MIN_POSITIVE, end.next_up(), f64::NAN, f64::INFINITY] {
                assert_eq!(axis.cell_of(outside), None);
            }
        }
    }
}

#[test]
fn a_knot_begins_its_span_also_where_the_quotient_is_rounded() {
    for cells in [3, 7, 49, 1000] {
        for cell in [0.1, 1.0 / 3.0, 0.7, 1e-3] {
            let axis = KnotVector::uniform(cell, cells, 2).unwrap();
            for i in 0..cells {
                assert_eq!(axis.cell_of(axis.breakpoint(i)), Some(i));
                assert_eq!(axis.cell_of(axis.breakpoint(i + 1).next_down()), Some(i));
            }
        }
    }
}

#[test]
fn breakpoints_count_from_the_first_so_that_the_origin_does_not_matter() {
    let breakpoints = [0.0, 0.25, 1.0, 1.5, 4.0];
    for origin in [1e3, 1e6, 1e8, -1e6] {
        let shifted = breakpoints.map(|x| x + origin);
        for order in 1..=3 {
            assert_eq!(
                KnotVector::graded(&shifted, order),
                KnotVector::graded(&breakpoints, order)
            );
        }
    }
}

#[test]
fn what_is_no_axis_is_refused() {
    for order in [0, 4] {
        assert!(KnotVector::uniform(1.0, 3, order).is_err());
    }
    let bad: [&[f64]; 5] = [&[], &[1.0], &[0.0, 0.0], &[0.0, 2.0, 1.0], &[0.0, f64::NAN]];
    assert!(
        bad.iter()
            .all(|breakpoints| KnotVector::graded(breakpoints, 2).is_err())
    );
    assert!(KnotVector::uniform(-1.0, 3, 2).is_err() && KnotVector::uniform(f64::NAN, 3, 2).is_err());
    assert!(KnotVector::uniform(1.0, 0, 2).is_err());
    // Increasing, but not when counted from the first; cells and axes whose volumes f64 cannot hold.
    let lost: [&[f64]; 4] = [&[-1e17, 1.0, 1.5], &[0.0, 5e-324], &[0.0, 1e-101], &[-1e308, 1e308]];
    assert!(
        lost.iter()
            .all(|breakpoints| KnotVector::graded(breakpoints, 2).is_err())
    );
    assert!(KnotVector::uniform(1e-101, 3, 2).is_err() && KnotVector::uniform(1e100, 2, 2).is_err());
}
