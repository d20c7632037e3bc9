//! Rows of text in columns, for the screen and as CSV, and the numbers in them.

/// At which side of its column a text stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Lines in columns of the widths that they need, two spaces apart.
pub(crate) fn aligned(lines: &[Vec<String>], align: impl Fn(usize) -> Align) -> String {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut made = String::new();
    for line in lines {
        let cell = |(column, cell): (usize, &String)| match align(column) {
            Align::Left => format!("{cell:<width$}", width = widths[column]),
            Align::Right => format!("{cell:>width$}", width = widths[column]),
        };
        let cells: Vec<String> = line.iter().enumerate().map(cell).collect();
        made += cells.join("  ").trim_end();
        made.push('\n');
    }
    made
}

/// Lines as comma-separated values (RFC 4180): a cell with a comma, a quote or a line break is quoted.
pub(crate) fn csv(lines: &[Vec<String>]) -> String {
    let cell = |cell: &String| match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.clone(),
    };
    lines.iter().map(|line| line.iter().map(cell).collect::<Vec<_>>().join(",") + "\n").collect()
}

/// Five digits, without an exponent where that is readable.
pub(crate) fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-3..1e7).contains(&rounded.abs()) { format!("{rounded:e}") } else { rounded.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines() -> Vec<Vec<String>> {
        let line = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        vec![line(["a", "value"]), line(["[1, 2]", "3"]), line(["\"q\"", ""])]
    }

    #[test]
    fn columns_are_as_wide_as_they_must_be() {
        let text = aligned(&lines(), |column| if column == 0 { Align::Left } else { Align::Right });
        assert_eq!(text, "a       value\n[1, 2]      3\n\"q\"\n");
    }

    #[test]
    fn what_would_end_a_cell_is_quoted() {
        assert_eq!(csv(&lines()), "a,value\n\"[1, 2]\",3\n\"\"\"q\"\"\",\n");
    }
}
