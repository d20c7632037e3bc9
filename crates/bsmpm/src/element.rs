//! Element test (`bsmpm element`): one material point follows a path of strains and stresses, without inertia and
//! F-bar.
//!
//! The deformation gradient is `F = [[a, γ b, 0], [0, b, 0], [0, 0, c]]` with stretches a, b, c and shear γ. Each of ln
//! a, ln b, ln c and γ is given, or follows from a given Cauchy stress. Undrained tests have constant volume.

use crate::initial;
use crate::material::{Branch, Material, MaterialError, Response, Separation};
use crate::tensor::{Symmetric, Tensor};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Driven components xx, yy, zz and xy, the first ones of a [`Symmetric`].
pub const COMPONENTS: usize = 4;
/// Largest number of iterations of a step.
const ITERATIONS: usize = 60;
/// Largest number of halvings of a correction that does not reduce the residual.
const HALVINGS: usize = 12;
/// Smallest fraction of a step that is tried.
const SMALLEST: f64 = 1.0 / 1024.0;
/// Tolerances of prescribed stresses, relative to the largest stress and to Young's modulus, which limits the accuracy.
const BALANCED: [f64; 2] = [1e-11, 1e-14];
/// Singular values below this fraction of the largest are treated as zero. At an edge of the yield surface two
/// directions are equivalent, and the smallest correction uses both equally.
const SINGULAR: f64 = 1e-10;
/// Plastic strain below which a state is considered on the yield surface, except for round-off.
const AT_YIELD: f64 = 1e-9;

/// Prescribed value of a component at the end of a stage; it is approached linearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Growth of the logarithmic strain in the stage, positive in extension, or of the shear γ (-).
    Strain(f64),
    /// Total Cauchy stress at the end, positive in tension (Pa).
    Stress(f64),
}

/// Stage of a loading path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Targets of xx, yy, zz and the shear.
    pub targets: [Target; COMPONENTS],
    /// Whether the volume is constant and prescribed stresses are total stresses.
    pub undrained: bool,
    /// Number of equal steps.
    pub steps: u64,
    /// Duration for rate-dependent strength (s); infinite for quasi-static loading.
    pub duration: f64,
}

impl Control {
    /// Returns the targets after the fraction `share` of the stage, from the values at its `start`.
    fn wanted(&self, start: &[f64; COMPONENTS], share: f64) -> [Target; COMPONENTS] {
        std::array::from_fn(|k| match self.targets[k] {
            Target::Strain(growth) => Target::Strain(start[k] + share * growth),
            Target::Stress(end) => Target::Stress(start[k] + share * (end - start[k])),
        })
    }
}

/// Reason why a path cannot start, or cannot be completed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ElementError {
    /// The initial stress exceeds the strength of the material.
    #[error(
        "the initial stress exceeds the strength: plastic strain of {0:.1e} at the start. Change `k0` or the strength."
    )]
    BeyondYield(f64),
    /// The initial stress is not compressive, but the stiffness of the material depends on pressure.
    #[error("the stiffness of this model follows the stress, and the initial stress is 0. Give `pressure`.")]
    NoPressure,
    /// The law has no response to the initial state.
    #[error("the material has no stress at the start: {0}")]
    Start(MaterialError),
    /// No state of the material carries the prescribed stress.
    #[error("the material cannot carry the prescribed stress: {:.2} % of the stage was reached; {reason}", 100.0 * done)]
    NoEquilibrium {
        /// Fraction of the stage that was reached.
        done: f64,
        /// Result of the last attempt.
        reason: String,
    },
}

/// Material point in a converged state.
#[derive(Clone, Debug)]
pub struct Element {
    law: Material,
    b_e: Symmetric,
    state: Vec<f64>,
    gap: f64,
    strain: [f64; COMPONENTS],
    /// Effective Cauchy stress (Pa).
    sigma: Symmetric,
    pore_pressure: f64,
    plastic_strain: f64,
}

/// Trial strain and its response.
struct Attempt {
    strain: [f64; COMPONENTS],
    pore_pressure: f64,
    response: Response,
    /// Effective Cauchy stress (Pa).
    sigma: Symmetric,
    /// Residual in the order of the unknowns.
    residual: DVector<f64>,
}

impl Element {
    /// Creates a point of `law` under the Cauchy stress `sigma` (Pa).
    ///
    /// # Errors
    /// If the material cannot have that stress.
    pub fn new(law: Material, sigma: Symmetric) -> Result<Self, ElementError> {
        let mut state = vec![0.0; law.state().len()];
        let b_e = initial::b_e_of(&law, &sigma, &mut state);
        if !law.is_linear() && b_e.0.iter().any(|component| !component.is_finite()) {
            return Err(ElementError::NoPressure);
        }
        let response = law.respond(&b_e, &state).map_err(ElementError::Start)?;
        if response.branch() != Branch::Elastic && response.plastic_increment() > AT_YIELD {
            return Err(ElementError::BeyondYield(response.plastic_increment()));
        }
        Ok(Self {
            law,
            b_e,
            state,
            gap: 0.0,
            strain: [0.0; 4],
            sigma,
            pore_pressure: 0.0,
            plastic_strain: 0.0,
        })
    }

