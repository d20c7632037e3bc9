//! Reads triangles from STL files.

use super::invalid;
use std::io::{self, Error};

/// Bytes of a binary STL before its triangles: a heading, and their number.
const STL_HEADING: usize = 84;
/// Bytes of a triangle there: a normal, three corners, all of three singles, and two bytes.
const STL_TRIANGLE: usize = 50;

/// Whether bytes are binary STL: as many as its number of triangles says, whatever the heading (some begin with
/// `solid`, as the text format does).
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|number| bytes.len() as u64 == length(number))
}

/// Triangles that the heading of binary STL announces.
fn announced(bytes: &[u8]) -> Option<u32> {
    bytes
        .get(STL_HEADING - 4..STL_HEADING)
        .and_then(|four| four.try_into().ok())
        .map(u32::from_le_bytes)
}

/// Bytes of binary STL of so many triangles.
fn length(number: u32) -> u64 {
    STL_HEADING as u64 + u64::from(number) * STL_TRIANGLE as u64
}

/// Why bytes that are no text are not binary STL either.
pub(super) fn broken(bytes: &[u8]) -> Error {
    let message = match announced(bytes) {
        Some(number) => format!(
            "E0031: the binary STL file has {} bytes, but its {number} triangles need {}, so the file is incomplete. \
             Export the file again.",
            bytes.len(),
            length(number)
        ),
        None => format!(
            "E0031: the binary STL file has {} bytes, but its header needs {STL_HEADING}, so the file is incomplete. \
             Export the file again.",
            bytes.len()
        ),
    };
    invalid(message)
}

/// Rows of three corners as TOML of binary STL.
pub(super) fn triangles(bytes: &[u8]) -> io::Result<String> {
    let mut whole = String::from("[");
    for (number, triangle) in bytes[STL_HEADING..].chunks_exact(STL_TRIANGLE).enumerate() {
        let singles = triangle[12..48]
            .chunks_exact(4)
            .map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
        let corners: Vec<String> = singles
            .filter(|at| at.is_finite())
            .map(|at| format!("{at:?}"))
            .collect();
        if corners.len() != 9 {
            let message = format!(
                "E0031: a corner of triangle {} of the STL file has a coordinate that is not a finite number. Export \
                 the file again.",
                number + 1
            );
            return Err(invalid(message));
        }
        whole.push_str(&format!("[{}],", corners.join(",")));
    }
    whole.push(']');
    Ok(whole)
}

/// Rows of three corners as TOML of STL as text. A library's reader would round its numbers to singles, by which
/// places in a country's coordinates lie centimetres beside.
pub(super) fn facets(text: &str) -> io::Result<String> {
    let mut whole = String::from("[");
    let mut corners = Vec::with_capacity(9);
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => {
                let numbers: Vec<f64> = words
                    .filter_map(|word| word.parse().ok())
                    .filter(|at: &f64| at.is_finite())
                    .collect();
                if numbers.len() != 3 {
                    return Err(invalid(format!(
                        "E0031: the vertex in line {} of the STL file does not have three numbers. Export the file \
                         again.",
                        number + 1
                    )));
                }
                corners.extend(numbers.iter().map(|at| format!("{at:?}")));
            }
            Some("endfacet") if corners.len() == 9 => {
                whole.push_str(&format!("[{}],", corners.join(",")));
                corners.clear();
            }
            Some("endfacet") => {
                return Err(invalid(format!(
                    "E0031: the facet that ends in line {} of the STL file does not have three vertices. Export the \
                     file again.",
                    number + 1
                )));
            }
            _ => {}
        }
    }
    if !corners.is_empty() || whole.len() == 1 {
        return Err(invalid(
            "E0031: the STL file has no triangle, or its last triangle is incomplete. Export the file again.",
        ));
    }
    whole.push(']');
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_are_rows_of_three_corners() {
        let text = "solid a\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\nvertex 50.125 0 0\n vertex 0 1e-1 0\n\
                    endloop\nendfacet\nendsolid a\n";
        let row = "[[0.0,0.0,0.0,50.125,0.0,0.0,0.0,0.1,0.0],]";
        assert_eq!(facets(text).unwrap(), row);
        let mut bytes = b"solid ".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(1_u32.to_le_bytes());
        let numbers = [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 50.125, 0.0, 0.0, 0.0, 0.1, 0.0];
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()).chain([0, 0]));
        assert!(is_binary(&bytes) && !is_binary(&bytes[..133]) && !is_binary(text.as_bytes()));
        assert_eq!(triangles(&bytes).unwrap(), row);
        bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(
            triangles(&bytes)
                .unwrap_err()
                .to_string()
                .contains("a corner of triangle 1 ")
        );
        assert!(
            broken(&bytes[..133])
                .to_string()
                .contains("has 133 bytes, but its 1 triangles need 134")
        );
        assert!(
            broken(&bytes[..80])
                .to_string()
                .contains("has 80 bytes, but its header needs 84")
        );
        let refuses = |text: &str, says: &str| {
            let message = facets(text).unwrap_err().to_string();
            assert!(message.starts_with("E0031: ") && message.contains(says), "{message}");
        };
        refuses(&text.replace("vertex 0 0 0", "vertex 0 x 0"), "the vertex in line 4 ");
        refuses(&text.replace("vertex 0 0 0", ""), "the facet that ends in line 8 ");
        refuses(text.split("endloop").next().unwrap(), "its last triangle is incomplete");
    }
}
