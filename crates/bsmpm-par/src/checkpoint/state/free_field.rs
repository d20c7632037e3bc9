//! Free-field columns in a checkpoint.

use super::{Row, rows, vectors};
use bsmpm::interactions::state::{InteractionState, SoilColumn};
use bsmpm::points::{Number, Points};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One column of soil.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeFieldState {
    /// Every array of its points by name, row after row.
    pub arrays: BTreeMap<String, Vec<f64>>,
    /// N  what holds the state of the start at the nodes of a base that absorbs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<Vec<Row>>,
}

impl FreeFieldState {
    /// Of a column.
    pub fn of<const D: usize>(column: &SoilColumn<D>) -> Self {
        let mut points = column.points.clone();
        let arrays = points.named_columns().into_iter().map(|(name, column)| {
            let mut numbers = Vec::with_capacity(column.rows() * column.width());
            (0..column.rows()).for_each(|p| column.show(p, &mut numbers));
            (name.to_owned(), numbers)
        });
        Self {
            arrays: arrays.collect(),
            held: rows(&column.state.held),
        }
    }

    /// The column, whose laws have so many numbers of state; `None` if it is not whole.
    pub fn column<const D: usize>(&self, state: usize) -> Option<SoilColumn<D>> {
        let names: Vec<&str> = self.arrays.keys().map(String::as_str).collect();
        let mut points = Points::holding(&names, state);
        let mut columns = points.named_columns();
        let rows = self.arrays.get("id")?.len();
        for (name, column) in &mut columns {
            let numbers = self
                .arrays
                .get(*name)
                .filter(|numbers| numbers.len() == rows * column.width())?;
            for row in numbers.chunks_exact(column.width().max(1)) {
                let bytes = row
                    .iter()
                    .flat_map(|&value| bytes(column.number(), value))
                    .collect::<Vec<u8>>();
                if !column.fits(&bytes) {
                    return None;
                }
                column.take(&mut &bytes[..]);
            }
        }
        if columns.len() != names.len() {
            return None;
        }
        let state = InteractionState {
            held: vectors(&self.held)?,
            ..InteractionState::default()
        };
        Some(SoilColumn { points, state })
    }
}

/// A number as the columns take it. Ids and numbers of materials are whole, and far from where a float leaves some out.
fn bytes(number: Number, value: f64) -> Vec<u8> {
    match number {
        Number::U16 => (value as u16).to_le_bytes().to_vec(),
        Number::U64 => (value as u64).to_le_bytes().to_vec(),
        Number::F64 => value.to_le_bytes().to_vec(),
    }
}
