//! The quantity that `bsmpm fos` determines: factor of safety or seismic coefficient.

use bsmpm_scene::Case;
use bsmpm_scene::words::{Geometry, Side};
use clap::ValueEnum;
use serde::Serialize;

/// The factor, or coefficient, of the body that shows the elastic displacement: its materials follow their elastic
/// laws, without strength that could limit the stress.
pub(super) const ELASTIC: f64 = 0.0;
/// The least factor that a case may have.
pub(super) const LEAST: f64 = 0.1;

/// Where the inertia of an earthquake pushes the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PushedSide {
    /// Towards the lowest x
    Left,
    /// Towards the highest x
    Right,
    /// Towards the lowest y (3-D)
    Front,
    /// Towards the highest y (3-D)
    Back,
}

/// By what the trials of a search differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Sought {
    /// By the factor that divides the strength.
    FactorOfSafety,
    /// By the horizontal acceleration over the vertical one.
    SeismicCoefficient(PushedSide),
}

impl PushedSide {
    fn side(self) -> Side {
        match self {
            Self::Left => Side::Left,
            Self::Right => Side::Right,
            Self::Front => Side::Front,
            Self::Back => Side::Back,
        }
    }

    /// The axis of a geometry along which it pushes, and the sign; none where the geometry has no such side.
    fn direction(self, geometry: Geometry) -> Option<(usize, f64)> {
        let horizontal = Side::of(geometry).split_last()?.1;
        let axis = horizontal.iter().position(|sides| sides.contains(&self.side()))?;
        let is_lower = horizontal[axis][0] == self.side();
        Some((axis, if is_lower { -1.0 } else { 1.0 }))
    }
}

impl Sought {
    /// What is found, in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::FactorOfSafety => "factor of safety",
            Self::SeismicCoefficient(_) => "critical seismic coefficient",
        }
    }

    /// The same at the beginning of a title.
    pub fn title(self) -> &'static str {
        match self {
            Self::FactorOfSafety => "Factor of safety",
            Self::SeismicCoefficient(_) => "Critical seismic coefficient",
        }
    }

    /// What a trial has, in words.
    pub fn value(self) -> &'static str {
        match self {
            Self::FactorOfSafety => "factor",
            Self::SeismicCoefficient(_) => "coefficient",
        }
    }

    /// The label of the axis of the chart.
    pub fn label(self) -> &'static str {
        match self {
            Self::FactorOfSafety => "Strength reduction factor",
            Self::SeismicCoefficient(_) => "Horizontal seismic coefficient",
        }
    }

    pub fn is_seismic(self) -> bool {
        self != Self::FactorOfSafety
    }

    /// The range in which it is searched, and the width of its bands.
    pub fn range(self) -> ([f64; 2], f64) {
        match self {
            Self::FactorOfSafety => ([0.5, 3.0], 0.02),
            Self::SeismicCoefficient(_) => ([0.02, 1.0], 0.01),
        }
    }

    /// Why a case has none, beyond the reasons that hold for both.
    pub fn refusal(self, case: &Case) -> Option<String> {
        let Self::SeismicCoefficient(pushed) = self else {
            return None;
        };
        let Some(gravity) = &case.gravity else {
            let reason =
                "E0824: the seismic coefficient is a fraction of gravity, and the case has no gravity. Add [gravity].";
            return Some(reason.to_owned());
        };
        let dims = case.grid.dims();
        let is_straight = gravity.acceleration[..dims - 1].iter().all(|part| *part == 0.0);
        if !is_straight || gravity.acceleration[dims - 1] >= 0.0 {
            let reason = "E0824: gravity.acceleration must act vertically downwards, because --seismic adds the \
                          horizontal component. Give a negative vertical component and zeros otherwise.";
            return Some(reason.to_owned());
        }
        if case.geometry == Geometry::Axisymmetric || pushed.direction(case.geometry).is_none() {
            let side = pushed.side();
            return Some(format!(
                "E0825: --seismic {side} is not possible in this geometry. Use `left` or `right` in plane strain, and \
                 also `front` or `back` in 3-D."
            ));
        }
        None
    }

    /// The overrides of the trial of a value, whose Young's moduli are multiplied by `stiffness`.
    pub fn overrides(self, case: &Case, value: f64, stiffness: f64) -> Vec<String> {
        match self {
            Self::FactorOfSafety => reduction(value.max(LEAST), value == ELASTIC, stiffness),
            Self::SeismicCoefficient(_) => {
                let trial = reduction(1.0, value == ELASTIC, stiffness);
                trial.into_iter().chain([self.inclination(case, value)]).collect()
            }
        }
    }

    /// Those of the elastic body under the inertia of a coefficient.
    pub fn pushed_elastic(self, case: &Case, coefficient: f64, stiffness: f64) -> Vec<String> {
        reduction(1.0, true, stiffness)
            .into_iter()
            .chain([self.inclination(case, coefficient)])
            .collect()
    }

    /// Gravity with a horizontal part of `coefficient` times the vertical one.
    fn inclination(self, case: &Case, coefficient: f64) -> String {
        let mut acceleration = case.gravity.as_ref().map_or([0.0; 3], |gravity| gravity.acceleration);
        let dims = case.grid.dims();
        if let Self::SeismicCoefficient(pushed) = self
            && let Some((axis, sign)) = pushed.direction(case.geometry)
        {
            acceleration[axis] = sign * coefficient * acceleration[dims - 1].abs();
        }
        format!("gravity.acceleration={:?}", &acceleration[..dims])
    }
}

fn reduction(factor: f64, is_elastic: bool, stiffness: f64) -> Vec<String> {
    let elastic = is_elastic.then(|| "strength_reduction.elastic=true".to_owned());
    let stiffened = (stiffness != 1.0).then(|| format!("strength_reduction.stiffness={stiffness:?}"));
    [format!("strength_reduction.factor={factor:?}")]
        .into_iter()
        .chain(elastic)
        .chain(stiffened)
        .collect()
}
