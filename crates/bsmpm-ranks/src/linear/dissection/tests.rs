//! Tests of the direct solver. Each rank is replaced by a thread.

mod system;

use super::factor::{self, Factor, Precision};
use super::front;
use super::plan::{NONE, Plan, Supernode};
use super::reduction::role;
use crate::slab::Slabs;
use nalgebra::{DMatrix, DVector};
use system::{System, noise};

#[test]
fn a_front_is_factorised_and_solved_as_a_dense_matrix() {
    for (rows, own) in [(1, 1), (3, 2), (5, 5), (40, 33), (70, 64), (131, 67), (20, 0)] {
        let random = DMatrix::from_fn(rows, rows, |i, j| noise(i * rows + j) - 0.5);
        let matrix = &random * random.transpose() + DMatrix::identity(rows, rows);
        let whole = matrix.clone().cholesky().unwrap().l();
        let mut columns = matrix.columns(0, own).clone_owned();
        assert!(front::factorise(columns.as_mut_slice(), rows));
        let lower = |m: &DMatrix<f64>| m.lower_triangle();
        let close = |a: &DMatrix<f64>, b: &DMatrix<f64>| (a - b).amax() < 1e-11 * matrix.amax();
        assert!(
            close(&lower(&columns), &lower(&whole.columns(0, own).clone_owned())),
            "{rows} {own}"
        );
        let mut rest = matrix.view((own, own), (rows - own, rows - own)).clone_owned();
        front::subtract_from_rest(columns.as_slice(), rows, rest.as_mut_slice());
        let corner = whole.view((own, own), (rows - own, rows - own));
        assert!(
            rows == own || close(&lower(&rest), &lower(&(corner * corner.transpose()))),
            "{rows} {own}"
        );
        // With the rest eliminated too, the two solves give the solution of the whole.
        let b = DVector::from_fn(rows, |i, _| noise(i) - 0.3);
        let mut x = b.clone();
        let mut kept = Factor::default();
        kept.restart(Precision::Double, factor::entries(rows, own))
            .keep(0, columns.as_slice(), rows);
        kept.forward(0, rows, own, x.as_mut_slice());
        let mut below = x.rows_mut(own, rows - own);
        if own < rows {
            below.copy_from(&(corner * corner.transpose()).cholesky().unwrap().solve(&below));
        }
        kept.backward(0, rows, own, x.as_mut_slice());
        assert!((&matrix * &x - &b).amax() < 1e-10 * b.amax(), "{rows} {own}");
    }
}

#[test]
fn a_pivot_that_is_not_positive_and_finite_is_reported() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut matrix = DMatrix::identity(40, 40);
        matrix[(37, 37)] = bad;
        assert!(!front::factorise(matrix.as_mut_slice(), 40), "{bad}");
    }
}

/// The front of every part holds all that its unknowns couple with and all that its children leave.
#[test]
fn every_unknown_is_eliminated_once_and_before_what_receives_it() {
    fn check<const D: usize, const C: usize>(
        counts: [usize; D],
        q: usize,
        inner: [std::ops::Range<usize>; D],
        filled: f64,
    ) {
        let nodes: usize = counts.iter().product();
        let free: Vec<bool> = (0..nodes * C).map(|component| noise(component) < filled).collect();
        let plan = Plan::new::<D, C>(counts, q, &inner, &free);
        assert_eq!(plan.order.len(), free.iter().filter(|&&free| free).count());
        assert!((0..plan.order.len()).all(|number| plan.number[plan.order[number] as usize] as usize == number));
        let at = |mut node: usize| {
            let mut place = [0; D];
            for axis in (0..D).rev() {
                (place[axis], node) = (node % counts[axis], node / counts[axis]);
            }
            place
        };
        let is_inner = |component: u32| {
            let node = at(component as usize / C);
            (0..D).all(|axis| inner[axis].contains(&node[axis]))
        };
        assert!(plan.shared().iter().all(|&component| !is_inner(component)));
        assert!(
            plan.order[..plan.eliminated()]
                .iter()
                .all(|&component| is_inner(component))
        );
        let mut next: usize = 0;
        let mut stack: Vec<&Supernode> = Vec::new();
        for part in &plan.parts {
            assert_eq!(part.own.start, next);
            next = part.own.end;
            assert!(part.rim.is_sorted_by(|a, b| a < b) && part.rim.iter().all(|&number| number as usize >= next));
            let holds = |number: usize| part.own.contains(&number) || part.rim.contains(&(number as u32));
            for number in part.own.clone() {
                let node = at(plan.order[number] as usize / C);
                for (component, &other) in plan.number.iter().enumerate().filter(|(_, other)| **other != NONE) {
                    let place = at(component / C);
                    let near = (0..D).all(|axis| node[axis].abs_diff(place[axis]) <= q);
                    assert!(!near || (other as usize) < number || holds(other as usize));
                }
            }
            for child in stack.split_off(stack.len() - part.children) {
                assert!(child.rim.iter().all(|&number| holds(number as usize)));
            }
            stack.push(part);
        }
        assert!(stack.len() == 1 && next == plan.eliminated());
    }
    check::<2, 2>([30, 14], 2, [2..28, 0..14], 0.9);
    check::<2, 2>([30, 14], 2, [2..28, 2..12], 0.9);
    check::<2, 1>([9, 40], 1, [0..9, 0..40], 0.5);
    check::<2, 2>([26, 20], 3, [3..3, 0..20], 1.0);
    check::<2, 3>([12, 12], 2, [0..10, 0..12], 0.02);
    check::<3, 3>([7, 6, 5], 1, [1..6, 0..6, 0..5], 0.8);
    check::<3, 3>([7, 6, 5], 1, [1..6, 1..5, 0..5], 0.8);
    check::<2, 2>([5, 4], 2, [0..5, 0..4], 0.0);
}

