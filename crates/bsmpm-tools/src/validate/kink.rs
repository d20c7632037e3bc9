//! Finds a failure load: the load at which a load-displacement curve bends away from its elastic branch.

use super::course::reached;
use super::matrix::MatrixKink;
use super::measured::MeasuredNumber;
use crate::line::{BENT, FALLEN};

/// Where the straight line through the beginning of the branch after the kink meets the elastic one, and in the remark
/// where twice the elastic displacement is reached. A curve that has not gone that far shows no failure, whatever has
/// ended it: that a solver gives up is no collapse.
pub(super) fn failure(kink: &MatrixKink, curve: &[[f64; 2]]) -> Result<MeasuredNumber, String> {
    let (loads, moved): (Vec<f64>, Vec<f64>) = curve.iter().map(|&[x, y]| (x, y)).unzip();
    let end = reached(&loads, kink.elastic).ok_or("it ended within the elastic part")?;
    let (&load, &place) = loads.first().zip(moved.first()).ok_or("no row for a kink")?;
    // Settlements and the like go down: what counts is the way.
    let sense = (end.of(&moved) - place).signum();
    let curve: Vec<[f64; 2]> = curve.iter().map(|[x, y]| [x - load, sense * (y - place)]).collect();
    let elastic = sense * (end.of(&moved) - place) / (kink.elastic - load);
    if !(elastic.is_finite() && elastic > 0.0) {
        return Err("no elastic beginning for a kink".into());
    }
    let [doubled, bent, fallen] = [2.0, BENT, FALLEN].map(|many| {
        let mut places = curve.iter();
        places.find(|[x, y]| *x > 0.0 && *y > many * elastic * x).copied()
    });
    let said = |x: f64| (load + x) * kink.scale;
    let doubled = doubled.map_or("never".to_owned(), |[x, _]| format!("{:.4}", said(x)));
    let doubled = format!("twice the elastic displacement: {doubled}");
    let ends = bent.zip(fallen.or(curve.last().copied()));
    let Some((from, to)) = ends.filter(|(from, to)| to[0] > from[0]) else {
        let end = curve.last().map_or(load, |[x, _]| said(*x));
        return Err(format!("no kink before its end at {end:.4}; {doubled}"));
    };
    let steep = (to[1] - from[1]) / (to[0] - from[0]);
    let meet = (from[1] - steep * from[0]) / (elastic - steep);
    Ok(MeasuredNumber {
        value: said(meet),
        remark: Some(doubled),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINK: MatrixKink = MatrixKink {
        x: String::new(),
        y: String::new(),
        elastic: 0.2,
        scale: 2.0,
    };

    /// Straight, and a hundred times as soft from 0.7 on.
    fn bent(loads: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
        loads.map(|x| [x, x + 100.0 * (x - 0.7).max(0.0)]).collect()
    }

    #[test]
    fn a_kink_is_where_both_lines_meet() {
        let curve = bent((0..=50).map(|k| f64::from(k) / 50.0));
        let found = failure(&KINK, &curve).unwrap();
        assert!((found.value - 1.4).abs() < 1e-9, "{found:?}");
        assert_eq!(found.remark.as_deref(), Some("twice the elastic displacement: 1.4400"));
        let settling: Vec<[f64; 2]> = curve.iter().map(|[x, y]| [*x, 3.0 - y]).collect();
        assert!((failure(&KINK, &settling).unwrap().value - 1.4).abs() < 1e-9);
    }

    #[test]
    fn the_number_of_rows_and_where_they_are_dense_do_not_count() {
        // Steps that are cut near failure, and a run that ends soon after it.
        let cut = bent(
            (0..=13)
                .map(|k| f64::from(k) / 20.0)
                .chain((1..=150).map(|k| 0.65 + f64::from(k) / 1000.0)),
        );
        assert!((failure(&KINK, &cut).unwrap().value - 1.4).abs() < 1e-9);
    }

    #[test]
    fn a_curve_that_ends_before_it_bends_shows_no_failure() {
        let curve = bent((0..=36).map(|k| f64::from(k) / 50.0));
        let reason = failure(&KINK, &curve).unwrap_err();
        assert_eq!(
            reason,
            "no kink before its end at 1.4400; twice the elastic displacement: 1.4400"
        );
        assert!(failure(&KINK, &curve[..5]).unwrap_err().contains("elastic part"));
        assert!(
            failure(&KINK, &[[0.0, 1.0], [0.5, 1.0]])
                .unwrap_err()
                .contains("no elastic beginning")
        );
        assert!(failure(&KINK, &[]).is_err());
    }
}
