//! Methods against volumetric locking and stress oscillation (chapter 3 of the theory manual). All except `None` are
//! F-bar methods (T3.1) to (T3.3). Averages do not mix materials of different stiffness ([`Groups`]).

use std::ops::Range;

/// Method against volumetric locking; see the table of chapter 3 of the theory manual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stabilisation {
    /// B-spline method without F-bar.
    #[default]
    None,
    /// F-bar with dJ averaged over the grid in every iteration: ratio = S(dJ)/dJ (Eqs 15-18).
    FBar,
    /// Method of the paper: dJ is averaged, and b^e after every step (T3.5). Results depend on the number of steps.
    ModifiedFBar,
    /// F-bar with ratio = S1(dJ)/dJ (T3.4), where S1 uses splines of degree q - 1, and a filter of the elastic dilation
    /// (T3.7) that acts only during plastic flow. Results converge with the step size. In dilatant material the
    /// internal force is the adjoint of the stress, see `step::adjoint`.
    ConsistentFBar,
    /// Consistent F-bar with S1 on pairs of cells inside a body and on single cells at its edges (sub-grid method of
    /// Bressan and Sangalli, 2013; see [`grid::shape::merged`](crate::grid::shape::merged)).
    SubgridFBar,
}

/// Groups of materials that averages over the grid may mix; by default one group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    of: Vec<u16>, // per material; empty for one group
    count: usize, // number of groups, if there are several
}

impl Groups {
    /// Groups materials that are equal in everything that affects averages; groups are numbered in the order of their
    /// first material.
    pub fn of_alike<T: PartialEq>(materials: &[T]) -> Self {
        let mut kinds: Vec<&T> = Vec::new();
        let mut of = Vec::with_capacity(materials.len());
        for material in materials {
            let known = kinds.iter().position(|kind| *kind == material);
            of.push(known.unwrap_or(kinds.len()) as u16);
            if known.is_none() {
                kinds.push(material);
            }
        }
        if kinds.len() > 1 {
            Self { of, count: kinds.len() }
        } else {
            Self::default()
        }
    }

    /// Returns the number of groups.
    pub fn count(&self) -> usize {
        self.count.max(1)
    }

    /// Returns the group of a material.
    #[inline]
    pub fn of(&self, material: u16) -> usize {
        self.of
            .get(usize::from(material))
            .map_or(0, |&group| usize::from(group))
    }
}

/// Points in groups. Nodal values of the groups are adjacent: those of group g have index g at a node.
#[derive(Clone, Copy)]
pub struct GroupedPoints<'a> {
    by: Option<(&'a Groups, &'a [u16])>, // with the materials of the points; several groups
}

impl<'a> GroupedPoints<'a> {
    /// All points in one group.
    pub const ONE_GROUP: Self = Self { by: None };

    /// Assigns points with the materials `material` to the groups.
    pub fn by(groups: &'a Groups, material: &'a [u16]) -> Self {
        Self {
            by: (groups.count() > 1).then_some((groups, material)),
        }
    }

    /// Returns the number of groups.
    pub fn count(&self) -> usize {
        self.by.map_or(1, |(groups, _)| groups.count())
    }

    /// Returns the group of point `p`.
    #[inline]
    pub fn of(&self, p: usize) -> usize {
        self.by.map_or(0, |(groups, material)| groups.of(material[p]))
    }

    /// Returns the points of a cell as runs of one group each, with the group.
    #[inline]
    pub(crate) fn runs(&self, points: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
        let mut start = points.start;
        std::iter::from_fn(move || {
            let first = start;
            let group = (first < points.end).then(|| self.of(first))?;
            let change = self.by.and_then(|_| (first..points.end).find(|&p| self.of(p) != group));
            start = change.unwrap_or(points.end);
            Some((group, first..start))
        })
    }
}

impl Stabilisation {
    /// Returns the layers of nodes that the stiffness needs beyond those of the cells of a window, for splines of the
    /// given `order`, see [`Grid::reaching`](crate::grid::Grid::reaching). Functions of degree q - 1 span q cells, or q
    /// pairs of cells.
    pub fn beyond(self, order: usize) -> usize {
        match self {
            Self::ConsistentFBar => order - 1,
            Self::SubgridFBar => 2 * order - 1,
            Self::None | Self::FBar | Self::ModifiedFBar => 0,
        }
    }

    /// Returns whether the elastic strain is smoothed after a step.
    pub fn smooths(self) -> bool {
        self.lowers() || self == Self::ModifiedFBar
    }

    /// Returns whether dilations are averaged by splines of degree q - 1, and the elastic dilation is filtered during
    /// plastic flow.
    pub fn lowers(self) -> bool {
        self == Self::ConsistentFBar || self == Self::SubgridFBar
    }

    /// Returns whether dilations are averaged.
    pub fn averages(self) -> bool {
        self != Self::None
    }
}
