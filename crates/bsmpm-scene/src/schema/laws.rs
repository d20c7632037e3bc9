//! Constitutive laws in the language: a law's word, its keys, and what it is made of.

use super::Kind::{self, *};
use super::Presence::{Optional, Required};
use super::{Dimension as In, Range, Table, key, loads, one_of};
use crate::record::Record;
use crate::words::{Drainage, Word};
use bsmpm::material::{
    CamClay, Decay, DruckerPrager, Elastic, Hencky, Match, Material, MohrCoulomb, MuI, Rate, Separation,
    SofteningMohrCoulomb, VonMises,
};
use bsmpm::water::flow::PermeabilityLaw;
use std::ops::Bound::{Excluded, Included, Unbounded};

choice! {
    /// Constitutive law.
    pub enum LawName {
        /// Elastic at any strain.
        Hencky = "elastic",
        /// Elastic, perfectly plastic with friction, dilation and cohesion.
        MohrCoulomb = "mohr-coulomb",
        /// The same without friction.
        Tresca = "tresca",
        /// The same strength with a cone in the place of the pyramid.
        DruckerPrager = "drucker-prager",
        /// Elastic, plastic without friction, hardening linearly.
        VonMises = "von-mises",
        /// Mohr-Coulomb whose strength goes from a first to a last value with plastic strain.
        Softening = "mohr-coulomb-softening",
        /// Clay without drainage whose strength falls with plastic shear and grows with its rate.
        SensitiveClay = "sensitive-clay",
        /// Clay whose stiffness and strength come from the pressure that it has seen.
        CamClay = "modified-cam-clay",
        /// Dense granular flow whose friction grows with the rate of shear.
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
            Self::Tresca => (&["cohesion"], &[]),
            Self::MohrCoulomb => (&["friction_angle", "cohesion"], &["dilation_angle", "separation", "ocr"]),
            Self::DruckerPrager => (&["friction_angle", "cohesion"], &["dilation_angle", "fit", "ocr"]),
            Self::VonMises => (&["yield_stress"], &["hardening"]),
            Self::SensitiveClay => {
                (&["cohesion", "sensitivity", "softening_strain"], &["band_width", "rate_parameter", "reference_rate"])
            }
            Self::CamClay => (
                &["critical_state_ratio"],
                &["kappa_star", "lambda_star", "kappa", "lambda", "void_ratio", "preconsolidation", "ocr"],
            ),
            Self::MuI => (&["mu_s", "mu_2", "inertial_number", "grain_diameter", "grain_density"], &[]),
            Self::Softening => (
                &["friction_angle", "cohesion", "residual_friction_angle", "residual_cohesion", "softening_strain"],
                &["dilation_angle", "residual_dilation_angle", "softening", "band_width", "ocr"],
            ),
        }
    }

    /// The law with the choices of its table; its numbers are those of the elastic part only.
    pub(crate) fn chosen(self, record: &Record, elastic: Elastic) -> Material {
        match self {
            Self::Hencky => Material::Hencky(Hencky { elastic }),
            Self::MohrCoulomb | Self::Tresca => {
                let separation = record.word("separation").unwrap_or_default();
                Material::MohrCoulomb(MohrCoulomb::new(elastic, 0.0, 0.0, 0.0).separating(separation))
            }
            Self::DruckerPrager => {
                let fit = record.word("fit").unwrap_or_default();
                Material::DruckerPrager(DruckerPrager::new(elastic, (0.0, 0.0, 0.0), fit))
            }
            Self::SensitiveClay => {
                let none = (0.0, 0.0, 0.0);
                let law = SofteningMohrCoulomb::new(elastic, none, none, 1.0, Decay::Exponential);
                let rate = record.number("rate_parameter").zip(record.number("reference_rate"));
                let rate = rate.map(|(per_decade, reference)| Rate { per_decade, reference });
                Material::SofteningMohrCoulomb(match rate {
                    Some(rate) => law.at_rate(rate),
                    None => law,
                })
            }
            Self::CamClay => Material::CamClay(CamClay::new(elastic, [0.0; 5])),
            Self::MuI => Material::MuI(MuI::new(elastic, [0.0; 5])),
            Self::VonMises => Material::VonMises(VonMises::new(elastic, 0.0, 0.0)),
            Self::Softening => {
                let (decay, none) = (record.word("softening").unwrap_or_default(), (0.0, 0.0, 0.0));
                Material::SofteningMohrCoulomb(SofteningMohrCoulomb::new(elastic, none, none, 1.0, decay))
            }
        }
    }
}

