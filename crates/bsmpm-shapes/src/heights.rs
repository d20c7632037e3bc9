//! Reads heights from the contents of an ASCII grid, the raster format of geographic information systems.

use crate::error::HeightsError;
use std::collections::BTreeMap;
use std::iter::Peekable;
use std::str::SplitWhitespace;

/// Header of an ASCII grid: numbers by their keys in lower case.
struct GridHeader(BTreeMap<String, f64>);

impl GridHeader {
    /// Takes the header from the beginning of the words of a grid.
    fn of(words: &mut Peekable<SplitWhitespace<'_>>) -> Result<Self, HeightsError> {
        let mut header = BTreeMap::new();
        while let Some(key) = words.next_if(|word| word.parse::<f64>().is_err()) {
            let value = words.next().and_then(|word| word.parse::<f64>().ok());
            let Some(value) = value.filter(|value| value.is_finite()) else {
                return Err(HeightsError::HeaderNumber { key: key.to_owned() });
            };
            header.insert(key.to_ascii_lowercase(), value);
        }
        Ok(Self(header))
    }

    /// The number of a key, if the header has it.
    fn number(&self, key: &str) -> Option<f64> {
        self.0.get(key).copied()
    }

    /// The number of a required key.
    fn needed(&self, key: &str) -> Result<f64, HeightsError> {
        self.number(key)
            .ok_or_else(|| HeightsError::HeaderKey { key: key.to_owned() })
    }

    /// Middle of the first cell (m) along the axis with a name, for cells of an edge (m).
    fn first(&self, axis: &str, cell: f64) -> Result<f64, HeightsError> {
        match self.number(&format!("{axis}llcenter")) {
            Some(center) => Ok(center),
            None => self
                .needed(&format!("{axis}llcorner"))
                .map(|corner| corner + 0.5 * cell),
        }
    }
}

/// Returns the points `[x, y, z]` (m) of an ASCII grid, at the middles of its cells, row by row from the north.
///
/// The header has the keys `ncols`, `nrows`, `cellsize`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`, and
/// optionally `nodata_value`.
///
/// # Errors
/// Missing keys of the header, a number of heights that does not match the header, text in the place of a number, and
/// cells without data.
pub fn ascii_grid(text: &str) -> Result<Vec<[f64; 3]>, HeightsError> {
    let mut words = text.split_whitespace().peekable();
    let header = GridHeader::of(&mut words)?;
    let columns = header.needed("ncols")?;
    let lines = header.needed("nrows")?;
    let cell = header.needed("cellsize")?;
    let x = header.first("x", cell)?;
    let y = header.first("y", cell)?;
    let heights: Vec<&str> = words.collect();
    if columns < 2.0 || lines < 2.0 || columns.fract() + lines.fract() != 0.0 || cell <= 0.0 {
        return Err(HeightsError::HeaderRange);
    }
    if heights.len() as f64 != columns * lines {
        return Err(HeightsError::Count {
            found: heights.len(),
            expected: columns * lines,
        });
    }
    let mut points = Vec::with_capacity(heights.len());
    for (number, word) in heights.into_iter().enumerate() {
        let row = number / columns as usize;
        let column = number % columns as usize;
        let value = word.parse::<f64>().ok().filter(|value| value.is_finite());
        let Some(value) = value else {
            return Err(HeightsError::NotANumber {
                word: word.to_owned(),
                row: row + 1,
                column: column + 1,
            });
        };
        if header.number("nodata_value") == Some(value) {
            return Err(HeightsError::NoData {
                row: row + 1,
                column: column + 1,
            });
        }
        points.push([x + column as f64 * cell, y + (lines - 1.0 - row as f64) * cell, value]);
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n";

    #[test]
    fn points_are_the_middles_of_cells() {
        let points = ascii_grid(&format!("{HEADER}1 2\n3 4\n")).unwrap();
        assert_eq!(
            points,
            [[11.0, 3.0, 1.0], [13.0, 3.0, 2.0], [11.0, 1.0, 3.0], [13.0, 1.0, 4.0]]
        );
    }

    #[test]
    fn incomplete_grids_are_refused() {
        let error = |text: &str| ascii_grid(text).unwrap_err();
        let no_data = HeightsError::NoData { row: 2, column: 2 };
        assert_eq!(error(&format!("{HEADER}1 2\n3 -9999\n")), no_data);
        let count = HeightsError::Count {
            found: 3,
            expected: 4.0,
        };
        assert_eq!(error(&format!("{HEADER}1 2\n3\n")), count);
        let key = HeightsError::HeaderKey { key: "cellsize".into() };
        assert_eq!(error("ncols 2\nnrows 2\n1 2\n3 4"), key);
        let number = HeightsError::HeaderNumber { key: "ncols".into() };
        assert_eq!(error("ncols x\n"), number);
        let word = HeightsError::NotANumber {
            word: "nan".into(),
            row: 2,
            column: 2,
        };
        assert_eq!(error(&format!("{HEADER}1 2\n3 nan\n")), word);
        let range = error(&HEADER.replace("cellsize 2", "cellsize 0"));
        assert_eq!(range, HeightsError::HeaderRange);
    }
}
