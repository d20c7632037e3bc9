//! Stiffness and strength that vary linearly with the initial depth of a point.

use super::law::MOST_PARAMETERS;
use super::{Elastic, Material, MaterialError, Response};
use crate::tensor::Symmetric;
use std::ops::Range;

/// Parameter that grows linearly with depth: `value + per_metre (at - y)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Value at the height `at`, in the unit of the parameter.
    pub value: f64,
    /// Height from the lower corner of the grid (m).
    pub at: f64,
    /// Growth per metre of depth.
    pub per_metre: f64,
}

impl Profile {
    /// Creates a constant profile.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            at: 0.0,
            per_metre: 0.0,
        }
    }

    /// Returns the parameter at a height (m from the lower corner of the grid).
    #[inline]
    pub fn at(&self, height: f64) -> f64 {
        self.value + self.per_metre * (self.at - height)
    }

    /// Returns the smallest and the largest value between two heights.
    pub fn bounds(&self, heights: &Range<f64>) -> (f64, f64) {
        let a = self.at(heights.start);
        let b = self.at(heights.end);
        (a.min(b), a.max(b))
    }
}

/// Law with parameters that depend on the height.
#[derive(Clone, Debug, PartialEq)]
pub struct GradedLaw {
    young: Profile,
    stiffest: Elastic,
    parameters: Vec<Profile>,
    law: Box<Material>,
    reduction: f64,
}

impl GradedLaw {
    /// Creates the `law` with profiles of Young's modulus (Pa) and of its parameters, for points placed at `heights` (m
    /// from the lower corner of the grid). The strength is divided by `reduction` (section 3.2 of the paper).
    pub fn new(law: &Material, young: Profile, parameters: Vec<Profile>, heights: Range<f64>, reduction: f64) -> Self {
        let stiffest = Elastic {
            young: young.bounds(&heights).1,
            ..law.elastic().clone()
        };
        let most: Vec<f64> = parameters
            .iter()
            .map(|parameter| parameter.bounds(&heights).1)
            .collect();
        Self {
            young,
            law: Box::new(law.with_parameters(stiffest.clone(), &most)),
            stiffest,
            parameters,
            reduction,
        }
    }

    /// Returns the law for a step of length `dt` (s); `None` if the law does not depend on it.
    pub(super) fn with_time_step(&self, dt: f64) -> Option<Self> {
        Some(Self {
            law: Box::new(self.law.with_time_step(dt)?),
            ..self.clone()
        })
    }

    /// Returns the law with its strength divided by a further `factor`.
    pub(super) fn reduced(self, factor: f64) -> Self {
        Self {
            reduction: self.reduction * factor,
            ..self
        }
    }

    /// Returns the elastic part where it is stiffest.
    pub fn stiffest(&self) -> &Elastic {
        &self.stiffest
    }

    /// Returns Young's modulus at a height, relative to the largest one.
    #[inline]
    pub fn relative_stiffness(&self, height: f64) -> f64 {
        self.young.at(height) / self.stiffest.young
    }

    /// Returns the law with the largest value of each parameter.
    pub(super) fn most(&self) -> &Material {
        &self.law
    }

    /// Computes the response of a point that was placed at a height (m), see [`Material::respond`].
    #[inline(never)]
    pub fn respond(&self, height: f64, b_trial: &Symmetric, state: &[f64]) -> Result<Response, MaterialError> {
        self.at(height).respond(b_trial, state)
    }

    /// Returns the law at a height.
    pub fn at(&self, height: f64) -> Material {
        let elastic = Elastic {
            young: self.young.at(height),
            ..self.stiffest
        };
        let mut parameters = [0.0; MOST_PARAMETERS];
        for (parameter, profile) in parameters.iter_mut().zip(&self.parameters) {
            *parameter = profile.at(height);
        }
        self.law
            .with_parameters(elastic, &parameters[..self.parameters.len()])
            .reduced(self.reduction)
    }
}
