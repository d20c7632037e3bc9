//! What the text of a case says that pictures need. It is read with leave: a text of another version of the program, or
//! none, leaves gaps, and no errors.

use bsmpm_io::manifest::GridExtent;
use toml::de::{DeTable, DeValue};

/// What is known of a case; what it does not say, or not in a known form, is none.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Case {
    /// Whether inertia acts.
    pub regime: Option<RecordedRegime>,
    /// The method of stabilisation.
    pub stabilisation: Option<String>,
    /// Whether the grid's lower and upper faces along x and y hold the body, fixed or as rollers.
    pub walls: [[bool; 2]; 2],
    /// The rigid strip.
    pub footing: Option<RecordedFooting>,
    /// By which the strength is divided.
    pub strength_reduction: Option<f64>,
    /// What it records, in its order.
    pub histories: Vec<RecordedHistory>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RecordedRegime {
    QuasiStatic,
    Dynamic,
}

/// A rigid strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RecordedFooting {
    /// m  the x of its ends
    ends: Option<[f64; 2]>,
    /// Whether the grid's left and right faces are planes of symmetry.
    rollers: [bool; 2],
}

/// A `[[history]]`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RecordedHistory {
    pub quantity: String,
    /// The beginning of its columns' names.
    pub name: String,
    /// The factor as written, empty for none.
    pub scale: String,
}

impl Case {
    /// What `text` says.
    pub fn of(text: &str) -> Self {
        let Ok(document) = DeTable::parse(text) else { return Self::default() };
        let root = document.get_ref();
        let regime = match word(table(root, "analysis"), "type") {
            Some("quasi-static") => Some(RecordedRegime::QuasiStatic),
            Some("dynamic") => Some(RecordedRegime::Dynamic),
            _ => None,
        };
        // An absent table is no stabilisation, but only in a text that is a case.
        let stabilisation = word(table(root, "stabilisation"), "method").or(regime.map(|_| "none")).map(str::to_owned);
        let held = |face| matches!(word(table(root, "boundary"), face), Some("fixed" | "roller"));
        let walls = [["left", "right"], ["bottom", "top"]].map(|faces| faces.map(held));
        let histories = match root.get("history").map(|value| value.get_ref()) {
            Some(DeValue::Array(list)) => list.iter().filter_map(|item| RecordedHistory::of(item.get_ref())).collect(),
            _ => Vec::new(),
        };
        let reduction =
            table(root, "strength_reduction").and_then(|reduction| number(reduction.get("factor")?.get_ref()));
        Self {
            regime,
            stabilisation,
            walls,
            footing: RecordedFooting::of(root),
            strength_reduction: reduction,
            histories,
        }
    }
}

impl RecordedHistory {
    fn of(value: &DeValue) -> Option<Self> {
        let DeValue::Table(table) = value else { return None };
        let quantity = word(Some(table), "quantity")?.to_owned();
        let name = word(Some(table), "name").unwrap_or(&quantity).to_owned();
        let scale = match table.get("scale").map(|value| value.get_ref()) {
            Some(DeValue::Float(number)) => number.as_str().to_owned(),
            Some(DeValue::Integer(number)) => number.as_str().to_owned(),
            Some(DeValue::String(text)) => text.to_string(),
            _ => String::new(),
        };
        Some(Self { quantity, name, scale })
    }

    /// Whether a column of `history.csv` is one of this history: it bears its name, or that of one of its components.
    pub fn has(&self, column: &str) -> bool {
        bears(column, &self.name)
    }
}

/// Whether a column is called `name` or `name-...`.
pub(crate) fn bears(column: &str, name: &str) -> bool {
    column.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
}

impl RecordedFooting {
    fn of(root: &DeTable) -> Option<Self> {
        let footing = table(root, "footing")?;
        let end = |key| match footing.get(key)?.get_ref() {
            DeValue::Array(list) => length(list.first()?.get_ref()),
            _ => None,
        };
        let ends = end("from").and_then(|from| Some([from, end("to")?]));
        let rollers = ["left", "right"].map(|face| word(table(root, "boundary"), face) == Some("roller"));
        Some(Self { ends, rollers })
    }

    /// m  The whole width, of which a half model that begins or ends at a plane of symmetry has only the half.
    pub fn width(&self, grid: &GridExtent) -> Option<f64> {
        let [one, other] = self.ends?;
        let (left, right) = (one.min(other), one.max(other));
        let width = right - left;
        let touches = |end: f64, face: f64| (end - face).abs() <= 1e-6 * width;
        let at_left = self.rollers[0] && touches(left, *grid.lower.first()?);
        let at_right = self.rollers[1] && touches(right, *grid.upper.first()?);
        (width > 0.0).then_some(if at_left == at_right { width } else { 2.0 * width })
    }
}

fn table<'a>(root: &'a DeTable, key: &str) -> Option<&'a DeTable<'a>> {
    match root.get(key)?.get_ref() {
        DeValue::Table(table) => Some(table),
        _ => None,
    }
}

fn word<'a>(table: Option<&'a DeTable>, key: &str) -> Option<&'a str> {
    match table?.get(key)?.get_ref() {
        DeValue::String(text) => Some(text),
        _ => None,
    }
}

fn number(value: &DeValue) -> Option<f64> {
    let text = match value {
        DeValue::Float(value) => value.as_str(),
        DeValue::Integer(value) => value.as_str(),
        _ => return None,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// m  A length: a number, or a text with a unit.
fn length(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::String(text) => {
            let (digits, worth) = [("mm", 1e-3), ("cm", 1e-2), ("km", 1e3), ("m", 1.0), ("", 1.0)]
                .into_iter()
                .find_map(|(unit, worth)| Some((text.trim().strip_suffix(unit)?, worth)))?;
            let number: f64 = digits.trim().parse().ok()?;
            number.is_finite().then_some(number * worth)
        }
        _ => number(value),
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
        right = "roller"
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
    "#;

    fn width(text: &str) -> Option<f64> {
        let grid = GridExtent { lower: vec![0.0; 2], upper: vec![5.0, 11.0], cell: vec![0.1; 2] };
        Case::of(text).footing?.width(&grid)
    }

    #[test]
    fn a_case_is_read() {
        let case = Case::of(HALF);
        assert_eq!((case.regime, case.stabilisation.as_deref()), (Some(RecordedRegime::QuasiStatic), Some("none")));
        assert_eq!(
            (case.strength_reduction, Case::of("strength_reduction.factor = 2").strength_reduction),
            (None, Some(2.0))
        );
        assert_eq!(case.walls, [[true, true], [false, false]]);
        let [pressure, displacement] = &case.histories[..] else { panic!("{case:?}") };
        assert_eq!((&*pressure.name, &*pressure.scale), ("p_over_c", "5e-5"));
        assert!(displacement.has("displacement-x") && !displacement.has("displacements"));
    }

    #[test]
    fn half_a_footing_is_doubled() {
        assert_eq!(width(HALF), Some(2.0));
        assert_eq!(width(&HALF.replace("roller", "free")), Some(1.0));
        assert_eq!(width(&HALF.replace("[0, 10.0]", "[\"0.5 m\", 10.0]")), Some(0.5));
        assert_eq!(width(&HALF.replace("[0, 10.0]", "\"far\"")), None);
    }

    #[test]
    fn what_is_no_case_leaves_gaps() {
        for text in ["", "title = \"A\"\n", "[analysis", "analysis = 3\nhistory = 4\nfooting = [1]"] {
            assert_eq!(Case::of(text), Case::default(), "{text}");
        }
    }
}
