//! After a step, corrects velocities of material points within a cell of a fixed face, theory-manual equation (T6.2).

use crate::boundary::Support;
use crate::exact::Exact;
use crate::grid::Grid;
use crate::model::{Model, WallVelocity};
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;
use crate::threads;

/// Rate of the relaxation (-) per path of the excess velocity in cells. It is determined by run-outs of a
/// dam break (commits fe945cd8 and f99b65e3).
const RATE: f64 = 4.0;

/// Displacement since the start (in cells) from which the velocity of a point near a fixed face counts. Vibrating
/// ground has such velocities too, but does not slide by them.
const LEAST_PATH: f64 = 0.05;

/// Layer of cells at a face of the grid where all components are fixed.
#[derive(Clone, Copy, Debug)]
struct Layer {
    /// Axis normal to the face.
    axis: usize,
    /// Position of the face (m).
    face: f64,
    /// Position of the other end of the cells (m).
    end: f64,
}

impl Layer {
    /// Returns the layer at the face of a support.
    fn at<const D: usize>(grid: &Grid<D>, support: &Support<D>) -> Self {
        let axis = &grid.axes()[support.axis];
        let cells = axis.cells();
        let [face, end] = if support.upper { [cells, cells - 1] } else { [0, 1] };
        Self {
            axis: support.axis,
            face: axis.breakpoint(face),
            end: axis.breakpoint(end),
        }
    }

    /// Returns the distance from the face in cells (-), if the position is in the layer.
    fn depth<const D: usize>(&self, x: &Vector<D>) -> Option<f64> {
        let depth = (x[self.axis] - self.face) / (self.end - self.face);
        (0.0..=1.0).contains(&depth).then_some(depth)
    }

    /// Returns the thickness (m).
    fn thickness(&self) -> f64 {
        (self.end - self.face).abs()
    }
}

/// Returns the layers at all faces where all components are fixed.
fn layers<K, const D: usize>(model: &Model<K, D>) -> Vec<Layer> {
    model
        .boundary
        .supports
        .iter()
        .filter(|support| support.velocity == [Some(0.0); D])
        .map(|support| Layer::at(&model.grid, support))
        .collect()
}

/// Relaxes the velocities of the points near fixed faces towards du/dt. `du` is their displacement (m) in the step of
/// size `dt` (s). The points are still at their positions at the start.
pub fn relax<K, const D: usize>(model: &Model<K, D>, points: &mut Points<D>, du: &[Vector<D>], dt: f64) {
    if model.wall_velocity == WallVelocity::Own {
        return;
    }
    let layers = layers(model);
    let degree = model.grid.order() as i32;
    let Points {
        x,
        motion: Some(motion),
        ..
    } = points
    else {
        return;
    };
    threads::change(&mut motion.v, 1, |p, v| {
        let near = layers
            .iter()
            .filter_map(|layer| Some((layer.thickness(), layer.depth(&x[p])?)));
        let mut thickness = f64::INFINITY;
        let mut others = 1.0;
        for (of_layer, depth) in near {
            thickness = of_layer.min(thickness);
            others *= 1.0 - (1.0 - depth).powi(degree);
        }
        let excess = v[0] - du[p] / dt;
        let path = excess.norm() * dt / thickness;
        v[0] -= excess * ((1.0 - others) * (RATE * path).min(1.0));
    });
}

/// Returns the kinetic energy of points within a cell of a fixed face in excess of that of du/dt (J), over all ranks.
/// `du` is their displacement (m) in the step of size `dt` (s). Points that have hardly moved since the start do not
/// count. `None` without such a face or without inertia.
pub fn excess<K, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    du: &[Vector<D>],
    dt: f64,
    halo: &dyn Halo,
) -> Option<f64> {
    let layers = layers(model);
    let v = &points.motion.as_ref().filter(|_| !layers.is_empty())?.v;
    let mut sum = Exact::ZERO;
    for p in 0..points.len() {
        let x = &points.x[p];
        let path = (points.u[p] + du[p]).norm();
        let counts = layers
            .iter()
            .any(|layer| layer.depth(x).is_some() && path > LEAST_PATH * layer.thickness());
        if counts {
            sum.add(0.5 * points.mass[p] * (v[p].norm_squared() - (du[p] / dt).norm_squared()));
        }
    }
    Some(halo.reproducible_sum(&[sum])[0])
}
