//! Extended B-splines, theory-manual equations (T2.10) to (T2.12): coefficients of splines of nearly empty cells are
//! tied to (extrapolated from) those of full cells.
//!
//! A *published* tie is used by several ranks. All ranks know it and exchange its displacement and force.

use crate::grid::extension::{ExtendedSplines, Homes, Nearness, REACH, weights};
use crate::grid::{Grid, Shape};
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::Points;
use std::collections::BTreeMap;

/// Filled fraction of a cell from which it counts as full. With 1, a cell would not be full after slight compression.
const FULL: f64 = 0.8;

/// An outer spline that is tied to the splines of a full cell, its home.
#[derive(Clone, Debug, PartialEq)]
pub struct Tie<const D: usize> {
    /// Number of its node in the whole grid.
    pub number: usize,
    /// Its node in the window, if it is there.
    pub node: Option<usize>,
    /// Tied components; the other components are prescribed.
    pub tied: [bool; D],
    /// Whether all ranks know this tie.
    pub is_published: bool,
    /// Home: global cell number along each axis.
    home: [usize; D],
    /// Splines of the home with a non-zero weight.
    pub inner: Vec<InnerFunction>,
}

/// A spline of a home.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerFunction {
    /// Number of its node in the whole grid.
    pub number: usize,
    /// Its node in the window, if it is there.
    pub node: Option<usize>,
    /// Weight e_ij (-).
    pub weight: f64,
}

/// Ties that concern the window of this rank, and the published ties.
#[derive(Clone, Debug, Default)]
pub struct Extension<const D: usize> {
    ties: Vec<Tie<D>>, // ascending by number
    of_node: Vec<u32>, // per node of the window: position of its tie + 1; 0 without a tie
    published: usize,
    loose: Vec<usize>, // nodes of the window whose splines are outer and have no home
    /// Outer splines that are tied, over all ranks.
    pub tied: usize,
    /// Outer splines that remain unknowns, over all ranks: at a rigid body, or without a full cell near enough.
    pub untied: usize,
}

