//! Transfers between material points and nodes, theory-manual equations (T2.4) to (T2.6), and internal nodal forces
//! (T5.1). Threads share the columns of cells.

mod patch;
pub mod scalars;

use super::contributions::Contributions;
use super::shape::{Patch, PatchColumn, Shape, with_width};
use crate::kinematics::{Kinematics, Slope};
use crate::lanes;
use crate::stabilisation::GroupedPoints;
use crate::tensor::Vector;
use crate::threads::{CHUNK, share};
use patch::{Divergence, Gradients, PatchSums};
use rayon::prelude::*;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Mutex;

/// Largest number of nodes of a patch: (3 + 1)^3.
const MOST_NODES: usize = 64;

/// `C` numbers at each node of a patch.
type PatchBlock<const C: usize> = [[f64; C]; MOST_NODES];

/// Sums values of points to nodes with the shape functions: sum_p N_Ip value_p (Eq. 2), `C` numbers per point.
pub fn to_nodes<const D: usize, const C: usize>(
    shape: &Shape<D>,
    value: impl Fn(usize) -> [f64; C] + Sync,
) -> Contributions {
    to_nodes_grouped(shape, GroupedPoints::ONE_GROUP, value)
}

/// Sums values of points to nodes as [`to_nodes`] does, separately for each group.
pub fn to_nodes_grouped<const D: usize, const C: usize>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    value: impl Fn(usize) -> [f64; C] + Sync,
) -> Contributions {
    let (rows, stride) = shape.rows();
    with_width!(lowered shape.width(), W => scatter_columns(shape, grouped, |_| {
        let mut values = Vec::new();
        let value = &value;
        move |points: Range<usize>, block: &mut PatchBlock<C>| {
            values.clear();
            values.extend(points.clone().map(value));
            lanes::run(PatchSums::<D, C, W> { rows, stride, points, values: &values, block });
        }
    }))
}

/// Returns per node and group the largest `value` of the points with N_Ip > 0, or zero if none is positive.
/// Contributions of other ranks are not included.
pub fn largest_to_nodes<const D: usize>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    value: impl Fn(usize) -> f64 + Sync,
) -> Vec<f64> {
    let count = grouped.count();
    let mut largest = nothing(shape, count);
    let columns = apart(&mut largest);
    with_width!(lowered shape.width(), W => share(columns.len(), &|index| {
        let column = &shape.columns()[index];
        let out = &mut *columns[index].lock().expect("the column's only thread");
        let first = column.column * shape.extent().layer_nodes;
        for patch in &shape.patches()[column.patches.clone()] {
            for p in patch.points.clone() {
                let support = shape.values::<W>(p);
                let value = value(p);
                for (k, offset) in shape.offsets().iter().enumerate() {
                    if support.value(k) > 0.0 {
                        let at_node = &mut out[(patch.first_node - first + offset) * count + grouped.of(p)];
                        *at_node = at_node.max(value);
                    }
                }
            }
        }
    }));
    drop(columns);
    largest.highest()
}

/// Interpolates nodal values at every point, value_p = sum_I N_Ip nodal_I (Eq. 1), and returns `found(p, value_p)`.
pub fn to_points<const D: usize, const C: usize, T: Clone + Send>(
    shape: &Shape<D>,
    nodal: &[f64],
    found: impl Fn(usize, [f64; C]) -> T + Sync,
) -> Vec<T> {
    to_points_grouped(shape, GroupedPoints::ONE_GROUP, nodal, found)
}

/// Interpolates as [`to_points`] does, with the nodal values of each point's group.
pub fn to_points_grouped<const D: usize, const C: usize, T: Clone + Send>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    nodal: &[f64],
    found: impl Fn(usize, [f64; C]) -> T + Sync,
) -> Vec<T> {
    let scratch = [[0.0; C]; MOST_NODES];
    with_width!(lowered shape.width(), W => at_points(shape, scratch, |number, block, out: &mut Vec<T>| {
        for (group, points) in grouped.runs(shape.patches()[number].points.clone()) {
            gathered(shape, nodal, number, group, grouped.count(), block);
            for p in points {
                let support = shape.values::<W>(p);
                let mut value = [0.0; C];
                for (k, at_node) in block[..const { W.pow(D as u32) }].iter().enumerate() {
                    let N = support.value(k);
                    for c in 0..C {
                        value[c] += N * at_node[c];
                    }
                }
                out.push(found(p, value));
            }
        }
    }))
}

