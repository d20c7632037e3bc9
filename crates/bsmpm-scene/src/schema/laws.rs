//! Constitutive laws in the case file: the name of each law, its keys, and its conversion to a Rust type.

use super::MaterialTable;
use bsmpm::material::Strength;
use bsmpm::material::{
    CamClay, CutOff, Decay, DruckerPrager, Elastic, Hencky, Match, Material, MohrCoulomb, MuI, Rate, Separation,
    SofteningMohrCoulomb, TensileStrength, VonMises,
};

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

    /// The law with the choices of its table; its numbers are those of the elastic part only.
    pub(crate) fn chosen(self, record: &MaterialTable, elastic: Elastic) -> Material {
        match self {
            Self::Hencky => Material::Hencky(Hencky { elastic }),
            Self::MohrCoulomb | Self::Tresca => {
                let separation = record.separation.get().unwrap_or_default();
                let law = MohrCoulomb::new(elastic, 0.0, 0.0, 0.0).separating(separation);
                match tension(record) {
                    Some(tension) => Material::MohrCoulombCutOff(CutOff::new(law, tension)),
                    None => Material::MohrCoulomb(law),
                }
            }
            Self::DruckerPrager => {
                let fit = record.fit.get().unwrap_or_default();
                let law = DruckerPrager::new(elastic, 0.0, 0.0, 0.0, fit);
                match tension(record) {
                    Some(tension) => Material::DruckerPragerCutOff(CutOff::new(law, tension)),
                    None => Material::DruckerPrager(law),
                }
            }
            Self::SensitiveClay => {
                let none = Strength::default();
                let law = SofteningMohrCoulomb::new(elastic, none, none, 1.0, Decay::Exponential);
                let rate = record.rate_parameter.get().zip(record.reference_rate.get());
                let rate = rate.map(|(per_decade, reference)| Rate { per_decade, reference });
                Material::SofteningMohrCoulomb(match rate {
                    Some(rate) => law.at_rate(rate),
                    None => law,
                })
            }
            Self::CamClay => Material::CamClay(CamClay::new(elastic, [0.0; 5])),
            Self::MuI => Material::MuI(MuI::new(elastic, [0.0; 5])),
            Self::VonMises => {
                let law = VonMises::new(elastic, 0.0, 0.0);
                match tension(record) {
                    Some(tension) => Material::VonMisesCutOff(CutOff::new(law, tension)),
                    None => Material::VonMises(law),
                }
            }
            Self::Softening => {
                let decay = record.softening.get().unwrap_or_default();
                let none = Strength::default();
                Material::SofteningMohrCoulomb(SofteningMohrCoulomb::new(elastic, none, none, 1.0, decay))
            }
        }
    }
}

/// The choices of the tension cut-off of a material, without its numbers; `None` without a cut-off.
fn tension(record: &MaterialTable) -> Option<TensileStrength> {
    record.tensile_strength.is_given().then(|| TensileStrength {
        strength: 0.0,
        strain: 0.0,
        decay: record.softening.get().unwrap_or_default(),
        is_reduced: record.reduce_tensile_strength.get().unwrap_or(false),
    })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document;
    use crate::record::{self, CaseTable};
    use crate::report::Report;
    use crate::source::Source;
    use crate::words::Word;

    #[test]
    fn every_parameter_of_a_law_is_a_key_of_the_material() {
        let source = Source::new("case", "");
        let mut report = Report::new(&source, &[]);
        let document = document::parse(&source, &mut report);
        let material = MaterialTable::from_record(record::read(MaterialTable::TABLE, &document, &mut report));
        let laws = LawName::WORDS.words().filter_map(LawName::of);
        let mut names: Vec<&str> = laws.flat_map(|law| [law.keys().0, law.keys().1].concat()).collect();
        names.sort_unstable();
        names.dedup();
        let keys = material.law_keys().map(|key| key.place().name());
        assert_eq!(names, keys);
    }
}
