//! The schema of case files: all keys with type, unit, range, default and description.

#[macro_use]
pub(crate) mod define;

mod answers;
mod body;
mod element;
mod flow;
mod law_types;
mod laws;
mod loads;
mod material;
mod output;
mod rigid;
mod site;
mod stage;
mod tables;
mod water;

pub(crate) use answers::answer;

pub use crate::unit::Dimension;
pub use crate::words::Words;
pub(crate) use body::{
    BodyTable, BoxTable, CircleTable, ExtrudeTable, RevolveTable, ShapeKey, SpinTable, SurfaceTable, TerrainTable,
};
pub(crate) use element::{ElementStageTable, ElementTable};
pub(crate) use flow::{DrainTable, InflowTable};
pub(crate) use laws::LawName;
pub(crate) use loads::{
    DepthTable, DiscTable, FootingTable, InitialTable, PointLoadTable, PrescribedTable, ReductionTable, SupportField,
    SupportTable, TractionTable,
};
pub(crate) use material::{LawKey, MaterialTable, RetentionTable};
pub(crate) use output::{CheckTable, CheckpointTable, HistoryTable, OutputTable, ProfileTable};
pub(crate) use rigid::RigidTable;
pub(crate) use site::{MotionKey, PlateKey, SiteKey, StripKeys};
pub(crate) use stage::{ExchangeTable, StageTable};
pub use tables::ROOT;
pub(crate) use tables::{AnalysisTable, Draft, GridTable, KnotsTable, SolverTable};
pub(crate) use water::WaterTable;

use std::fmt;
use std::ops::Bound;

/// A table of the case file.
#[derive(Debug)]
pub struct Table {
    /// Its header as written, e.g. `[material.NAME]`.
    pub header: &'static str,
    /// What it says.
    pub doc: &'static str,
    /// Its keys.
    pub keys: &'static [Key],
    /// Keys of which only one may be given.
    pub exclusive: &'static [Group],
}

/// Keys of which only one may be given; `--set` of one removes the others.
#[derive(Debug)]
pub struct Group {
    /// The keys.
    pub keys: &'static [&'static str],
    /// Whether one of them must be given.
    pub required: bool,
    /// Whether `accuracy` or `purpose` chooses one of them where none is given.
    pub has_preset: bool,
}

/// A key of a table.
#[derive(Debug)]
pub struct Key {
    /// The key as written.
    pub name: &'static str,
    /// What its value may be.
    pub kind: Kind,
    /// Whether it must be given.
    pub presence: Presence,
    /// What it means: sentences with a full stop; of a key without effect the reason, as part of a sentence.
    pub doc: &'static str,
    /// Symbol of the field; empty without one.
    pub symbol: &'static str,
    /// A value as written in a case file; empty where its kind gives one.
    pub value: &'static str,
    /// Names that it had in earlier versions, which are still read.
    pub earlier: &'static [&'static str],
    /// Whether `accuracy` or `purpose` chooses its value where it is not given.
    pub has_preset: bool,
}

impl Key {
    /// The same key with the names that it had in earlier versions.
    const fn renamed_from(self, earlier: &'static [&'static str]) -> Self {
        Self { earlier, ..self }
    }

    /// The same key, whose value `accuracy` or `purpose` chooses where it is not given.
    const fn or_preset(self) -> Self {
        Self {
            has_preset: true,
            ..self
        }
    }

    /// The same key with its symbol in the field.
    const fn symbol(self, symbol: &'static str) -> Self {
        Self { symbol, ..self }
    }

    /// The same key with an example of its value, as written in a case file.
    const fn example(self, value: &'static str) -> Self {
        Self { value, ..self }
    }

    /// A value as written in a case file, which its kind accepts.
    pub fn example_value(&self) -> Option<String> {
        if !self.value.is_empty() {
            return Some(self.value.to_owned());
        }
        match self.kind {
            Kind::Choice(words) | Kind::ChoiceOr(words, _) => words.words().next().map(|word| format!("\"{word}\"")),
            Kind::Choices(words) => words.words().next().map(|word| format!("[\"{word}\"]")),
            Kind::Flag => Some("true".to_owned()),
            _ => None,
        }
    }
}

const fn key(name: &'static str, kind: Kind, presence: Presence, doc: &'static str) -> Key {
    Key {
        name,
        kind,
        presence,
        doc,
        symbol: "",
        value: "",
        earlier: &[],
        has_preset: false,
    }
}

