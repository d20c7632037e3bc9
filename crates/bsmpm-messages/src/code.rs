//! Reads the code of a message, such as W0206, from the beginning of the message text.

/// Characters of a code and of the colon and the blank behind it.
const LENGTH: usize = "E0001".len();

/// What a message reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The program cannot do what was asked.
    Error,
    /// The program goes on, and the result may not be what was meant.
    Warning,
    /// A measured quality of a result is outside its usual range.
    Indicator,
}

impl Kind {
    /// The kind of a code: by its letter, `E`, `W` or `I`.
    pub fn of(code: &str) -> Option<Self> {
        match code.as_bytes().first()? {
            b'E' => Some(Self::Error),
            b'W' => Some(Self::Warning),
            b'I' => Some(Self::Indicator),
            _ => None,
        }
    }

    /// The word that a message begins with. An indicator out of its range is a warning.
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning | Self::Indicator => "warning",
        }
    }
}

/// The code that a message begins with, if it has one: a letter, four digits and `": "`.
pub fn code_of(message: &str) -> Option<&str> {
    let (code, rest) = message.split_at_checked(LENGTH)?;
    let has_digits = code.bytes().skip(1).all(|byte| byte.is_ascii_digit());
    (Kind::of(code).is_some() && has_digits && rest.starts_with(": ")).then_some(code)
}

/// A message without its code.
pub fn without_code(message: &str) -> &str {
    match code_of(message) {
        Some(_) => &message[LENGTH + ": ".len()..],
        None => message,
    }
}

/// A message as it is printed: `warning W0206: gravity ...`. `otherwise` is the word of one that has no code.
pub fn headed(message: &str, otherwise: &str) -> String {
    match code_of(message).and_then(Kind::of) {
        Some(kind) => format!("{} {message}", kind.word()),
        None => format!("{otherwise}: {message}"),
    }
}

/// A message with the place that it concerns between its code and its words.
pub fn with_context(message: &str, context: &str) -> String {
    match code_of(message) {
        Some(code) => format!("{code}: {context}: {}", without_code(message)),
        None => format!("{context}: {message}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{code_of, headed, with_context, without_code};

    #[test]
    fn a_code_is_a_letter_and_four_digits_before_a_colon() {
        assert_eq!(code_of("W0206: gravity"), Some("W0206"));
        for other in [
            "",
            "W0206",
            "W0206 gravity",
            "X0112: gravity",
            "W01a2: gravity",
            "äöü: gravity",
        ] {
            assert_eq!(code_of(other), None, "{other}");
            assert_eq!(without_code(other), other);
        }
        assert_eq!(without_code("W0206: gravity"), "gravity");
        assert_eq!(with_context("W0206: gravity", "stage"), "W0206: stage: gravity");
        assert_eq!(with_context("gravity", "stage"), "stage: gravity");
    }

    #[test]
    fn a_printed_message_begins_with_its_kind_and_its_code() {
        assert_eq!(headed("W0206: gravity", "warning"), "warning W0206: gravity");
        assert_eq!(headed("E0206: gravity", "error"), "error E0206: gravity");
        assert_eq!(headed("I0007: energy", "warning"), "warning I0007: energy");
        assert_eq!(headed("gravity", "warning"), "warning: gravity");
    }
}
