//! Tests that files without a case are refused, and how errors are reported.

use super::{DYNAMIC, STATIC};
use bsmpm_scene::{Case, Error, MAX_BYTES, Place};

fn refuse(bytes: &[u8]) -> Vec<Error> {
    Case::from_bytes("case.toml", bytes, &[]).expect_err("accepted")
}

fn only(bytes: &[u8], says: &str) {
    let errors = refuse(bytes);
    assert!(
        errors.len() == 1 && errors[0].message.contains(says),
        "{says}: {errors:#?}"
    );
}

fn utf16(text: &str, little: bool) -> Vec<u8> {
    let unit = |unit: u16| if little { unit.to_le_bytes() } else { unit.to_be_bytes() };
    std::iter::once(0xfeff)
        .chain(text.encode_utf16())
        .flat_map(unit)
        .collect()
}

#[test]
fn i05_i06_no_text_of_a_case() {
    only(b"", "the file is empty");
    only(b"\xef\xbb\xbf", "the file is empty");
    only(b"# nothing but a comment\n", "the file is empty");
    only(&utf16(STATIC, true), "UTF-16");
    only(&utf16(STATIC, false), "UTF-16");
    only(&utf16(STATIC, true)[2..], "a zero byte");
    only(b"\x7fELF\x02\x01\x00", "line 1 has a zero byte");
    only(
        b"title = \"a\"\ngeometry = \"\xff\"",
        "line 2 has characters that are not UTF-8",
    );
    only(&vec![b'#'; MAX_BYTES + 1], "is larger than 16 MiB");
}

#[test]
fn i06_line_ends_and_byte_order_marks_do_not_matter() {
    let plain = Case::from_text("case.toml", DYNAMIC, &[]).unwrap();
    for text in [DYNAMIC.replace('\n', "\r\n"), format!("\u{feff}{DYNAMIC}")] {
        let other = Case::from_text("case.toml", &text, &[]).unwrap();
        assert_eq!(
            Case {
                text: String::new(),
                ..other
            },
            Case {
                text: String::new(),
                ..plain.clone()
            }
        );
    }
    let text = format!("\u{feff}{}", DYNAMIC.replace('\n', "\r\n").replace("0.49\r", "0.6\r"));
    let expected = 1 + DYNAMIC[..DYNAMIC.find("0.49").unwrap()].matches('\n').count();
    assert_eq!(
        refuse(text.as_bytes())[0].place,
        Place::Line {
            line: expected,
            column: 15
        }
    );
}

#[test]
fn i21_large_and_deep_files_are_refused_soon() {
    let many: String = (0..60_000).map(|i| format!("k{i} = {i}\n")).collect();
    let started = std::time::Instant::now();
    let errors = refuse(many.as_bytes());
    assert!(errors.len() <= 110, "{}", errors.len());
    assert!(
        errors.iter().any(|error| error.message.contains("more unknown keys")),
        "{errors:?}"
    );
    refuse(format!("a = {}", "[".repeat(1_000_000)).as_bytes());
    refuse(format!("{}b = 1", "a.".repeat(500_000)).as_bytes());
    refuse(format!("[{}]", vec!["a"; 500_000].join(".")).as_bytes());
    let long = refuse(format!("{} = 1", "k".repeat(1_000_000)).as_bytes());
    assert!(long.iter().all(|error| error.to_string().len() < 1000));
    assert!(started.elapsed().as_secs() < 20, "{:?}", started.elapsed());
}

#[test]
fn all_errors_come_at_once_in_the_order_of_the_file() {
    let text = DYNAMIC
        .replace("0.49", "0.6")
        .replace("poisson  = 0.3", "poison = 0.3")
        .replace("\"10 ms\"", "\"10 m\"");
    let errors = refuse(text.as_bytes());
    let keys: Vec<&str> = errors.iter().map(|error| error.key.as_str()).collect();
    assert_eq!(keys, ["analysis.dt", "material.sand.poison", "material.clay.poisson"]);
    let errors = refuse(b"a = x\nb = y\nc = \"");
    assert_eq!(
        errors.len(),
        3,
        "every line with a syntax error is reported: {errors:#?}"
    );
}

#[test]
fn an_error_reads_well() {
    let text = DYNAMIC.replace("poisson     = 0.49", "poisson     = 0.6");
    let error = &refuse(text.as_bytes())[0];
    let line = 1 + text[..text.find("0.6").unwrap()].matches('\n').count();
    let message = "0.6 is outside the allowed range (-1 < poisson < 0.5): at 0.5 the material is incompressible; \
    for undrained soil use 0.49 with model = \"tresca\", or drainage = \"undrained\". Correct the value.";
    assert_eq!(
        error.to_string(),
        format!("case.toml:{line}:15: error E0010: material.clay.poisson: {message}")
    );
    let block = format!("{error:#}");
    let lines: Vec<&str> = block.lines().skip(1).collect();
    assert_eq!(
        lines,
        [
            format!("  {line} | poisson     = 0.6"),
            "     |               ^".to_owned()
        ]
    );
}

#[test]
fn nothing_printed_can_move_the_cursor() {
    let text = "\"\u{1b}[31m\u{202e}\" = 1\ntitle = \"\u{202e}\u{7f}\"\n".replace(['\u{1b}', '\u{7f}'], "\\u001b");
    for error in refuse(text.as_bytes()) {
        assert!(!error.to_string().contains(['\u{1b}', '\u{202e}']), "{error:?}");
    }
}

#[test]
fn i20_counts_are_bounded_before_anything_is_made() {
    let set = |values: &[&str]| {
        let overrides: Vec<String> = values.iter().map(ToString::to_string).collect();
        Case::from_text("case.toml", STATIC, &overrides)
    };
    let errors = set(&["grid.cell=5e-4", "body.0.points_per_cell=100"]).unwrap_err();
    assert!(
        errors[0]
            .message
            .contains("80000000000 material points (at most 2147483647)"),
        "{errors:?}"
    );
    assert!(set(&["grid.upper=[1e9, 1e9]", "grid.cell=1"]).is_err());
    let errors = set(&["grid.upper=[40000, 40000]", "grid.cell=1"]).unwrap_err();
    assert!(
        errors[0].message.contains("1600000000 cells and 3200320008 unknowns"),
        "{errors:?}"
    );
    let large = set(&["grid.cell=1e-4", "grid.degree=linear", "body.0.points_per_cell=1"]).unwrap();
    let estimate = large.estimate(1);
    assert_eq!(estimate.points, 200_000_000);
    assert!(estimate.bytes > 100_000_000_000, "{estimate:?}");
}
