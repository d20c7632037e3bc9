//! Material of a body: one law at all heights, or a law with parameters that depend on the height.

use super::{Elastic, GradedLaw, Material, Separation, Variable};
use std::borrow::Cow;

/// Material of the case.
#[derive(Clone, Debug, PartialEq)]
pub enum LayeredMaterial {
    /// Law with equal parameters at all heights.
    Uniform(Material),
    /// Law with parameters that depend on the height.
    Graded(GradedLaw),
}

impl From<Material> for LayeredMaterial {
    fn from(law: Material) -> Self {
        Self::Uniform(law)
    }
}

impl LayeredMaterial {
    /// Returns the law of a point that was placed at `height` (m from the lower corner of the grid).
    #[inline]
    pub fn at(&self, height: f64) -> Cow<'_, Material> {
        match self {
            Self::Uniform(law) => Cow::Borrowed(law),
            Self::Graded(law) => Cow::Owned(law.at(height)),
        }
    }

    /// Returns the law whose kind is that of all heights, with the largest value of each parameter.
    fn bound(&self) -> &Material {
        match self {
            Self::Uniform(law) => law,
            Self::Graded(law) => law.most(),
        }
    }

    /// Returns the elastic part where it is stiffest.
    pub fn elastic(&self) -> &Elastic {
        self.bound().elastic()
    }

    /// Returns Young's modulus at `height`, relative to that of [`LayeredMaterial::elastic`].
    #[inline]
    pub fn relative_stiffness(&self, height: f64) -> f64 {
        match self {
            Self::Uniform(_) => 1.0,
            Self::Graded(law) => law.relative_stiffness(height),
        }
    }

    /// Returns Young's modulus at a height (Pa).
    pub fn young_at(&self, height: f64) -> f64 {
        self.elastic().young * self.relative_stiffness(height)
    }

    /// Returns whether parameters depend on the height.
    pub fn is_graded(&self) -> bool {
        matches!(self, Self::Graded(_))
    }

    /// Returns the largest dilation angle (rad), of a graded law before strength reduction.
    pub fn dilation(&self) -> f64 {
        self.bound().dilation()
    }

    /// Returns the treatment of the volume that opens at the apex.
    pub fn separation(&self) -> Separation {
        self.bound().separation()
    }

    /// Returns whether the law limits the stress.
    pub fn yields(&self) -> bool {
        self.bound().yields()
    }

    /// Returns whether any part of the strength increases with plastic strain.
    pub fn hardens(&self) -> bool {
        self.bound().hardens()
    }

    /// Returns whether the strength changes with plastic strain.
    pub fn softens(&self) -> bool {
        self.bound().softens()
    }

    /// Returns whether elastic stress is linear in strain, so that a stress-free state exists.
    pub fn is_linear(&self) -> bool {
        self.bound().is_linear()
    }

    /// Returns the state variables of a point.
    pub fn state(&self) -> &'static [Variable] {
        self.bound().state()
    }

    /// Returns names and units of the parameters besides the elastic ones.
    pub fn parameter_names(&self) -> &'static [Variable] {
        self.bound().parameter_names()
    }

    /// Returns the largest value of each parameter, in the order of their names; of a graded law before strength
    /// reduction.
    pub fn parameters(&self) -> Vec<f64> {
        self.bound().parameters()
    }

    /// Returns the material for a step of length `dt` (s); `None` if the law does not depend on it.
    pub fn with_time_step(&self, dt: f64) -> Option<Self> {
        match self {
            Self::Uniform(law) => law.with_time_step(dt).map(Self::Uniform),
            Self::Graded(law) => law.with_time_step(dt).map(Self::Graded),
        }
    }

    /// Returns the material with its strength divided by `factor` (section 3.2 of the paper).
    pub fn reduced(self, factor: f64) -> Self {
        match self {
            Self::Uniform(law) => Self::Uniform(law.reduced(factor)),
            Self::Graded(law) => Self::Graded(law.reduced(factor)),
        }
    }
}

/// Returns the number of state variables that points of these materials store.
pub fn state_width<'a>(materials: impl IntoIterator<Item = &'a LayeredMaterial>) -> usize {
    materials
        .into_iter()
        .map(|material| material.state().len())
        .max()
        .unwrap_or(0)
}
