//! Stiffness and strength that vary linearly with depth (layers of one material, section 3.2's soils in the field).
//!
//! A point keeps the parameters of the height at which it was placed: they follow the material, not the place.

use super::law::{Law, Separation, Variable};
use super::{Elastic, Hencky, Material, MaterialError, MohrCoulomb, Response};
use crate::tensor::Symmetric;
use std::ops::Range;

/// A parameter that grows linearly downwards: `value + per_metre (at - y)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// the parameter at the height `at`, in its own unit
    pub value: f64,
    /// m  height from the grid's lower corner
    pub at: f64,
    /// growth per metre of depth
    pub per_metre: f64,
}

impl Profile {
    /// The same everywhere.
    pub fn constant(value: f64) -> Self {
        Self { value, at: 0.0, per_metre: 0.0 }
    }

    /// The parameter at a height, m from the grid's lower corner.
    #[inline]
    pub fn at(&self, height: f64) -> f64 {
        self.value + self.per_metre * (self.at - height)
    }

    /// Its smallest and largest value between two heights.
    pub fn bounds(&self, heights: &Range<f64>) -> (f64, f64) {
        let (a, b) = (self.at(heights.start), self.at(heights.end));
        (a.min(b), a.max(b))
    }
}

/// Mohr-Coulomb strength by height.
#[derive(Clone, Debug, PartialEq)]
pub struct GradedStrength {
    /// rad  friction angle
    pub friction: Profile,
    /// rad  dilation angle; where the friction angle is smaller, that
    pub dilation: f64,
    /// Pa  cohesion
    pub cohesion: Profile,
    /// -  strength reduction factor (section 3.2); 1: none
    pub reduction: f64,
    /// what becomes of the volume that opens at the apex
    pub separation: Separation,
}

/// An elastic or Mohr-Coulomb material whose parameters depend on the height.
#[derive(Clone, Debug, PartialEq)]
pub struct Graded {
    young: Profile,
    stiffest: Elastic,
    strength: Option<GradedStrength>,
}

impl Graded {
    /// A material between two heights (m from the grid's lower corner), elastic without `strength`.
    pub fn new(young: Profile, poisson: f64, strength: Option<GradedStrength>, heights: Range<f64>) -> Self {
        let stiffest = Elastic { young: young.bounds(&heights).1, poisson };
        Self { young, stiffest, strength }
    }

    /// The elastic part where it is stiffest.
    pub fn stiffest(&self) -> &Elastic {
        &self.stiffest
    }

    /// Young's modulus at a height over the largest one.
    #[inline]
    pub fn relative_stiffness(&self, height: f64) -> f64 {
        self.young.at(height) / self.stiffest.young
    }

    /// What becomes of the volume that opens at the apex.
    pub(super) fn separation(&self) -> Separation {
        self.strength.as_ref().map_or(Separation::Forgotten, |strength| strength.separation)
    }

    /// Dilation angle, rad; elastic material has none.
    pub(super) fn dilation(&self) -> f64 {
        self.strength.as_ref().map_or(0.0, |strength| strength.dilation)
    }

    /// The response of a point that was placed at a height, m; see [`Material::respond`].
    #[inline(never)]
    pub fn respond(&self, height: f64, b_trial: &Symmetric, state: &[f64]) -> Result<Response, MaterialError> {
        self.at(height).respond(b_trial, state)
    }

    /// State variables of its points.
    pub(super) fn state(&self) -> &'static [Variable] {
        if self.strength.is_some() { MohrCoulomb::STATE } else { Hencky::STATE }
    }

    /// The law at a height.
    pub fn at(&self, height: f64) -> Material {
        let elastic = Elastic { young: self.young.at(height), poisson: self.stiffest.poisson };
        match &self.strength {
            None => Material::Hencky(Hencky { elastic }),
            Some(strength) => {
                let law = MohrCoulomb::new(
                    elastic,
                    strength.friction.at(height),
                    strength.dilation.min(strength.friction.at(height)),
                    strength.cohesion.at(height),
                );
                Material::MohrCoulomb(law.separating(strength.separation).reduced(strength.reduction))
            }
        }
    }
}
