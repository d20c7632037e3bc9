//! Groups bodies that share a face into connected pieces.

use crate::case::Case;

/// Parts of the shortest cell by which bodies that share a face may miss each other: rounding.
const ROUNDING: f64 = 1e-6;

/// Part of the largest angular momentum, with which all bodies would move around the centre of mass, from which on a
/// piece of material rotates: less is what bodies that meet head-on have by rounding.
const ROTATING: f64 = 0.1;

impl Case {
    /// Smallest edge, m, of the boxes around the connected pieces of material: bodies whose bounds share a face are one
    /// piece.
    pub fn thinnest(&self) -> f64 {
        let dims = self.grid.dims();
        let bounds: Vec<[[f64; 3]; 2]> = self.bodies.iter().map(|body| body.region.corners()).collect();
        let boxes = self.pieces().into_iter().map(|piece| around(&bounds, &piece));
        let edges = boxes.flat_map(|[lower, upper]| (0..dims).map(move |axis| upper[axis] - lower[axis]));
        edges.fold(f64::INFINITY, f64::min)
    }

    /// Whether a piece of material rotates at the start: by the spin of a body, or by the different velocities of
    /// bodies that are connected.
    pub(crate) fn rotates_at_start(&self) -> bool {
        self.bodies.iter().any(|body| body.spin.is_some()) || self.pieces().iter().any(|piece| self.rotates(piece))
    }

    /// Whether the velocities of some bodies have an angular momentum about their centre of mass. The place of a body
    /// is the middle of its bounds.
    fn rotates(&self, piece: &[usize]) -> bool {
        let velocities = piece.iter().map(|&body| self.bodies[body].velocity.unwrap_or_default());
        let velocities: Vec<[f64; 3]> = velocities.collect();
        if velocities.iter().all(|velocity| *velocity == velocities[0]) {
            return false;
        }
        let masses: Vec<f64> = piece.iter().map(|&body| self.mass(body)).collect();
        let places = piece.iter().map(|&body| {
            let [lower, upper] = self.bodies[body].region.corners();
            std::array::from_fn(|axis| 0.5 * (lower[axis] + upper[axis]))
        });
        let arms = about_mean(places.collect(), &masses);
        let relative = about_mean(velocities, &masses);
        let mut momentum = [0.0; 3];
        let mut most = 0.0;
        for ((mass, arm), velocity) in masses.iter().zip(&arms).zip(&relative) {
            let moment = cross(*arm, *velocity);
            momentum = std::array::from_fn(|axis| momentum[axis] + mass * moment[axis]);
            most += mass * length(*arm) * length(*velocity);
        }
        length(momentum) > ROTATING * most
    }

    /// Mass of a body, kg, or in a plane kg/m; of one without density its volume.
    fn mass(&self, body: usize) -> f64 {
        let body = &self.bodies[body];
        body.area() * self.materials[body.material].density.unwrap_or(1.0)
    }

    /// Bodies of every connected piece of material.
    pub(crate) fn pieces(&self) -> Vec<Vec<usize>> {
        let bounds: Vec<[[f64; 3]; 2]> = self.bodies.iter().map(|body| body.region.corners()).collect();
        pieces(&bounds, self.grid.dims(), ROUNDING * self.grid.shortest())
    }
}

/// Vectors less their mean, which is weighted by masses.
fn about_mean(mut vectors: Vec<[f64; 3]>, masses: &[f64]) -> Vec<[f64; 3]> {
    let total: f64 = masses.iter().sum();
    for axis in 0..3 {
        let mean = vectors
            .iter()
            .zip(masses)
            .map(|(vector, mass)| mass * vector[axis])
            .sum::<f64>()
            / total;
        vectors.iter_mut().for_each(|vector| vector[axis] -= mean);
    }
    vectors
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]: [usize; 2]| a[i] * b[j] - a[j] * b[i])
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|along| along * along).sum::<f64>().sqrt()
}