/// Computes the gradient at every point, (grad u)_p = sum_I u_I (x) grad N_Ip (step 4a), and returns `found(p,
/// gradient)`. The points are at `x` (m).
pub fn gradients<K: Kinematics<D>, const D: usize, T: Clone + Send>(
    shape: &Shape<D>,
    x: &[Vector<D>],
    u: &[f64],
    found: impl Fn(usize, K::Gradient) -> T + Sync,
) -> Vec<T> {
    let scratch = [[0.0; D]; MOST_NODES];
    with_width!(shape.width(), W => at_points(shape, scratch, |number, block, out: &mut Vec<T>| {
        let patch = &shape.patches()[number];
        gather(u, shape.offsets(), patch.first_node, 0, 1, block);
        let rows = shape.rows_with_derivatives();
        let points = patch.points.clone();
        let kinematics = PhantomData::<K>;
        lanes::run(Gradients::<K, _, _, D, W> { rows, x, points, block, found: &found, out, kinematics });
    }))
}

/// Sums fluxes of points to nodes with the gradients of the shape functions: sum_p flux_p grad N_Ip (step 5a), the
/// adjoint of [`gradients`].
pub fn divergence<K: Kinematics<D>, const D: usize>(
    shape: &Shape<D>,
    x: &[Vector<D>],
    flux: impl Fn(usize) -> K::Gradient + Sync,
) -> Contributions {
    divergence_of::<K, D>(shape, x, |points, fluxes| fluxes.extend(points.map(&flux)))
}

/// Computes [`divergence`] of fluxes that `flux` appends for many consecutive points at a time.
pub fn divergence_of<K: Kinematics<D>, const D: usize>(
    shape: &Shape<D>,
    x: &[Vector<D>],
    flux: impl Fn(Range<usize>, &mut Vec<K::Gradient>) + Sync,
) -> Contributions {
    with_width!(shape.width(), W => scatter_columns(shape, GroupedPoints::ONE_GROUP, |column| {
        let first = column.points.start;
        let mut fluxes = Vec::with_capacity(column.points.len());
        flux(column.points.clone(), &mut fluxes);
        move |points: Range<usize>, block: &mut PatchBlock<D>| {
            let fluxes = &fluxes[points.start - first..points.end - first];
            lanes::run(Divergence::<K, D, W> { rows: shape.rows_with_derivatives(), x, points, fluxes, block });
        }
    }))
}

/// Computes sum_p weight_p |grad N_Ip|^2, which shows nodes that have stiffness but no mass.
pub fn squared_gradients<const D: usize>(shape: &Shape<D>, weight: impl Fn(usize) -> f64 + Sync) -> Contributions {
    with_width!(shape.width(), W => scatter(shape, GroupedPoints::ONE_GROUP, |points, block: &mut PatchBlock<1>| {
        for p in points {
            let support = shape.support::<W>(p);
            let weight = weight(p);
            for (k, sum) in block[..const { W.pow(D as u32) }].iter_mut().enumerate() {
                sum[0] += weight * support.gradient(k).norm_squared();
            }
        }
    }))
}

/// Writes the [`Slope`] of every node at point `p` to `out`, for sums over pairs of nodes of a patch. The points are at
/// `x` (m).
#[inline]
pub(crate) fn slopes_of<K: Kinematics<D>, const D: usize>(
    shape: &Shape<D>,
    x: &[Vector<D>],
    p: usize,
    out: &mut [Slope<K, D>],
) {
    with_width!(shape.width(), W => {
        let support = shape.support::<W>(p);
        for (k, slope) in out[..const { W.pow(D as u32) }].iter_mut().enumerate() {
            *slope = K::slope::<f64>(|| support.value(k), support.gradient(k), &x[p]);
        }
    });
}

/// Sums over the patches: `fill` adds the points of one group to a block of zeros.
fn scatter<const D: usize, const C: usize>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    fill: impl Fn(Range<usize>, &mut PatchBlock<C>) + Sync,
) -> Contributions {
    scatter_columns(shape, grouped, |_| &fill)
}

/// Sums over the patches as [`scatter`] does; `filling` creates the function that fills the blocks of a column.
fn scatter_columns<const D: usize, const C: usize, F: FnMut(Range<usize>, &mut PatchBlock<C>)>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    filling: impl Fn(&PatchColumn) -> F + Sync,
) -> Contributions {
    let count = grouped.count();
    let mut contributions = nothing(shape, count * C);
    let sums = apart(&mut contributions);
    share(sums.len(), &|index| {
        let column = &shape.columns()[index];
        let sums = &mut *sums[index].lock().expect("the column's only thread");
        let first = column.column * shape.extent().layer_nodes;
        let mut fill = filling(column);
        let mut block = [[0.0; C]; MOST_NODES];
        for number in column.patches.clone() {
            let patch = &shape.patches()[number];
            for (group, points) in grouped.runs(patch.points.clone()) {
                block[..shape.offsets().len()].fill([0.0; C]);
                fill(points, &mut block);
                let node = patch.first_node - first;
                let Some(merged) = shape.merger() else {
                    add(sums, shape.offsets(), node, group, count, &block);
                    continue;
                };
                let [cells, pairs] = merged.spread(number, group, &block);
                add(sums, shape.offsets(), node, 2 * group, 2 * count, &cells);
                add(sums, merged.offsets(number), node, 2 * group + 1, 2 * count, &pairs);
            }
        }
    });
    contributions
}