/// Whether a key must be given, and what holds if it is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    /// It must be given.
    Required,
    /// It may be absent: then the thing does not exist, or follows from other keys as its meaning says.
    Optional,
    /// Absent, it has this value (TOML).
    Default(&'static str),
    /// Part of the language, but not available yet: an error that says so.
    Later,
    /// Without effect any more; its meaning says why. Its value is verified and left out, with a warning.
    Retired,
}

/// What a value may be.
#[derive(Debug)]
pub enum Kind {
    /// A number in SI (degrees for angles), or a string with a unit.
    Quantity(Dimension, Range),
    /// Like `Quantity`, or a table that says how it grows with depth; the range holds wherever there are bodies.
    Profile(Dimension, Range, &'static Table),
    /// Growth of a quantity per metre: a number in SI per metre (degrees per metre), or a string such as `"2 kPa/m"`.
    Gradient(Dimension),
    /// As many of these as the geometry has axes.
    GradientVector(Dimension),
    /// A number, or a string with a unit of whatever the key is about.
    Measure,
    /// Two quantities, x and y.
    Pair(Dimension, Range),
    /// As many as the geometry has axes: x and y, and in 3-D z.
    Vector(Dimension, Range),
    /// Like `Vector`, or a table that says how they grow with depth.
    PairProfile(Dimension, Range, &'static Table),
    /// One quantity for all axes, or one each.
    Either(Dimension, Range),
    /// Any number of quantities.
    List(Dimension, Range),
    /// Any number of rows, each a list of quantities.
    Rows(&'static [(Dimension, Range)]),
    /// Any number of rows of a time and as many quantities as the geometry has axes.
    Course(Dimension),
    /// A whole number within bounds, both included.
    Count(u64, u64),
    /// One of several words.
    Choice(Words),
    /// One of several words, or a table that says it in detail.
    ChoiceOr(Words, &'static Table),
    /// Text of at most so many characters.
    Text(usize),
    /// A name: ASCII letters, digits, `-` and `_`.
    Name,
    /// Any number of names.
    Names,
    /// Any number of several words, each at most once.
    Choices(Words),
    /// `true` or `false`.
    Flag,
    /// A table.
    Table(&'static Table),
    /// Tables with names of the author's choice, `[key.NAME]`.
    Named(&'static Table),
    /// Any number of tables, `[[key]]`.
    Tables(&'static Table),
    /// Whatever it will be once it is available.
    Open,
}

/// An interval that a quantity must lie in.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Lower end, in SI (angles in degrees).
    pub lower: Bound<f64>,
    /// Upper end.
    pub upper: Bound<f64>,
    /// Why, where that helps; else empty.
    pub why: &'static str,
}

impl Range {
    /// Any finite number.
    pub const ANY: Self = Self::of(Bound::Unbounded, Bound::Unbounded);
    /// Above zero.
    pub const POSITIVE: Self = Self::of(Bound::Excluded(0.0), Bound::Unbounded);
    /// Zero or above.
    pub const NOT_NEGATIVE: Self = Self::of(Bound::Included(0.0), Bound::Unbounded);

    /// Between two ends.
    pub const fn of(lower: Bound<f64>, upper: Bound<f64>) -> Self {
        Self { lower, upper, why: "" }
    }

    /// Whether `value` lies in it.
    pub fn contains(&self, value: f64) -> bool {
        use std::ops::RangeBounds;
        (self.lower, self.upper).contains(&value)
    }

    /// Whether any finite number lies in it.
    pub fn is_any(&self) -> bool {
        matches!((self.lower, self.upper), (Bound::Unbounded, Bound::Unbounded))
    }

    /// The condition on `name` in words, e.g. `0 <= friction < 90`.
    pub fn condition(&self, name: &str) -> String {
        let more = " < ";
        let at_least = " <= ";
        match (self.lower, self.upper) {
            (Bound::Unbounded, Bound::Unbounded) => format!("any {name}"),
            (Bound::Excluded(lower), Bound::Unbounded) => format!("{name} > {lower}"),
            (Bound::Included(lower), Bound::Unbounded) => format!("{name} >= {lower}"),
            (lower, upper) => {
                let left = match lower {
                    Bound::Excluded(lower) => format!("{lower}{more}"),
                    Bound::Included(lower) => format!("{lower}{at_least}"),
                    Bound::Unbounded => String::new(),
                };
                match upper {
                    Bound::Excluded(upper) => format!("{left}{name}{more}{upper}"),
                    Bound::Included(upper) => format!("{left}{name}{at_least}{upper}"),
                    Bound::Unbounded => format!("{left}{name}"),
                }
            }
        }
    }
}

impl Table {
    /// The key called `name`.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The key that had this name in an earlier version.
    pub fn renamed(&self, earlier: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.earlier.contains(&earlier))
    }

    /// Keys of which none may be given beside `name`.
    pub fn rivals(&self, name: &str) -> impl Iterator<Item = &'static str> {
        let groups = self.exclusive.iter().filter(move |group| group.keys.contains(&name));
        groups
            .flat_map(|group| group.keys)
            .copied()
            .filter(move |key| *key != name)
    }

    /// This table and all below it, outer ones first.
    pub fn all(&'static self) -> Vec<&'static Table> {
        let below = self.keys.iter().filter_map(|key| key.kind.table()).flat_map(Table::all);
        std::iter::once(self).chain(below).collect()
    }
}

impl Kind {
    /// The table that the value is, or is made of.
    pub fn table(&self) -> Option<&'static Table> {
        match self {
            Self::Table(table) | Self::Named(table) | Self::Tables(table) => Some(table),
            Self::Profile(.., table) | Self::PairProfile(.., table) | Self::ChoiceOr(_, table) => Some(table),
            _ => None,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quantity(dimension, _) => write!(f, "{}", QuantityWords(*dimension)),
            Self::Profile(dimension, _, table) => write!(f, "{}, or {}", QuantityWords(*dimension), table.header),
            Self::Gradient(dimension) => write!(f, "{}", PerMetre(*dimension)),
            Self::GradientVector(dimension) => {
                write!(f, "a list of two (three in 3-D), each {}", PerMetre(*dimension))
            }
            Self::Rows(columns) => {
                let columns: Vec<String> = columns.iter().map(|(dimension, _)| dimension.to_string()).collect();
                write!(f, "a list of rows, each [{}], or {FILE}", columns.join(", "))
            }
            Self::Course(dimension) => {
                write!(
                    f,
                    "a list of rows, each [a time, {dimension}, {dimension}] (three in 3-D), or {FILE}"
                )
            }
            Self::Measure => f.write_str("a number, or a string with a unit"),
            Self::Pair(dimension, _) => write!(f, "a list of two, each {}", QuantityWords(*dimension)),
            Self::PairProfile(dimension, _, table) => {
                write!(
                    f,
                    "a list of two (three in 3-D), each {}, or {}",
                    QuantityWords(*dimension),
                    table.header
                )
            }
            Self::Vector(dimension, _) => {
                write!(f, "a list of two (three in 3-D), each {}", QuantityWords(*dimension))
            }
            Self::Either(dimension, _) => {
                write!(f, "{}, or a list of two (three in 3-D)", QuantityWords(*dimension))
            }
            Self::List(dimension, _) => write!(f, "a list, each item {}", QuantityWords(*dimension)),
            Self::Count(least, most) => write!(f, "a whole number from {least} to {most}"),
            Self::Choice(words) => write!(f, "{}", OneOf(words)),
            Self::ChoiceOr(words, table) => write!(f, "{}, or a table, {}", OneOf(words), table.header),
            Self::Text(most) => write!(f, "a text of at most {most} characters without control characters"),
            Self::Name => f.write_str("a name of at most 64 ASCII letters, digits, `-` and `_`"),
            Self::Names => f.write_str("a list of names"),
            Self::Choices(words) => write!(f, "a list of words, each {}", OneOf(words)),
            Self::Flag => f.write_str("true or false"),
            Self::Table(table) => write!(f, "a table, {}", table.header),
            Self::Named(table) => write!(f, "tables with names, {}", table.header),
            Self::Tables(table) => write!(f, "a list of tables, {}", table.header),
            Self::Open => f.write_str("not available yet"),
        }
    }
}

/// Rows from a file, which is read where the case file names it.
const FILE: &str = "`{ file = \"rows.csv\" }`";

/// Words in words.
struct OneOf<'a>(&'a Words);

impl fmt::Display for OneOf<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<String> = self.0.words().map(|word| format!("\"{word}\"")).collect();
        write!(f, "one of {}", words.join(", "))
    }
}

/// Growth of a quantity in words.
struct PerMetre(Dimension);

impl fmt::Display for PerMetre {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let units: Vec<String> = self.0.units().map(|unit| format!("{unit}/m")).collect();
        write!(
            f,
            "a number ({}) or a string with a unit ({})",
            units[0],
            units.join(", ")
        )
    }
}

/// A quantity of a dimension in words.
struct QuantityWords(Dimension);

impl fmt::Display for QuantityWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.0.units().next(), self.0) {
            (None, _) => f.write_str("a number"),
            (Some(unit), dimension) => {
                let units: Vec<&str> = dimension.units().collect();
                write!(f, "a number ({unit}) or a string with a unit ({})", units.join(", "))
            }
        }
    }
}
