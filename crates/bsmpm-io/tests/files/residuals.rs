//! Tests `residuals.csv`.

use bsmpm_io::Error;
use bsmpm_io::residuals::{Iterate, ResidualMethod, read};
use bsmpm_io::table::CsvTable;

const NAMES: &str = "step,time,iteration,method,energy,force\n# -,s,-,-,-,-\n";

#[test]
fn rows_are_read_as_they_were_written() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("residuals.csv");
    let row = |iteration, method, energy| {
        let time = 0.1 + 0.2;
        let water = 2e-5;
        Iterate {
            step: 3,
            time,
            iteration,
            method,
            energy,
            force: 1e-9,
            water,
        }
    };
    let rows = [
        ResidualMethod::Multisecant,
        ResidualMethod::Broyden,
        ResidualMethod::Newton,
    ]
    .map(|method| row(1, Some(method), 1.0));
    let write = |path: &std::path::Path, flows| {
        let mut table = CsvTable::create(path, &Iterate::columns("s", flows)).unwrap();
        rows.iter().for_each(|row| table.row(&row.cells(flows)).unwrap());
        table.row(&row(2, None, f64::NAN).cells(flows)).unwrap();
    };
    write(&dir.path().join("wet.csv"), true);
    let found = read(&dir.path().join("wet.csv")).unwrap();
    assert!(found[..3] == rows && found[3].water == 2e-5, "{found:?}");
    write(&path, false);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        text.starts_with(&format!("{NAMES}3,0.30000000000000004,1,multisecant,1.0,1e-9\n")),
        "{text}"
    );
    assert!(text.ends_with("3,0.30000000000000004,2,,,1e-9\n"), "{text}");
    // A line that is being written does not count.
    std::fs::write(&path, text + "3,0.30000000000000004,3,new").unwrap();
    let found = read(&path).unwrap();
    let dry = rows.map(|row| Iterate { water: 0.0, ..row });
    assert!(found.iter().all(|row| row.water.is_nan()));
    assert_eq!(
        found[..3]
            .iter()
            .map(|row| Iterate { water: 0.0, ..*row })
            .collect::<Vec<_>>(),
        dry
    );
    let last = found[3];
    assert!(
        found.len() == 4 && last.energy.is_nan() && last.method.is_none() && last.force == 1e-9,
        "{last:?}"
    );
}

#[test]
fn what_is_no_row_is_named_by_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("residuals.csv");
    for line in [
        "1,0.1,1,secants,1.0,0.1",
        "1,0.1,1,newton,1.0,0.1,0.1,0.1",
        "1,0.1,1,newton,1.0",
        "1,0.1,1,newton,1.0,x",
        "-1,0.1,1,newton,1.0,1.0",
    ] {
        std::fs::write(&path, format!("{NAMES}1,0.1,1,newton,1.0,0.5\n{line}\n")).unwrap();
        let error = read(&path).unwrap_err();
        assert!(
            matches!(error, Error::Format { .. }) && error.to_string().contains("line 4"),
            "{error}"
        );
    }
    assert!(matches!(read(&dir.path().join("none.csv")), Err(Error::File { .. })));
}
