//! Methods against volumetric locking and stress oscillation (chapter 3 of the theory manual). All except `None` are
//! F-bar methods (T3.1) to (T3.3). Averages do not mix materials of different stiffness ([`Groups`]).

use std::ops::Range;

/// The method that a run uses; see the table of chapter 3 of the theory manual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stabilisation {
    /// The plain B-spline method.
    #[default]
    None,
    /// dJ averaged over the grid every iteration: ratio = S(dJ)/dJ (Eqs 15-18).
    FBar,
    /// The total J averaged: ratio = R(t+dt)/R(t) with R = S(J)/J, 1 at the start; the baseline of the paper, a reading
    /// of Zhao, Jiang and Choo (2022).
    FBarZhao,
    /// The paper's method: dJ averaged, and b^e averaged after every step (T3.5). Results depend on the number of
    /// steps.
    ModifiedFBar,
    /// ratio = S1(dJ)/dJ (T3.4), S1 with the splines of degree q - 1, and a filter of the elastic dilation (T3.7) that
    /// acts with plastic flow only: results converge in the step size. In dilatant material its force is the adjoint
    /// of its stress, see `step::adjoint`.
    ConsistentFBar,
    /// Consistent F-bar whose S1 has the splines of degree q - 1 on pairs of cells inside a body, and on the cells at
    /// its edges (sub-grid method of Bressan and Sangalli, 2013; see
    /// [`grid::shape::merged`](crate::grid::shape::merged)).
    SubgridFBar,
}

/// Which materials an average over the grid may mix; by default all.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    of: Vec<u16>, // per material; empty: one group
    count: usize, // of groups, if there are several
}

impl Groups {
    /// Materials that are alike in everything that averages feel are one group, under the number of the first of them.
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

    /// Number of groups.
    pub fn count(&self) -> usize {
        self.count.max(1)
    }

    /// Group of a material.
    #[inline]
    pub fn of(&self, material: u16) -> usize {
        self.of
            .get(usize::from(material))
            .map_or(0, |&group| usize::from(group))
    }
}

/// Points in groups, whose nodal values stand side by side: numbers of group g at place g of a node.
#[derive(Clone, Copy)]
pub struct GroupedPoints<'a> {
    by: Option<(&'a Groups, &'a [u16])>, // with the materials of the points; several groups
}

impl<'a> GroupedPoints<'a> {
    /// All points in one group.
    pub const NOT: Self = Self { by: None };

    /// Points of these materials.
    pub fn by(groups: &'a Groups, material: &'a [u16]) -> Self {
        Self {
            by: (groups.count() > 1).then_some((groups, material)),
        }
    }

    /// Number of groups.
    pub fn count(&self) -> usize {
        self.by.map_or(1, |(groups, _)| groups.count())
    }

    /// Group of point `p`.
    #[inline]
    pub fn of(&self, p: usize) -> usize {
        self.by.map_or(0, |(groups, material)| groups.of(material[p]))
    }

    /// Points of a patch in runs of one group, each with its group.
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
    /// Layers of nodes that its stiffness needs beyond those of the cells of a window of splines of the `order`, see
    /// [`Grid::reaching`](crate::grid::Grid::reaching): the functions of degree q - 1 span q cells, or as many pairs.
    pub fn beyond(self, order: usize) -> usize {
        match self {
            Self::ConsistentFBar => order - 1,
            Self::SubgridFBar => 2 * order - 1,
            Self::None | Self::FBar | Self::FBarZhao | Self::ModifiedFBar => 0,
        }
    }

    /// Whether the elastic strain is smoothed after a step.
    pub fn smooths(self) -> bool {
        self.lowers() || self == Self::ModifiedFBar
    }

    /// Whether dilations are averaged by splines of degree q - 1, and the elastic dilation is filtered where material
    /// flows.
    pub fn lowers(self) -> bool {
        self == Self::ConsistentFBar || self == Self::SubgridFBar
    }

    /// Whether dilations are averaged at all.
    pub fn averages(self) -> bool {
        self != Self::None
    }
}
