//! Invariants of stress and strain, density and mobilised strength of a material point.

use crate::material::LayeredMaterial;
use crate::points::Points;
use crate::tensor::Symmetric;

/// Returns the mean normal stress, positive in compression: -tr(sigma)/3 (Pa).
pub fn pressure(sigma: &Symmetric) -> f64 {
    -sigma.0[..3].iter().sum::<f64>() / 3.0
}

/// Returns the deviatoric stress q = sqrt(3/2 s:s) (Pa).
pub fn deviatoric(sigma: &Symmetric) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = sigma.0;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

/// Returns the principal values in descending order.
pub fn principal(tensor: &Symmetric) -> [f64; 3] {
    let mut values: [f64; 3] = tensor.full().symmetric_eigenvalues().into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Returns the deviatoric part of a point's total logarithmic strain since the start: sqrt(2/3 e:e), e the deviator of
/// ln V, V^2 = F F^T (-).
pub fn deviatoric_strain<const D: usize>(points: &Points<D>, p: usize) -> f64 {
    let F = points.F.at(p);
    let strains = principal(&Symmetric::of(&(F * F.transpose()))).map(|square| 0.5 * square.ln());
    let mean = strains.iter().sum::<f64>() / 3.0;
    (strains.iter().map(|strain| (strain - mean).powi(2)).sum::<f64>() / 1.5).sqrt()
}

/// Returns the current density of a point (kg/m3).
pub fn density<const D: usize>(points: &Points<D>, p: usize) -> f64 {
    points.mass[p] / (points.volume[p] * points.F.at(p).determinant())
}

/// Returns the mobilised strength of a point, see [`Material::mobilised`](crate::material::Material::mobilised). It is
/// computed from the stress that the law returned: the Kirchhoff stress with the volume ratio J-bar.
pub fn mobilised<const D: usize>(materials: &[LayeredMaterial], points: &Points<D>, p: usize) -> f64 {
    let law = materials[usize::from(points.material[p])].at(points.height(p));
    let dilation = points.F.at(p).determinant() * points.dilation_of(p);
    law.mobilised(principal(&points.sigma.at(p).scaled(dilation)), points.state_of(p))
}
