//! Newmark time integration with optional numerical damping, theory-manual equations (T5.3) to (T5.5).

/// Parameters of the time integration; the paper uses α = 0, β = 1/4, γ = 1/2.
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
    /// Returns the WBZ-α method (Bossak): `α = (ρ - 1)/(ρ + 1)`, `γ = 1/2 - α`, `β = (1 - α)²/4`; second-order
    /// accurate, unconditionally stable. The spectral radius ρ at infinite frequency is in [0, 1]; 1 is bitwise the
    /// paper's method.
    pub fn of_spectral_radius(rho: f64) -> Self {
        let alpha = (rho - 1.0) / (rho + 1.0);
        Self {
            alpha,
            beta: 0.25 * (1.0 - alpha).powi(2),
            gamma: 0.5 - alpha,
        }
    }

    /// Returns Newmark's method with damping, γ in [1/2, 1]: `β = (γ + 1/2)²/4`, α = 0; first-order accurate unless γ =
    /// 1/2.
    pub fn of_gamma(gamma: f64) -> Self {
        Self {
            alpha: 0.0,
            beta: 0.25 * (gamma + 0.5).powi(2),
            gamma,
        }
    }

    /// Returns β = 1/2, γ = 1. Nothing depends on a at the start of the step, and a constant acceleration is exact. For
    /// the first step under a sudden force, where a = 0 of the points would delay the force by half a step. Starting
    /// from `M a = f` instead would make stiff parts oscillate in steps that do not resolve them; this method damps
    /// them.
    pub fn for_sudden_load() -> Self {
        Self {
            alpha: 0.0,
            beta: 0.5,
            gamma: 1.0,
        }
    }

    /// Returns β = γ = 1, with a = 0 at the start of the step: first-order accurate, and the velocity at the end is
    /// u/dt. Stopped material then rests; other parameters make it rebound.
    pub fn backward_euler() -> Self {
        Self {
            alpha: 0.0,
            beta: 1.0,
            gamma: 1.0,
        }
    }

    /// Returns the factor of u in a' (1/s2): `1/(β dt²)`.
    #[inline]
    fn stiffness(&self, dt: f64) -> f64 {
        1.0 / (self.beta * dt * dt)
    }

    /// Returns the acceleration a' at the end for a displacement u, from v and a at the start (m/s2; steps 5b, 10a).
    #[inline]
    pub fn acceleration(&self, dt: f64, u: f64, v: f64, a: f64) -> f64 {
        self.stiffness(dt) * u - 1.0 / (self.beta * dt) * v - (0.5 / self.beta - 1.0) * a
    }

    /// Returns the change of velocity from a and a' (m/s), `dt ((1 - γ) a + γ a')`.
    #[inline]
    pub fn gained(&self, dt: f64, a: f64, end: f64) -> f64 {
        (a * (1.0 - self.gamma) + end * self.gamma) * dt
    }

    /// Returns the acceleration in the balance of forces (m/s2), `(1 - α) a' + α a`.
    #[inline]
    pub fn acting(&self, a: f64, end: f64) -> f64 {
        (1.0 - self.alpha) * end + self.alpha * a
    }

    /// Returns the factor of the mass in the tangent of the out-of-balance force (1/s2): `(1 - α)/(β dt²)`.
    pub fn factor(&self, dt: f64) -> f64 {
        (1.0 - self.alpha) * self.stiffness(dt)
    }

    /// Returns the derivative of v' with respect to u (1/s): `γ/(β dt)`.
    pub fn velocity_factor(&self, dt: f64) -> f64 {
        self.gamma / (self.beta * dt)
    }

    /// Returns the factor of M v in the inertia (1/s): `(1 - α)/(β dt)`.
    pub fn pulse(&self, dt: f64) -> f64 {
        (1.0 - self.alpha) / (self.beta * dt)
    }
}