/// The connected pieces of bodies with these bounds, in `dims` dimensions.
fn pieces(bounds: &[[[f64; 3]; 2]], dims: usize, slack: f64) -> Vec<Vec<usize>> {
    let touching = near_pairs(bounds, slack).filter(|&(i, j)| share_face(&bounds[i], &bounds[j], dims, slack));
    pieces_of_pairs(bounds.len(), touching.map(|(i, j)| [i, j]))
}

/// The pieces that so many bodies make of which these pairs are connected.
pub(crate) fn pieces_of_pairs(count: usize, connected: impl Iterator<Item = [usize; 2]>) -> Vec<Vec<usize>> {
    let mut piece_of: Vec<usize> = (0..count).collect();
    for pair in connected {
        let [one, other] = pair.map(|body| root(&piece_of, body));
        piece_of[one.max(other)] = one.min(other);
    }
    let mut pieces = vec![Vec::new(); count];
    (0..count).for_each(|body| pieces[root(&piece_of, body)].push(body));
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// Bounds of some bodies together.
fn around(bounds: &[[[f64; 3]; 2]], bodies: &[usize]) -> [[f64; 3]; 2] {
    let mut around = bounds[bodies[0]];
    for [lower, upper] in bodies.iter().map(|&body| bounds[body]) {
        for axis in 0..3 {
            around[0][axis] = around[0][axis].min(lower[axis]);
            around[1][axis] = around[1][axis].max(upper[axis]);
        }
    }
    around
}

/// The first body of the piece that a body belongs to.
fn root(piece_of: &[usize], mut body: usize) -> usize {
    while piece_of[body] != body {
        body = piece_of[body];
    }
    body
}

/// Pairs of bodies whose bounds along x are at most `reach` (m) apart.
pub(crate) fn near_pairs(bounds: &[[[f64; 3]; 2]], reach: f64) -> impl Iterator<Item = (usize, usize)> {
    let mut order: Vec<usize> = (0..bounds.len()).collect();
    order.sort_by(|&i, &j| bounds[i][0][0].total_cmp(&bounds[j][0][0]));
    (0..order.len()).flat_map(move |k| {
        let i = order[k];
        let end = bounds[i][1][0] + reach;
        let later: Vec<usize> = order[k + 1..]
            .iter()
            .copied()
            .take_while(|&j| bounds[j][0][0] <= end)
            .collect();
        later.into_iter().map(move |j| (i, j))
    })
}

/// Whether the bounds overlap or touch, along all axes but one by more than `slack`: an edge in common connects
/// nothing.
fn share_face(a: &[[f64; 3]; 2], b: &[[f64; 3]; 2], dims: usize, slack: f64) -> bool {
    let common = |axis: usize| a[1][axis].min(b[1][axis]) - a[0][axis].max(b[0][axis]);
    let touching = (0..dims).filter(|&axis| common(axis) >= -slack).count();
    let overlapping = (0..dims).filter(|&axis| common(axis) > slack).count();
    touching == dims && overlapping + 1 >= dims
}

#[cfg(test)]
mod tests {
    use super::{around, pieces};

    const BOX: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0]];

    /// The box, moved.
    fn moved(x: f64, y: f64) -> [[f64; 3]; 2] {
        BOX.map(|corner| [corner[0] + x, corner[1] + y, 0.0])
    }

    #[test]
    fn bodies_that_share_a_face_are_one_piece() {
        let bounds = [moved(2.0, 0.0), BOX, moved(1.0, 1.0)];
        let pieces = pieces(&bounds, 2, 1e-9);
        assert_eq!(pieces, [[0, 1, 2]]);
        assert_eq!(around(&bounds, &pieces[0]), [[0.0, 0.0, 0.0], [3.0, 3.0, 0.0]]);
    }

    #[test]
    fn bodies_that_are_apart_or_share_a_corner_are_pieces_of_their_own() {
        for [x, y] in [[1.1, 0.0], [0.0, 2.1], [1.0, 2.0], [-1.0, 2.0]] {
            assert_eq!(pieces(&[BOX, moved(x, y)], 2, 1e-9), [[0], [1]]);
        }
    }
}
