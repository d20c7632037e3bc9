//! Makes coarser versions of a case, for trial runs.

use bsmpm_scene::{Case, GridAxis};
use toml::{Table, Value};

/// Points along each axis of a cell: more make a step dearer, and hardly change how many iterations it takes.
const POINTS: i64 = 3;
/// Cells across the thinnest body below which a form says nothing.
const FEWEST: f64 = 2.0;
/// Cells of coarse forms over the case's own, the coarsest first.
pub(super) const FACTORS: [usize; 4] = [16, 8, 4, 2];

/// The text of a form with cells that many times as long; none where it would be too coarse, or no valid case.
pub(super) fn text(case: &Case, factor: usize) -> Option<String> {
    let mut fewest = f64::INFINITY;
    for body in &case.bodies {
        let [lower, upper] = body.bounds();
        for axis in 0..2 {
            let length = factor as f64 * case.grid.axes[axis].longest();
            fewest = fewest.min((upper[axis] - lower[axis]) / length);
        }
    }
    if fewest < FEWEST {
        return None;
    }
    let mut table: Table = case.text.parse().ok()?;
    for key in ["output", "history", "check"] {
        table.remove(key);
    }
    let grid = table.get_mut("grid")?.as_table_mut()?;
    for key in ["lower", "upper", "cell"] {
        grid.remove(key);
    }
    let mut of_axes = Table::new();
    for (axis, name) in (0..case.grid.dims()).zip(["x", "y", "z"]) {
        let lines: Vec<usize> = case.grid.lines[axis].iter().map(|line| line.breakpoint).collect();
        of_axes.insert(name.to_owned(), knots(&case.grid.axes[axis], &lines, factor));
    }
    grid.insert("knots".to_owned(), Value::Table(of_axes));
    for body in table.get_mut("body")?.as_array_mut()? {
        let points = body.get_mut("points_per_cell")?;
        *points = Value::Integer(points.as_integer()?.min(POINTS));
    }
    let text = table.to_string();
    Case::from_text("coarse form", &text, &[]).ok().map(|_| text)
}

/// Every so many breakpoints, and the last; a rest of less than half a cell goes to the one before. Breakpoints that
/// are repeated stay, as the form is to have them, too, in place of others less than half a cell away.
fn knots(axis: &GridAxis, lines: &[usize], factor: usize) -> Value {
    let cells = axis.cells();
    let mut kept: Vec<usize> = (0..=cells).step_by(factor).collect();
    let rest = cells % factor;
    if rest > 0 && 2 * rest < factor && kept.len() > 1 {
        kept.pop();
    }
    if rest > 0 {
        kept.push(cells);
    }
    let ends = [0, cells];
    kept.retain(|k| ends.contains(k) || lines.iter().all(|line| 2 * line.abs_diff(*k) >= factor));
    kept.extend(lines);
    kept.sort_unstable();
    kept.dedup();
    Value::Array(
        kept.into_iter()
            .map(|i| Value::Float(axis.lower() + axis.breakpoint(i)))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMN: &str = include_str!("../../../../cases/short/column_collapse.toml");
    const FOOTING: &str = include_str!("../../../../cases/short/strip_footing.toml");

    #[test]
    fn forms_have_the_same_body_in_larger_cells_as_long_as_it_has_two_across() {
        for text in [COLUMN, FOOTING] {
            let case = Case::from_text("case", text, &[]).unwrap();
            let coarse = Case::from_text("coarse", &super::text(&case, 2).unwrap(), &[]).unwrap();
            assert!(
                coarse.grid.axes[0].cells() == case.grid.axes[0].cells().div_ceil(2) && coarse.histories.is_empty()
            );
            let apart = (0..2).map(|axis| (coarse.grid.upper()[axis] - case.grid.upper()[axis]).abs());
            assert!(apart.fold(0.0, f64::max) <= 1e-12);
            assert_eq!(coarse.bodies[0].area(), case.bodies[0].area());
            assert!(super::text(&case, 4).is_some() && super::text(&case, 8).is_none());
        }
    }

    #[test]
    fn a_rest_of_cells_makes_one_more_or_a_longer_one() {
        let lengths = |cells: usize, lines: &[usize], factor: usize| {
            let value = knots(
                &GridAxis::Uniform {
                    lower: 1.0,
                    cell: 1.0,
                    cells,
                },
                lines,
                factor,
            );
            let at: Vec<f64> = value
                .as_array()
                .unwrap()
                .iter()
                .map(|x| x.as_float().unwrap())
                .collect();
            at.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>()
        };
        assert_eq!(lengths(8, &[], 4), [4.0, 4.0]);
        assert_eq!(lengths(9, &[], 4), [4.0, 5.0]);
        assert_eq!(lengths(11, &[], 4), [4.0, 4.0, 3.0]);
        assert_eq!(lengths(1, &[], 4), [1.0]);
        // A line inside, and one beside a breakpoint that goes.
        assert_eq!(lengths(8, &[2], 4), [2.0, 2.0, 4.0]);
        assert_eq!(lengths(8, &[3], 4), [3.0, 5.0]);
    }
}
