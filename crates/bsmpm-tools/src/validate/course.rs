//! Evaluates one history column as a function of another: where it first reaches a value, and means over an interval.

/// Relative distance at which two values are the same.
const SAME: f64 = 1e-9;

/// A place in a history: a row, and the share of the way to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    pub row: usize,
    pub share: f64,
}

impl Spot {
    /// The value of a column there, between the rows linearly.
    pub fn of(self, values: &[f64]) -> f64 {
        match self.share {
            0.0 => values[self.row],
            share => values[self.row] + share * (values[self.row + 1] - values[self.row]),
        }
    }
}

/// Where a column first reaches a value, from whichever side it comes.
pub(super) fn reached(across: &[f64], value: f64) -> Option<Spot> {
    let side = (value - across.first()?).signum();
    for (row, &x) in across.iter().enumerate() {
        if (x - value).abs() <= SAME * value.abs() {
            return Some(Spot { row, share: 0.0 });
        }
        if row > 0 && (x - value) * side > 0.0 {
            let before = across[row - 1];
            return Some(Spot {
                row: row - 1,
                share: (value - before) / (x - before),
            });
        }
    }
    None
}

/// Both columns from one spot to another: the ends, and the rows between them.
pub(super) fn window(across: &[f64], up: &[f64], from: Spot, to: Spot) -> Vec<[f64; 2]> {
    let last = if to.share == 0.0 { to.row } else { to.row + 1 };
    let mut window = vec![[from.of(across), from.of(up)]];
    window.extend((from.row + 1..last).map(|row| [across[row], up[row]]));
    if to != from {
        window.push([to.of(across), to.of(up)]);
    }
    window
}

/// The integral over a window, by trapezia, divided by its length; of a window without length its value.
pub(super) fn mean(window: &[[f64; 2]]) -> f64 {
    let Some((first, last)) = window.first().zip(window.last()) else {
        return f64::NAN;
    };
    let length = last[0] - first[0];
    if length == 0.0 {
        return first[1];
    }
    let trapezia = window
        .windows(2)
        .map(|pair| (pair[1][0] - pair[0][0]) * (pair[0][1] + pair[1][1]) / 2.0);
    trapezia.sum::<f64>() / length
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_found_where_it_is_first_reached() {
        let up_and_down = [0.0, 1.0, 3.0, 1.0, 4.0];
        assert_eq!(reached(&up_and_down, 2.0), Some(Spot { row: 1, share: 0.5 }));
        assert_eq!(reached(&up_and_down, 3.0 + 1e-10), Some(Spot { row: 2, share: 0.0 }));
        assert_eq!(
            reached(&up_and_down, 3.5).map(|spot| spot.of(&[0.0, 0.0, 0.0, 6.0, 12.0])),
            Some(11.0)
        );
        assert_eq!(reached(&up_and_down, 5.0), None);
        assert_eq!(reached(&up_and_down, 0.0), Some(Spot { row: 0, share: 0.0 }));
        assert_eq!(reached(&[0.0, -1.0, -2.0], -1.5), Some(Spot { row: 1, share: 0.5 }));
        assert_eq!(reached(&[], 1.0), None);
    }

    #[test]
    fn a_window_ends_between_rows_and_uneven_rows_count_by_their_length() {
        let across = [0.0, 1.0, 3.0, 4.0];
        let up = [0.0, 2.0, 6.0, 8.0];
        let ends = |from, to| (reached(&across, from).unwrap(), reached(&across, to).unwrap());
        let (from, to) = ends(0.5, 3.5);
        assert_eq!(
            window(&across, &up, from, to),
            [[0.5, 1.0], [1.0, 2.0], [3.0, 6.0], [3.5, 7.0]]
        );
        assert_eq!(mean(&window(&across, &up, from, to)), 4.0);
        let (from, to) = ends(1.0, 3.0);
        assert_eq!(window(&across, &up, from, to), [[1.0, 2.0], [3.0, 6.0]]);
        let (from, to) = ends(1.0, 1.0);
        assert_eq!(mean(&window(&across, &up, from, to)), 2.0);
        let (from, to) = ends(1.5, 2.5);
        assert_eq!(window(&across, &up, from, to), [[1.5, 3.0], [2.5, 5.0]]);
    }
}
