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

/// Length (m) along which so many passes of S smooth on splines of degree `order` over cells of size `h` (m):
/// `h sqrt(passes (q+1)/6)` (T3.6).
pub fn length(order: usize, h: f64, passes: f64) -> f64 {
    h * (passes * (order as f64 + 1.0) / 6.0).sqrt()
}

/// Eq. 20, modified F-bar: b^e_p <- sum_I N_Ip (1/m_I sum_p N_Ip m_p b^e_p).
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

/// What smoothing made of elastic strains: of b^e before and after it the left Cauchy-Green tensor that leads from the
/// one to the other, L^-1 b^e L^-T with the Cholesky factor L of that before; where nothing changed it is the identity.
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

/// The same of one point; `None` where nothing changed.
fn change_of_point(before: Symmetric, after: Symmetric) -> Option<Symmetric> {
    if before == after {
        return None;
    }
    let inverse = before.full().cholesky()?.l().try_inverse()?;
    Some(Symmetric::of(&(inverse * after.full() * inverse.transpose())))
}

/// What the filter of consistent F-bar needs of a point's return.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlasticFlow {
    /// -  sqrt(2/3) |eps_trial - eps^e|, the plastic strain of the step with its dilation
    plastic: f64,
    /// -  eps_v = tr eps^e = 1/2 ln det b^e
    dilation: f64,
}

impl PlasticFlow {
    /// Of one response; `gap` is what gaped before the step, which is in its trial but did not flow in it.
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

/// Plastic strain (-) that removes 63 % of the fluctuation of the elastic dilation: of the order in which points move
/// relative to each other, not of the elastic strain.
const RENEWING: f64 = 0.01;

/// Consistent F-bar: b^e_p <- exp(2/3 theta_p (S(eps_v)_p - eps_v,p)) b^e_p, theta_p = S(1 - exp(-x/0.01))_p.
///
/// x_p = sum_I N_Ip chi_I, chi_I the largest plastic strain of the step among the points that node I sees, of those
/// groups of materials by themselves that averages do not mix. Two half
/// steps have the flow of the whole, so that the filter converges in the step size, and where nothing flows within
/// reach b^e stays bit by bit. The factor is a positive scalar on the whole tensor: 1/2 ln det b^e changes by
/// theta (S(eps_v) - eps_v), the deviator of the elastic strain not at all. Returns the mean of theta over all points.
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
