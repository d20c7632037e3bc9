//! Tests tables with one row per step.

use bsmpm_io::Error;
use bsmpm_io::steps::StepRow;
use bsmpm_io::table::{self, Cell, CsvTable, TableColumn};

fn columns() -> [TableColumn; 3] {
    [
        TableColumn::new("step", ""),
        TableColumn::new("time", "s"),
        TableColumn::new("footing-pressure", "Pa"),
    ]
}

#[test]
fn every_float_reads_back_to_the_bit_and_is_in_the_file_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("history.csv");
    let mut table = CsvTable::create(&path, &columns()).unwrap();
    let mut numbers = vec![0.1 + 0.2, -0.0, 5e-324, f64::MAX, 1e16, 123_456_789.123_456_78, -1e-7];
    // A linear congruential walk through the bit patterns.
    let mut state = 1_u64;
    for _ in 0..1000 {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        numbers.extend(Some(f64::from_bits(state)).filter(|value| value.is_finite()));
    }
    for (step, &value) in numbers.iter().enumerate() {
        table
            .row(&[
                Cell::Int(step as u64),
                Cell::Float(step as f64 * 0.1),
                Cell::Float(value),
            ])
            .unwrap();
        if step < 10 {
            assert_eq!(table::read(&path).unwrap().values[0].len(), step + 1);
        }
    }
    let read = table::read(&path).unwrap();
    assert_eq!(read.headings, columns());
    assert_eq!(read.unit("footing-pressure"), Some("Pa"));
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(read.get("footing-pressure").unwrap()), bits(&numbers));
    assert!(
        std::fs::read_to_string(&path)
            .unwrap()
            .starts_with("step,time,footing-pressure\n# -,s,Pa\n0,0.0,0.3")
    );
}

#[test]
fn a_bad_row_leaves_the_file_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("history.csv");
    let mut table = CsvTable::create(&path, &columns()).unwrap();
    table.row(&[Cell::Int(0), Cell::Float(0.0), Cell::Float(1.5)]).unwrap();
    let before = std::fs::read(&path).unwrap();
    for value in [f64::NAN, f64::INFINITY] {
        let error = table
            .row(&[Cell::Int(7), Cell::Float(0.1), Cell::Float(value)])
            .unwrap_err();
        assert!(
            matches!(&error, Error::NotFinite { item, .. } if item == "footing-pressure in step 7"),
            "{error}"
        );
    }
    assert!(matches!(
        table.row(&[Cell::Int(1)]),
        Err(Error::Length {
            expected: 3,
            found: 1,
            ..
        })
    ));
    assert_eq!(std::fs::read(&path).unwrap(), before);
}

#[test]
fn headings_that_would_break_the_file_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("history.csv");
    for name in ["", "a,b", "a\nb", "\"a\"", "#a", " a", "step"] {
        let columns = [TableColumn::new("step", ""), TableColumn::new(name, "m")];
        assert!(
            matches!(CsvTable::create(&path, &columns), Err(Error::Name { .. })),
            "{name:?}"
        );
    }
    assert!(!path.exists());
    CsvTable::create(&path, &columns()).unwrap();
    assert!(matches!(
        CsvTable::create(&path, &columns()),
        Err(Error::File { action: "create", .. })
    ));
}

#[test]
fn a_row_that_is_being_written_is_left_out_and_a_damaged_one_is_reported() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("history.csv");
    std::fs::write(&path, "step,time\n# -,s\n0,0.0\n1,0.2").unwrap();
    assert_eq!(table::read(&path).unwrap().values, [[0.0], [0.0]]);
    for (text, line) in [
        ("step,time\n0,0\n1\n2,2\n", "line 3"),
        ("a\n1\nNaN\n", "line 3"),
        ("\n", "no line of names"),
    ] {
        std::fs::write(&path, text).unwrap();
        let error = table::read(&path).unwrap_err();
        assert!(error.to_string().contains(line), "{error}");
    }
}

#[test]
fn a_table_of_the_literature_may_begin_with_its_source() {
    let read = table::parse("# Xie et al. (2023), figure 5\ntime, x, y\n0.1,0.2,0.05\n# later\n0.2,0.3,0.04").unwrap();
    assert_eq!(read.get("y").unwrap(), [0.05, 0.04]);
    assert_eq!(read.unit("y"), Some(""));
}

#[test]
fn steps_fit_their_columns() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("steps.csv");
    let mut table = CsvTable::create(&path, &StepRow::columns("s")).unwrap();
    let step = StepRow {
        step: 1,
        time: 2.5e-4,
        dt: 2.5e-4,
        iterations: 7,
        residual: 3e-9,
        linear_iterations: 0,
        cutbacks: 1,
        active_nodes: 4000,
        wall: 0.25,
        newton_iterations: 0,
        evaluations: 0,
        products: 0,
        factorisations: 0,
        reductions: 90,
        messages: 30,
        bytes: 48000,
        imbalance: 1.25,
    };
    table.row(&step.cells()).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let names = "step,time,dt,iterations,residual,linear_iterations,cutbacks,active_nodes,wall,\
                 newton_iterations,evaluations,products,factorisations,reductions,messages,bytes,imbalance\n";
    assert_eq!(
        text,
        format!(
            "{names}# -,s,s,-,-,-,-,-,s,-,-,-,-,-,-,-,-\n1,0.00025,0.00025,7,3e-9,0,1,4000,0.25,0,0,0,0,90,30,48000,1.25\n"
        )
    );
}

#[test]
fn a_table_goes_on_from_a_mark_and_loses_what_came_later() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("history.csv");
    let row = |step: u64| [Cell::Int(step), Cell::Float(0.1 * step as f64), Cell::Float(0.0)];
    let mut table = CsvTable::create(&path, &columns()).unwrap();
    table.row(&row(0)).unwrap();
    let mark = table.mark().unwrap();
    let marked = std::fs::read(&path).unwrap();
    table.row(&row(1)).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let whole_mark = table.mark().unwrap();
    // A row of which a crash has left one half.
    std::fs::write(&path, [&whole[..], b"2,0.2"].concat()).unwrap();
    let mut again = CsvTable::resume(&path, &columns(), &mark).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), marked);
    again.row(&row(1)).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), whole);
    assert_eq!(again.mark().unwrap(), whole_mark);
}

#[test]
fn a_table_that_is_not_the_marked_one_is_refused_and_stays() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("history.csv");
    let mut table = CsvTable::create(&path, &columns()).unwrap();
    table.row(&[Cell::Int(0), Cell::Float(0.0), Cell::Float(1.5)]).unwrap();
    let mark = table.mark().unwrap();
    let whole = std::fs::read(&path).unwrap();
    let mut other = whole.clone();
    other[whole.len() - 2] ^= 1;
    for found in [&whole[..whole.len() - 1], &other, b""] {
        std::fs::write(&path, found).unwrap();
        assert!(matches!(
            CsvTable::resume(&path, &columns(), &mark),
            Err(Error::Format { .. })
        ));
        assert_eq!(std::fs::read(&path).unwrap(), found);
    }
    std::fs::write(&path, &whole).unwrap();
    assert!(
        matches!(
            CsvTable::resume(&path, &columns()[..2], &mark),
            Err(Error::Format { .. })
        ),
        "other columns"
    );
    assert!(CsvTable::resume(&path, &columns(), &mark).is_ok());
}