    /// Returns the logarithmic strains along x, y and z since the start, positive in extension, and the shear γ.
    pub fn strain(&self) -> [f64; COMPONENTS] {
        self.strain
    }

    /// Returns the volumetric (logarithmic) strain since the start.
    pub fn volume_strain(&self) -> f64 {
        self.strain[0] + self.strain[1] + self.strain[2]
    }

    /// Returns the effective Cauchy stress (Pa).
    pub fn sigma(&self) -> Symmetric {
        self.sigma
    }

    /// Returns the pore pressure since the start (Pa); 0 for drained paths.
    pub fn pore_pressure(&self) -> f64 {
        self.pore_pressure
    }

    /// Returns the state variables of the law, in their order.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Returns the accumulated plastic strain.
    pub fn plastic_strain(&self) -> f64 {
        self.plastic_strain
    }

    /// Returns the total stress of a component (Pa).
    pub fn total(&self, component: usize) -> f64 {
        total(&self.sigma, self.pore_pressure, component)
    }

    /// Follows a stage of the path and calls `each` after every step.
    ///
    /// # Errors
    /// If no state carries the prescribed stress; the point keeps the last converged state.
    pub fn follow(&mut self, control: &Control, mut each: impl FnMut(&Self)) -> Result<(), ElementError> {
        let start: [f64; COMPONENTS] = std::array::from_fn(|k| match control.targets[k] {
            Target::Strain(_) => self.strain[k],
            Target::Stress(_) => self.total(k),
        });
        let volume = self.volume_strain();
        let own = self.law.clone();
        for step in 0..control.steps {
            let mut done = 0.0_f64;
            let mut part = 1.0_f64;
            while done < 1.0 {
                let share = (step as f64 + (done + part).min(1.0)) / control.steps as f64;
                let undrained = control.undrained.then_some(volume);
                self.law = own
                    .with_time_step(part * control.duration / control.steps as f64)
                    .unwrap_or_else(|| own.clone());
                match self.solve(&control.wanted(&start, share), undrained) {
                    Ok(found) => {
                        self.accept(found);
                        done += part;
                    }
                    Err(_) if part > SMALLEST => part *= 0.5,
                    Err(reason) => {
                        let done = (step as f64 + done) / control.steps as f64;
                        return Err(ElementError::NoEquilibrium { done, reason });
                    }
                }
            }
            each(self);
        }
        Ok(())
    }

    fn accept(&mut self, found: Attempt) {
        let Attempt {
            strain,
            pore_pressure,
            response,
            sigma,
            ..
        } = found;
        response.advance(&mut self.state);
        self.b_e = response.b_e();
        self.gap = if self.law.separation() == Separation::Closing {
            response.gap()
        } else {
            0.0
        };
        self.plastic_strain += response.plastic_increment();
        (self.strain, self.pore_pressure, self.sigma) = (strain, pore_pressure, sigma);
    }

    /// Solves for the unknown strains and pore pressure by Newton's method with step halving. `undrained` is the
    /// constant volumetric strain.
    fn solve(&self, wanted: &[Target; COMPONENTS], undrained: Option<f64>) -> Result<Attempt, String> {
        let free: Vec<usize> = (0..COMPONENTS)
            .filter(|&k| matches!(wanted[k], Target::Stress(_)))
            .collect();
        let mut strain = self.strain;
        for (strain, target) in strain.iter_mut().zip(wanted) {
            if let Target::Strain(given) = target {
                *strain = *given;
            }
        }
        let young = self.law.elastic().young;
        let mut now = self.attempt(strain, self.pore_pressure, wanted, &free, undrained)?;
        for _ in 0..ITERATIONS {
            let size = (0..COMPONENTS)
                .map(|k| total(&now.sigma, now.pore_pressure, k).abs())
                .fold(0.0, f64::max);
            let size = size.max(now.sigma.0.iter().fold(0.0, |most: f64, s| most.max(s.abs())));
            if now.residual.amax() * young <= BALANCED[0] * size + BALANCED[1] * young {
                return Ok(now);
            }
            let by = self
                .correction(&now, &free, undrained.is_some())
                .ok_or("the stiffness is not finite")?;
            let mut length = 1.0;
            now = loop {
                let mut strain = now.strain;
                free.iter()
                    .enumerate()
                    .for_each(|(row, &k)| strain[k] += length * by[row]);
                let pore = if undrained.is_some() {
                    length * young * by[free.len()]
                } else {
                    0.0
                };
                match self.attempt(strain, now.pore_pressure + pore, wanted, &free, undrained) {
                    Ok(next) if next.residual.norm() < now.residual.norm() => break next,
                    _ if length * 2_f64.powi(HALVINGS as i32) <= 1.0 => return Err(not_carried(&now, &free, wanted)),
                    _ => length *= 0.5,
                }
            };
        }
        Err(not_carried(&now, &free, wanted))
    }

