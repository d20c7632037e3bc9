//! Macros that define an enum with its accepted words.

/// The words of an enum: `Variant = "word": "what it means",` those that are not available `later`, and `misnomers`
/// with what is meant by them, `earlier` words with those of now, and those that were `removed`.
macro_rules! words {
    ($type:ident {
        $($variant:ident = $word:literal: $doc:expr,)+
    } $(later [$($later:literal),+])? $(misnomers [$($misnomer:literal: $meant:literal),+])?
    $(earlier [$($earlier:literal: $now:literal),+])? $(removed [$($removed:expr),+])?) => {
        impl $crate::words::Word for $type {
            const WORDS: $crate::words::Words = $crate::words::Words {
                auto: None,
                words: &[$(($word, $doc)),+],
                later: &[$($($later),+)?],
                misnomers: &[$($(($misnomer, $meant)),+)?],
                earlier: &[$($(($earlier, $now)),+)?],
                removed: &[$($($removed),+)?],
            };

            fn of(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$variant),)+
                    _ => None,
                }
            }

            fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }
    };
}

/// An enum with its words; a variant's documentation is what its word means.
macro_rules! choice {
    ($(#[$about:meta])+ pub enum $type:ident {
        $($(#[doc = $doc:literal])+ $variant:ident = $word:literal,)+
    } $(later [$($later:literal),+])? $(misnomers [$($misnomer:literal: $meant:literal),+])?
    $(earlier [$($earlier:literal: $now:literal),+])? $(removed [$($removed:expr),+])?) => {
        $(#[$about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $($(#[doc = $doc])+ $variant,)+
        }

        words! { $type {
            $($variant = $word: concat!($($doc),+),)+
        } $(later [$($later),+])? $(misnomers [$($misnomer: $meant),+])? $(earlier [$($earlier: $now),+])? $(removed [$($removed),+])? }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str($crate::words::Word::word(*self))
            }
        }
    };
}
