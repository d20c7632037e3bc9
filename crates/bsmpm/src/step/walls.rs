//! After a step, corrects velocities of material points within a cell of a fixed face, theory-manual equation (T6.2).

use crate::boundary::Support;
use crate::exact::Exact;
use crate::grid::Grid;
use crate::model::{Model, WallVelocity};
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;
use crate::threads;

/// Rate of the relaxation (-), over the path of the excess velocity in cells. For the run-outs that chose it see
/// `decisions.md` of the manual.
const RATE: f64 = 4.0;

/// Cells by which a point beside a fixed face must have been displaced since the start for its velocity to count.
/// Ground that vibrates about its place keeps such velocities too, but nothing slides by them.
const LEAST_PATH: f64 = 0.05;

/// The cells at a face of the grid that holds all components.
#[derive(Clone, Copy, Debug)]
struct Layer {
    /// normal of the face
    axis: usize,
    /// m  the face
    face: f64,
    /// m  the other end of the cells
    end: f64,
}

impl Layer {
    /// The cells at the face of a support.
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

    /// Distance (-) from the face in cells, if the place is in the layer.
    fn depth<const D: usize>(&self, x: &Vector<D>) -> Option<f64> {
        let depth = (x[self.axis] - self.face) / (self.end - self.face);
        (0.0..=1.0).contains(&depth).then_some(depth)
    }

    /// Thickness, m.
    fn thickness(&self) -> f64 {
        (self.end - self.face).abs()
    }
}

/// The cells at all faces that hold all components.
fn layers<K, const D: usize>(model: &Model<K, D>) -> Vec<Layer> {
    model
        .boundary
        .supports
        .iter()
        .filter(|support| support.velocity == [Some(0.0); D])
        .map(|support| Layer::at(&model.grid, support))
        .collect()
}

/// Relaxes the velocities of the points near fixed faces to those of their displacement `du`, m, in the step of the
/// length `dt`, s. The points are still where they were at its start.
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

/// Kinetic energy, J, that points within a cell of a face which holds all components have by their velocities, beyond
/// that of the motion `du`, m, which they make in the step of the length `dt`, over all ranks. Points that have hardly
/// moved since the start do not count. `None` without such a face, or without inertia.
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