    fn attempt(
        &self,
        strain: [f64; COMPONENTS],
        pore_pressure: f64,
        wanted: &[Target; COMPONENTS],
        free: &[usize],
        undrained: Option<f64>,
    ) -> Result<Attempt, String> {
        let before = deformation(&self.strain)
            .try_inverse()
            .ok_or("the point has no volume")?;
        let step = deformation(&strain) * before;
        let b_trial = Symmetric::of(&(step * self.b_e.full() * step.transpose())).scaled((2.0 / 3.0 * self.gap).exp());
        let response = self
            .law
            .respond(&b_trial, &self.state)
            .map_err(|error| error.to_string())?;
        let sigma = response.tau().scaled((-(strain[0] + strain[1] + strain[2])).exp());
        let young = self.law.elastic().young;
        let mut residual: Vec<f64> = Vec::with_capacity(COMPONENTS + 1);
        for &k in free {
            let Target::Stress(given) = wanted[k] else { continue };
            residual.push((total(&sigma, pore_pressure, k) - given) / young);
        }
        residual.extend(undrained.map(|volume| strain[0] + strain[1] + strain[2] - volume));
        let residual = DVector::from_vec(residual);
        if residual.iter().any(|number| !number.is_finite()) {
            return Err("the stress is not finite".to_owned());
        }
        Ok(Attempt {
            strain,
            pore_pressure,
            response,
            sigma,
            residual,
        })
    }

    /// Returns the smallest correction of the unknown strains, and of the pore pressure divided by Young's modulus,
    /// from the consistent tangent `dσ = dτ/J - σ tr l`.
    fn correction(&self, now: &Attempt, free: &[usize], undrained: bool) -> Option<DVector<f64>> {
        let size = now.residual.len();
        let young = self.law.elastic().young;
        let volume = (now.strain[0] + now.strain[1] + now.strain[2]).exp();
        let mut jacobian = DMatrix::zeros(size, size);
        for (column, &k) in free.iter().enumerate() {
            let l = velocity(now.strain[3], k);
            let change = Symmetric::of(&now.response.linearise(&l)).scaled(1.0 / volume);
            for (row, &i) in free.iter().enumerate() {
                jacobian[(row, column)] = (change.0[i] - now.sigma.0[i] * l.trace()) / young;
            }
            if undrained {
                jacobian[(size - 1, column)] = l.trace();
                jacobian[(column, size - 1)] = if k < 3 { -1.0 } else { 0.0 };
            }
        }
        if jacobian.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let svd = jacobian.svd(true, true);
        let least = SINGULAR * svd.singular_values.amax();
        svd.solve(&-&now.residual, least).ok()
    }
}

/// Formats the prescribed stresses that were not reached.
fn not_carried(now: &Attempt, free: &[usize], wanted: &[Target; COMPONENTS]) -> String {
    let found = free.iter().filter_map(|&k| {
        let Target::Stress(given) = wanted[k] else { return None };
        let name = ["xx", "yy", "zz", "xy"][k];
        let stress = total(&now.sigma, now.pore_pressure, k);
        Some(format!("stress-{name} is {stress:.6e} Pa for {given:.6e} Pa"))
    });
    found.collect::<Vec<_>>().join(", ")
}

/// Returns a component of the total stress (Pa).
fn total(sigma: &Symmetric, pore_pressure: f64, component: usize) -> f64 {
    sigma.0[component] - if component < 3 { pore_pressure } else { 0.0 }
}

/// Returns F for a strain.
fn deformation(strain: &[f64; COMPONENTS]) -> Tensor {
    let [x, y, z] = [0, 1, 2].map(|k| strain[k].exp());
    Tensor::new(x, strain[3] * y, 0.0, 0.0, y, 0.0, 0.0, 0.0, z)
}

/// Returns `∂F/∂ε_k F⁻¹` for the component k at the shear γ.
fn velocity(shear: f64, component: usize) -> Tensor {
    match component {
        0 => Tensor::new(1.0, -shear, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        1 => Tensor::new(0.0, shear, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0),
        2 => Tensor::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        _ => Tensor::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    }
}
