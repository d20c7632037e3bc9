//! Validates the retention curve of a soil.

use crate::record::{Field, ListRow};
use crate::report::Report;
use crate::schema::RetentionTable;
use crate::validate::course::increasing;
use bsmpm::field::pore_water::retention::{Curve, MeasuredCurve, Retention};

/// How much water a soil keeps under suction.
pub(super) fn retention(of: &RetentionTable, report: &mut Report<'_>) -> Option<Retention> {
    let residual = of.residual.get()?;
    if !of.curve.is_given() {
        if !of.n.is_given() {
            let message = "E0507: `alpha` of van Genuchten's curve requires `n`, which is missing. Add `n`, or give a \
                           measured `curve` instead.";
            of.alpha.error(message, report);
            return None;
        }
        return Some(Retention::van_genuchten(of.alpha.get()?, of.n.get()?, residual));
    }
    if of.n.is_given() {
        let message = "E0508: `n` has no effect with a measured `curve`. Remove `n`, or replace `curve` by `alpha`.";
        of.n.error(message, report);
        return None;
    }
    let rows = measured(&of.curve, residual, report)?;
    Some(Retention::new(Curve::Measured(MeasuredCurve::new(rows)), residual))
}

/// Rows of a measured curve: suction head, effective saturation, relative permeability.
fn measured(key: &Field<Vec<ListRow>>, residual: f64, report: &mut Report<'_>) -> Option<Vec<[f64; 3]>> {
    let rows: Vec<[f64; 3]> = increasing(key, report)?.map(|row| [row[0], row[1], row[2]]).collect();
    let mut pairs = rows.windows(2);
    let last = rows[rows.len() - 1];
    let wrong = if rows[0] != [0.0, 1.0, 1.0] {
        Some(
            "E0509: the first row must be that of saturated soil, with zero suction. Begin the curve with [0, 1, \
              1]."
            .into(),
        )
    } else if rows.len() < 2 {
        let message = "E0509: the curve has one row, but needs at least two. Add rows [suction head, saturation, \
                       relative permeability].";
        Some(message.into())
    } else if let Some(pair) = pairs.find(|pair| pair[1][1] > pair[0][1] || pair[1][2] > pair[0][2]) {
        let to = pair[1][0];
        let from = pair[0][0];
        Some(format!(
            "E0509: from a suction head of {from} m to {to} m the saturation or relative permeability increases. Give \
             values that decrease or stay constant."
        ))
    } else if last[1] < residual {
        Some(format!(
            "E0509: the last saturation, {}, is below the residual saturation, {residual}. Reduce `residual`, or \
             end the curve at a higher saturation.",
            last[1]
        ))
    } else {
        None
    };
    if let Some(message) = wrong {
        key.error(message, report);
        return None;
    }
    Some(
        rows.into_iter()
            .map(|[s, kept, k]| [s, (kept - residual) / (1.0 - residual), k])
            .collect(),
    )
}