words! { Separation {
    Forgotten = "plastic": "volume that opens is plastic",
    Closing = "gap": "volume that opens is a gap that closes first",
} earlier ["forgotten": "plastic", "closing": "gap"] }

words! { Decay {
    Linear = "linear": "in proportion to the plastic strain, until it is softening_strain",
    Exponential = "exponential": "95 % of the way at softening_strain",
} }

words! { Match {
    Outer = "outer": "in triaxial compression; stronger than Mohr-Coulomb elsewhere",
    Inner = "inner": "in triaxial extension; weaker in compression",
    PlaneStrain = "plane-strain": "as strong in plane strain with associated flow (dilation_angle = friction_angle), weaker with less",
} }

pub(crate) static MATERIAL: Table = Table {
    header: "[material.NAME]",
    doc: "A material by its name",
    keys: &[
        key("model", Choice(LawName::WORDS), Required, "constitutive law"),
        key("young", Profile(In::Stress, Range::POSITIVE, &loads::STRESS_PROFILE), Required, "Young's modulus"),
        key("poisson", Quantity(In::Number, POISSON), Required, "Poisson's ratio"),
        key(
            "friction_angle",
            Profile(In::Angle, BELOW_90, &loads::ANGLE_PROFILE),
            Optional,
            "friction angle (mohr-coulomb, drucker-prager and mohr-coulomb-softening, before any plastic strain: required)",
        ).renamed_from(&["friction"]),
        key(
            "dilation_angle",
            Profile(In::Angle, BELOW_90, &loads::ANGLE_PROFILE),
            Optional,
            "dilation angle, at most friction_angle; 0 unless given",
        ).renamed_from(&["dilation"]),
        key(
            "cohesion",
            Profile(In::Stress, Range::NOT_NEGATIVE, &loads::STRESS_PROFILE),
            Optional,
            "cohesion (elastic and von-mises: none; else required)",
        ),
        key(
            "residual_friction_angle",
            Profile(In::Angle, BELOW_90, &loads::ANGLE_PROFILE),
            Optional,
            "friction angle after softening_strain (mohr-coulomb-softening: required)",
        ).renamed_from(&["residual_friction"]),
        key(
            "residual_dilation_angle",
            Profile(In::Angle, BELOW_90, &loads::ANGLE_PROFILE),
            Optional,
            "dilation angle after softening_strain, at most residual_friction_angle; 0 unless given",
        ).renamed_from(&["residual_dilation"]),
        key(
            "residual_cohesion",
            Profile(In::Stress, Range::NOT_NEGATIVE, &loads::STRESS_PROFILE),
            Optional,
            "cohesion after softening_strain (mohr-coulomb-softening: required)",
        ),
        key(
            "softening_strain",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "plastic strain kappa, the sum of sqrt(2/3) |dev| of its increments, at which the strength has its last value \
             (mohr-coulomb-softening: required); of sensitive-clay xi = sqrt(3) kappa, in plane strain the accumulated largest \
             plastic shear, at 95 % of the way, xi_95 (required). Frames have kappa, of both, as plastic_shear_strain; with \
             band_width it is that of the cells, and a band's own is 2 h / band_width times as much",
        ),
        key(
            "sensitivity",
            Quantity(In::Number, Range::of(Included(1.0), Unbounded)),
            Optional,
            "cohesion over that of the remoulded clay (sensitive-clay: required)",
        ),
        key(
            "rate_parameter",
            Quantity(In::Number, Range::NOT_NEGATIVE),
            Optional,
            "growth of the cohesion per decade of the rate of plastic shear (sensitive-clay in dynamics); none unless given",
        ),
        key(
            "reference_rate",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "the rate of the laboratory that cohesion is of, 1/s (with rate_parameter)",
        ),
        key("softening", Choice(Decay::WORDS), Optional, "how the strength gets there; linear unless given"),
        key(
            "band_width",
            Quantity(In::Length, Range::POSITIVE),
            Optional,
            "of the shear band that softening_strain is of: a band in cells of size h does its work across 2 h, so that \
             these take softening_strain band_width / (2 h), and the work is that of the band in any grid (crack band; \
             cells of one size only); without it results depend on the cells",
        ),
        key(
            "kappa_star",
            Quantity(In::Number, BELOW_1),
            Optional,
            "kappa*, slope of the unloading line in ln v over ln p' (modified-cam-clay: required, or kappa with void_ratio); \
             the bulk modulus is p'/kappa*, the shear modulus that of young and poisson, which hold together at one pressure",
        ),
        key(
            "lambda_star",
            Quantity(In::Number, BELOW_1),
            Optional,
            "lambda*, slope of the normal compression line in ln v over ln p', above kappa_star (modified-cam-clay: \
             required, or lambda with void_ratio)",
        ),
        key(
            "kappa",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "kappa, slope of the unloading line in v over ln p', instead of kappa_star: kappa* = kappa / (1 + void_ratio)",
        ),
        key(
            "lambda",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "lambda, slope of the normal compression line in v over ln p', instead of lambda_star: lambda* = lambda / \
             (1 + void_ratio)",
        ),
        key(
            "void_ratio",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "e0, void ratio at the start (modified-cam-clay: required with kappa and lambda)",
        ),
        key(
            "critical_state_ratio",
            Quantity(In::Number, BELOW_3),
            Optional,
            "M = q/p at the critical state, 6 sin(phi)/(3 - sin(phi)) in triaxial compression (modified-cam-clay: \
             required); the same in all directions of shear",
        ).renamed_from(&["critical_ratio"]),
        key(
            "preconsolidation",
            Profile(In::Stress, Range::POSITIVE, &loads::STRESS_PROFILE),
            Optional,
            "pressure at the tip of the yield surface at the start (modified-cam-clay: this or ocr)",
        ),
        key(
            "ocr",
            Quantity(In::Number, Range::of(Included(1.0), Unbounded)),
            Optional,
            "size of the yield surface over that through the stress at the start (modified-cam-clay); of laws with friction \
             largest vertical stress ever over that of the start, and k0 = (1 - sin(phi)) ocr^sin(phi)",
        ),
        key(
            "mu_s",
            Quantity(In::Number, BELOW_3),
            Optional,
            "friction of slow shear, the tangent of the slope at rest (mu-i: required, in dynamics)",
        ),
        key("mu_2", Quantity(In::Number, BELOW_3), Optional, "friction of fast shear, at least mu_s (mu-i: required)"),
        key(
            "inertial_number",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "I_0 at which half of mu_2 - mu_s is gained; I = rate of shear times grain_diameter sqrt(grain_density/p) \
             (mu-i: required)",
        ),
        key("grain_diameter", Quantity(In::Length, Range::POSITIVE), Optional, "of the grains (mu-i: required)"),
        key("grain_density", Quantity(In::Density, Range::POSITIVE), Optional, "of the grains (mu-i: required)"),
        key(
            "fit",
            Choice(Match::WORDS),
            Optional,
            "where drucker-prager meets mohr-coulomb; plane-strain unless given, which is warned of where it is none",
        ).renamed_from(&["match"]),
        key(
            "yield_stress",
            Profile(In::Stress, Range::POSITIVE, &loads::STRESS_PROFILE),
            Optional,
            "uniaxial (von-mises: required)",
        ),
        key(
            "hardening",
            Profile(In::Stress, Range::NOT_NEGATIVE, &loads::STRESS_PROFILE),
            Optional,
            "yield stress gained per plastic strain (von-mises); 0 unless given",
        ),
        key(
            "separation",
            Choice(Separation::WORDS),
            Optional,
            "volume that opens at the apex of mohr-coulomb: plastic, or a gap that closes first; plastic unless given",
        ),
        key("unit_weight", Quantity(In::UnitWeight, Range::POSITIVE), Optional, "density = unit_weight / 9.81 m/s2"),
        key("density", Quantity(In::Density, Range::POSITIVE), Optional, "neither: weightless, in dynamics an error"),
        key(
            "saturated_unit_weight",
            Quantity(In::UnitWeight, Range::POSITIVE),
            Optional,
            "of what lies below the water table at the start; unit_weight, or what density is, unless given",
        ),
        key(
            "ru",
            Quantity(In::Number, BELOW_1),
            Optional,
            "pore pressure over the weight straight above at the start, instead of [water]; its points carry it",
        ),
        key("k0", Quantity(In::Number, loads::COEFFICIENT), Optional, "horizontal over vertical stress at the start"),
        key(
            "drainage",
            Choice(Drainage::WORDS),
            Optional,
            "what its pore water does (consolidation); that of [water] unless given",
        ),
        key(
            "porosity",
            Quantity(In::Number, BELOW_1),
            Optional,
            "share of pores in the volume at the start (coupled and undrained: required)",
        ),
        key(
            "permeability",
            Either(In::Seepage, Range::POSITIVE),
            Optional,
            "hydraulic conductivity, or that along each axis (coupled: required)",
        ),
        key(
            "permeability_law",
            Choice(PermeabilityLaw::WORDS),
            Optional,
            "how it follows the porosity; constant unless given",
        ),
        key(
            "retention",
            Kind::Table(&RETENTION),
            Optional,
            "how much water it keeps under suction (coupled); its pores stay full unless given",
        ),
        key(
            "damping",
            Kind::Table(&DAMPING),
            Optional,
            "viscous stress beside that of the law (dynamic); none unless given",
        ),
    ],
    exclusive: &[
        one_of(&["unit_weight", "density"], false),
        one_of(&["preconsolidation", "ocr"], false),
        one_of(&["kappa_star", "kappa"], false),
        one_of(&["lambda_star", "lambda"], false),
    ],
};

