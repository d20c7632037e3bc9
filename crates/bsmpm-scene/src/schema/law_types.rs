//! Conversion of the choices of a material into the law of the physics.

use super::laws::LawName;
use super::material::MaterialTable;
use bsmpm::material::{
    CamClay, CutOff, Decay, DruckerPrager, Elastic, Hencky, Material, MohrCoulomb, MuI, Rate, SofteningMohrCoulomb,
    Strength, TensileStrength, VonMises,
};

impl LawName {
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
