//! Schema of a material, its retention curve and its damping.

use super::laws::LawName;
use super::loads::{self, AngleProfileTable, DepthTable, StressProfileTable};
use super::{Dimension as In, Range};
use crate::record::{Field, KeyPlace, OrTable};
use crate::words::Drainage;
use bsmpm::field::pore_water::flow::PermeabilityLaw;
use bsmpm::material::{Decay, Match, Profile, Separation};
use std::ops::Bound::{Excluded, Included, Unbounded};

table! {
    /// A material with a name. Its keys depend on `model`: [how to choose a law](../how-to/choose-law.md).
    struct MaterialTable = "[material.NAME]" {
        /// Constitutive law.
        model: Choice(LawName), Required, example(r#""mohr-coulomb""#);
        /// Young's modulus. In modified-cam-clay it determines only the constant shear modulus G = E / (2 (1 + ν)). Use
        /// E = 3 (1 - 2ν) p'/κ* at a typical pressure p'.
        young: Profile(In::Stress, Range::POSITIVE, StressProfileTable), Required,
            symbol("E"),
            example(r#""30 MPa""#);
        /// Poisson's ratio.
        poisson: Quantity(In::Number, POISSON), Required, symbol("ν"), example("0.3");
        /// Friction angle. Required by mohr-coulomb, drucker-prager and mohr-coulomb-softening. In
        /// mohr-coulomb-softening it is the peak value.
        friction_angle: Profile(In::Angle, BELOW_90, AngleProfileTable), Optional,
            symbol("φ'"),
            example("30.0"),
            renamed_from(&["friction"]);
        /// Dilation angle, at most equal to the friction angle. Default: 0.
        dilation_angle: Profile(In::Angle, BELOW_90, AngleProfileTable), Optional,
            symbol("ψ"),
            example("0.0"),
            renamed_from(&["dilation"]);
        /// Cohesion; in tresca and sensitive-clay the undrained shear strength. Required by all models except elastic,
        /// von-mises, modified-cam-clay and mu-i.
        cohesion: Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable), Optional,
            symbol("c', s_u"),
            example(r#""10 kPa""#);
        /// Friction angle after complete softening. Required by mohr-coulomb-softening.
        residual_friction_angle: Profile(In::Angle, BELOW_90, AngleProfileTable), Optional,
            symbol("φ'_r"),
            example("25.0"),
            renamed_from(&["residual_friction"]);
        /// Dilation angle after complete softening, at most equal to residual_friction_angle. Default: 0.
        residual_dilation_angle: Profile(In::Angle, BELOW_90, AngleProfileTable), Optional,
            symbol("ψ_r"),
            example("0.0"),
            renamed_from(&["residual_dilation"]);
        /// Cohesion after complete softening. Required by mohr-coulomb-softening.
        residual_cohesion: Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable), Optional,
            symbol("c'_r"),
            example(r#""1 kPa""#);
        /// Plastic strain at the end of softening; with exponential softening at 95 % of the loss of strength. In
        /// mohr-coulomb-softening it is κ, the sum of sqrt(2/3) times the norm of the deviatoric plastic strain
        /// increments. In sensitive-clay it is the shear strain ξ = sqrt(3) κ. Required by both models.
        softening_strain: Quantity(In::Number, Range::POSITIVE), Optional, symbol("κ_r, ξ95"), example("0.2");
        /// Cohesion divided by the cohesion of the remoulded clay. Required by sensitive-clay.
        sensitivity: Quantity(In::Number, Range::of(Included(1.0), Unbounded)), Optional,
            symbol("S_t"),
            example("10.0");
        /// Relative increase of the cohesion for a tenfold plastic shear strain rate, in sensitive-clay and in dynamic
        /// and quasi-static-rate analyses. Without this key the cohesion does not depend on the rate.
        rate_parameter: Quantity(In::Number, Range::NOT_NEGATIVE), Optional, symbol("μ"), example("0.1");
        /// Shear strain rate, in 1/s, of the laboratory test that gave the cohesion. Required with rate_parameter.
        reference_rate: Quantity(In::Number, Range::POSITIVE), Optional, symbol("ξ̇_ref"), example("1e-5");
        /// Decrease of the strength of mohr-coulomb-softening with the plastic strain, or of tensile_strength with the
        /// opening of a crack. Default: "linear". The strength of sensitive-clay always decreases exponentially.
        softening: Choice(Decay), Optional, example(r#""exponential""#);
        /// Thickness of the shear band to which softening_strain belongs. In cells of size h softening ends at the
        /// strain softening_strain times band_width / (2 h), so that the dissipated energy does not depend on the cell
        /// size (crack-band model). All cells must have the same size. Without this key the results depend on the cell
        /// size.
        band_width: Quantity(In::Length, Range::POSITIVE), Optional, example(r#""0.02 m""#);
        /// Slope of the unloading line in the diagram of ln v and ln p' (v: specific volume). The bulk modulus is
        /// p'/κ*; the shear modulus follows from young and poisson. Required by modified-cam-clay, unless it has kappa
        /// and void_ratio.
        kappa_star: Quantity(In::Number, BELOW_1), Optional, symbol("κ*"), example("0.02");
        /// Slope of the normal compression line in the diagram of ln v and ln p' (v: specific volume), larger than
        /// kappa_star. Required by modified-cam-clay, unless it has lambda and void_ratio.
        lambda_star: Quantity(In::Number, BELOW_1), Optional, symbol("λ*"), example("0.1");
        /// Alternative to `kappa_star`: slope of the unloading line in the diagram of v and ln p', with κ* = κ / (1 +
        /// e0).
        kappa: Quantity(In::Number, Range::POSITIVE), Optional, symbol("κ"), example("0.05");
        /// Alternative to `lambda_star`: slope of the normal compression line in the diagram of v and ln p', with λ* =
        /// λ / (1 + e0).
        lambda: Quantity(In::Number, Range::POSITIVE), Optional, symbol("λ"), example("0.25");
        /// Void ratio at the start. Required with kappa and lambda.
        void_ratio: Quantity(In::Number, Range::POSITIVE), Optional, symbol("e0"), example("1.2");
        /// Stress ratio q/p' at the critical state, equal for all Lode angles. It is 6 sin(φ')/(3 - sin(φ')) for the
        /// friction angle φ' of triaxial compression. Required by modified-cam-clay.
        critical_state_ratio: Quantity(In::Number, BELOW_3), Optional,
            symbol("M"),
            example("1.2"),
            renamed_from(&["critical_ratio"]);
        /// Isotropic preconsolidation pressure at the start (size of the yield surface). modified-cam-clay requires
        /// preconsolidation or ocr.
        preconsolidation: Profile(In::Stress, Range::POSITIVE, StressProfileTable), Optional,
            symbol("p'_c"),
            example(r#""100 kPa""#);
        /// Overconsolidation ratio. In modified-cam-clay it is the size of the yield surface divided by the size of the
        /// yield surface through the initial stress. In laws with a friction angle it gives k0 = (1 - sin(φ'))
        /// OCR^sin(φ').
        ocr: Quantity(In::Number, Range::of(Included(1.0), Unbounded)), Optional, symbol("OCR"), example("1.5");
        /// Friction coefficient in slow shear. In plane strain it is the sine of the friction angle. Required by mu-i.
        mu_s: Quantity(In::Number, BELOW_3), Optional, symbol("μ_s"), example("0.38");
        /// Friction coefficient in fast shear, not less than mu_s. Required by mu-i.
        mu_2: Quantity(In::Number, BELOW_3), Optional, symbol("μ_2"), example("0.64");
        /// Inertial number at which the friction coefficient is the mean of μ_s and μ_2. It is the shear strain rate
        /// times grain_diameter times sqrt(grain_density / p), with the pressure p. Required by mu-i.
        inertial_number: Quantity(In::Number, Range::POSITIVE), Optional, symbol("I_0"), example("0.3");
        /// Diameter of the grains. Required by mu-i.
        grain_diameter: Quantity(In::Length, Range::POSITIVE), Optional, symbol("d"), example(r#""1 mm""#);
        /// Density of the grains. Required by mu-i.
        grain_density: Quantity(In::Density, Range::POSITIVE), Optional, symbol("ρ_s"), example("2500.0");
        /// Stress state in which drucker-prager has the strength of mohr-coulomb. Default: "plane-strain". The program
        /// warns if this state does not suit the geometry.
        fit: Choice(Match), Optional, example(r#""plane-strain""#), renamed_from(&["match"]);
        /// Uniaxial yield stress. Required by von-mises.
        yield_stress: Profile(In::Stress, Range::POSITIVE, StressProfileTable), Optional,
            symbol("σ_y"),
            example(r#""200 kPa""#);
        /// Hardening modulus of von-mises: increase of the yield stress per plastic strain. Default: 0.
        hardening: Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable), Optional,
            symbol("H"),
            example(r#""1 MPa""#);
        /// Tension cut-off: largest principal stress of mohr-coulomb, tresca, drucker-prager and von-mises. With 0 the
        /// soil carries no tension. Without this key, laws with a friction angle carry a mean tension of up to
        /// c'/tan(φ'); a larger tensile strength has no effect.
        tensile_strength: Profile(In::Stress, Range::NOT_NEGATIVE, StressProfileTable), Optional,
            symbol("f_t"),
            example(r#""5 kPa""#);
        /// Opening of a crack at which tensile_strength has decreased to 0; with exponential softening, 5 % of it
        /// remain. In cells of size h the crack is smeared over 2 h, so its plastic strain is crack_opening / (2 h).
        /// The dissipated energy then does not depend on the cell size (crack-band model). All cells must have the same
        /// size. Without this key the tensile strength is constant.
        crack_opening: Quantity(In::Length, Range::POSITIVE), Optional, symbol("w_c"), example(r#""2 mm""#);
        /// Whether strength reduction divides tensile_strength, too. Default: false.
        reduce_tensile_strength: Flag, Optional, example("true");
        /// Meaning of the volume increase at the apex of mohr-coulomb. Default: "plastic".
        separation: Choice(Separation), Optional, example(r#""gap""#);
        /// Unit weight. The density is the unit weight divided by 9.81 m/s2.
        unit_weight: Quantity(In::UnitWeight, Range::POSITIVE), Optional, symbol("γ"), example(r#""20 kN/m3""#);
        /// Alternative to `unit_weight`: density. A material without either is weightless, which dynamic analyses
        /// refuse.
        density: Quantity(In::Density, Range::POSITIVE), Optional, symbol("ρ"), example("2000.0");
        /// Unit weight of soil below the water table at the start. Default: the unit weight above the water table.
        saturated_unit_weight: Quantity(In::UnitWeight, Range::POSITIVE), Optional,
            symbol("γ_sat"),
            example(r#""21 kN/m3""#);
        /// Pore pressure ratio, instead of [water]: pore pressure divided by the weight of the soil vertically above,
        /// at the start. Material points keep this pore pressure.
        ru: Quantity(In::Number, BELOW_1), Optional, symbol("r_u"), example("0.25");
        /// Ratio of horizontal to vertical effective stress at the start.
        k0: Quantity(In::Number, loads::COEFFICIENT), Optional, symbol("K0"), example("0.5");
        /// Drainage of this material in consolidation and dynamic analyses. Default: `water.drainage`.
        drainage: Choice(Drainage), Optional, example(r#""coupled""#);
        /// Porosity at the start. Required with drainage "coupled" and "undrained".
        porosity: Quantity(In::Number, BELOW_1), Optional, symbol("n"), example("0.4");
        /// Hydraulic conductivity: one value, or one along each axis. Required with drainage "coupled".
        permeability: Either(In::Seepage, Range::POSITIVE), Optional, symbol("k"), example(r#""1e-8 m/s""#);
        /// Dependence of the permeability on the porosity. Without this key the permeability is constant.
        permeability_law: Choice(PermeabilityLaw), Optional, example(r#""kozeny-carman""#);
        /// Soil-water retention curve of a coupled material. Without this table the soil stays saturated.
        retention: Table(RetentionTable), Optional, example(r#"{ alpha = 2.0, n = 1.6, residual = 0.1 }"#);
        /// Viscous damping in dynamic analyses. Without this table there is no viscous damping.
        damping: Table(DampingTable), Optional, example(r#"{ ratio = 0.05, frequency = 2.0 }"#);
    }
    one_of optional [unit_weight, density];
    one_of optional [preconsolidation, ocr];
    one_of optional [kappa_star, kappa];
    one_of optional [lambda_star, lambda];
}

table! {
    /// Soil-water retention curve: the function of van Genuchten, or a measured curve. Van Genuchten's effective
    /// saturation is (1 + (alpha s)^n)^(1/n - 1) at the suction head s, with the permeability of Mualem. The effective
    /// stress is that of Bishop.
    struct RetentionTable = "[material.NAME] retention" {
        /// Van Genuchten's alpha in 1/m: about the inverse of the suction head at air entry.
        alpha: Quantity(In::Number, Range::POSITIVE), Optional, symbol("α"), example("2.0");
        /// Van Genuchten's n, which is large in soil with pores of uniform size. Required with alpha.
        n: Quantity(In::Number, PORES), Optional, symbol("n"), example("1.6");
        /// Alternative to `alpha` and `n`: measured curve, in rows of suction head, saturation and relative
        /// permeability. The first row is [0, 1, 1]. The curve decreases smoothly between the rows, and is constant
        /// after the last row.
        curve: Rows(CURVE), Optional,
            example("[[0.0, 1.0, 1.0], [2.0, 0.6, 0.1]]");
        /// Residual saturation, which remains under any suction.
        residual: Quantity(In::Number, SHARE), Default("0"), symbol("S_r"), example("0.1");
    }
    one_of required [alpha, curve];
}

const PORES: Range = Range::of(Included(1.05), Included(20.0));
const SHARE: Range = Range::of(Included(0.0), Excluded(1.0));
const CURVE: &[(In, Range)] = &[
    (In::Length, Range::NOT_NEGATIVE),
    (In::Number, SHARES),
    (In::Number, SHARES),
];
const SHARES: Range = Range::of(Included(0.0), Included(1.0));

table! {
    /// Kelvin-Voigt damping. The viscous stress is the elastic stiffness times `ratio`/(π `frequency`) times the rate
    /// of elastic strain. Vibrations of another frequency have a damping ratio in proportion to their frequency.
    /// Rigid-body motion and plastic flow are not damped.
    struct DampingTable = "[material.NAME] damping" {
        /// Damping ratio (fraction of critical damping) at `frequency`.
        ratio: Quantity(In::Number, BELOW_1), Required, symbol("ξ"), example("0.05");
        /// Frequency in Hz at which the damping ratio is `ratio`.
        frequency: Quantity(In::Number, Range::POSITIVE), Required, symbol("f"), example("2.0");
    }
}

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

/// A key that some laws have and others have not.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LawKey<'a> {
    Stress(&'a Field<OrTable<f64, StressProfileTable>>),
    Angle(&'a Field<OrTable<f64, AngleProfileTable>>),
    Number(&'a Field<f64>),
    /// A word or a flag.
    Other(&'a KeyPlace),
}

impl<'a> LawKey<'a> {
    /// Where the key is written.
    pub(crate) fn place(self) -> &'a KeyPlace {
        match self {
            Self::Stress(key) => key,
            Self::Angle(key) => key,
            Self::Number(key) => key,
            Self::Other(key) => key,
        }
    }

    /// The number by depth; `None` of another value, without the key, or after an error.
    pub(crate) fn profile(self) -> Option<Profile> {
        match self {
            Self::Stress(key) => key.profile(),
            Self::Angle(key) => key.profile(),
            Self::Number(key) => key.get().map(Profile::constant),
            Self::Other(_) => None,
        }
    }
}

impl MaterialTable {
    /// The keys that some laws have and others have not, in alphabetical order.
    pub(crate) fn law_keys(&self) -> [LawKey<'_>; 32] {
        use LawKey::{Angle, Number, Other, Stress};
        [
            Number(&self.band_width),
            Stress(&self.cohesion),
            Number(&self.crack_opening),
            Number(&self.critical_state_ratio),
            Angle(&self.dilation_angle),
            Other(&self.fit),
            Angle(&self.friction_angle),
            Number(&self.grain_density),
            Number(&self.grain_diameter),
            Stress(&self.hardening),
            Number(&self.inertial_number),
            Number(&self.kappa),
            Number(&self.kappa_star),
            Number(&self.lambda),
            Number(&self.lambda_star),
            Number(&self.mu_2),
            Number(&self.mu_s),
            Number(&self.ocr),
            Stress(&self.preconsolidation),
            Number(&self.rate_parameter),
            Other(&self.reduce_tensile_strength),
            Number(&self.reference_rate),
            Stress(&self.residual_cohesion),
            Angle(&self.residual_dilation_angle),
            Angle(&self.residual_friction_angle),
            Number(&self.sensitivity),
            Other(&self.separation),
            Other(&self.softening),
            Number(&self.softening_strain),
            Stress(&self.tensile_strength),
            Number(&self.void_ratio),
            Stress(&self.yield_stress),
        ]
    }

    /// The key of a law with a name.
    pub(crate) fn law_key(&self, name: &str) -> Option<LawKey<'_>> {
        self.law_keys().into_iter().find(|key| key.place().name() == name)
    }
}

impl<T: DepthTable> Field<OrTable<f64, T>> {
    /// The number by depth; zero without the key, or after an error.
    pub(crate) fn profile_or_zero(&self) -> Profile {
        self.profile().unwrap_or(Profile::constant(0.0))
    }
}
