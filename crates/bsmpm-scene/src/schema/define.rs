//! The macro that declares a table of the case file.

/// Declares a table of the case file: its keys once, each with meaning, type, presence, symbol, example and earlier
/// names. The reference, the JSON Schema, the reader and the struct follow from the declaration.
///
/// ```text
/// table! {
///     /// Meaning of the table.
///     struct GravityTable = "[gravity]" {
///         /// Meaning of the key.
///         acceleration: Vector(In::Acceleration, Range::ANY), Required, symbol("g"), example("[0.0, -9.81]");
///         /// Meaning of the key.
///         ramp: Quantity(In::Time, Range::NOT_NEGATIVE), Default("0.0"), example("1.0");
///     }
/// }
/// ```
///
/// The type is a [`Kind`](super::Kind); where it names words or tables, they are given by their Rust types. A key that
/// several tables have is written as `name: Shared(KEY, Type)`. Groups of keys that exclude each other follow the
/// keys: `one_of required [a, b];`, with `optional` if none need be given, and `preset` if `accuracy` or `purpose`
/// may choose one. Keys without effect are in a block `retired { ... }`, whose documentation is the reason.
macro_rules! table {
    (
        $(#[doc = $about:literal])+
        struct $Table:ident = $header:literal {
            $(
                $(#[doc = $doc:literal])*
                $name:ident: $kind:ident $(($($of:tt)*))?
                $(, $presence:ident $(($default:literal))? $(, $fact:ident($($value:tt)*))*)?;
            )+
        }
        $(retired { $($(#[doc = $why:literal])+ $old:ident: $was:expr;)+ })?
        $(one_of $need:ident [$($member:ident),+];)*
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug)]
        pub(crate) struct $Table {
            /// Where the table is written.
            location: $crate::record::Location,
            $($(#[doc = $doc])* pub(crate) $name: $crate::record::Field<value_type!($kind $(($($of)*))?)>,)+
        }

        impl $crate::record::CaseTable for $Table {
            const TABLE: &'static $crate::schema::Table = {
                static TABLE: $crate::schema::Table = $crate::schema::Table {
                    header: $header,
                    doc: $crate::schema::define::text(concat!($($about),+)),
                    keys: &[$(declared_key!(
                        $name [$($doc),*] $kind $(($($of)*))?
                        $(, $presence $(($default))? $(, $fact($($value)*))*)?
                    ),)+ $($($crate::schema::key(
                        stringify!($old),
                        $was,
                        $crate::schema::Presence::Retired,
                        $crate::schema::define::text(concat!($($why),+)),
                    ),)+)?],
                    exclusive: &[$(exclusive_group!($need [$($member),+])),*],
                };
                &TABLE
            };

            fn location(&self) -> &$crate::record::Location {
                &self.location
            }

            fn from_record(mut record: $crate::record::Record) -> Self {
                Self {
                    $($name: record.take($crate::schema::define::name(stringify!($name)), value_reader!($kind $(($($of)*))?)),)+
                    location: record.into_location(),
                }
            }
        }
    };
}

/// The key of one line of a [`table!`].
macro_rules! declared_key {
    ($name:ident [] Shared($key:expr, $($kind:tt)+)) => {
        $crate::schema::Key {
            name: $crate::schema::define::name(stringify!($name)),
            ..$key
        }
    };
    (
        $name:ident [$($doc:literal),+] $kind:ident $(($($of:tt)*))?, $presence:ident $(($default:literal))?
        $(, $fact:ident($($value:tt)*))*
    ) => {
        $crate::schema::key(
            $crate::schema::define::name(stringify!($name)),
            declared_kind!($kind $(($($of)*))?),
            $crate::schema::Presence::$presence $(($default))?,
            $crate::schema::define::text(concat!($($doc),+)),
        ) $(.$fact($($value)*))*
    };
}

/// What the value of a key may be, as the schema has it.
macro_rules! declared_kind {
    (Choice($Word:ty)) => { $crate::schema::Kind::Choice(<$Word as $crate::words::Word>::WORDS) };
    (Choices($Word:ty)) => { $crate::schema::Kind::Choices(<$Word as $crate::words::Word>::WORDS) };
    (ChoiceOr($Word:ty, $Table:ty)) => {
        $crate::schema::Kind::ChoiceOr(
            <$Word as $crate::words::Word>::WORDS,
            <$Table as $crate::record::CaseTable>::TABLE,
        )
    };
    (Table($Table:ty)) => { $crate::schema::Kind::Table(<$Table as $crate::record::CaseTable>::TABLE) };
    (Tables($Table:ty)) => { $crate::schema::Kind::Tables(<$Table as $crate::record::CaseTable>::TABLE) };
    (Named($Table:ty)) => { $crate::schema::Kind::Named(<$Table as $crate::record::CaseTable>::TABLE) };
    (Profile($dimension:expr, $range:expr, $Table:ty)) => {
        $crate::schema::Kind::Profile(
            $dimension,
            $range,
            <$Table as $crate::record::CaseTable>::TABLE,
        )
    };
    (PairProfile($dimension:expr, $range:expr, $Table:ty)) => {
        $crate::schema::Kind::PairProfile(
            $dimension,
            $range,
            <$Table as $crate::record::CaseTable>::TABLE,
        )
    };
    ($kind:ident $(($($of:tt)*))?) => { $crate::schema::Kind::$kind $(($($of)*))? };
}

/// The Rust type of a key's value.
macro_rules! value_type {
    (Choice($Word:ty)) => { $Word };
    (Choices($Word:ty)) => { Vec<$Word> };
    (ChoiceOr($Word:ty, $Table:ty)) => { $crate::record::OrTable<$Word, $Table> };
    (Table($Table:ty)) => { $Table };
    (Tables($Table:ty)) => { Vec<$Table> };
    (Named($Table:ty)) => { Vec<(String, $Table)> };
    (Profile($dimension:expr, $range:expr, $Table:ty)) => { $crate::record::OrTable<f64, $Table> };
    (PairProfile($dimension:expr, $range:expr, $Table:ty)) => { $crate::record::OrTable<Vec<f64>, $Table> };
    (Shared($key:expr, $($kind:tt)+)) => { value_type!($($kind)+) };
    (Quantity $(($($of:tt)*))?) => { f64 };
    (Gradient $(($($of:tt)*))?) => { f64 };
    (Pair $(($($of:tt)*))?) => { [f64; 2] };
    (Vector $(($($of:tt)*))?) => { Vec<f64> };
    (GradientVector $(($($of:tt)*))?) => { Vec<f64> };
    (Either $(($($of:tt)*))?) => { Vec<f64> };
    (List $(($($of:tt)*))?) => { Vec<f64> };
    (Rows $(($($of:tt)*))?) => { Vec<$crate::record::ListRow> };
    (Course $(($($of:tt)*))?) => { Vec<$crate::record::ListRow> };
    (Count $(($($of:tt)*))?) => { u64 };
    (Text $(($($of:tt)*))?) => { String };
    (Name) => { String };
    (Names) => { Vec<String> };
    (Flag) => { bool };
    (Measure) => { $crate::record::Measure };
}

/// The function that turns the datum of a key into its Rust type.
macro_rules! value_reader {
    (Shared($key:expr, $($kind:tt)+)) => { value_reader!($($kind)+) };
    (Choice $($of:tt)?) => { $crate::record::Datum::word };
    (Choices $($of:tt)?) => { $crate::record::Datum::words };
    (ChoiceOr $($of:tt)?) => { $crate::record::Datum::word_or_table };
    (Table $($of:tt)?) => { $crate::record::Datum::table };
    (Tables $($of:tt)?) => { $crate::record::Datum::tables };
    (Named $($of:tt)?) => { $crate::record::Datum::named };
    (Profile $($of:tt)?) => { $crate::record::Datum::number_or_table };
    (PairProfile $($of:tt)?) => { $crate::record::Datum::numbers_or_table };
    (Quantity $($of:tt)?) => { $crate::record::Datum::number };
    (Gradient $($of:tt)?) => { $crate::record::Datum::number };
    (Pair $($of:tt)?) => { $crate::record::Datum::pair };
    (Vector $($of:tt)?) => { $crate::record::Datum::numbers };
    (GradientVector $($of:tt)?) => { $crate::record::Datum::numbers };
    (Either $($of:tt)?) => { $crate::record::Datum::numbers };
    (List $($of:tt)?) => { $crate::record::Datum::numbers };
    (Rows $($of:tt)?) => { $crate::record::Datum::rows };
    (Course $($of:tt)?) => { $crate::record::Datum::rows };
    (Count $($of:tt)?) => { $crate::record::Datum::count };
    (Text $($of:tt)?) => { $crate::record::Datum::text };
    (Name $($of:tt)?) => { $crate::record::Datum::text };
    (Names $($of:tt)?) => { $crate::record::Datum::names };
    (Flag $($of:tt)?) => { $crate::record::Datum::flag };
    (Measure $($of:tt)?) => { $crate::record::Datum::measure };
}

/// A group of keys of which only one may be given.
macro_rules! exclusive_group {
    (required [$($member:ident),+]) => { exclusive_group!(true, false, $($member),+) };
    (optional [$($member:ident),+]) => { exclusive_group!(false, false, $($member),+) };
    (preset [$($member:ident),+]) => { exclusive_group!(true, true, $($member),+) };
    ($required:literal, $has_preset:literal, $($member:ident),+) => {
        $crate::schema::Group {
            keys: &[$($crate::schema::define::name(stringify!($member))),+],
            required: $required,
            has_preset: $has_preset,
        }
    };
}

/// The variant of the first key of a table that is given, or of the last one.
macro_rules! first_given {
    ($table:ident, $Keys:ident: $($Variant:ident($key:ident)),+) => {
        first_given!(@ $table, $Keys, $($Variant $key)+)
    };
    (@ $table:ident, $Keys:ident, $Last:ident $last:ident) => { $Keys::$Last(&$table.$last) };
    (@ $table:ident, $Keys:ident, $First:ident $first:ident $($rest:ident)+) => {
        if $table.$first.is_given() {
            $Keys::$First(&$table.$first)
        } else {
            first_given!(@ $table, $Keys, $($rest)+)
        }
    };
}

/// Finds the key of a face by its side.
macro_rules! support_table {
    ($Table:ident) => {
        impl $crate::schema::SupportTable for $Table {
            fn face(&self, side: $crate::words::Side) -> &$crate::schema::SupportField {
                match side {
                    $crate::words::Side::Left => &self.left,
                    $crate::words::Side::Right => &self.right,
                    $crate::words::Side::Front => &self.front,
                    $crate::words::Side::Back => &self.back,
                    $crate::words::Side::Bottom => &self.bottom,
                    $crate::words::Side::Top => &self.top,
                }
            }
        }
    };
}

/// A key as written in the case file: a field's name without the mark of a word that Rust reserves.
pub(crate) const fn name(field: &'static str) -> &'static str {
    match field.as_bytes() {
        [b'r', b'#', rest @ ..] => utf8(rest),
        _ => field,
    }
}

/// The text of documentation lines, without the space before the first word.
pub(crate) const fn text(lines: &'static str) -> &'static str {
    match lines.as_bytes() {
        [b' ', rest @ ..] => utf8(rest),
        _ => lines,
    }
}

/// Text from the bytes of a text.
const fn utf8(bytes: &'static [u8]) -> &'static str {
    match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => panic!("a declaration is not UTF-8"),
    }
}