impl<const D: usize> Extension<D> {
    /// Ties the outer splines of the `active` nodes, except those `at_bodies`; tied components are removed from `free`.
    /// `None` if no rank has outer splines. Two exchanges with the neighbours, two reductions, and two gathers if ranks
    /// share outer splines.
    pub fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        active: &[bool],
        at_bodies: &[bool],
        free: &mut [bool],
        halo: &dyn Halo,
    ) -> Option<Self> {
        if model.extended_splines == ExtendedSplines::Off {
            return None;
        }
        let grid = &model.grid;
        let full = full_cells::<K, D>(grid, shape, points);
        let is_inner = inner_functions(grid, shape, &full, halo);
        let is_outer: Vec<bool> = (0..grid.nodes())
            .map(|node| active[node] && !is_inner[node] && free[Nodal::<D>::of(node)].contains(&true))
            .collect();
        let mut outer: Vec<usize> = halo.owned().nodes().filter(|&node| is_outer[node]).collect();
        let mut counts = [outer.len() as f64, 0.0];
        halo.all_reduce_sum(&mut counts[..1]);
        if counts[0] == 0.0 {
            return None;
        }
        outer.retain(|&node| !at_bodies[node]);
        let search = HomeSearch {
            grid,
            full: &full,
            homes: Homes::of(grid, model.boundary.contact_faces()),
        };
        let ties = search.ties(outer, free, halo);
        let mut extension = Self {
            of_node: vec![0; grid.nodes()],
            ..Self::default()
        };
        extension.published = ties.iter().filter(|tie| tie.is_published).count();
        for (place, tie) in ties.iter().enumerate() {
            let Some(node) = tie.node else { continue };
            extension.of_node[node] = place as u32 + 1;
            (0..D)
                .filter(|&i| tie.tied[i])
                .for_each(|i| free[Nodal::<D>::at(node, i)] = false);
            counts[1] += f64::from(u8::from(halo.owned().contains(node)));
        }
        halo.all_reduce_sum(&mut counts[1..]);
        extension.ties = ties;
        extension.loose = (0..grid.nodes())
            .filter(|&node| is_outer[node] && !at_bodies[node] && extension.of_node[node] == 0)
            .collect();
        extension.tied = counts[1] as usize;
        extension.untied = (counts[0] - counts[1]) as usize;
        Some(extension)
    }

    /// Returns all ties that concern the window, ascending by number.
    pub fn ties(&self) -> &[Tie<D>] {
        &self.ties
    }

    /// Returns the tie of a node of the window.
    #[inline]
    pub fn tie_of(&self, node: usize) -> Option<&Tie<D>> {
        self.place_of(node).map(|place| &self.ties[place])
    }

    /// Returns the position in [`Extension::ties`] of the tie of a node of the window.
    #[inline]
    pub fn place_of(&self, node: usize) -> Option<usize> {
        self.of_node[node].checked_sub(1).map(|place| place as usize)
    }

    /// Returns the position in [`Extension::ties`] of the tie of a node, given by its number in the whole grid.
    pub fn place_of_number(&self, number: usize) -> Option<usize> {
        self.ties.binary_search_by_key(&number, |tie| tie.number).ok()
    }

    /// Returns whether a component (position in a nodal array) is tied.
    pub fn is_tied(&self, component: usize) -> bool {
        let (node, axis) = Nodal::<D>::split(component);
        self.tie_of(node).is_some_and(|tie| tie.tied[axis])
    }

    /// Returns whether any tie is published. Only then do ranks communicate here.
    pub fn is_published(&self) -> bool {
        self.published > 0
    }

    /// Sets the tied components of a nodal array, D numbers per node: u_J = E u_I. Valid at all nodes of the window.
    /// One gather if ties are published.
    pub fn extend(&self, grid: &Grid<D>, u: &mut [f64], halo: &dyn Halo) {
        let mut message = Vec::new();
        for tie in self.ties.iter().filter(|tie| grid.holds(&tie.home)) {
            let value = tie.value(u);
            if tie.is_published {
                message.push(tie.number as f64);
                message.extend_from_slice(&value);
            }
            tie.set(value, u);
        }
        if self.is_published() {
            let known = values_by_number::<D>(&halo.gather(&message), D);
            for tie in self.ties.iter().filter(|tie| tie.is_published) {
                tie.set(std::array::from_fn(|i| known[&tie.number][i]), u);
            }
        }
    }

    /// Sets outer splines without a home to zero in a nodal array of D numbers per node.
    pub fn drop_loose(&self, u: &mut [f64]) {
        self.loose.iter().for_each(|&node| u[Nodal::<D>::of(node)].fill(0.0));
    }

    /// Moves the forces of tied components to the splines of their homes: f_I + E^T f_J, in several nodal arrays of D
    /// numbers per node. Valid at all nodes of the window. One gather if ties are published.
    pub fn reduce(&self, forces: &mut [&mut [f64]], halo: &dyn Halo) {
        let width = forces.len() * D;
        let mut known = BTreeMap::new();
        if self.is_published() {
            let mut message = Vec::new();
            for tie in self.ties.iter().filter(|tie| tie.is_published) {
                let Some(node) = tie.node.filter(|&node| halo.owned().contains(node)) else {
                    continue;
                };
                message.push(tie.number as f64);
                forces
                    .iter()
                    .for_each(|force| message.extend_from_slice(&force[Nodal::<D>::of(node)]));
            }
            known = values_by_number::<D>(&halo.gather(&message), width);
        }
        for tie in &self.ties {
            let gathered = known.get(&tie.number);
            for (array, force) in forces.iter_mut().enumerate() {
                let own: [f64; D] = match (gathered, tie.node) {
                    (Some(gathered), _) => std::array::from_fn(|i| gathered[array * D + i]),
                    (None, Some(node)) => std::array::from_fn(|i| force[Nodal::<D>::at(node, i)]),
                    (None, None) => continue,
                };
                tie.move_force(own, force);
            }
        }
    }
}

impl<const D: usize> Tie<D> {
    /// Returns sum_i e_ij u_i; all splines of the home must be in the window.
    fn value(&self, u: &[f64]) -> [f64; D] {
        let mut value = [0.0; D];
        for (node, weight) in self.inner.iter().filter_map(|inner| Some((inner.node?, inner.weight))) {
            value
                .iter_mut()
                .zip(&u[Nodal::<D>::of(node)])
                .for_each(|(sum, u)| *sum += weight * u);
        }
        value
    }

    /// Sets the tied components, if the node is in the window.
    fn set(&self, value: [f64; D], u: &mut [f64]) {
        let Some(node) = self.node else { return };
        (0..D)
            .filter(|&i| self.tied[i])
            .for_each(|i| u[Nodal::<D>::at(node, i)] = value[i]);
    }

