use super::transfer::Transfer;
use super::*;
use bsmpm::grid::KnotVector;

/// A ball of elastic material in cells that it cuts, held at the lower x face: the moments of its 27 points a cell, and
/// a Laplacian of 1e-4 in the cells that it touches.
fn ball(cells: usize, poisson: f64) -> (Grid<3>, Stencil<3, 3>, Vec<bool>) {
    let axis = || KnotVector::uniform(1.0, cells, 2).unwrap();
    let grid = Grid::new([axis(), axis(), axis()]).unwrap();
    let lambda = poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let mu = 0.5 / (1.0 + poisson);
    let mut blocks = Vec::new();
    let mut free = vec![false; grid.nodes() * 3];
    let middle = 0.5 * cells as f64;
    for number in 0..grid.cells() {
        let cell = grid.cell_at(number);
        let mut block = vec![0.0; 81 * 81];
        let mut inside = 0;
        for place in 0..27 {
            let off = [place / 9, place / 3 % 3, place % 3].map(|k| (k as f64 + 0.5) / 3.0);
            let x: [f64; 3] = std::array::from_fn(|axis| cell[axis] as f64 + off[axis]);
            let from = x.map(|x| (x - middle).powi(2)).iter().sum::<f64>().sqrt();
            let held = from < 0.46 * cells as f64;
            inside += usize::from(held);
            let rows: [_; 3] = std::array::from_fn(|axis| grid.axes()[axis].basis::<3>(x[axis], cell[axis]));
            let gradient = |a: usize| -> [f64; 3] {
                let at = [a / 9, a / 3 % 3, a % 3];
                std::array::from_fn(|along| {
                    (0..3)
                        .map(|k| if k == along { rows[k].1[at[k]] } else { rows[k].0[at[k]] })
                        .product()
                })
            };
            for (a, b) in (0..27 * 27).map(|pair| (pair / 27, pair % 27)) {
                let g = gradient(a);
                let h = gradient(b);
                let dot: f64 = (0..3).map(|k| g[k] * h[k]).sum();
                for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                    let same = f64::from(u8::from(i == j));
                    let stiff = lambda * g[i] * h[j] + mu * (g[j] * h[i] + same * dot);
                    let value = if held { stiff } else { 0.0 } + 1e-4 * same * dot;
                    block[(a * 3 + i) * 81 + b * 3 + j] += value / 27.0;
                }
            }
        }
        if inside > 0 {
            let first = grid.first_node(&cell);
            for offset in grid.offsets() {
                free[(first + offset) * 3..(first + offset + 1) * 3].fill(true);
            }
            blocks.push((first, block));
        }
    }
    for node in grid.face_nodes(0, false) {
        free[node * 3..(node + 1) * 3].fill(false);
    }
    let mut stencil = Stencil::<3, 3>::new(&grid);
    stencil.keep(|node| free[node * 3]);
    blocks.iter().for_each(|(first, block)| stencil.add(*first, block));
    (grid, stencil, free)
}

fn noise(free: &[bool], seed: usize) -> Vec<f64> {
    let value = |k: usize| ((k * 7919 + seed * 104_729) % 1009) as f64 / 1009.0 - 0.5;
    free.iter()
        .enumerate()
        .map(|(k, free)| if *free { value(k) } else { 0.0 })
        .collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Conjugate gradients around one cycle until 1e-6 of the right-hand side is left.
fn iterations(cells: usize, poisson: f64) -> usize {
    let (grid, stencil, free) = ball(cells, poisson);
    let operator = Operator {
        stencil: &stencil,
        free: &free,
    };
    let multigrid = Multigrid::new(&grid, operator).unwrap();
    let b = noise(&free, 1);
    let mut r = b.clone();
    let mut z = vec![0.0; b.len()];
    let mut image = vec![0.0; b.len()];
    multigrid.apply(operator, 1, &r, &mut z);
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    for iteration in 1..200 {
        stencil.multiply(&free, &p, &mut image);
        let alpha = rz / dot(&p, &image);
        r.iter_mut().zip(&image).for_each(|(r, image)| *r -= alpha * image);
        if dot(&r, &r).sqrt() <= 1e-6 * dot(&b, &b).sqrt() {
            return iteration;
        }
        multigrid.apply(operator, 1, &r, &mut z);
        let next = dot(&r, &z);
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + next / rz * *p);
        rz = next;
    }
    panic!("{cells} {poisson}: no solution in 200 iterations");
}

#[test]
fn iterations_grow_neither_with_the_cells_nor_with_the_bulk_modulus() {
    let found = [(8, 0.3), (8, 0.495), (12, 0.3), (12, 0.495)].map(|(cells, poisson)| iterations(cells, poisson));
    println!("{found:?}"); // measured 12, 12, 12, 14 with 8 and 16 cells
    assert!(found.iter().all(|&found| found <= 16), "{found:?}");
}

#[test]
fn cycles_are_symmetric_and_linear() {
    let (grid, stencil, free) = ball(8, 0.4);
    let operator = Operator {
        stencil: &stencil,
        free: &free,
    };
    let multigrid = Multigrid::new(&grid, operator).unwrap();
    assert!(multigrid.levels.len() > 1);
    let [x, y] = [noise(&free, 2), noise(&free, 3)];
    let image = |x: &[f64]| {
        let mut image = vec![0.0; x.len()];
        multigrid.apply(operator, 2, x, &mut image);
        image
    };
    let bx = image(&x);
    let by = image(&y);
    assert!((dot(&bx, &y) - dot(&x, &by)).abs() <= 1e-5 * dot(&bx, &x), "symmetric");
    let sum: Vec<f64> = x.iter().zip(&y).map(|(x, y)| 3.0 * x - y).collect();
    let off = image(&sum)
        .iter()
        .zip(bx.iter().zip(&by))
        .map(|(s, (x, y))| (s - 3.0 * x + y).abs())
        .fold(0.0, f64::max);
    assert!(
        off <= 1e-5 * bx.iter().fold(0.0, |largest, x| x.abs().max(largest)),
        "linear: {off:e}"
    );
}

/// Coarse coefficients of x at its Greville places become those of the fine splines, whatever the cells and knots are.
#[test]
fn coarse_splines_are_splines_of_the_grid() {
    for (breakpoints, order) in [
        (&[0.0, 1.0, 2.0, 3.5, 4.0, 4.0, 5.0, 7.0, 8.0, 9.0][..], 2),
        (&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0][..], 3),
        (&[0.0, 0.5, 2.0, 2.5, 4.0, 6.0][..], 1),
    ] {
        let axis = || KnotVector::graded(breakpoints, order).unwrap();
        let grid = Grid::new([axis(), axis()]).unwrap();
        let (coarse, transfer) = Transfer::new(&grid).unwrap();
        assert!(coarse.nodes() < grid.nodes());
        let linear = |grid: &Grid<2>, node: usize| {
            let at = grid.node_at(node);
            1.0 + 2.0 * grid.axes()[0].greville(at[0]) - 3.0 * grid.axes()[1].greville(at[1])
        };
        let values: Vec<f64> = (0..coarse.nodes()).map(|node| linear(&coarse, node)).collect();
        let found = transfer.prolong::<1>(&values);
        for (node, found) in found.iter().enumerate() {
            assert!((found - linear(&grid, node)).abs() <= 1e-12, "{order} {node}");
        }
        let fine: Vec<f64> = (0..grid.nodes()).map(|node| (node % 7) as f64).collect();
        assert!(
            (dot(&fine, &found) - dot(&transfer.restrict::<1>(&fine), &values)).abs() <= 1e-9,
            "the transpose"
        );
    }
}
