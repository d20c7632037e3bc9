//! Step (11e): smoothing of the elastic state that the next step starts from, once a converged step.

use crate::grid::{Shape, transfer};
use crate::material::Response;
use crate::model::Model;
use crate::points::Points;
use crate::seam::Halo;
use crate::step::nodes::Nodes;
use crate::tensor::Symmetric;

/// Eq. 20, modified F-bar: b^e_p <- sum_I N_Ip (1/m_I sum_p N_Ip m_p b^e_p).
pub fn average_b_e<K, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    nodes: &Nodes<D>,
    points: &mut Points<D>,
    halo: &dyn Halo,
) {
    let nodal = nodes.average(shape, points, model.weighting, halo, |p| points.b_e[p].0);
    transfer::to_points(shape, &nodal, |p, b_e| points.b_e[p] = Symmetric(b_e));
}

/// What the filter of consistent F-bar needs of a point's return.
#[derive(Clone, Copy, Debug)]
pub struct Flow {
    /// -  |eps_trial - eps^e|, the plastic strain of the step with its dilation
    plastic: f64,
    /// -  |eps^e|
    elastic: f64,
    /// -  eps_v = tr eps^e = 1/2 ln det b^e
    dilation: f64,
}

impl Flow {
    /// Of one response.
    pub fn of(response: &Response) -> Self {
        let (trial, elastic) = (response.principal_eps_trial(), response.principal_eps_e());
        let norm = |eps: [f64; 3]| eps.iter().map(|eps| eps * eps).sum::<f64>().sqrt();
        Self {
            plastic: norm(std::array::from_fn(|a| trial[a] - elastic[a])),
            elastic: norm(elastic),
            dilation: elastic.iter().sum(),
        }
    }
}

/// Consistent F-bar: b^e_p <- exp(2/3 theta_p (S[eps_v]_p - eps_v,p)) b^e_p, theta_p = S[1 - exp(-x)]_p.
///
/// x_p is the plastic over the elastic strain around the point: sum_I N_Ip max_I |eps_trial - eps^e| over sum_I N_Ip
/// max_I |eps^e|, max_I among the points that node I sees. Flow as large as the elastic strain has renewed it, and with it
/// goes the memory of its fluctuation; two half steps have the flow of the whole, so that the filter converges in the
/// step size, and where nothing flows within reach b^e stays bit by bit. The factor is a positive scalar on the whole
/// tensor: 1/2 ln det b^e changes by theta (S[eps_v] - eps_v), the deviator of the elastic strain not at all.
pub fn filter_dilation<K, const D: usize>(
    model: &Model<K, D>,
    (shape, nodes): (&Shape<D>, &Nodes<D>),
    points: &mut Points<D>,
    flow: &[Flow],
    halo: &dyn Halo,
) {
    let mut flowing = [flow.iter().map(|flow| flow.plastic).fold(0.0, f64::max)];
    halo.maximum(&mut flowing);
    if flowing[0] == 0.0 {
        return;
    }
    let mut largest = vec![0.0; nodes.weight.len() * 2];
    transfer::largest_to_nodes(shape, &mut largest, |p| [flow[p].plastic, flow[p].elastic]);
    halo.max(&mut largest, 2);
    let mut share = vec![0.0; points.len()];
    transfer::to_points(shape, &largest, |p, [plastic, elastic]| {
        share[p] = if plastic > 0.0 { -(-plastic / elastic).exp_m1() } else { 0.0 };
    });
    let nodal = nodes.average(shape, points, model.weighting, halo, |p| [share[p], flow[p].dilation]);
    transfer::to_points(shape, &nodal, |p, [theta, mean]| {
        let change = theta * (mean - flow[p].dilation);
        points.b_e[p] = points.b_e[p].scaled((2.0 / 3.0 * change).exp());
    });
}