static RETENTION: Table = Table {
    header: "[material.NAME] retention",
    doc: "Van Genuchten's curve, by alpha and n: effective saturation (1 + (alpha s)^n)^(1/n - 1) under the suction head s, \
          with Mualem's permeability; or a measured curve. Bishop's effective stress goes with it",
    keys: &[
        key("alpha", Quantity(In::Number, Range::POSITIVE), Optional, "1/m, over the head at which air enters"),
        key("n", Quantity(In::Number, PORES), Optional, "the larger, the more alike the pores; required with alpha"),
        key(
            "curve",
            Rows(&[(In::Length, Range::NOT_NEGATIVE), (In::Number, SHARES), (In::Number, SHARES)]),
            Optional,
            "rows [suction head, saturation, relative permeability] instead, the first [0, 1, 1]; smooth and falling between, \
             constant beyond the last",
        ),
        key(
            "residual",
            Quantity(In::Number, SHARE),
            super::Presence::Default("0"),
            "saturation that no suction removes",
        ),
    ],
    exclusive: &[one_of(&["alpha", "curve"], true)],
};

const PORES: Range = Range::of(Included(1.05), Included(20.0));
const SHARE: Range = Range::of(Included(0.0), Excluded(1.0));
const SHARES: Range = Range::of(Included(0.0), Included(1.0));

static DAMPING: Table = Table {
    header: "[material.NAME] damping",
    doc: "Kelvin-Voigt damping: the elastic stiffness times ratio/(pi frequency) times the rate of elastic strain. Higher \
          frequencies are damped more, in proportion; motion without strain and plastic flow are not",
    keys: &[
        key("ratio", Quantity(In::Number, BELOW_1), Required, "of the damping to the critical one, at the frequency"),
        key("frequency", Quantity(In::Number, Range::POSITIVE), Required, "Hz"),
    ],
    exclusive: &[],
};

const POISSON: Range = Range {
    lower: Excluded(-1.0),
    upper: Excluded(0.5),
    why: "at 0.5 the material is incompressible; for undrained soil use 0.49 with model = \"tresca\", or drainage = \"undrained\"",
};
/// Slopes of compression.
const BELOW_1: Range = Range::of(Excluded(0.0), Excluded(1.0));
/// Stress ratio: that of 90 degrees is 3.
const BELOW_3: Range = Range::of(Excluded(0.0), Excluded(3.0));
/// Friction and dilation angles, degrees.
const BELOW_90: Range = Range::of(Included(0.0), Excluded(90.0));
