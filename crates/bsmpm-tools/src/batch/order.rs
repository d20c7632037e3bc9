//! One run of a batch: the case with its changed keys, and the name of the run.

use std::path::Path;

use bsmpm_io::manifest;
use bsmpm_scene::{Case, GridAxis};

use super::PoolLoad;

/// Characters of the settings in the name of a directory; what is longer is distinguished by the hash.
const LONGEST: usize = 80;
/// Digits of the hash there.
const DIGITS: usize = 8;

/// A run that is wanted.
#[derive(Clone, Debug)]
pub(crate) struct RunOrder {
    /// Overrides, `KEY=VALUE`.
    pub set: Vec<String>,
    /// What they make of the case.
    pub case: Case,
    /// Of its directory: the settings that it is named by, and a part of the case's hash.
    pub name: String,
}

impl RunOrder {
    /// The case with overrides, named by the last `named` of them.
    ///
    /// # Errors
    /// All errors of the case, a line each.
    pub fn read(path: &Path, bytes: &[u8], set: Vec<String>, named: usize) -> Result<Self, Vec<String>> {
        let case = Case::from_bytes(&path.display().to_string(), bytes, &set)
            .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        let hash = manifest::ManifestCase::new("", "", "", case.text.clone()).blake3;
        let settings = &set[set.len().saturating_sub(named)..];
        let name = format!("{}{}", slug(settings), &hash[..DIGITS]);
        Ok(Self { set, case, name })
    }

    /// What it takes of the machine.
    pub fn load(&self, ranks: usize) -> PoolLoad {
        let steps = self.case.analysis.end / self.case.analysis.dt;
        PoolLoad {
            memory: self.case.estimate(ranks).bytes_with_newton,
            work: self.case.points() as f64 * steps,
        }
    }

    /// m  the size of its cells: the edge of a square, of a solid a cube, as large as the largest.
    pub fn cell(&self) -> f64 {
        Self::cell_of(&self.case)
    }

    /// The same of any case.
    pub fn cell_of(case: &Case) -> f64 {
        let size = case.grid.axes.iter().map(GridAxis::longest).product::<f64>();
        if case.grid.axes.len() == 3 {
            size.cbrt()
        } else {
            size.sqrt()
        }
    }
}

/// The settings as part of a file's name: the last part of each key, and its value, without what shells would take
/// amiss.
fn slug(settings: &[String]) -> String {
    let mut made = String::new();
    for (key, value) in settings.iter().filter_map(|set| set.split_once('=')) {
        let part = format!("{}-{}_", key.rsplit('.').next().unwrap_or(key), value);
        let kept = part.chars().filter(|c| !c.is_whitespace() && *c != '"');
        made.extend(kept.map(|c| {
            if c.is_ascii_alphanumeric() || "._-".contains(c) {
                c
            } else {
                '-'
            }
        }));
    }
    if made.len() > LONGEST { String::new() } else { made }
}

#[cfg(test)]
mod tests {
    use super::{RunOrder, slug};
    use bsmpm_scene::Case;

    #[test]
    fn names_are_plain() {
        let settings = [
            "grid.cell=\"10 mm\"".to_owned(),
            "body.*.points_per_cell = 3".to_owned(),
        ];
        assert_eq!(slug(&settings), "cell-10mm_points_per_cell-3_");
        assert_eq!(slug(&[]), "");
    }

    /// Of cells of several sizes the largest counts.
    #[test]
    fn the_size_of_a_cell_is_the_edge_of_a_square_or_cube_as_large() {
        let of = |geometry: &str, corner: &str, grid: &str, made: &str| {
            let text = format!(
                "geometry = \"{geometry}\"\nanalysis = {{ type = \"quasi-static\", steps = 1 }}\n\
                 grid = {{ {grid}, degree = \"quadratic\" }}\n\
                 material.soil = {{ model = \"elastic\", young = 1e6, poisson = 0.3 }}\nboundary.bottom = \"fixed\"\n\
                 body = [{{ material = \"soil\", box = {{ lower = [{corner}], upper = [{made}] }}, points_per_cell = 2 }}]\n"
            );
            RunOrder::cell_of(&Case::from_text("case.toml", &text, &[]).expect("a valid case"))
        };
        let cells = "lower = [0.0, 0.0], upper = [8.0, 4.0], cell = [4.0, 1.0]";
        assert_eq!(of("plane-strain", "0.0, 0.0", cells, "4.0, 2.0"), 2.0);
        let cells = "lower = [0.0, 0.0, 0.0], upper = [8.0, 4.0, 4.0], cell = [8.0, 2.0, 4.0]";
        assert!((of("solid", "0.0, 0.0, 0.0", cells, "8.0, 2.0, 4.0") - 4.0).abs() < 1e-12);
        let knots = "knots = { x = [0.0, 1.0, 9.0], y = [0.0, 1.0, 2.0], z = [0.0, 1.0, 2.0] }";
        assert!((of("solid", "0.0, 0.0, 0.0", knots, "1.0, 1.0, 1.0") - 2.0).abs() < 1e-12);
    }
}