/// Patch that a thread works on, and the results at its points.
struct CurrentPatch<S, T> {
    scratch: S,
    points: Range<usize>,
    found: Vec<T>,
}

impl<S, T: Clone> CurrentPatch<S, T> {
    /// Starts without a patch.
    fn new(scratch: S) -> Self {
        Self {
            scratch,
            points: 0..0,
            found: Vec::new(),
        }
    }

    /// Returns the result at point `p`. A thread that starts within a patch computes the whole patch.
    #[inline]
    fn find(&mut self, patches: &[Patch], work: &impl Fn(usize, &mut S, &mut Vec<T>), p: usize) -> T {
        if !self.points.contains(&p) {
            let number = patches.partition_point(|patch| patch.points.end <= p);
            self.found.clear();
            work(number, &mut self.scratch, &mut self.found);
            self.points.clone_from(&patches[number].points);
        }
        self.found[p - self.points.start].clone()
    }
}

/// Returns the results of `work` on all patches, in the order of the points.
fn at_points<const D: usize, S: Copy + Sync, T: Clone + Send>(
    shape: &Shape<D>,
    scratch: S,
    work: impl Fn(usize, &mut S, &mut Vec<T>) + Sync,
) -> Vec<T> {
    if rayon::current_num_threads() == 1 {
        let mut scratch = scratch;
        let mut out = Vec::with_capacity(shape.len());
        (0..shape.patches().len()).for_each(|patch| work(patch, &mut scratch, &mut out));
        return out;
    }
    let patches = shape.patches();
    (0..shape.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map_init(|| CurrentPatch::new(scratch), |patch, p| patch.find(patches, &work, p))
        .collect()
}

/// Creates zero contributions, `width` numbers per node and level.
fn nothing<const D: usize>(shape: &Shape<D>, width: usize) -> Contributions {
    let columns = shape.columns().iter().map(|column| column.column).collect();
    Contributions::zeros(shape.extent(), width * shape.levels(), columns)
}

/// Returns the sums of each column, each for one thread at a time.
fn apart(contributions: &mut Contributions) -> Vec<Mutex<&mut [f64]>> {
    contributions.columns_mut().map(Mutex::new).collect()
}

/// Fills a block with the nodal values of a patch, or with the values of its functions if these are merged.
#[inline]
fn gathered<const D: usize, const C: usize>(
    shape: &Shape<D>,
    nodal: &[f64],
    number: usize,
    group: usize,
    groups: usize,
    block: &mut PatchBlock<C>,
) {
    let first = shape.patches()[number].first_node;
    let Some(merged) = shape.merger() else {
        return gather(nodal, shape.offsets(), first, group, groups, block);
    };
    let mut pairs = [[0.0; C]; MOST_NODES];
    gather(nodal, shape.offsets(), first, 2 * group, 2 * groups, block);
    gather(
        nodal,
        merged.offsets(number),
        first,
        2 * group + 1,
        2 * groups,
        &mut pairs,
    );
    *block = merged.combine(number, group, [*block, pairs]);
}

fn gather<const C: usize>(
    nodal: &[f64],
    offsets: &[usize],
    first: usize,
    group: usize,
    groups: usize,
    block: &mut PatchBlock<C>,
) {
    for (at_node, offset) in block.iter_mut().zip(offsets) {
        at_node.copy_from_slice(&nodal[((first + offset) * groups + group) * C..][..C]);
    }
}

fn add<const C: usize>(
    nodal: &mut [f64],
    offsets: &[usize],
    first: usize,
    group: usize,
    groups: usize,
    block: &PatchBlock<C>,
) {
    for (sums, offset) in block.iter().zip(offsets) {
        let at_node = &mut nodal[((first + offset) * groups + group) * C..][..C];
        for (total, sum) in at_node.iter_mut().zip(sums) {
            *total += sum;
        }
    }
}

/// Divides nodal values (any count per node) by the weight of their node. They become zero where the weight is at most
/// the threshold, so that 1/m is never evaluated there.
pub fn divide(nodal: &mut [f64], weight: &[f64], threshold: f64) {
    let width = nodal.len() / weight.len();
    for (values, &weight) in nodal.chunks_exact_mut(width).zip(weight) {
        let inverse = if weight > threshold { 1.0 / weight } else { 0.0 };
        values.iter_mut().for_each(|value| *value *= inverse);
    }
}
