//! Newmark time integration with optional numerical damping, theory-manual equations (T5.3) to (T5.5).

/// Parameters of the family; the paper's are α = 0, β = 1/4, γ = 1/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newmark {
    alpha: f64,
    beta: f64,
    gamma: f64,
}

impl Default for Newmark {
    fn default() -> Self {
        Self {
            alpha: 0.0,
            beta: 0.25,
            gamma: 0.5,
        }
    }
}

impl Newmark {
    /// WBZ-α (Bossak): `α = (ρ - 1)/(ρ + 1)`, `γ = 1/2 - α`, `β = (1 - α)²/4`; of second order, unconditionally stable.
    /// The spectral radius ρ at infinite frequency lies in [0, 1]; 1 is the paper's method to the bit.
    pub fn of_spectral_radius(rho: f64) -> Self {
        let alpha = (rho - 1.0) / (rho + 1.0);
        Self {
            alpha,
            beta: 0.25 * (1.0 - alpha).powi(2),
            gamma: 0.5 - alpha,
        }
    }

    /// Newmark's own damping, γ in [1/2, 1]: `β = (γ + 1/2)²/4`, α = 0; of first order unless γ = 1/2.
    pub fn of_gamma(gamma: f64) -> Self {
        Self {
            alpha: 0.0,
            beta: 0.25 * (gamma + 0.5).powi(2),
            gamma,
        }
    }

    /// β = 1/2, γ = 1: nothing depends on a at the start of the step, and a constant acceleration is exact. For a first
    /// step under a force that acts at once: the points' a = 0 there would let it come half a step late. `M a = f` at
    /// the start instead makes what is stiff swing about its equilibrium in steps that do not resolve it, where this
    /// one damps it.
    pub fn dissipative_first_step() -> Self {
        Self {
            alpha: 0.0,
            beta: 0.5,
            gamma: 1.0,
        }
    }

    /// β = γ = 1, with a = 0 at the start of the step: of first order, and the end's velocity is that of the step. What
    /// is stopped rests then, where the others throw it back.
    pub fn backward_euler() -> Self {
        Self {
            alpha: 0.0,
            beta: 1.0,
            gamma: 1.0,
        }
    }

    /// 1/s2  what multiplies u in a': `1/(β dt²)`.
    #[inline]
    fn stiffness(&self, dt: f64) -> f64 {
        1.0 / (self.beta * dt * dt)
    }

    /// m/s2  a' of a displacement u, from v and a at the start of the step (steps 5b, 10a).
    #[inline]
    pub fn acceleration(&self, dt: f64, u: f64, v: f64, a: f64) -> f64 {
        self.stiffness(dt) * u - 1.0 / (self.beta * dt) * v - (0.5 / self.beta - 1.0) * a
    }

    /// m/s  change of the velocity, `dt ((1 - γ) a + γ a')`, from a and a'.
    #[inline]
    pub fn gained(&self, dt: f64, a: f64, end: f64) -> f64 {
        (a * (1.0 - self.gamma) + end * self.gamma) * dt
    }

    /// m/s2  what the mass resists with, `(1 - α) a' + α a`, from a and a'.
    #[inline]
    pub fn acting(&self, a: f64, end: f64) -> f64 {
        (1.0 - self.alpha) * end + self.alpha * a
    }

    /// 1/s2  factor of the mass in the tangent of the out-of-balance force: `(1 - α)/(β dt²)`.
    pub fn factor(&self, dt: f64) -> f64 {
        (1.0 - self.alpha) * self.stiffness(dt)
    }

    /// 1/s  how v' changes with u: `γ/(β dt)`.
    pub fn velocity_factor(&self, dt: f64) -> f64 {
        self.gamma / (self.beta * dt)
    }

    /// 1/s  what multiplies M v in the inertia: `(1 - α)/(β dt)`.
    pub fn pulse(&self, dt: f64) -> f64 {
        (1.0 - self.alpha) / (self.beta * dt)
    }
}
