//! Parameters of the law of a material, and the law that they make.

use super::Layer;
use crate::record::CaseTable;
use crate::schema::{Dimension, Kind, LawName, MaterialTable};
use bsmpm::material::{Elastic, GradedLaw, LayeredMaterial, Profile};

/// A law and its numbers, by the height in the case's coordinates and units.
pub(super) struct Parameters<'a> {
    pub(super) model: LawName,
    pub(super) values: Vec<KeyProfile<'a>>,
}

/// A parameter by the height, and its key.
pub(super) struct KeyProfile<'a> {
    pub(super) key: &'a str,
    pub(super) profile: Profile,
}

impl Parameters<'_> {
    /// What is left of them where no strength limits the stress.
    pub(super) fn elastic() -> Self {
        Self {
            model: LawName::Hencky,
            values: Vec::new(),
        }
    }

    fn is_graded(&self) -> bool {
        self.values.iter().any(|own| own.profile.per_metre != 0.0)
    }

    /// Replaces the values of a key by one constant.
    pub(super) fn set(&mut self, key: &str, value: f64) {
        let own = self.values.iter_mut().filter(|own| own.key == key);
        own.for_each(|own| own.profile = Profile::constant(value));
    }

    /// Its profile of a key, 0 of one that it has not.
    pub(super) fn of(&self, key: &str) -> Profile {
        let found = self.values.iter().find(|own| own.key == key);
        found.map_or(Profile::constant(0.0), |own| own.profile)
    }

    /// The material, its strength divided by `factor`.
    pub(super) fn material(
        &self,
        record: &MaterialTable,
        young: Profile,
        poisson: f64,
        layer: Option<&Layer>,
        factor: f64,
    ) -> Option<LayeredMaterial> {
        let law = self.model.chosen(
            record,
            Elastic {
                young: young.value,
                poisson,
            },
        );
        let ordered = law
            .parameter_names()
            .iter()
            .map(|parameter| in_si(parameter.name, self.of(parameter.name)));
        let parameters: Vec<Profile> = ordered.collect();
        if young.per_metre == 0.0 && !self.is_graded() {
            let values: Vec<f64> = parameters.iter().map(|parameter| parameter.value).collect();
            let law = law.with_parameters(law.elastic().clone(), &values);
            return Some(LayeredMaterial::Uniform(law.reduced(factor)));
        }
        let layer = layer?;
        let heights = layer.heights.start - layer.base..layer.heights.end - layer.base;
        let parameters = parameters
            .into_iter()
            .map(|profile| relative(profile, layer.base))
            .collect();
        Some(LayeredMaterial::Graded(GradedLaw::new(
            &law,
            relative(young, layer.base),
            parameters,
            heights,
            factor,
        )))
    }
}

/// A profile by the height above a base, m.
fn relative(profile: Profile, base: f64) -> Profile {
    Profile {
        at: profile.at - base,
        ..profile
    }
}

/// A parameter as laws take it: angles in rad.
fn in_si(key: &str, profile: Profile) -> Profile {
    match MaterialTable::TABLE.key(key).map(|key| &key.kind) {
        Some(Kind::Profile(Dimension::Angle, ..)) => Profile {
            value: profile.value.to_radians(),
            per_metre: profile.per_metre.to_radians(),
            ..profile
        },
        _ => profile,
    }
}
