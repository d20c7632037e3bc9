//! Constitutive laws in the case file: the name of each law, and its keys.

use bsmpm::material::{Decay, Match, Separation};

choice! {
    /// Constitutive law.
    pub enum LawName {
        /// Elastic at finite strain (Hencky).
        Hencky = "elastic",
        /// Mohr-Coulomb: linear elastic, perfectly plastic, with friction, cohesion and dilation.
        MohrCoulomb = "mohr-coulomb",
        /// Tresca: undrained shear strength without friction.
        Tresca = "tresca",
        /// Drucker-Prager: a cone that is fitted to Mohr-Coulomb.
        DruckerPrager = "drucker-prager",
        /// Von Mises with linear hardening.
        VonMises = "von-mises",
        /// Mohr-Coulomb with softening: the strength decreases with the plastic strain to residual values.
        Softening = "mohr-coulomb-softening",
        /// Undrained clay with softening. The strength decreases with the plastic shear strain, and can increase with
        /// the strain rate.
        SensitiveClay = "sensitive-clay",
        /// Modified Cam-clay: stiffness and strength depend on the effective stress and on the preconsolidation.
        CamClay = "modified-cam-clay",
        /// Dense granular flow with the mu(I) rheology: friction grows with the shear strain rate.
        MuI = "mu-i",
    } misnomers [
        "hardening-soil": "E0012: this model is not available. Use \"mohr-coulomb\", or \"modified-cam-clay\" for soft clay.",
        "hs-small": "E0012: this model is not available. Use \"mohr-coulomb\", or \"modified-cam-clay\" for soft clay.",
        "soft-soil": "E0012: this model is not available. Use \"modified-cam-clay\".",
        "cam-clay": "E0012: this model is not available. Use \"modified-cam-clay\".",
        "hoek-brown": "E0012: this model is not available. Use \"mohr-coulomb\" with the cohesion and friction angle \
                       for the stress level of the problem.",
        "hypoplastic": "E0012: this model is not available. Use \"mohr-coulomb-softening\".",
        "hypoplasticity": "E0012: this model is not available. Use \"mohr-coulomb-softening\".",
        "linear-elastic": "Use \"elastic\"",
        "linear_elastic": "Use \"elastic\"",
        "neo-hookean": "E0012: this model is not available. Use \"elastic\"."
    ] earlier ["hencky": "elastic"]
}

impl LawName {
    /// Whether its stress is limited.
    pub(crate) fn is_plastic(self) -> bool {
        match self {
            Self::Hencky => false,
            Self::MohrCoulomb | Self::Tresca | Self::DruckerPrager | Self::VonMises => true,
            Self::Softening | Self::SensitiveClay | Self::CamClay | Self::MuI => true,
        }
    }

    /// Its keys besides the elastic ones: those that it needs, and others that it knows.
    pub(crate) fn keys(self) -> (&'static [&'static str], &'static [&'static str]) {
        match self {
            Self::Hencky => (&[], &[]),
            Self::Tresca => (
                &["cohesion"],
                &[
                    "tensile_strength",
                    "crack_opening",
                    "softening",
                    "reduce_tensile_strength",
                ],
            ),
            Self::MohrCoulomb => (
                &["friction_angle", "cohesion"],
                &[
                    "dilation_angle",
                    "separation",
                    "ocr",
                    "tensile_strength",
                    "crack_opening",
                    "softening",
                    "reduce_tensile_strength",
                ],
            ),
            Self::DruckerPrager => (
                &["friction_angle", "cohesion"],
                &[
                    "dilation_angle",
                    "fit",
                    "ocr",
                    "tensile_strength",
                    "crack_opening",
                    "softening",
                    "reduce_tensile_strength",
                ],
            ),
            Self::VonMises => (
                &["yield_stress"],
                &[
                    "hardening",
                    "tensile_strength",
                    "crack_opening",
                    "softening",
                    "reduce_tensile_strength",
                ],
            ),
            Self::SensitiveClay => (
                &["cohesion", "sensitivity", "softening_strain"],
                &["band_width", "rate_parameter", "reference_rate"],
            ),
            Self::CamClay => (
                &["critical_state_ratio"],
                &[
                    "kappa_star",
                    "lambda_star",
                    "kappa",
                    "lambda",
                    "void_ratio",
                    "preconsolidation",
                    "ocr",
                ],
            ),
            Self::MuI => (
                &["mu_s", "mu_2", "inertial_number", "grain_diameter", "grain_density"],
                &[],
            ),
            Self::Softening => (
                &[
                    "friction_angle",
                    "cohesion",
                    "residual_friction_angle",
                    "residual_cohesion",
                    "softening_strain",
                ],
                &[
                    "dilation_angle",
                    "residual_dilation_angle",
                    "softening",
                    "band_width",
                    "ocr",
                ],
            ),
        }
    }
}

words! { Separation {
    Forgotten = "plastic": "The volume increase is a plastic strain.",
    Closing = "gap": "The volume increase is a gap. The soil carries pressure again after the gap has closed.",
} earlier ["forgotten": "plastic", "closing": "gap"] }

words! { Decay {
    Linear = "linear": "The strength decreases linearly, until the plastic strain is softening_strain.",
    Exponential = "exponential": "The strength decreases exponentially, with 95 % of the loss at softening_strain.",
} }

words! { Match {
    Outer = "outer": "Equal strength in triaxial compression. Elsewhere drucker-prager is stronger.",
    Inner = "inner": "Equal strength in triaxial extension. In compression drucker-prager is weaker.",
    PlaneStrain = "plane-strain": "Equal strength in plane strain if ψ = φ'. With less dilation drucker-prager is weaker.",
} }
