//! Limits the cell size of a preset (key `accuracy`), so that cells resolve waves.

use super::scene::PresetScene;
use crate::schema::{LawName, SupportTable};
use crate::spectrum::SHARE;
use crate::waves::{WaveInput, fewest_cells, inputs};
use crate::words::{AnalysisType, Side, Support};
use bsmpm::dynamics::mass::MassMatrix;

/// Part of the cells of a preset to which waves make them smaller at most: each half costs eight times as much.
const SMALLEST: f64 = 0.25;

impl PresetScene<'_> {
    /// m  cells smaller than `size` (m) that the waves of an input need for 2 % of error in their speed, and why;
    /// `None` where no waves need any.
    pub(super) fn wave_cell(&self, size: f64) -> Option<(f64, String)> {
        if self.draft.analysis.value()?.r#type.get() != Some(AnalysisType::Dynamic) {
            return None;
        }
        let order = super::ORDER;
        let order = self
            .draft
            .grid
            .value()
            .and_then(|grid| grid.degree.get())
            .unwrap_or(order);
        let fewest = fewest_cells(self.mass(), order.degree());
        let inputs = inputs(self.draft);
        let cells = inputs
            .iter()
            .filter_map(|input| Some((input, self.slowest(input)? / (input.frequency * fewest))));
        let (input, cell) = cells
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, cell)| *cell < size)?;
        let part = 100.0 * SHARE;
        let frequency = input.frequency;
        let why = format!(
            "{fewest} cells in the wavelength at {frequency:.3} Hz, below which {} has {part} % of its energy",
            input.name
        );
        Some(if cell < SMALLEST * size {
            (
                SMALLEST * size,
                format!(
                    "a quarter of the cell that the bodies need, the least of this preset; {why}, would be smaller"
                ),
            )
        } else {
            (cell, why)
        })
    }

    /// The mass matrix that the case gives or that is chosen for it.
    fn mass(&self) -> MassMatrix {
        if let Some(given) = self.draft.analysis.value().and_then(|analysis| analysis.mass.get()) {
            return given;
        }
        let mut laws = self.materials().map(|material| material.model.get());
        let waves = self.draft.shaking.value().is_some() || laws.all(|law| law == Some(LawName::Hencky));
        if waves && !self.touches() {
            MassMatrix::Consistent
        } else {
            MassMatrix::Lumped
        }
    }

    /// Whether a face of the grid, a strip or a rigid body is in contact with material.
    fn touches(&self) -> bool {
        let mut boundaries = self.draft.boundary.value().into_iter();
        let has_contact = boundaries.any(|boundary| {
            let mut faces = Side::ALL.as_flattened().iter().map(|side| boundary.face(*side));
            faces.any(|face| face.table().is_some() || face.plain() == Some(Support::Contact))
        });
        has_contact || !self.draft.rigid.items().is_empty() || self.draft.strips().any(|strip| strip.contact.is_some())
    }

    /// m/s  slowest elastic wave that an input makes in the bodies' materials, at the middle of their height
    fn slowest(&self, input: &WaveInput) -> Option<f64> {
        let [lower, upper] = self.bounds()?;
        let speeds = self.materials().filter_map(|material| {
            let shear = super::scene::shear_wave(material, [0.5 * (lower[1] + upper[1]); 2])?;
            let poisson = material.poisson.get()?;
            let ratio = if input.axis.is_some() {
                (2.0 - 2.0 * poisson) / (1.0 - 2.0 * poisson)
            } else {
                1.0
            };
            Some(shear * ratio.sqrt())
        });
        speeds
            .filter(|speed| speed.is_finite() && *speed > 0.0)
            .reduce(f64::min)
    }
}
