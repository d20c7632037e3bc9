//! Smooths the elastic tensor b^e of the material points after a converged step, theory-manual equations (T3.5) to
//! (T3.7).

use crate::exact::Exact;
use crate::grid::{Shape, transfer};
use crate::material::Response;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::{PackedTensors, Points};
use crate::step::nodes::GridState;
use crate::tensor::Symmetric;
use crate::threads;

/// Returns the length (m) over which `passes` passes of S smooth, with splines of degree `order` on cells of size `h`
/// (m): `h sqrt(passes (q+1)/6)` (T3.6).
pub fn length(order: usize, h: f64, passes: f64) -> f64 {
    h * (passes * (order as f64 + 1.0) / 6.0).sqrt()
}

/// Averages b^e under modified F-bar (Eq. 20): b^e_p <- sum_I N_Ip (1/m_I sum_p N_Ip m_p b^e_p).
pub fn average_b_e<K, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    nodes: &GridState<D>,
    points: &mut Points<D>,
    halo: &dyn Halo,
) {
    let b_e = &points.b_e;
    let averaged = nodes.average(model, shape, points, halo, |p| b_e.at(p).0, |_, b_e| Symmetric(b_e));
    let averaged: PackedTensors<D, Symmetric> = averaged.into_iter().collect();
    if let Some(dilation) = &mut points.dilation {
        for ((dilation, after), before) in dilation.iter_mut().zip(averaged.iter()).zip(points.b_e.iter()) {
            *dilation *= (after.full().determinant() / before.full().determinant()).sqrt();
        }
    }
    points.b_e = averaged;
}

/// Returns the change of elastic strain by smoothing as a left Cauchy-Green tensor: L^-1 b^e L^-T, where L is the
/// Cholesky factor of b^e before. It is the identity where nothing changed.
pub fn change<const D: usize>(
    before: &PackedTensors<D, Symmetric>,
    after: &PackedTensors<D, Symmetric>,
) -> PackedTensors<D, Symmetric> {
    threads::each(before.len(), |p| {
        change_of_point(before.at(p), after.at(p)).unwrap_or(Symmetric::IDENTITY)
    })
    .into_iter()
    .collect()
}

/// Returns the change of one point; `None` where nothing changed.
fn change_of_point(before: Symmetric, after: Symmetric) -> Option<Symmetric> {
    if before == after {
        return None;
    }
    let inverse = before.full().cholesky()?.l().try_inverse()?;
    Some(Symmetric::of(&(inverse * after.full() * inverse.transpose())))
}

/// Plastic flow of a point in the step, for the filter of consistent F-bar.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlasticFlow {
    /// Plastic strain of the step including dilation, sqrt(2/3) |eps_trial - eps^e| (-).
    plastic: f64,
    /// Elastic dilation eps_v = tr eps^e = 1/2 ln det b^e (-).
    dilation: f64,
}

impl PlasticFlow {
    /// Evaluates a response. `gap` was open before the step; the trial strain contains it, but it did not flow in the
    /// step.
    pub fn of(response: &Response, gap: f64) -> Self {
        let trial = response.principal_eps_trial();
        let elastic = response.principal_eps_e();
        let squares: f64 = trial
            .iter()
            .zip(elastic)
            .map(|(trial, elastic)| (trial - gap / 3.0 - elastic).powi(2))
            .sum();
        Self {
            plastic: (2.0 / 3.0 * squares).sqrt(),
            dilation: elastic.iter().sum(),
        }
    }
}

/// Plastic strain that removes 63 % of the fluctuation of the elastic dilation (-): of the order of the relative
/// displacement of points, not of the elastic strain.
const RENEWING: f64 = 0.01;

/// Filters b^e under consistent F-bar: b^e_p <- exp(2/3 theta_p (S(eps_v)_p - eps_v,p)) b^e_p, with theta_p = S(1 -
/// exp(-x/0.01))_p. Returns the mean of theta over all points.
///
/// x_p = sum_I N_Ip chi_I, where chi_I is the largest plastic strain of the step among the points of node I, separately
/// for the groups of materials that averages do not mix. Two half steps filter as much as the whole step, so the filter
/// converges in the step size. Where nothing flows nearby, b^e is bitwise unchanged. The factor is a positive scalar:
/// 1/2 ln det b^e changes by theta (S(eps_v) - eps_v), and the deviator of the elastic strain is unchanged.
pub fn filter_dilation<K, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    nodes: &GridState<D>,
    points: &mut Points<D>,
    flow: &[PlasticFlow],
    halo: &dyn Halo,
) -> f64 {
    let mut flowing = [threads::largest(flow.len(), |p| flow[p].plastic)];
    halo.all_reduce_max(&mut flowing);
    if flowing[0] == 0.0 {
        return 0.0;
    }
    let grouped = model.grouped(points);
    let mut chi = transfer::largest_to_nodes(shape, grouped, |p| flow[p].plastic);
    halo.ghost_max(&mut chi, grouped.count());
    let share = transfer::to_points_grouped(shape, grouped, &chi, |_, [x]| -(-x / RENEWING).exp_m1());
    let b_e = &points.b_e;
    let filtered = nodes.average(
        model,
        shape,
        points,
        halo,
        |p| [share[p], flow[p].dilation],
        |p, [theta, mean]| {
            let change = theta * (mean - flow[p].dilation);
            (b_e.at(p).scaled((2.0 / 3.0 * change).exp()), theta, change)
        },
    );
    let elastic = points.b_e.apart();
    let dilations = points.dilation.as_mut().map(|all| threads::apart(all, 1));
    let shares = threads::of_chunks(filtered.len(), |chunk, range| {
        let only = "the chunk's only thread";
        let mut b_e = elastic[chunk].lock().expect(only);
        let mut dilation = dilations.as_ref().map(|all| all[chunk].lock().expect(only));
        let mut shares = Exact::ZERO;
        for (k, (filtered, theta, change)) in filtered[range].iter().enumerate() {
            b_e.set(k, *filtered);
            dilation.iter_mut().for_each(|dilation| dilation[k] *= change.exp());
            shares.add(*theta);
        }
        [shares]
    });
    let [shares] = threads::added(shares);
    let count = std::iter::once(filtered.len() as f64).collect();
    let sums = halo.reproducible_sum(&[shares, count]);
    sums[0] / sums[1]
}
