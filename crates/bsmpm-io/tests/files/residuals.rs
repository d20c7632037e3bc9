//! `residuals.csv`.

use bsmpm_io::Error;
use bsmpm_io::residuals::{Iterate, ResidualMethod, read};
use bsmpm_io::table::CsvTable;

const NAMES: &str = "step,time,iteration,method,energy,force\n# -,s,-,-,-,-\n";

#[test]
fn rows_are_read_as_they_were_written() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("residuals.csv");
    let row = |iteration, method, energy| Iterate { step: 3, time: 0.1 + 0.2, iteration, method, energy, force: 1e-9 };
    let rows = [ResidualMethod::Multisecant, ResidualMethod::Broyden, ResidualMethod::Newton]
        .map(|method| row(1, Some(method), 1.0));
    let mut table = CsvTable::create(&path, &Iterate::columns("s")).unwrap();
    rows.iter().for_each(|row| table.row(&row.cells()).unwrap());
    table.row(&row(2, None, f64::NAN).cells()).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with(&format!("{NAMES}3,0.30000000000000004,1,multisecant,1.0,1e-9\n")), "{text}");
    assert!(text.ends_with("3,0.30000000000000004,2,,,1e-9\n"), "{text}");
    // A line that is being written does not count.
    std::fs::write(&path, text + "3,0.30000000000000004,3,new").unwrap();
    let found = read(&path).unwrap();
    assert_eq!(found[..3], rows);
    let last = found[3];
    assert!(found.len() == 4 && last.energy.is_nan() && last.method.is_none() && last.force == 1e-9, "{last:?}");
}

#[test]
fn what_is_no_row_is_named_by_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("residuals.csv");
    for line in ["1,0.1,1,secants,1.0,0.1", "1,0.1,1,newton,1.0", "1,0.1,1,newton,1.0,x", "-1,0.1,1,newton,1.0,1.0"] {
        std::fs::write(&path, format!("{NAMES}1,0.1,1,newton,1.0,0.5\n{line}\n")).unwrap();
        let error = read(&path).unwrap_err();
        assert!(matches!(error, Error::Format { .. }) && error.to_string().contains("line 4"), "{error}");
    }
    assert!(matches!(read(&dir.path().join("none.csv")), Err(Error::File { .. })));
}
