//! Options of the nonlinear solution: methods and convergence criteria (chapter 5 of the theory manual).

/// Method of the equilibrium iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Nonlinear {
    /// Quasi-Newton method with all recent secants, followed by Newton's method if it stalls.
    #[default]
    Auto,
    /// One quasi-Newton method up to the limit of iterations.
    QuasiNewton(QuasiNewton),
    /// Newton's method from the start.
    Newton,
}

/// Method that gave the direction of one iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Quasi-Newton method with the stiffness at the initial state.
    QuasiNewton(QuasiNewton),
    /// Newton's method with the consistent tangent.
    Newton,
}

/// Correction of the stiffness K_0 from iteration to iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum QuasiNewton {
    /// Least-squares fit of all recent secants (Anderson, 1965).
    #[default]
    Multisecant,
    /// Rank-one update of the paper (Broyden, 1965).
    Broyden,
}

/// Convergence criteria of a step. Both residuals must be below their tolerances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Tolerance of the energy residual |du_k . f_k| / |du_0 . f_0| (step 9 of the paper).
    pub energy: f64,
    /// Tolerance of the force residual |f_oob| / max(|f_ext|, |f_int|, |M a|, |reaction|), which is needed because the
    /// energy product is no norm. It is evaluated for all nodes, and for the nodes of each material alone.
    pub force: f64,
    /// Limit of quasi-Newton iterations of one attempt.
    pub max_iterations: usize,
}

impl Criteria {
    /// Formats both residuals with their tolerances, the force residual with the number of its material.
    pub fn judged(&self, energy: f64, force: f64, material: Option<usize>) -> String {
        let of = material.map_or_else(String::new, |material| format!(" of material {material}"));
        format!(
            "energy residual {}, force residual{of} {}",
            against(energy, self.energy),
            against(force, self.force)
        )
    }

    /// Returns the tolerance of the water residual |R| / max(storage, flow, water through surfaces).
    pub fn second_field(&self) -> f64 {
        WATER.min(self.force)
    }

    /// Formats the water residual with its tolerance, as a continuation of [`Criteria::judged`].
    pub fn judged_water(&self, water: f64) -> String {
        format!(", water residual {}", against(water, self.second_field()))
    }
}

/// Largest tolerance of the water residual; the tolerance of forces applies if it is smaller.
const WATER: f64 = 1e-4;

fn against(measure: f64, tolerance: f64) -> String {
    format!("{measure:.1e} (tolerance {tolerance:e})")
}
