//! Fuzz target of the constitutive laws: the stress after the return mapping must not be outside the yield surface.

use crate::draw;
use arbitrary::{Result, Unstructured};
use bsmpm::material::Moduli;
use bsmpm::material::Strength;
use bsmpm::material::{
    CamClay, CutOff, Decay, DruckerPrager, Elastic, GradedLaw, Hencky, Law, Match, Material, MohrCoulomb, MuI, Profile,
    Response, Separation, SofteningMohrCoulomb, TensileStrength, VonMises,
};
use bsmpm::tensor::{Symmetric, Tensor};
use nalgebra::{Rotation3, Vector3};

/// Violation of yield, and change by a second return, over the size of the stress.
const SAME: f64 = 1e-8;
/// Ratio of the eigenvalues of b up to which its components tell them all apart.
const CONDITION: f64 = 1e10;
/// Strain up to which b can be written down with all digits.
const LARGEST: f64 = 100.0;

/// A law, then trial states.
pub fn target(data: &[u8]) {
    // What the bytes are too few for is no input.
    let _ = draw(&mut Unstructured::new(data));
}

fn draw(u: &mut Unstructured<'_>) -> Result<()> {
    let material = material(u)?;
    let mut state = vec![0.0; material.state().len()];
    if !material.is_linear() {
        // A stress at the start: any pressure.
        material.initial_state([-draw::size(u, -3.0, 9.0)?; 3], &mut state);
    }
    while !u.is_empty() {
        let trial = trial(u)?;
        match material.respond(&trial, &state) {
            Ok(response) => {
                response.advance(&mut state);
                check(&material, &trial, &response, &state);
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    Ok(())
}

/// What [`bsmpm_scene`] admits: E > 0, -1 < ν < ½, 0 ≤ ψ ≤ φ < 90°, c ≥ 0, σ_y > 0, H ≥ 0, a strength reduction of 0.1
/// to 100, a strength that falls, 0 < κ < λ < 1, 0 < M < 3, μ_s ≤ μ_2; of any law also by height.
fn material(u: &mut Unstructured<'_>) -> Result<Material> {
    let elastic = Elastic {
        young: draw::size(u, -12.0, 20.0)?,
        poisson: poisson(u)?,
    };
    let friction = draw::between(u, 0.0, 89.999)?.to_radians() * if u.ratio(1, 8)? { 1e-9 } else { 1.0 };
    let dilation = friction * draw::fraction(u)?;
    let cohesion = if u.ratio(1, 4)? {
        0.0
    } else {
        draw::size(u, -12.0, 20.0)?
    };
    let separation = if u.arbitrary()? {
        Separation::Forgotten
    } else {
        Separation::Closing
    };
    let reduction = if u.arbitrary()? { 1.0 } else { draw::size(u, -1.0, 2.0)? };
    let law = match u.int_in_range(0..=11)? {
        0 => Material::Hencky(Hencky { elastic }),
        1 | 2 => {
            let fit = *u.choose(&[Match::PlaneStrain, Match::Inner, Match::Outer])?;
            Material::DruckerPrager(DruckerPrager::new(elastic, friction, dilation, cohesion, fit))
        }
        3 | 4 => Material::VonMises(VonMises::new(elastic, cohesion.max(1e-12), friction * cohesion)),
        5 => {
            let peak = Strength {
                friction_angle: friction,
                dilation_angle: dilation,
                cohesion,
            };
            softening(u, elastic, peak)?
        }
        6 => {
            let lambda = draw::between(u, 1e-4, 0.9)?;
            let kappa = lambda * draw::between(u, 0.01, 0.99)?;
            let ratio = draw::between(u, 0.01, 2.99)?;
            let given = if u.arbitrary()? { 0.0 } else { draw::size(u, -3.0, 9.0)? };
            let ocr = draw::size(u, 0.0, 3.0)?;
            Material::CamClay(CamClay::new(elastic, [kappa, lambda, ratio, given, ocr]))
        }
        7 => mu_i(u, elastic, friction)?,
        8 | 9 => {
            let fit = *u.choose(&[Match::PlaneStrain, Match::Inner, Match::Outer])?;
            let kind = u.int_in_range(0..=2)?;
            let tension = tension(u)?;
            match kind {
                0 => {
                    let cone = DruckerPrager::new(elastic, friction, dilation, cohesion, fit);
                    Material::DruckerPragerCutOff(CutOff::new(cone, tension))
                }
                1 => {
                    let cylinder = VonMises::new(elastic, cohesion.max(1e-12), friction * cohesion);
                    Material::VonMisesCutOff(CutOff::new(cylinder, tension))
                }
                _ => {
                    let pyramid = MohrCoulomb::new(elastic, friction, dilation, cohesion);
                    Material::MohrCoulombCutOff(CutOff::new(pyramid, tension))
                }
            }
        }
        _ => Material::MohrCoulomb(MohrCoulomb::new(elastic, friction, dilation, cohesion).separating(separation)),
    };
    if u.ratio(7, 8)? {
        return Ok(law.reduced(reduction));
    }
    let young = Profile::constant(law.elastic().young);
    let parameters = law.parameters().into_iter().map(Profile::constant).collect();
    Ok(GradedLaw::new(&law, young, parameters, 0.0..1.0, reduction).at(draw::fraction(u)?))
}

/// A tensile strength, that may decrease faster than the stress of elastic soil.
fn tension(u: &mut Unstructured<'_>) -> Result<TensileStrength> {
    let [strength, strain] = [draw::size(u, -12.0, 20.0)?, draw::size(u, -6.0, 3.0)?];
    Ok(TensileStrength {
        strength: if u.ratio(1, 3)? { 0.0 } else { strength },
        strain: if u.arbitrary()? { 0.0 } else { strain },
        decay: *u.choose(&[Decay::Linear, Decay::Exponential])?,
        is_reduced: u.arbitrary()?,
    })
}

/// A strength that falls from its peak, or rises to it.
fn softening(u: &mut Unstructured<'_>, elastic: Elastic, peak: Strength) -> Result<Material> {
    let decay = *u.choose(&[Decay::Linear, Decay::Exponential])?;
    let part = draw::fraction(u)?;
    let residual = Strength {
        friction_angle: peak.friction_angle * part,
        dilation_angle: peak.dilation_angle * part,
        cohesion: peak.cohesion * draw::fraction(u)?,
    };
    let strain = draw::size(u, -6.0, 3.0)?;
    let (first, last) = if u.arbitrary()? {
        (peak, residual)
    } else {
        (residual, peak)
    };
    Ok(Material::SofteningMohrCoulomb(SofteningMohrCoulomb::new(
        elastic, first, last, strain, decay,
    )))
}

fn mu_i(u: &mut Unstructured<'_>, elastic: Elastic, friction: f64) -> Result<Material> {
    let [fast, i_0] = [friction * draw::between(u, 1.0, 2.0)?, draw::size(u, -6.0, 3.0)?];
    let [diameter, density] = [draw::size(u, -9.0, 3.0)?, draw::size(u, -3.0, 6.0)?];
    let law = MuI::new(elastic, [friction, fast, i_0, diameter, density]);
    Ok(Material::MuI(
        law.with_time_step(draw::size(u, -12.0, 6.0)?)
            .filter(|_| u.ratio(3, 4).unwrap_or(true))
            .unwrap_or(law),
    ))
}

/// Anywhere between -1 and ½, or near an end.
fn poisson(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(match u.int_in_range(0..=3)? {
        0 => 0.5 - draw::size(u, -15.0, -1.0)?,
        1 => -1.0 + draw::size(u, -15.0, -1.0)?,
        _ => draw::between(u, -0.999, 0.499)?,
    })
}

/// Principal strains in turned axes, or any six components.
fn trial(u: &mut Unstructured<'_>) -> Result<Symmetric> {
    Ok(match u.int_in_range(0..=7)? {
        0 => Symmetric([(); 6].map(|()| draw::bits(u).unwrap_or(0.0))),
        1 => Symmetric([(); 6].map(|()| draw::signed(u, -12.0, 12.0).unwrap_or(0.0))),
        kind => {
            let size = draw::size(u, -12.0, 1.5)?;
            let mut stretches = Vector3::zeros();
            for stretch in &mut stretches {
                *stretch = (2.0 * size * draw::between(u, -1.0, 1.0)?).exp();
            }
            let plane = kind < 5;
            let mut turn = Vector3::zeros();
            for angle in turn.iter_mut().skip(if plane { 2 } else { 0 }) {
                *angle = draw::between(u, -3.2, 3.2)?;
            }
            let q = Rotation3::new(turn).into_inner();
            Symmetric::of(&(q * Tensor::from_diagonal(&stretches) * q.transpose()))
        }
    })
}

fn check(material: &Material, trial: &Symmetric, response: &Response, state: &[f64]) {
    let tau = response.tau();
    let b_e = response.b_e();
    let context = || format!("{material:?} at {trial:?}: {response:?}");
    let principal = response.principal_tau();
    let increments = [response.gap(), response.plastic_increment(), response.dissipation()];
    let numbers = tau
        .0
        .iter()
        .chain(&b_e.0)
        .chain(&principal)
        .chain(&increments)
        .chain(state);
    assert!(
        numbers.into_iter().all(|number| number.is_finite()),
        "not finite: {}",
        context()
    );
    assert!(
        principal[0] >= principal[1] && principal[1] >= principal[2],
        "order: {}",
        context()
    );
    assert!(increments[0] >= 0.0 && increments[1] >= 0.0, "sign: {}", context());
    let tangent = response.linearise(&Tensor::new(0.3, -0.2, 0.1, 0.5, -0.4, 0.2, 0.1, 0.0, 0.6));
    assert!(
        tangent.iter().all(|number| number.is_finite()),
        "tangent: {}",
        context()
    );
    let scale = yield_scale(material, principal, state);
    if let Material::MuI(law) = material {
        // Sheared at a rate it lies beyond its surface at rest, and within that of the fastest shear.
        let mut parameters = law.parameters();
        parameters[0] = parameters[1];
        let fastest = material.with_parameters(law.elastic().clone(), &parameters);
        // Of a pressure that is a small difference of large moduli no more is left than their rounding.
        let Moduli { lambda, mu } = material.elastic().moduli();
        let strain = response
            .principal_eps_e()
            .iter()
            .fold(0.0_f64, |most, eps| most.max(eps.abs()));
        let rounding = 32.0 * f64::EPSILON * (3.0 * lambda.abs() + 2.0 * mu) * strain;
        assert!(
            fastest.yield_function(principal, state) <= SAME * scale + rounding,
            "yield: {}",
            context()
        );
        return;
    }
    assert!(
        material.yield_function(principal, state) <= SAME * scale,
        "yield: {}",
        context()
    );
    second_return(material, response, scale, state);
}

/// Size of the terms of the yield function, Pa.
fn yield_scale(material: &Material, [first, second, third]: [f64; 3], state: &[f64]) -> f64 {
    let strength = if material.yields() {
        material.yield_function([0.0; 3], state).abs()
    } else {
        0.0
    };
    first.abs() + second.abs() + third.abs() + strength
}

/// A second return changes no more than rounding: of b's components, and of the inverse elasticity where ν is near an
/// end.
fn second_return(material: &Material, response: &Response, scale: f64, state: &[f64]) {
    let eps = response.principal_eps_e();
    let condition = (2.0 * (eps[0] - eps[2])).exp();
    if condition > CONDITION || eps[0].abs().max(eps[2].abs()) > LARGEST {
        return;
    }
    // Of elasticity by the pressure, K = p/κ; nothing is left of a stress that is less than the digits of b hold.
    let bulk = if material.is_linear() {
        0.0
    } else {
        scale / material.parameters()[0]
    };
    let Moduli { lambda, mu } = material.elastic().moduli();
    let stiffness = 3.0 * (lambda.abs() + bulk) + 2.0 * mu;
    if !material.is_linear() && 32.0 * f64::EPSILON * condition * stiffness > SAME * scale {
        return;
    }
    let again = material.respond(&response.b_e(), state);
    let again = again.unwrap_or_else(|error| panic!("{error} after a return of {material:?}: {response:?}"));
    let bulk = material.elastic().young / (3.0 - 6.0 * material.elastic().poisson);
    let elasticity = (lambda.abs() / mu).max(mu / bulk);
    let rounding = 32.0 * f64::EPSILON * (condition * stiffness + elasticity * scale);
    let before = response.principal_tau();
    let after = again.principal_tau();
    let change = (0..3).map(|k| (before[k] - after[k]).abs()).fold(0.0, f64::max);
    assert!(
        change <= SAME * scale + rounding,
        "{material:?}: {response:?} became {again:?}, {change:e} {rounding:e}"
    );
}