#[test]
fn every_shared_node_is_eliminated_once_where_all_that_touch_it_have_met() {
    let of = |bounds: Vec<usize>| {
        let ranks = bounds.len() - 1;
        let columns = bounds[bounds.len() - 1];
        Slabs::new(bounds, ranks, 0..columns).unwrap()
    };
    let unequal = [
        (vec![0, 5], 2),
        (vec![0, 1, 2, 3, 4], 3),
        (vec![0, 9, 10, 11, 30, 31], 2),
    ];
    let mut cuts: Vec<(Slabs, usize)> = unequal.map(|(bounds, q)| (of(bounds), q)).to_vec();
    cuts.extend((1..18).map(|ranks| (of((0..=ranks).collect()), 2)));
    let parts = vec![vec![0, 2, 4, 6], vec![0, 1, 2, 6], vec![0, 4, 5, 6]];
    cuts.push((of(vec![0, 3, 4, 9]).parted(parts, &(0..6)).unwrap(), 2));
    for (slabs, q) in cuts {
        let ranks = slabs.ranks();
        let roles: Vec<_> = (0..ranks).map(|rank| role(ranks, rank)).collect();
        let met: Vec<usize> = roles
            .iter()
            .filter_map(|role| role.join.as_ref())
            .flat_map(|join| join.from)
            .collect();
        // What a rank hands over is met where it goes to: its slab, and what it has joined.
        for (rank, role) in roles.iter().enumerate() {
            let joined = role.join.as_ref().and_then(|join| join.joined_by);
            for by in role.joined_by.into_iter().chain(joined) {
                assert!(
                    roles[by].join.as_ref().is_some_and(|join| join.from.contains(&rank)),
                    "{rank} {slabs:?}"
                );
            }
        }
        assert_eq!(met.len(), 2 * (ranks - 1), "{slabs:?}");
        assert_eq!(
            roles.iter().filter(|role| role.join.is_some()).count(),
            ranks - 1,
            "no rank has two fronts"
        );
        let columns = slabs.bounds()[slabs.slabs()];
        for node in (0..columns + q).flat_map(|layer| (0..6 + q).map(move |row| [layer, row])) {
            let touched: Vec<usize> = (0..ranks)
                .filter(|&rank| {
                    let window = slabs.nodes(rank, q, &(0..6));
                    (0..2).all(|axis| window[axis].contains(&node[axis]))
                })
                .collect();
            let touching = slabs.touching(node, q);
            let group = |rank: usize| roles[rank].join.as_ref().map(|join| join.group.clone());
            // From rank to rank, up to the group that has all of them: the first of these eliminates it.
            let all = |rank: &usize| {
                group(*rank).is_some_and(|group| group.start <= touching.start && touching.end <= group.end)
            };
            let smallest = (0..ranks).filter(all).min_by_key(|&rank| group(rank).unwrap().len());
            assert_eq!(smallest.is_some(), ranks > 1);
            if let (Some(rank), true) = (smallest, touched.len() > 1) {
                let group = group(rank).unwrap();
                let middle = rank;
                assert!(touched.iter().all(|rank| group.contains(rank)));
                assert!(touched.iter().any(|&rank| rank < middle) && touched.iter().any(|&rank| rank >= middle));
            }
        }
    }
}

