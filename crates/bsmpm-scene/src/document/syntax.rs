//! Explains TOML syntax errors and their correction.

use crate::error::Origin;
use crate::report::{Report, shortened};
use crate::source::Source;

/// An error as the reader of TOML reports it.
pub(super) struct SyntaxError<'a> {
    /// bytes of the text, if it has a place
    pub span: Option<std::ops::Range<usize>>,
    pub message: &'a str,
}

/// Reports the errors, one for each line; behind a bracket that is not closed nothing is sure, and nothing reported.
pub(super) fn report_all(source: &Source<'_>, errors: &[SyntaxError<'_>], report: &mut Report<'_>) {
    let unclosed = if errors.is_empty() {
        None
    } else {
        unclosed_bracket(source.text)
    };
    let mut last_line = None;
    let mut duplicates: Vec<&str> = Vec::new();
    // Where a table that is given twice begins, whose keys are not given twice then.
    let mut repeated: Option<usize> = None;
    for error in errors {
        let Some(span) = &error.span else {
            report.error(
                Origin::Nowhere,
                "",
                format!(
                    "E0005: the line does not follow the TOML format: {}. Correct this line or the line before.",
                    error.message
                ),
            );
            continue;
        };
        let line = source.line(span.start);
        let is_behind = unclosed.as_ref().is_some_and(|of| of.bracket.at <= span.start);
        let name = &source.text[span.clone()];
        let is_in_repeated = repeated.is_some_and(|from| {
            source.text[from..span.start]
                .lines()
                .skip(1)
                .all(|line| header(line).is_none())
        });
        let is_repeated = error.message == DUPLICATE && (duplicates.contains(&name) || is_in_repeated);
        if is_behind || is_repeated || last_line == Some(line) {
            continue;
        }
        if error.message == DUPLICATE {
            duplicates.push(name);
            repeated = header(line_of(source.text, span.start)).map(|_| span.start);
        }
        last_line = Some(line);
        report.error(Origin::Text(span.start), "", explained(source, span, error.message));
    }
    if let Some(UnclosedBracket { bracket, behind }) = unclosed {
        let Bracket { at, opening } = bracket;
        let closing = if opening == '[' { ']' } else { '}' };
        let line = source.line(behind);
        let message = format!(
            "E0041: the bracket `{opening}` is not closed before line {line}. Add `{closing}` at the end of the value."
        );
        report.error(Origin::Text(at), "", message);
    }
}

/// What the reader of TOML says of a key or table that stands twice.
const DUPLICATE: &str = "duplicate key";

/// The line that a byte lies in.
fn line_of(text: &str, at: usize) -> &str {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    text[start..].lines().next().unwrap_or_default()
}

/// The error in the author's words, where there are better ones than those of the reader of TOML.
fn explained(source: &Source<'_>, span: &std::ops::Range<usize>, message: &str) -> String {
    let line = line_of(source.text, span.start);
    if message == DUPLICATE {
        return duplicate(source, span, line);
    }
    let value = line
        .split_once('=')
        .map_or("", |(_, value)| value.split('#').next().unwrap_or(value).trim());
    if let Some(number) = with_decimal_comma(value) {
        return format!(
            "E0042: `{}` has a decimal comma. Write a decimal point: {number}.",
            shortened(value)
        );
    }
    if let Some(value) = [value, item_at(source.text, span.start)]
        .into_iter()
        .find(|value| is_number_with_unit(value))
    {
        return format!(
            "E0043: `{}` has a unit, but no quotes. Write \"{}\".",
            shortened(value),
            shortened(value)
        );
    }
    let remedy = match source.line(span.start) {
        1 => "Check that this is a case file, and correct the line.",
        _ => "Correct this line or the line before.",
    };
    format!("E0005: the line does not follow the TOML format: {message}. {remedy}")
}

/// The item of a list or of a table in braces that a byte lies in.
fn item_at(text: &str, at: usize) -> &str {
    let before = text[..at].rfind(['=', ',', '[', '{', '\n']);
    let length = text[at..].find([',', ']', '}', '#', '\n']);
    let start = before.map_or(0, |before| before + 1);
    let end = length.map_or(text.len(), |length| at + length);
    text[start..end].trim()
}

/// The number with a decimal point if it is written with a comma.
fn with_decimal_comma(value: &str) -> Option<String> {
    let (whole, part) = value.split_once(',')?;
    let digits = whole.trim_start_matches(['+', '-']);
    let are_digits = [digits, part]
        .iter()
        .all(|text| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit()));
    are_digits.then(|| format!("{whole}.{part}"))
}