    /// Moves the tied components of a spline's force from its node to the splines of the home.
    fn move_force(&self, own: [f64; D], force: &mut [f64]) {
        for i in (0..D).filter(|&i| self.tied[i]) {
            if let Some(node) = self.node {
                force[Nodal::<D>::at(node, i)] = 0.0;
            }
            for (node, weight) in self.inner.iter().filter_map(|inner| Some((inner.node?, inner.weight))) {
                force[Nodal::<D>::at(node, i)] += weight * own[i];
            }
        }
    }
}

/// Returns `width` numbers of every tie in a message, by the number of its node.
fn values_by_number<const D: usize>(message: &[f64], width: usize) -> BTreeMap<usize, Vec<f64>> {
    message
        .chunks_exact(width + 1)
        .map(|item| (item[0] as usize, item[1..].to_vec()))
        .collect()
}

/// Marks the cells of the window that their points fill.
fn full_cells<K: Kinematics<D>, const D: usize>(grid: &Grid<D>, shape: &Shape<D>, points: &Points<D>) -> Vec<bool> {
    let mut full = vec![false; grid.cells()];
    for patch in shape.patches() {
        let volumes = patch
            .points
            .clone()
            .map(|p| points.volume[p] * points.F.at(p).determinant());
        let filled: f64 = volumes.sum();
        full[patch.cell] = filled >= FULL * grid.cell_volume::<K>(&grid.cell_at(patch.cell));
    }
    full
}

/// Marks the nodes of the window whose splines cover a full cell of any rank. One exchange with the neighbours.
fn inner_functions<const D: usize>(grid: &Grid<D>, shape: &Shape<D>, full: &[bool], halo: &dyn Halo) -> Vec<bool> {
    let mut marks = vec![0.0; grid.nodes()];
    for patch in shape.patches().iter().filter(|patch| full[patch.cell]) {
        shape
            .offsets()
            .iter()
            .for_each(|offset| marks[patch.first_node + offset] = 1.0);
    }
    halo.ghost_max(&mut marks, 1);
    marks.into_iter().map(|mark| mark > 0.0).collect()
}

/// Returns whether a tie of this node concerns this rank alone: the nodes of its home, the nodes that it couples with
/// in a matrix, and the homes of these.
fn is_surrounded_by_private_nodes<const D: usize>(grid: &Grid<D>, node: usize, halo: &dyn Halo) -> bool {
    let place = grid.node_at(node);
    let far = REACH + 2 * grid.order() + grid.beyond();
    let ends: [[usize; 2]; D] = std::array::from_fn(|axis| {
        let room = &grid.room()[axis];
        let last = room.end + grid.order() - 1;
        [
            place[axis].saturating_sub(far).max(room.start),
            (place[axis] + far).min(last),
        ]
    });
    // Private nodes form a box, so it suffices to test its corners.
    (0..1 << D).all(|corner: usize| {
        let corner: [usize; D] = std::array::from_fn(|axis| ends[axis][corner >> axis & 1]);
        grid.node_index(&corner).is_some_and(|node| halo.is_private(node))
    })
}

/// An outer spline that has no home yet.
#[derive(Clone, Copy, Debug)]
struct Candidate<const D: usize> {
    number: usize,
    tied: [bool; D],
}

impl<const D: usize> Candidate<D> {
    /// Creates the candidate of a node whose `free` components are to be tied.
    fn of(grid: &Grid<D>, node: usize, free: &[bool]) -> Self {
        Self {
            number: grid.number_of(node),
            tied: std::array::from_fn(|axis| free[Nodal::<D>::at(node, axis)]),
        }
    }
}

/// Returns cell number `at` of a box of cells, axis 0 slowest.
fn cell_within<const D: usize>(ranges: &[std::ops::Range<usize>; D], mut at: usize) -> [usize; D] {
    let mut cell = [0; D];
    for axis in (0..D).rev() {
        cell[axis] = ranges[axis].start + at % ranges[axis].len();
        at /= ranges[axis].len();
    }
    cell
}

/// Search for homes among the full cells of this rank.
struct HomeSearch<'a, const D: usize> {
    grid: &'a Grid<D>,
    full: &'a [bool],
    homes: Homes<D>,
}

