//! Tests of the constitutive laws.

mod cam_clay;
mod continuity;
mod cut_off;
mod driver;
mod drucker_prager;
mod eigen;
mod element;
mod gap;
mod input;
mod lanes;
mod mobilised;
mod mu_i;
mod projection;
mod random;
mod reference;
mod softening;
mod stiffness;
mod tangent;
mod von_mises;
mod yield_surface;

use bsmpm::material::{Branch, Elastic, Hencky, Material, MohrCoulomb, Response};
use bsmpm::tensor::{Symmetric, Tensor};

/// Every region of a response.
const REGIONS: [Branch; 5] = [
    Branch::Elastic,
    Branch::Face,
    Branch::LeftEdge,
    Branch::RightEdge,
    Branch::Apex,
];

fn hencky(young: f64, poisson: f64) -> Material {
    Material::Hencky(Hencky {
        elastic: Elastic { young, poisson },
    })
}

/// Angles in degrees.
fn mohr_coulomb(young: f64, poisson: f64, friction: f64, dilation: f64, cohesion: f64) -> Material {
    let friction = friction.to_radians();
    let dilation = dilation.to_radians();
    Material::MohrCoulomb(MohrCoulomb::new(
        Elastic { young, poisson },
        friction,
        dilation,
        cohesion,
    ))
}

/// `b = diag(exp(2 ε))`.
fn stretched(eps: [f64; 3]) -> Symmetric {
    let [x, y, z] = eps.map(|e| (2.0 * e).exp());
    Symmetric([x, y, z, 0.0, 0.0, 0.0])
}

/// `q b qᵀ`.
fn turned(q: &Tensor, b: &Symmetric) -> Symmetric {
    Symmetric::of(&(q * b.full() * q.transpose()))
}

fn respond(material: &Material, b: &Symmetric) -> Response {
    material
        .respond(b, &[])
        .unwrap_or_else(|error| panic!("{error} for {material:?}"))
}

/// The response of a law with one state variable, and what that is after it.
fn answer(material: &Material, b: &Symmetric, state: f64) -> (Response, f64) {
    let response = material.respond(b, &[state]).expect("an admissible trial");
    let mut after = [state];
    response.advance(&mut after);
    (response, after[0])
}

fn largest(t: &[f64]) -> f64 {
    t.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

fn difference(a: &Symmetric, b: &Symmetric) -> f64 {
    (0..6).map(|i| (a.0[i] - b.0[i]).abs()).fold(0.0, f64::max)
}
