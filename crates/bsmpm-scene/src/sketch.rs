//! Extracts basic data from the case of an old run, even if this version refuses it.

use crate::case::Support;
use crate::observables::Observable;
use crate::report::Report;
use crate::schema::{Draft, HistoryTable};
use crate::source::Source;
use crate::words::AnalysisType;
use crate::{document, validate};
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;

/// What is known of a case; what it does not say, or not in a form that is known today, is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sketch {
    /// Whether inertia acts.
    pub regime: Option<Regime>,
    /// Whether time is a pseudo-time without unit.
    pub is_timeless: Option<bool>,
    /// Section 2.3 of the paper; of a text without [`Sketch::regime`], which is no case, none.
    pub stabilisation: Option<Stabilisation>,
    /// Supports of the grid's faces: per axis the lower and the upper one.
    pub boundary: Option<[[Support; 2]; 3]>,
    /// m  the ends of the rigid strip's base at the start
    pub footing: Option<[[f64; 2]; 2]>,
    /// -  factor by which the materials' strength has been divided
    pub strength_reduction: Option<f64>,
    /// What is recorded every step, in the order of the file.
    pub histories: Vec<SketchedHistory>,
}

/// A `[[history]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct SketchedHistory {
    /// What is recorded.
    pub quantity: Observable,
    /// Name of the column, or beginning of the columns' names.
    pub name: String,
    /// -  multiplies
    pub scale: f64,
}

impl Sketch {
    /// What `text` reports.
    pub fn of(text: &str) -> Self {
        let source = Source::new("case", text);
        let mut report = Report::new(&source, &[]);
        let document = document::parse(&source, &mut report);
        if report.failed() {
            return Self::default();
        }
        let draft = Draft::read(&document, &mut report);
        let kind = draft.analysis.value().and_then(|analysis| analysis.r#type.get());
        let regime = kind.map(AnalysisType::regime);
        let is_timeless = kind.map(AnalysisType::is_timeless);
        let footing = draft.footing.value();
        Self {
            regime,
            is_timeless,
            stabilisation: regime.and_then(|_| validate::stabilisation(&draft)),
            boundary: validate::boundary(&draft),
            footing: footing.and_then(|strip| Some([strip.from.get()?, strip.to.get()?])),
            strength_reduction: draft
                .strength_reduction
                .value()
                .and_then(|reduction| reduction.factor.get()),
            histories: draft.history.items().iter().filter_map(SketchedHistory::of).collect(),
        }
    }
}

impl SketchedHistory {
    fn of(record: &HistoryTable) -> Option<Self> {
        let quantity = record.quantity.get()?;
        let name = record.name.text().map_or_else(|| quantity.to_string(), str::to_owned);
        Some(Self {
            quantity,
            name,
            scale: record.scale.get()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF: &str = r#"
        [analysis]
        type = "quasi-static"
        [boundary]
        left = "roller"
        right = "fixed"
        [footing]
        from = [0, 10.0]
        to = ["100 cm", 10.0]
        [[history]]
        quantity = "footing-pressure"
        name = "p_over_c"
        scale = 5e-5
        [[history]]
        quantity = "displacement"
        at = [0.0, 0.0]
        [[history]]
        quantity = "of-another-version"
    "#;

    #[test]
    fn what_is_there_is_reported_though_the_case_is_none() {
        assert!(crate::Case::from_text("case", HALF, &[]).is_err());
        let case = Sketch::of(HALF);
        assert_eq!(
            (case.regime, case.stabilisation),
            (Some(Regime::QuasiStatic), Some(Stabilisation::None))
        );
        assert_eq!(
            case.boundary,
            Some([
                [Support::Roller, Support::Fixed],
                [Support::Free; 2],
                [Support::Free; 2]
            ])
        );
        assert_eq!(case.footing, Some([[0.0, 10.0], [1.0, 10.0]]));
        assert_eq!(case.strength_reduction, None);
        assert_eq!(
            Sketch::of("strength_reduction.factor = 2").strength_reduction,
            Some(2.0)
        );
        let [pressure, displacement] = &case.histories[..] else {
            panic!("{case:?}")
        };
        assert_eq!(
            (pressure.quantity, &*pressure.name, pressure.scale),
            (Observable::FootingPressure, "p_over_c", 5e-5)
        );
        assert_eq!((&*displacement.name, displacement.scale), ("displacement", 1.0));
        let method = |word: &str| Sketch::of(&format!("{HALF}\n[stabilisation]\nmethod = \"{word}\"")).stabilisation;
        assert_eq!(
            (method("f-bar"), method("of-another-version")),
            (Some(Stabilisation::FBar), None)
        );
    }

    #[test]
    fn what_is_no_case_leaves_gaps() {
        for text in [
            "",
            "title = \"A\"\n",
            "[analysis",
            "analysis = 3\nhistory = 4\nfooting = [1]",
        ] {
            let case = Sketch::of(text);
            let nothing = Sketch {
                boundary: case.boundary,
                ..Sketch::default()
            };
            assert_eq!(case, nothing, "{text}");
            assert!(
                case.boundary.is_none_or(|axes| axes == [[Support::Free; 2]; 3]),
                "{text}"
            );
        }
    }
}
