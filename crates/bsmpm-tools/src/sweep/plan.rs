//! Checks a sweep before any run starts.

use bsmpm_scene::Case;

use super::SweepArguments;
use super::axes::{self, SweepAxis};
use super::quantity::{FACTOR, SweepQuantity};
use super::reference::Reference;
use super::study::{Point, Study};
use crate::{Error, case};

/// What is swept, before anything runs.
pub(super) struct SweepPlan {
    pub bytes: Vec<u8>,
    pub own: Case,
    pub axes: Vec<SweepAxis>,
    pub quantities: Vec<SweepQuantity>,
    pub reference: Reference,
    pub points: Vec<Point>,
}

impl SweepArguments {
    pub(super) fn plan(&self) -> Result<SweepPlan, Error> {
        let usage = |reason: String| Error::Usage { reason };
        let axes: Vec<SweepAxis> = self
            .vary
            .iter()
            .map(|text| SweepAxis::parse(text))
            .collect::<Result<_, _>>()
            .map_err(usage)?;
        let quantities: Vec<SweepQuantity> = self
            .quantity
            .iter()
            .map(|text| SweepQuantity::parse(text))
            .collect::<Result<_, _>>()
            .map_err(usage)?;
        let settings = axes::settings(&axes, self.one_at_a_time).map_err(usage)?;
        let bytes = case::load(&self.case)?;
        let own = case::parsed(&self.case, &bytes, &self.options.set)?;
        self.look_through(&quantities, &own)?;
        let reference = Reference::parse(&self.reference);
        reference.check(&quantities)?;
        let study = Study {
            path: &self.case,
            bytes: &bytes,
            set: &self.options.set,
            axes: &axes,
        };
        let points = study.points(&settings, &self.baseline.as_deref().map_or_else(Vec::new, axes::split))?;
        Ok(SweepPlan {
            bytes,
            own,
            axes,
            quantities,
            reference,
            points,
        })
    }

    /// Whether the case records what is wanted.
    fn look_through(&self, quantities: &[SweepQuantity], case: &Case) -> Result<(), Error> {
        let usage = |reason: String| Err(Error::Usage { reason });
        if quantities.iter().any(SweepQuantity::is_factor) {
            return match (quantities, self.options.max_wall) {
                ([only], None) if only.name == FACTOR => Ok(()),
                (_, Some(_)) => usage(format!(
                    "E0837: --max-wall cannot be combined with --quantity {FACTOR}. Remove one of the \
                        two options."
                )),
                _ => usage(format!(
                    "E0837: --quantity {FACTOR} needs several trial runs for each combination of values, so it must \
                     be the only quantity, without @TIME. Use a separate sweep for other quantities."
                )),
            };
        }
        let columns: Vec<String> = case
            .histories
            .iter()
            .flat_map(bsmpm_scene::History::columns)
            .map(|column| column.name)
            .collect();
        let parts = quantities.iter().flat_map(|quantity| &quantity.parts);
        match parts.into_iter().find(|part| !columns.contains(&part.column)) {
            Some(part) => usage(format!(
                "E0836: no [[history]] of the case records `{}`. Add a [[history]], or choose one of: {}, {FACTOR}.",
                part.column,
                columns.join(", ")
            )),
            None => Ok(()),
        }
    }
}