/// Slabs of all sorts: one, equal ones, thinner than the splines reach, and more than the binary tree has leaves.
#[test]
fn slabs_find_the_solution_of_the_dense_matrix() {
    let cases: [([usize; 2], usize, &[usize]); 10] = [
        ([12, 7], 2, &[0, 12]),
        ([12, 7], 2, &[0, 6, 12]),
        ([12, 5], 2, &[0, 4, 5, 6, 12]),
        ([6, 4], 3, &[0, 1, 2, 3, 4, 5, 6]),
        ([9, 6], 1, &[0, 3, 5, 9]),
        ([14, 3], 2, &[0, 3, 6, 8, 10, 14]),
        ([4, 12], 2, &[0, 1, 4]),
        ([9, 4], 2, &[0, 1, 2, 3, 4, 5, 6, 9]),
        ([10, 4], 1, &[0, 1, 2, 3, 4, 6, 7, 8, 10]),
        ([11, 3], 2, &[0, 1, 3, 4, 5, 6, 7, 8, 9, 11]),
    ];
    for (cells, order, bounds) in cases {
        System::<1>::new(cells, order, bounds).is_solved();
        System::<2>::new(cells, order, bounds).is_solved();
        System::<3>::new(cells, order, bounds).is_solved();
    }
}

/// Parts of slabs, side by side and not, thinner than the splines reach, and more than one to a side.
#[test]
fn parts_of_slabs_find_the_solution_of_the_dense_matrix() {
    type Parts<'a> = &'a [&'a [usize]];
    let cases: [([usize; 2], usize, &[usize], Parts<'_>); 6] = [
        ([12, 7], 2, &[0, 6, 12], &[&[0, 4, 7], &[0, 2, 7]]),
        (
            [12, 9],
            2,
            &[0, 4, 5, 12],
            &[&[0, 3, 6, 9], &[0, 1, 2, 9], &[0, 5, 8, 9]],
        ),
        ([8, 4], 3, &[0, 3, 8], &[&[0, 1, 2, 3, 4], &[0, 1, 2, 3, 4]]),
        ([9, 6], 1, &[0, 9], &[&[0, 2, 6]]),
        ([9, 6], 1, &[0, 9], &[&[0, 1, 3, 6]]),
        (
            [10, 6],
            2,
            &[0, 2, 4, 6, 10],
            &[&[0, 3, 6], &[0, 1, 6], &[0, 5, 6], &[0, 2, 6]],
        ),
    ];
    for (cells, order, bounds, parts) in cases {
        System::<1>::parted(cells, order, bounds, parts).is_solved();
        System::<2>::parted(cells, order, bounds, parts).is_solved();
        System::<3>::parted(cells, order, bounds, parts).is_solved();
    }
}

/// Between two bodies a separator may hold nothing: it does where the first of them has as many unknowns, or hardly
/// more. What the second slab shares with the first one, which has both bodies, must not be taken for that separator's.
#[test]
fn bodies_apart_find_the_solution_of_the_dense_matrix() {
    let mut parted = 0;
    for (side, other) in (6..10).flat_map(|side| (side - 1..side + 5).map(move |other| (side, other))) {
        let columns = side + 6 + other;
        for bounds in [
            vec![0, columns],
            vec![0, columns - 2, columns],
            vec![0, side + 1, side + 3, columns],
        ] {
            let system = System {
                gap: side..side + 6,
                ..System::<2>::new([columns, 7], 2, &bounds)
            };
            let counts = std::array::from_fn(|axis| system.grid.axes()[axis].functions());
            let plan = Plan::new::<2, 2>(counts, 2, &counts.map(|count| 0..count), &system.free());
            let (_, parts) = plan.parts.split_last().unwrap();
            parted += usize::from(parts.iter().any(|part| part.own.is_empty() && part.children == 2));
            system.is_solved();
        }
    }
    assert!(parted >= 2, "{parted} separators without unknowns");
}

#[test]
fn solutions_repeat_to_the_bit_however_late_messages_are_and_agree_where_slabs_meet() {
    let system = System::<2>::new([15, 6], 2, &[0, 4, 7, 8, 15]);
    let bits = |delay| -> Vec<Vec<u64>> {
        system
            .solutions(Precision::Single, delay)
            .iter()
            .map(|x| x.iter().map(|value| value.to_bits()).collect())
            .collect()
    };
    let first = bits(1);
    assert!((2..6).all(|delay| bits(delay) == first));
    let layer = system.grid.layer_nodes() * 2;
    for rank in 0..3 {
        let own = system.slabs.layers(rank, 2);
        let next = system.slabs.layers(rank + 1, 2);
        let common = (own.end - next.start) * layer;
        assert_eq!(first[rank][first[rank].len() - common..], first[rank + 1][..common]);
    }
}

#[test]
fn threads_find_the_solution_of_one_thread_to_the_bit() {
    let system = System::<2>::new([60, 40], 2, &[0, 60]);
    let counts = std::array::from_fn(|axis| system.grid.axes()[axis].functions());
    let plan = Plan::new::<2, 2>(counts, 2, &counts.map(|count| 0..count), &system.free());
    let shared = (0..plan.parts.len())
        .filter(|&root| plan.columns_to(root).len() >= super::tree::WORTH)
        .count();
    assert!(shared > 8, "only {shared} of {} subtrees are shared", plan.parts.len());
    let one = system.on_threads(1);
    assert!([2, 5].iter().all(|&threads| system.on_threads(threads) == one));
}
