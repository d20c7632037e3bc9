//! Dense granular flow μ(I), theory-manual equations (T4.17), (T4.18): a cone at constant volume, whose friction
//! coefficient μ increases with the inertial number I.

use super::law::{Branch, Law, Projection, Variable, joined, split};
use super::{Elastic, Moduli};
use crate::real::{Real, choose, three};
use crate::tensor::Tensor;
use std::f64::consts::SQRT_2;

/// Law with the elastic domain `√J₂ - μ_s p ≤ 0`, without tensile strength.
#[derive(Clone, Debug, PartialEq)]
pub struct MuI {
    elastic: Elastic,
    parameters: [f64; 5], // μ_s, μ_2, I_0, d (m), ρ_s (kg/m3)
    moduli: Moduli,
    quickness: f64, // d √ρ_s/Δt (√Pa), the ratio of I √p to the plastic shear of a step; 0 outside of a step
}

/// Return data.
#[derive(Clone, Copy, Debug)]
pub struct MuIReturn<R: Real> {
    /// Whether the stress returned to the apex; the other data are then meaningless.
    apex: R::Mask,
    /// Principal deviator of the trial divided by its norm (-).
    direction: [R; 3],
    /// Ratio of √J₂ after the return to that of the trial (-).
    kept: R,
    /// Derivatives of the reduction of √J₂ with respect to √J₂ and the pressure of the trial (-).
    rates: [R; 2],
}

impl MuI {
    /// Creates a law from `[μ_s, μ_2, I_0, d, ρ_s]`: 0 ≤ μ_s ≤ μ_2, the others positive; d in m, ρ_s in kg/m3.
    pub fn new(elastic: Elastic, parameters: [f64; 5]) -> Self {
        let moduli = elastic.moduli();
        Self {
            elastic,
            parameters,
            moduli,
            quickness: 0.0,
        }
    }

    /// Returns the plastic shear γ of a return from √J₂ = T > μ_s p at the pressure p > 0, and its derivatives with
    /// respect to T and p. It is the root of `(T - G γ)(I_0 √p + k γ) = p (μ_s I_0 √p + μ_2 k γ)`, with the quickness
    /// k.
    #[inline(always)]
    fn sheared<R: Real>(&self, root: R, pressure: R) -> (R, [R; 2]) {
        let [mu_s, mu_2, i_0, ..] = self.parameters;
        let mu = self.moduli.mu;
        let quick = self.quickness;
        let slow = pressure.root() * i_0;
        // Quadratic equation G k γ² + (G I_0 √p + (μ_2 p - T) k) γ - I_0 √p (T - μ_s p) = 0, from the definition of γ.
        let over = root - pressure * mu_s;
        let linear = slow * mu + (pressure * mu_2 - root) * quick;
        let square = mu * quick;
        let constant = slow * over;
        let discriminant = (linear * linear + constant * (4.0 * square)).root();
        // Of the two forms of the root, the one without cancellation is used.
        let falls = linear.below(linear.like(0.0));
        let denominator = R::choose(falls, linear.like(2.0 * square), linear + discriminant);
        let numerator = R::choose(falls, discriminant - linear, constant * 2.0);
        let gamma = numerator / denominator;
        let with_root = (gamma * quick + slow) / discriminant;
        let with_pressure =
            (slow / (pressure * 2.0)) * (root - pressure * (3.0 * mu_s) - gamma * mu) - gamma * (quick * mu_2);
        (gamma, [with_root, with_pressure / discriminant])
    }
}

impl Law for MuI {
    type Flow<R: Real> = MuIReturn<R>;
    const PARAMETERS: &'static [Variable] = &[
        Variable::new("mu_s", "-"),
        Variable::new("mu_2", "-"),
        Variable::new("inertial_number", "-"),
        Variable::new("grain_diameter", "m"),
        Variable::new("grain_density", "kg/m3"),
    ];

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        self.parameters.to_vec()
    }

    /// Returns the law with other parameters; μ_2 is raised to at least μ_s.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let mut own: [f64; 5] = std::array::from_fn(|k| parameters[k]);
        own[1] = own[1].max(own[0]);
        Self {
            quickness: self.quickness,
            ..Self::new(elastic, own)
        }
    }

    fn with_time_step(&self, dt: f64) -> Option<Self> {
        let [.., diameter, density] = self.parameters;
        Some(Self {
            quickness: diameter * density.sqrt() / dt,
            ..self.clone()
        })
    }

    /// Returns `f = √J₂ - μ_s p`.
    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], _state: &[R]) -> R {
        let (mean, _, norm) = split(tau);
        norm / SQRT_2 + mean * self.parameters[0]
    }

    /// Returns the stress along the deviator at constant pressure; without pressure to the apex, τ = 0.
    #[inline(always)]
    fn return_map<R: Real>(&self, trial: [R; 3], _state: &[R]) -> Projection<R, MuIReturn<R>> {
        let (mean, deviator, norm) = split(trial);
        let root = norm / SQRT_2;
        let pressure = -mean;
        let zero = mean.like(0.0);
        let yields = !(root + mean * self.parameters[0]).at_most(zero);
        let apex = pressure.at_most(zero);
        let (gamma, rates) = self.sheared(root, pressure);
        let kept = -(gamma * self.moduli.mu / root) + 1.0;
        let mu = self.moduli.mu;
        let returned = choose(apex, [zero; 3], joined(mean, kept, deviator));
        let tau = choose(yields, returned, trial);
        let flow = MuIReturn {
            apex,
            direction: three(|k| deviator[k] / norm),
            kept,
            rates: [rates[0] * mu, rates[1] * mu],
        };
        Projection { tau, yields, flow }
    }

    #[inline]
    fn branch(flow: &MuIReturn<f64>) -> Branch {
        if flow.apex { Branch::Apex } else { Branch::Face }
    }

    /// Returns the tangent; with the direction n, the ratio r of √J₂, and the derivatives a, b of its reduction with
    /// respect to T and p it is `2μ r (I₄ - ⅓ I ⊗ I) + 2μ (1 - r - a) n ⊗ n + √2 K b n ⊗ I + K I ⊗ I`; 0 at the apex.
    fn tangent(flow: &MuIReturn<f64>, moduli: Moduli) -> Tensor {
        let MuIReturn {
            apex,
            direction: n,
            kept,
            rates: [with_root, with_pressure],
        } = *flow;
        if apex {
            return Tensor::zeros();
        }
        let mu = moduli.mu;
        let bulk = moduli.bulk();
        Tensor::from_fn(|a, b| {
            let deviator = if a == b { 2.0 / 3.0 } else { -1.0 / 3.0 };
            2.0 * mu * (kept * deviator + (1.0 - kept - with_root) * n[a] * n[b])
                + SQRT_2 * bulk * with_pressure * n[a]
                + bulk
        })
    }

    /// Returns 2μ r: the return scales all stress differences equally.
    fn secant_modulus(flow: &MuIReturn<f64>, moduli: Moduli, _tau: f64, _eps: f64) -> f64 {
        if flow.apex { 0.0 } else { 2.0 * moduli.mu * flow.kept }
    }

    fn reduced(self, factor: f64) -> Self {
        let [mu_s, mu_2, rest @ ..] = self.parameters;
        let [i_0, diameter, density] = rest;
        let parameters = [mu_s / factor, mu_2 / factor, i_0, diameter, density];
        Self { parameters, ..self }
    }
}
