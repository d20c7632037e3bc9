//! A number computed from a history, or the reason why it is missing.

/// A number, and what its reader should know.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeasuredNumber {
    pub value: f64,
    pub remark: Option<String>,
}

/// Why there is no number.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Lack {
    /// The run did not come so far.
    NotReached(String),
    Other(String),
}

impl From<String> for Lack {
    fn from(reason: String) -> Self {
        Self::Other(reason)
    }
}