impl<const D: usize> HomeSearch<'_, D> {
    /// Finds the nearest full cell of this rank that may be the spline's home.
    fn nearest(&self, number: usize) -> Option<Nearness> {
        let grid = self.grid;
        let place = self.grid.place_of_number(number);
        let ranges: [std::ops::Range<usize>; D] = std::array::from_fn(|axis| {
            let window = &grid.cells_along()[axis];
            let start = place[axis].saturating_sub(grid.order() + REACH).max(window.start);
            start..(place[axis] + REACH + 1).min(window.end).max(start)
        });
        let count: usize = ranges.iter().map(ExactSizeIterator::len).product();
        let cells = (0..count).map(|at| cell_within(&ranges, at));
        let homes = cells.filter(|cell| self.full[grid.cell_index(cell)]);
        homes
            .filter_map(|cell| self.homes.nearness(grid, &place, &cell))
            .min_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal))
    }

    /// Ties the `outer` nodes of all ranks that have homes; ascending by number.
    fn ties(&self, outer: Vec<usize>, free: &[bool], halo: &dyn Halo) -> Vec<Tie<D>> {
        let (own, shared): (Vec<usize>, Vec<usize>) = outer
            .into_iter()
            .partition(|&node| is_surrounded_by_private_nodes(self.grid, node, halo));
        let own = own.into_iter().map(|node| Candidate::of(self.grid, node, free));
        let shared = shared.into_iter().map(|node| Candidate::of(self.grid, node, free));
        let mut ties: Vec<Tie<D>> = own.filter_map(|candidate| self.tie(candidate)).collect();
        ties.extend(self.published_ties(&shared.collect::<Vec<_>>(), halo));
        ties.sort_by_key(|tie| tie.number);
        ties
    }

    /// Ties a spline whose surroundings belong to this rank alone, if there is a home.
    fn tie(&self, outer: Candidate<D>) -> Option<Tie<D>> {
        self.nearest(outer.number)
            .map(|nearest| self.tied_to(outer, nearest, false))
    }

    /// Ties splines that several ranks see. Every rank sends its candidates to all ranks, then its best home for each
    /// of all candidates.
    fn published_ties(&self, own: &[Candidate<D>], halo: &dyn Halo) -> Vec<Tie<D>> {
        let mut message = Vec::with_capacity(own.len() * 2);
        for candidate in own {
            let tied: usize = (0..D).map(|axis| usize::from(candidate.tied[axis]) << axis).sum();
            message.extend([candidate.number as f64, tied as f64]);
        }
        let all: Vec<Candidate<D>> = halo
            .gather(&message)
            .chunks_exact(2)
            .map(|item| Candidate {
                number: item[0] as usize,
                tied: std::array::from_fn(|axis| item[1] as usize >> axis & 1 == 1),
            })
            .collect();
        if all.is_empty() {
            return Vec::new();
        }
        message.clear();
        for candidate in &all {
            let Some(nearest) = self.nearest(candidate.number) else {
                continue;
            };
            let Nearness {
                beyond_line,
                apart,
                off_centre,
                cell,
            } = nearest;
            message.extend([candidate.number as f64, beyond_line, apart, off_centre, cell]);
        }
        let mut nearest: BTreeMap<usize, Nearness> = BTreeMap::new();
        for item in halo.gather(&message).chunks_exact(5) {
            let other = Nearness {
                beyond_line: item[1],
                apart: item[2],
                off_centre: item[3],
                cell: item[4],
            };
            let known = nearest.entry(item[0] as usize).or_insert(other);
            if other < *known {
                *known = other;
            }
        }
        all.into_iter()
            .filter_map(|candidate| Some(self.tied_to(candidate, *nearest.get(&candidate.number)?, true)))
            .collect()
    }

    fn tied_to(&self, outer: Candidate<D>, nearest: Nearness, is_published: bool) -> Tie<D> {
        let grid = self.grid;
        let place = grid.place_of_number(outer.number);
        let home = self.cell_of_number(nearest.cell as usize);
        let along: [Vec<f64>; D] = std::array::from_fn(|axis| weights(&grid.axes()[axis], place[axis], home[axis]));
        let mut inner = Vec::new();
        for function in grid.functions_of(home) {
            let weight: f64 = (0..D).map(|axis| along[axis][function[axis] - home[axis]]).product();
            if weight != 0.0 {
                let number = (0..D).fold(0, |number, axis| {
                    number * grid.axes()[axis].functions() + function[axis]
                });
                inner.push(InnerFunction {
                    number,
                    node: grid.node_index(&function),
                    weight,
                });
            }
        }
        Tie {
            number: outer.number,
            node: grid.node_index(&place),
            tied: outer.tied,
            is_published,
            home,
            inner,
        }
    }

    /// Returns the cell along each axis from its number in the whole grid.
    fn cell_of_number(&self, mut number: usize) -> [usize; D] {
        let mut cell = [0; D];
        for axis in (0..D).rev() {
            let cells = self.grid.axes()[axis].cells();
            cell[axis] = number % cells;
            number /= cells;
        }
        cell
    }
}