/// Whether a value is a number, a blank and a word.
fn is_number_with_unit(value: &str) -> bool {
    let Some((number, unit)) = value.split_once(' ') else {
        return false;
    };
    let is_unit = unit.chars().all(|c| c.is_alphanumeric() || "/^%°²³ ".contains(c));
    number.parse::<f64>().is_ok() && is_unit && unit.starts_with(|c: char| c.is_alphabetic() || "%°".contains(c))
}

/// Says where a key or a table stands first.
fn duplicate(source: &Source<'_>, span: &std::ops::Range<usize>, line: &str) -> String {
    let name = &source.text[span.clone()];
    let before = &source.text[..span.start];
    let Some(header) = header(line) else {
        let first = first_entry(before, name).map(|at| source.line(at));
        return match first {
            Some(first) => format!("E0044: `{name}` is given twice, here and in line {first}. Delete one of them."),
            None => format!("E0044: `{name}` is given twice. Delete one of them."),
        };
    };
    let name = header.name;
    let lines = before.lines().enumerate();
    let same = lines.filter_map(|(number, line)| Some((number + 1, self::header(line)?)));
    let first = same.filter(|(_, other)| other.name == name).last();
    match first {
        Some((number, first)) if first.is_list == header.is_list => {
            format!(
                "E0045: the table [{name}] is given twice, here and in line {number}. Put the keys of both below one \
                 of the two headings."
            )
        }
        Some((number, first)) => format!(
            "E0046: the table `{name}` has {} here, but {} in line {number}. Write [[{name}]] in both lines.",
            pairs(header.is_list),
            pairs(first.is_list)
        ),
        None => {
            format!("E0045: the table [{name}] is given twice. Put the keys of both below one of the two headings.")
        }
    }
}

/// The brackets of a header in words.
fn pairs(is_list: bool) -> &'static str {
    if is_list {
        "two pairs of brackets"
    } else {
        "one pair of brackets"
    }
}

/// The header of a table, or of one of a list.
struct Header<'a> {
    name: &'a str,
    is_list: bool,
}

/// The header in a line, if it is one.
fn header(line: &str) -> Option<Header<'_>> {
    let line = line.split('#').next().unwrap_or(line).trim();
    let (line, is_list) = match line.strip_prefix("[[").and_then(|rest| rest.strip_suffix("]]")) {
        Some(name) => (name, true),
        None => (line.strip_prefix('[')?.strip_suffix(']')?, false),
    };
    let name = line.trim();
    let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic() || "_\"'".contains(c))
        && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.\"' ".contains(c));
    is_name.then_some(Header { name, is_list })
}

/// Byte at which an entry of the same table begins, in the text before another one; in an inline table it is in the
/// same line.
fn first_entry(before: &str, name: &str) -> Option<usize> {
    let mut end = before.len();
    while let Some(start) = before[..end].rfind(name) {
        let between = before[start..].lines().any(|line| header(line).is_some());
        if between {
            return None;
        }
        let is_entry = before[start + name.len()..].trim_start().starts_with(['=', '.']);
        let is_whole = !before[..start].ends_with(|c: char| c.is_alphanumeric() || "_-.".contains(c));
        if is_entry && is_whole {
            return Some(start);
        }
        end = start;
    }
    None
}

/// A bracket that begins a list or a table.
#[derive(Clone, Copy)]
struct Bracket {
    /// byte
    at: usize,
    opening: char,
}

/// A bracket that is not closed before a place at which a value cannot go on.
struct UnclosedBracket {
    bracket: Bracket,
    /// byte of the place
    behind: usize,
}

/// The first value whose bracket is not closed before the next entry, the next header or the end; `None` also where a
/// string has no end.
fn unclosed_bracket(text: &str) -> Option<UnclosedBracket> {
    let mut open: Vec<Bracket> = Vec::new();
    let mut start = 0;
    while start < text.len() {
        let line = text[start..].lines().next().unwrap_or_default();
        let is_in_list = open.last().is_some_and(|bracket| bracket.opening == '[');
        if let Some(&bracket) = open.first()
            && (header(line).is_some() || is_in_list && is_entry(line))
        {
            let behind = start;
            return Some(UnclosedBracket { bracket, behind });
        }
        let value = if open.is_empty() { value_of(line) } else { Some(0) };
        start = match value {
            Some(value) => scan_value(text, start + value, &mut open)?,
            None => start + line.len(),
        };
        start = text[start..].find('\n').map_or(text.len(), |length| start + length + 1);
    }
    let bracket = *open.first()?;
    let behind = text.len();
    Some(UnclosedBracket { bracket, behind })
}

