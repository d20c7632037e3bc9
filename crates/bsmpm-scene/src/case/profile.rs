//! Data of profiles: fields along a line.

use super::Column;
use crate::observables::ProfileQuantity;

/// Fields at equally spaced places of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// What its file is called after.
    pub name: String,
    /// Axes of the geometry.
    pub dims: usize,
    /// m  ends of the line, in the case's coordinates
    pub ends: [[f64; 3]; 2],
    /// Places, the ends among them; one stands in the middle.
    pub count: usize,
    /// What is reported of each.
    pub quantities: Vec<ProfileQuantity>,
    /// s (quasi-static: pseudo-time)  when, increasing, within (0, end], hit exactly; empty: at the start, with
    /// every frame that is wanted, and at the end
    pub times: Vec<f64>,
    /// The places stay where they are in space; they belong to the material else.
    pub fixed: bool,
}

impl Profile {
    /// The name of its file.
    pub fn file(&self) -> String {
        format!("profile_{}.csv", self.name)
    }

    /// Columns of the file after step and time.
    pub fn columns(&self) -> Vec<Column> {
        let quantities = self.quantities.iter().flat_map(|quantity| {
            let names = quantity.column_names(self.dims).into_iter();
            names.map(|name| (name, quantity.unit()))
        });
        let places = ["distance", "x", "y", "z"].into_iter().take(1 + self.dims);
        let all = places.map(|name| (name.to_owned(), "m")).chain(quantities);
        let columns = all.map(|(name, unit)| Column {
            name,
            unit: unit.to_owned(),
        });
        columns.collect()
    }

    /// Places on the line (m, in the case's coordinates), and their distances from its beginning, m.
    pub fn places(&self) -> Vec<(f64, [f64; 3])> {
        let [from, to] = self.ends;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]).hypot(to[2] - from[2]);
        let parts = (0..self.count).map(|number| match self.count {
            1 => 0.5,
            count => number as f64 / (count - 1) as f64,
        });
        let places = parts.map(|part| {
            let at = [0, 1, 2].map(|axis| (1.0 - part) * from[axis] + part * to[axis]);
            (part * length, at)
        });
        places.collect()
    }
}
