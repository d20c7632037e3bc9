//! Which bodies are connected: layers and slices that share a face are one piece of material.

use crate::case::Case;

/// Parts of the shortest cell by which bodies that share a face may miss each other: rounding.
const ROUNDING: f64 = 1e-6;

impl Case {
    /// Smallest edge, m, of the boxes around the connected pieces of material: bodies whose bounds share a face are one
    /// piece.
    pub fn thinnest(&self) -> f64 {
        let bounds: Vec<[[f64; 3]; 2]> = self.bodies.iter().map(|body| body.region.corners()).collect();
        let dims = self.grid.dims();
        let pieces = pieces(&bounds, dims, ROUNDING * self.grid.shortest());
        let edges = pieces.iter().flat_map(|[lower, upper]| (0..dims).map(|axis| upper[axis] - lower[axis]));
        edges.fold(f64::INFINITY, f64::min)
    }
}

/// Bounds of the connected pieces of bodies with these bounds, in `dims` dimensions.
fn pieces(bounds: &[[[f64; 3]; 2]], dims: usize, slack: f64) -> Vec<[[f64; 3]; 2]> {
    let mut piece_of: Vec<usize> = (0..bounds.len()).collect();
    for (i, j) in near_pairs(bounds, slack) {
        if share_face(&bounds[i], &bounds[j], dims, slack) {
            let [one, other] = [i, j].map(|body| root(&piece_of, body));
            piece_of[one.max(other)] = one.min(other);
        }
    }
    let mut pieces: Vec<Option<[[f64; 3]; 2]>> = vec![None; bounds.len()];
    for (body, [lower, upper]) in bounds.iter().enumerate() {
        let [least, most] = pieces[root(&piece_of, body)].get_or_insert([*lower, *upper]);
        for axis in 0..dims {
            least[axis] = least[axis].min(lower[axis]);
            most[axis] = most[axis].max(upper[axis]);
        }
    }
    pieces.into_iter().flatten().collect()
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
        let later: Vec<usize> = order[k + 1..].iter().copied().take_while(|&j| bounds[j][0][0] <= end).collect();
        later.into_iter().map(move |j| (i, j))
    })
}

/// Whether the bounds overlap or touch, along all axes but one by more than `slack`: an edge in common connects nothing.
fn share_face(a: &[[f64; 3]; 2], b: &[[f64; 3]; 2], dims: usize, slack: f64) -> bool {
    let common = |axis: usize| a[1][axis].min(b[1][axis]) - a[0][axis].max(b[0][axis]);
    let touching = (0..dims).filter(|&axis| common(axis) >= -slack).count();
    let overlapping = (0..dims).filter(|&axis| common(axis) > slack).count();
    touching == dims && overlapping + 1 >= dims
}

#[cfg(test)]
mod tests {
    use super::pieces;

    const BOX: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0]];

    /// The box, moved.
    fn moved(x: f64, y: f64) -> [[f64; 3]; 2] {
        BOX.map(|corner| [corner[0] + x, corner[1] + y, 0.0])
    }

    #[test]
    fn bodies_that_share_a_face_are_one_piece() {
        assert_eq!(pieces(&[moved(2.0, 0.0), BOX, moved(1.0, 1.0)], 2, 1e-9), [[[0.0, 0.0, 0.0], [3.0, 3.0, 0.0]]]);
    }

    #[test]
    fn bodies_that_are_apart_or_share_a_corner_are_pieces_of_their_own() {
        for [x, y] in [[1.1, 0.0], [0.0, 2.1], [1.0, 2.0], [-1.0, 2.0]] {
            assert_eq!(pieces(&[BOX, moved(x, y)], 2, 1e-9), [BOX, moved(x, y)]);
        }
    }
}