/// Byte at which the value of an entry begins in its line, if the line is one.
fn value_of(line: &str) -> Option<usize> {
    let is_other = line.trim_start().starts_with(['#', '[']);
    line.find('=').filter(|_| !is_other).map(|at| at + 1)
}

/// Follows the brackets of a value from a byte to the end of the line, or of one in which a longer string ends; the
/// byte of the end. `None` if a string has no end.
fn scan_value(text: &str, from: usize, open: &mut Vec<Bracket>) -> Option<usize> {
    let mut at = from;
    while let Some(next) = text[at..].chars().next() {
        match next {
            '\n' => return Some(at),
            '#' => return Some(at + text[at..].find('\n').unwrap_or(text.len() - at)),
            '"' | '\'' => {
                at = end_of_string(text, at)?;
                continue;
            }
            '[' | '{' => open.push(Bracket { at, opening: next }),
            ']' | '}' => drop(open.pop()),
            _ => {}
        }
        at += next.len_utf8();
    }
    Some(at)
}

/// The byte behind a string that begins at a byte.
fn end_of_string(text: &str, start: usize) -> Option<usize> {
    let quote = &text[start..=start];
    let long = quote.repeat(3);
    let delimiter = if text[start..].starts_with(&long) {
        long.as_str()
    } else {
        quote
    };
    let mut at = start + delimiter.len();
    loop {
        let rest = &text[at..];
        if rest.starts_with(delimiter) {
            return Some(at + delimiter.len());
        }
        let next = rest.chars().next().filter(|c| *c != '\n' || delimiter.len() > 1)?;
        let escaped = (next == '\\' && quote == "\"").then(|| rest.chars().nth(1)).flatten();
        at += next.len_utf8() + escaped.map_or(0, char::len_utf8);
    }
}

/// Whether a line begins with a key and `=`.
fn is_entry(line: &str) -> bool {
    let Some((key, _)) = line.split_once('=') else {
        return false;
    };
    let key = key.trim();
    key.starts_with(|c: char| c.is_ascii_alphabetic())
        && key.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c))
}

#[cfg(test)]
mod tests {
    use crate::case::Case;

    /// The only error, with its line and column.
    #[track_caller]
    fn only(text: &str) -> String {
        let errors = Case::from_text("case.toml", text, &[]).expect_err("accepted");
        assert_eq!(errors.len(), 1, "{errors:#?}");
        errors[0].to_string()
    }

    #[test]
    fn a_bracket_that_is_not_closed_is_reported_where_it_opens() {
        let expected = |line: usize| {
            format!(
                "case.toml:1:5: error E0041: the bracket `[` is not closed before line {line}. Add `]` at the end of the value."
            )
        };
        assert_eq!(only("a = [[0.0, 1.0], [2.0, 3.0]\n\n[x]\na=1\n"), expected(3));
        assert_eq!(only("a = [1.0, 2.0\nb = 3\nc = 4\n"), expected(2));
        assert_eq!(only("a = [[1.0, 2.0], # ]\n[3.0, \"]\"],\nb = 3\n"), expected(3));
        assert!(only("a = { b = 1, c = 2\n[d]\n").contains("`{` is not closed before line 2. Add `}`"));
    }

    #[test]
    fn a_key_that_is_given_twice_has_two_places() {
        assert_eq!(
            only("a = 1\nb = 2\na = 3\n"),
            "case.toml:3:1: error E0044: `a` is given twice, here and in line 1. Delete one of them."
        );
        assert_eq!(
            only("x = { a = 1, a = 2 }"),
            "case.toml:1:14: error E0044: `a` is given twice, here and in line 1. Delete one of them."
        );
        let table = only("[m.s]\na = 1\n[m.s]\nb = 2\n");
        assert!(
            table.contains("the table [m.s] is given twice, here and in line 1."),
            "{table}"
        );
        let list = only("[body]\na=1\n[[body]]\na=2\n[[body]]\na=3\n");
        assert!(list.contains("Write [[body]] in both lines."), "{list}");
    }

    #[test]
    fn numbers_as_people_write_them() {
        assert!(only("a = 0,3\n").contains("`0,3` has a decimal comma. Write a decimal point: 0.3."));
        assert!(only("a = -10,25 # m\n").contains("Write a decimal point: -10.25."));
        assert!(only("a = 10 kPa\n").contains("`10 kPa` has a unit, but no quotes. Write \"10 kPa\"."));
        assert!(only("a = [40 m, 12.0]\n").contains("`40 m` has a unit, but no quotes. Write \"40 m\"."));
        assert!(only("a = { b = 2, c = 3 kN }\n").contains("Write \"3 kN\"."));
        assert!(only("a = [1, 2\n, 3]]\n").contains("E0005: "));
    }
}
