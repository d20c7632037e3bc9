//! Schema of a material, its retention curve and its damping.

use super::Kind::{self, *};
use super::Presence::{Default, Optional, Required};
use super::laws::LawName;
use super::loads::{AngleProfileTable, StressProfileTable};
use super::{Dimension as In, Range, Table, key, loads, one_of};
use crate::record::CaseTable;
use crate::words::{Drainage, Word};
use bsmpm::field::pore_water::flow::PermeabilityLaw;
use bsmpm::material::{Decay, Match, Separation};
use std::ops::Bound::{Excluded, Included, Unbounded};

pub(crate) static MATERIAL: Table = Table {
    header: "[material.NAME]",
    doc: "A material with a name. Its keys depend on `model`: [how to choose a law](../how-to/choose-law.md).",
    keys: &[
        key("model", Choice(LawName::WORDS), Required, "Constitutive law.").example(r#""mohr-coulomb""#),
        key(
            "young",
            Profile(In::Stress, Range::POSITIVE, StressProfileTable::TABLE),
            Required,
            "Young's modulus. In modified-cam-clay it determines only the constant shear modulus G = E / (2 (1 + ν)). \
             Use E = 3 (1 - 2ν) p'/κ* at a typical pressure p'.",
        )
        .symbol("E")
        .example(r#""30 MPa""#),
        key("poisson", Quantity(In::Number, POISSON), Required, "Poisson's ratio.")
            .symbol("ν")
            .example("0.3"),
        key(
            "friction_angle",
            Profile(In::Angle, BELOW_90, AngleProfileTable::TABLE),
            Optional,
            "Friction angle. Required by mohr-coulomb, drucker-prager and mohr-coulomb-softening. In \
             mohr-coulomb-softening it is the peak value.",
        )
        .symbol("φ'")
        .example("30.0")
        .renamed_from(&["friction"]),
        key(
            "dilation_angle",
            Profile(In::Angle, BELOW_90, AngleProfileTable::TABLE),
            Optional,
            "Dilation angle, at most equal to the friction angle. Default: 0.",
        )
        .symbol("ψ")
        .example("0.0")
        .renamed_from(&["dilation"]),
        key(
            "cohesion",
            Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable::TABLE),
            Optional,
            "Cohesion; in tresca and sensitive-clay the undrained shear strength. Required by all models except \
             elastic, von-mises, modified-cam-clay and mu-i.",
        )
        .symbol("c', s_u")
        .example(r#""10 kPa""#),
        key(
            "residual_friction_angle",
            Profile(In::Angle, BELOW_90, AngleProfileTable::TABLE),
            Optional,
            "Friction angle after complete softening. Required by mohr-coulomb-softening.",
        )
        .symbol("φ'_r")
        .example("25.0")
        .renamed_from(&["residual_friction"]),
        key(
            "residual_dilation_angle",
            Profile(In::Angle, BELOW_90, AngleProfileTable::TABLE),
            Optional,
            "Dilation angle after complete softening, at most equal to residual_friction_angle. Default: 0.",
        )
        .symbol("ψ_r")
        .example("0.0")
        .renamed_from(&["residual_dilation"]),
        key(
            "residual_cohesion",
            Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable::TABLE),
            Optional,
            "Cohesion after complete softening. Required by mohr-coulomb-softening.",
        )
        .symbol("c'_r")
        .example(r#""1 kPa""#),
        key(
            "softening_strain",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Plastic strain at the end of softening; with exponential softening at 95 % of the loss of strength. In \
             mohr-coulomb-softening it is κ, the sum of sqrt(2/3) times the norm of the deviatoric plastic strain \
             increments. In sensitive-clay it is the shear strain ξ = sqrt(3) κ. Required by both models.",
        )
        .symbol("κ_r, ξ95")
        .example("0.2"),
        key(
            "sensitivity",
            Quantity(In::Number, Range::of(Included(1.0), Unbounded)),
            Optional,
            "Cohesion divided by the cohesion of the remoulded clay. Required by sensitive-clay.",
        )
        .symbol("S_t")
        .example("10.0"),
        key(
            "rate_parameter",
            Quantity(In::Number, Range::NOT_NEGATIVE),
            Optional,
            "Relative increase of the cohesion for a tenfold plastic shear strain rate, in sensitive-clay and in \
             dynamic and quasi-static-rate analyses. Without this key the cohesion does not depend on the rate.",
        )
        .symbol("μ")
        .example("0.1"),
        key(
            "reference_rate",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Shear strain rate, in 1/s, of the laboratory test that gave the cohesion. Required with rate_parameter.",
        )
        .symbol("ξ̇_ref")
        .example("1e-5"),
        key(
            "softening",
            Choice(Decay::WORDS),
            Optional,
            "Decrease of the strength of mohr-coulomb-softening with the plastic strain, or of tensile_strength with \
             the opening of a crack. Default: \"linear\". The strength of sensitive-clay always decreases \
             exponentially.",
        )
        .example(r#""exponential""#),
        key(
            "band_width",
            Quantity(In::Length, Range::POSITIVE),
            Optional,
            "Thickness of the shear band to which softening_strain belongs. In cells of size h softening ends at the \
             strain softening_strain times band_width / (2 h), so that the dissipated energy does not depend on the \
             cell size (crack-band model). All cells must have the same size. Without this key the results depend on \
             the cell size.",
        )
        .example(r#""0.02 m""#),
        key(
            "kappa_star",
            Quantity(In::Number, BELOW_1),
            Optional,
            "Slope of the unloading line in the diagram of ln v and ln p' (v: specific volume). The bulk modulus is \
             p'/κ*; the shear modulus follows from young and poisson. Required by modified-cam-clay, unless it has \
             kappa and void_ratio.",
        )
        .symbol("κ*")
        .example("0.02"),
        key(
            "lambda_star",
            Quantity(In::Number, BELOW_1),
            Optional,
            "Slope of the normal compression line in the diagram of ln v and ln p' (v: specific volume), larger than \
             kappa_star. Required by modified-cam-clay, unless it has lambda and void_ratio.",
        )
        .symbol("λ*")
        .example("0.1"),
        key(
            "kappa",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Alternative to `kappa_star`: slope of the unloading line in the diagram of v and ln p', with κ* = κ / (1 \
             + e0).",
        )
        .symbol("κ")
        .example("0.05"),
        key(
            "lambda",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Alternative to `lambda_star`: slope of the normal compression line in the diagram of v and ln p', with λ* \
             = λ / (1 + e0).",
        )
        .symbol("λ")
        .example("0.25"),
        key(
            "void_ratio",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Void ratio at the start. Required with kappa and lambda.",
        )
        .symbol("e0")
        .example("1.2"),
        key(
            "critical_state_ratio",
            Quantity(In::Number, BELOW_3),
            Optional,
            "Stress ratio q/p' at the critical state, equal for all Lode angles. It is 6 sin(φ')/(3 - sin(φ')) for the \
             friction angle φ' of triaxial compression. Required by modified-cam-clay.",
        )
        .symbol("M")
        .example("1.2")
        .renamed_from(&["critical_ratio"]),
        key(
            "preconsolidation",
            Profile(In::Stress, Range::POSITIVE, StressProfileTable::TABLE),
            Optional,
            "Isotropic preconsolidation pressure at the start (size of the yield surface). modified-cam-clay requires \
             preconsolidation or ocr.",
        )
        .symbol("p'_c")
        .example(r#""100 kPa""#),
        key(
            "ocr",
            Quantity(In::Number, Range::of(Included(1.0), Unbounded)),
            Optional,
            "Overconsolidation ratio. In modified-cam-clay it is the size of the yield surface divided by the size of \
             the yield surface through the initial stress. In laws with a friction angle it gives k0 = (1 - sin(φ')) \
             OCR^sin(φ').",
        )
        .symbol("OCR")
        .example("1.5"),
        key(
            "mu_s",
            Quantity(In::Number, BELOW_3),
            Optional,
            "Friction coefficient in slow shear. In plane strain it is the sine of the friction angle. Required by \
             mu-i.",
        )
        .symbol("μ_s")
        .example("0.38"),
        key(
            "mu_2",
            Quantity(In::Number, BELOW_3),
            Optional,
            "Friction coefficient in fast shear, not less than mu_s. Required by mu-i.",
        )
        .symbol("μ_2")
        .example("0.64"),
        key(
            "inertial_number",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Inertial number at which the friction coefficient is the mean of μ_s and μ_2. It is the shear strain rate \
             times grain_diameter times sqrt(grain_density / p), with the pressure p. Required by mu-i.",
        )
        .symbol("I_0")
        .example("0.3"),
        key(
            "grain_diameter",
            Quantity(In::Length, Range::POSITIVE),
            Optional,
            "Diameter of the grains. Required by mu-i.",
        )
        .symbol("d")
        .example(r#""1 mm""#),
        key(
            "grain_density",
            Quantity(In::Density, Range::POSITIVE),
            Optional,
            "Density of the grains. Required by mu-i.",
        )
        .symbol("ρ_s")
        .example("2500.0"),
        key(
            "fit",
            Choice(Match::WORDS),
            Optional,
            "Stress state in which drucker-prager has the strength of mohr-coulomb. Default: \"plane-strain\". The \
             program warns if this state does not suit the geometry.",
        )
        .example(r#""plane-strain""#)
        .renamed_from(&["match"]),
        key(
            "yield_stress",
            Profile(In::Stress, Range::POSITIVE, StressProfileTable::TABLE),
            Optional,
            "Uniaxial yield stress. Required by von-mises.",
        )
        .symbol("σ_y")
        .example(r#""200 kPa""#),
        key(
            "hardening",
            Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable::TABLE),
            Optional,
            "Hardening modulus of von-mises: increase of the yield stress per plastic strain. Default: 0.",
        )
        .symbol("H")
        .example(r#""1 MPa""#),
        key(
            "tensile_strength",
            Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable::TABLE),
            Optional,
            "Tension cut-off: largest principal stress of mohr-coulomb, tresca, drucker-prager and von-mises. With 0 \
             the soil carries no tension. Without this key, laws with a friction angle carry a mean tension of up to \
             c'/tan(φ'); a larger tensile strength has no effect.",
        )
        .symbol("f_t")
        .example(r#""5 kPa""#),
        key(
            "crack_opening",
            Quantity(In::Length, Range::POSITIVE),
            Optional,
            "Opening of a crack at which tensile_strength has decreased to 0; with exponential softening, 5 % of it \
             remain. In cells of size h the crack is smeared over 2 h, so its plastic strain is crack_opening / (2 h). \
             The dissipated energy then does not depend on the cell size (crack-band model). All cells must have the same size. Without this key the \
             tensile strength is constant.",
        )
        .symbol("w_c")
        .example(r#""2 mm""#),
        key(
            "reduce_tensile_strength",
            Flag,
            Optional,
            "Whether strength reduction divides tensile_strength, too. Default: false.",
        )
        .example("true"),
        key(
            "separation",
            Choice(Separation::WORDS),
            Optional,
            "Meaning of the volume increase at the apex of mohr-coulomb. Default: \"plastic\".",
        )
        .example(r#""gap""#),
        key(
            "unit_weight",
            Quantity(In::UnitWeight, Range::POSITIVE),
            Optional,
            "Unit weight. The density is the unit weight divided by 9.81 m/s2.",
        )
        .symbol("γ")
        .example(r#""20 kN/m3""#),
        key(
            "density",
            Quantity(In::Density, Range::POSITIVE),
            Optional,
            "Alternative to `unit_weight`: density. A material without either is weightless, which dynamic analyses \
             refuse.",
        )
        .symbol("ρ")
        .example("2000.0"),
        key(
            "saturated_unit_weight",
            Quantity(In::UnitWeight, Range::POSITIVE),
            Optional,
            "Unit weight of soil below the water table at the start. Default: the unit weight above the water table.",
        )
        .symbol("γ_sat")
        .example(r#""21 kN/m3""#),
        key(
            "ru",
            Quantity(In::Number, BELOW_1),
            Optional,
            "Pore pressure ratio, instead of [water]: pore pressure divided by the weight of the soil vertically \
             above, at the start. Material points keep this pore pressure.",
        )
        .symbol("r_u")
        .example("0.25"),
        key(
            "k0",
            Quantity(In::Number, loads::COEFFICIENT),
            Optional,
            "Ratio of horizontal to vertical effective stress at the start.",
        )
        .symbol("K0")
        .example("0.5"),
        key(
            "drainage",
            Choice(Drainage::WORDS),
            Optional,
            "Drainage of this material in consolidation and dynamic analyses. Default: `water.drainage`.",
        )
        .example(r#""coupled""#),
        key(
            "porosity",
            Quantity(In::Number, BELOW_1),
            Optional,
            "Porosity at the start. Required with drainage \"coupled\" and \"undrained\".",
        )
        .symbol("n")
        .example("0.4"),
        key(
            "permeability",
            Either(In::Seepage, Range::POSITIVE),
            Optional,
            "Hydraulic conductivity: one value, or one along each axis. Required with drainage \"coupled\".",
        )
        .symbol("k")
        .example(r#""1e-8 m/s""#),
        key(
            "permeability_law",
            Choice(PermeabilityLaw::WORDS),
            Optional,
            "Dependence of the permeability on the porosity. Without this key the permeability is constant.",
        )
        .example(r#""kozeny-carman""#),
        key(
            "retention",
            Kind::Table(&RETENTION),
            Optional,
            "Soil-water retention curve of a coupled material. Without this table the soil stays saturated.",
        )
        .example(r#"{ alpha = 2.0, n = 1.6, residual = 0.1 }"#),
        key(
            "damping",
            Kind::Table(&DAMPING),
            Optional,
            "Viscous damping in dynamic analyses. Without this table there is no viscous damping.",
        )
        .example(r#"{ ratio = 0.05, frequency = 2.0 }"#),
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
    doc: "Soil-water retention curve: the function of van Genuchten, or a measured curve. Van Genuchten's effective \
          saturation is (1 + (alpha s)^n)^(1/n - 1) at the suction head s, with the permeability of Mualem. The \
          effective stress is that of Bishop.",
    keys: &[
        key(
            "alpha",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Van Genuchten's alpha in 1/m: about the inverse of the suction head at air entry.",
        )
        .symbol("α")
        .example("2.0"),
        key(
            "n",
            Quantity(In::Number, PORES),
            Optional,
            "Van Genuchten's n, which is large in soil with pores of uniform size. Required with alpha.",
        )
        .symbol("n")
        .example("1.6"),
        key(
            "curve",
            Rows(&[
                (In::Length, Range::NOT_NEGATIVE),
                (In::Number, SHARES),
                (In::Number, SHARES),
            ]),
            Optional,
            "Alternative to `alpha` and `n`: measured curve, in rows of suction head, saturation and relative \
             permeability. The first row is [0, 1, 1]. The curve decreases smoothly between the rows, and is constant \
             after the last row.",
        )
        .example("[[0.0, 1.0, 1.0], [2.0, 0.6, 0.1]]"),
        key(
            "residual",
            Quantity(In::Number, SHARE),
            Default("0"),
            "Residual saturation, which remains under any suction.",
        )
        .symbol("S_r")
        .example("0.1"),
    ],
    exclusive: &[one_of(&["alpha", "curve"], true)],
};

const PORES: Range = Range::of(Included(1.05), Included(20.0));
const SHARE: Range = Range::of(Included(0.0), Excluded(1.0));
const SHARES: Range = Range::of(Included(0.0), Included(1.0));

static DAMPING: Table = Table {
    header: "[material.NAME] damping",
    doc: "Kelvin-Voigt damping. The viscous stress is the elastic stiffness times `ratio`/(π `frequency`) times the \
          rate of elastic strain. Vibrations of another frequency have a damping ratio in proportion to their \
          frequency. Rigid-body motion and plastic flow are not damped.",
    keys: &[
        key(
            "ratio",
            Quantity(In::Number, BELOW_1),
            Required,
            "Damping ratio (fraction of critical damping) at `frequency`.",
        )
        .symbol("ξ")
        .example("0.05"),
        key(
            "frequency",
            Quantity(In::Number, Range::POSITIVE),
            Required,
            "Frequency in Hz at which the damping ratio is `ratio`.",
        )
        .symbol("f")
        .example("2.0"),
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
