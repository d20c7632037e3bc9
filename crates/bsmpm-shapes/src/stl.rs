//! Reads triangles from the contents of STL files, binary or text.

use crate::error::StlError;

/// Length of the header of binary STL (bytes): 80 bytes of text, and the number of triangles.
const HEADER: usize = 84;
/// Length of a triangle in binary STL (bytes): the normal and three corners in single precision, and two more bytes.
const TRIANGLE: usize = 50;

/// Returns whether bytes are binary STL: their length matches the number of triangles in the header. The text of the
/// header is not used, because some programs begin it with `solid` as in the text format.
pub fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|number| bytes.len() as u64 == length(number))
}

/// Number of triangles in the header of binary STL.
fn announced(bytes: &[u8]) -> Option<u32> {
    bytes
        .get(HEADER - 4..HEADER)
        .and_then(|four| four.try_into().ok())
        .map(u32::from_le_bytes)
}

/// Length of binary STL of so many triangles (bytes).
fn length(triangles: u32) -> u64 {
    HEADER as u64 + u64::from(triangles) * TRIANGLE as u64
}

/// Returns why bytes for which [`is_binary`] is false cannot be read as binary STL.
pub fn broken(bytes: &[u8]) -> StlError {
    match announced(bytes) {
        Some(triangles) => StlError::WrongLength {
            bytes: bytes.len(),
            triangles,
            needed: length(triangles),
        },
        None => StlError::ShortHeader {
            bytes: bytes.len(),
            needed: HEADER,
        },
    }
}

/// Returns the corners of each triangle of binary STL, in the unit of the file.
///
/// # Errors
/// [`StlError::NotFinite`] for a coordinate that is infinite or not a number; those of [`broken`].
pub fn binary(bytes: &[u8]) -> Result<Vec<[[f32; 3]; 3]>, StlError> {
    if !is_binary(bytes) {
        return Err(broken(bytes));
    }
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE).enumerate();
    let corners = triangles.map(|(number, triangle)| {
        let corners = [0, 1, 2].map(|k| [0, 1, 2].map(|axis| coordinate(triangle, 3 * k + axis)));
        let is_finite = corners.as_flattened().iter().all(|at| at.is_finite());
        is_finite
            .then_some(corners)
            .ok_or(StlError::NotFinite { triangle: number + 1 })
    });
    corners.collect()
}

/// Coordinate `number` of the corners of a triangle in binary STL.
fn coordinate(triangle: &[u8], number: usize) -> f32 {
    let from = 12 + 4 * number;
    f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[from + byte]))
}

/// Returns the corners of each triangle of STL text, in the unit of the file.
///
/// Coordinates have double precision: in single precision, national coordinates of 1e6 m would be wrong by centimetres.
///
/// # Errors
/// A vertex without three finite numbers, a facet without three vertices, and text that has no facet or ends within
/// one.
pub fn text(text: &str) -> Result<Vec<[[f64; 3]; 3]>, StlError> {
    let mut triangles = Vec::new();
    let mut corners = Vec::with_capacity(3);
    for (number, line) in text.lines().enumerate() {
        let line_number = number + 1;
        let mut words = line.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => {
                let numbers: Vec<f64> = words
                    .filter_map(|word| word.parse().ok())
                    .filter(|at: &f64| at.is_finite())
                    .collect();
                let corner = numbers.try_into().map_err(|_| StlError::Vertex { line: line_number })?;
                corners.push(corner);
            }
            Some("endfacet") => {
                let triangle = std::mem::take(&mut corners).try_into();
                triangles.push(triangle.map_err(|_| StlError::Facet { line: line_number })?);
            }
            _ => {}
        }
    }
    if !corners.is_empty() || triangles.is_empty() {
        return Err(StlError::Incomplete);
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\nvertex 50.125 0 0\n \
                        vertex 0 1e-1 0\nendloop\nendfacet\nendsolid a\n";

    /// A binary file with one triangle, whose header begins with `solid`.
    fn one_triangle() -> Vec<u8> {
        let mut bytes = b"solid ".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(1_u32.to_le_bytes());
        let numbers = [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 50.125, 0.0, 0.0, 0.0, 0.1, 0.0];
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()).chain([0, 0]));
        bytes
    }

    #[test]
    fn triangles_have_three_corners() {
        assert_eq!(text(TEXT).unwrap(), [[[0.0; 3], [50.125, 0.0, 0.0], [0.0, 0.1, 0.0]]]);
        let bytes = one_triangle();
        assert!(is_binary(&bytes) && !is_binary(&bytes[..133]) && !is_binary(TEXT.as_bytes()));
        assert_eq!(
            binary(&bytes).unwrap(),
            [[[0.0; 3], [50.125, 0.0, 0.0], [0.0, 0.1, 0.0]]]
        );
    }

    #[test]
    fn incomplete_files_are_refused() {
        let mut bytes = one_triangle();
        let wrong = StlError::WrongLength {
            bytes: 133,
            triangles: 1,
            needed: 134,
        };
        assert_eq!(binary(&bytes[..133]), Err(wrong));
        assert_eq!(broken(&bytes[..80]), StlError::ShortHeader { bytes: 80, needed: 84 });
        bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(binary(&bytes), Err(StlError::NotFinite { triangle: 1 }));
        let no_number = TEXT.replace("vertex 0 0 0", "vertex 0 x 0");
        assert_eq!(text(&no_number), Err(StlError::Vertex { line: 4 }));
        let no_vertex = TEXT.replace("vertex 0 0 0", "");
        assert_eq!(text(&no_vertex), Err(StlError::Facet { line: 8 }));
        let no_end = TEXT.split("endloop").next().unwrap();
        assert_eq!(text(no_end), Err(StlError::Incomplete));
    }
}
