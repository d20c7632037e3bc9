//! Macro that defines the list of observables.

/// Defines the enum of all observables with its words, definitions and values. An entry is
/// `/// documentation` `Name = "word": Kind, "unit", COLUMNS, [aspects], [keys of an example] => value;` with the value
/// of a `sample` as a `Vec<f64>`.
macro_rules! observables {
    ($sample:ident => $(
        $(#[doc = $doc:literal])+
        $variant:ident = $word:literal: $kind:ident, $unit:literal, $columns:ident, [$($aspect:ident),*],
        [$($key:literal),*] => $value:expr;
    )+) => {
        /// Quantity that histories record.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Observable {
            $($(#[doc = $doc])+ $variant,)+
        }

        words! { Observable { $($variant = $word: concat!($($doc),+),)+ } }

        impl Observable {
            /// Returns kind, unit, columns, aspects and example.
            pub const fn definition(self) -> Definition {
                match self {
                    $(Self::$variant => Definition {
                        kind: SubjectKind::$kind,
                        unit: $unit,
                        columns: columns::$columns,
                        aspects: &[$(Aspect::$aspect),*],
                        example: &[$($key),*],
                    },)+
                }
            }

            /// Returns the values of the columns. Collective.
            ///
            /// # Errors
            /// Those of averages over the grid, if a material point lies outside of it.
            pub fn values<K: Kinematics<D>, const D: usize>(
                self,
                $sample: &Sample<'_, K, D>,
            ) -> Result<Vec<f64>, StepError> {
                Ok(match self {
                    $(Self::$variant => $value,)+
                })
            }
        }
    };
}
