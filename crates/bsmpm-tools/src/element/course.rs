//! Computes a laboratory test step by step.

use std::fmt::Write;

use bsmpm::element::{Control, Element, ElementError, Target};
use bsmpm::material::split;
use bsmpm::tensor::Symmetric;
use bsmpm_scene::{Case, ElementTest};

use crate::Error;

/// What a test left.
pub(super) struct StressPath {
    pub name: String,
    /// name of its material
    pub material: String,
    /// whether it shears along x
    pub is_sheared: bool,
    pub is_undrained: bool,
    /// names and units of the law's state variables
    state: Vec<(&'static str, &'static str)>,
    /// the start first
    pub rows: Vec<PathRow>,
    /// why it ended before its end
    pub failure: Option<String>,
}

/// The point after a step.
pub(super) struct PathRow {
    /// from 1; 0 is the start
    stage: usize,
    /// logarithmic, positive in extension, and the shear
    pub strain: [f64; 4],
    /// Pa  effective Cauchy stress
    sigma: Symmetric,
    /// Pa  mean, positive in compression
    pub pressure: f64,
    /// Pa  `√(3/2) |dev σ|`
    pub deviator: f64,
    /// Pa
    pub pore_pressure: f64,
    plastic_strain: f64,
    state: Vec<f64>,
}

impl PathRow {
    fn of(stage: usize, point: &Element) -> Self {
        let sigma = point.sigma();
        let principal = sigma.full().symmetric_eigenvalues();
        let (mean, _, norm) = split([principal[0], principal[1], principal[2]]);
        Self {
            stage,
            strain: point.strain(),
            sigma,
            pressure: -mean,
            deviator: 1.5_f64.sqrt() * norm,
            pore_pressure: point.pore_pressure(),
            plastic_strain: point.plastic_strain(),
            state: point.state().to_vec(),
        }
    }

    /// Logarithm of the volume.
    pub fn volume_strain(&self) -> f64 {
        self.strain[0] + self.strain[1] + self.strain[2]
    }
}

impl StressPath {
    /// Follows a test of a case.
    ///
    /// # Errors
    /// [`Error::Element`] where its material cannot have the stress at the start.
    pub fn of(case: &Case, test: &ElementTest) -> Result<Self, Error> {
        let named = &case.materials[test.material];
        let law = named.material.at(test.height.unwrap_or(0.0)).into_owned();
        let vertical = -test.pressure;
        let lateral = -test.k0 * test.pressure;
        let sigma = Symmetric([lateral, vertical, lateral, 0.0, 0.0, 0.0]);
        let state = law
            .state()
            .iter()
            .map(|variable| (variable.name, variable.unit))
            .collect();
        let point = Element::new(law, sigma);
        let mut point = point.map_err(|error: ElementError| Error::Element {
            failed: vec![format!("{}: {error}", test.name)],
        })?;
        let mut course = Self {
            name: test.name.clone(),
            material: named.name.clone(),
            is_sheared: false,
            is_undrained: test.stages.iter().any(|stage| stage.undrained),
            state,
            rows: vec![PathRow::of(0, &point)],
            failure: None,
        };
        for (number, stage) in test.stages.iter().enumerate() {
            let targets = std::array::from_fn(|k| stage.targets[k].unwrap_or_else(|| Target::Stress(point.total(k))));
            course.is_sheared |= targets[3] != Target::Strain(0.0);
            let control = Control {
                targets,
                undrained: stage.undrained,
                steps: stage.steps,
                duration: stage.duration,
            };
            let followed = point.follow(&control, |point| course.rows.push(PathRow::of(number + 1, point)));
            if let Err(error) = followed {
                course.failure = Some(format!("stage {}: {error}", number + 1));
                break;
            }
        }
        Ok(course)
    }

    /// The row of the largest deviator.
    pub fn peak(&self) -> &PathRow {
        let largest = self.rows.iter().max_by(|a, b| a.deviator.total_cmp(&b.deviator));
        largest.unwrap_or(&self.rows[0])
    }

    /// The row of the end.
    pub fn last(&self) -> &PathRow {
        &self.rows[self.rows.len() - 1]
    }

    /// Its table, with names and units above, in the form of a history.
    pub fn csv(&self) -> String {
        let fixed = "step,stage,strain-xx,strain-yy,strain-zz,shear-xy,volume-strain,stress-xx,stress-yy,stress-zz,stress-xy,\
                     pressure,deviator,pore-pressure,plastic-strain";
        let units = "-,-,-,-,-,-,-,Pa,Pa,Pa,Pa,Pa,Pa,Pa,-";
        let mut state_names = String::new();
        let mut state_units = String::new();
        for (name, unit) in &self.state {
            state_names += &format!(",{name}");
            state_units += &format!(",{unit}");
        }
        let mut text = format!("{fixed}{state_names}\n# {units}{state_units}\n");
        for (step, row) in self.rows.iter().enumerate() {
            let [xx, yy, zz, xy, ..] = row.sigma.0;
            let [x, y, z, shear] = row.strain;
            let invariants = [row.pressure, row.deviator, row.pore_pressure, row.plastic_strain];
            let _ = write!(text, "{step},{}", row.stage);
            let numbers = [x, y, z, shear, row.volume_strain(), xx, yy, zz, xy];
            for number in numbers.iter().chain(&invariants).chain(&row.state) {
                // Adding zero turns a minus zero into zero.
                let _ = write!(text, ",{:?}", number + 0.0);
            }
            text.push('\n');
        }
        text
    }
}
