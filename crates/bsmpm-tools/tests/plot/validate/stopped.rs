//! Tests of rows that are taken from runs that did not come to their end.

use super::{prepare, printed, validate};
use std::fs;

const STOPPED: &str = r#"
[[study]]
title = "A footing that stops"
case  = "nowhere.toml"
depth = "short"

[[study.run]]
name     = "half"
case     = "case.toml"
set      = ["stop=80"]
may_stop = true

[[study.run]]
name = "stiffer"
set  = ["stiffer=1"]

[[study.run]]
name  = "whole"
case  = "case.toml"
depth = "full"

[[study.row]]
quantity  = "time where it is 0.5 deep"
run       = "half"
column    = "time"
where     = { column = "penetration", value = 0.51 }
reference = 0.255
tolerance = 1e-9

[[study.row]]
quantity  = "mean depth"
run       = "half"
column    = "penetration"
operation = "mean"
where     = { from = 0.11, to = 0.31 }
scale     = 10.0
reference = 4.2
tolerance = 1e-9

[[study.row]]
quantity = "deeper, reported"
run      = "half"
column   = "p_over_c"
at       = 0.5

[[study.row]]
quantity = "deeper, judged"
run      = "half"
column   = "p_over_c"
where    = { column = "penetration", value = 1.0 }
min      = 0.0

[[study.row]]
quantity  = "largest to its end"
run       = "half"
column    = "penetration"
operation = "max"
max       = 9.0

[[study.row]]
quantity = "at its end"
run      = "half"
column   = "penetration"
max      = 9.0

[[study.row]]
quantity = "no kink"
run      = "half"
kink     = { x = "time", y = "penetration", elastic = 0.1 }
max      = 9.0

[[study.row]]
quantity  = "where it stops"
run       = "half"
column    = "penetration"
operation = "reach"
min       = 2.0
known     = { why = "it is a stub", min = 0.9, max = 1.0 }

[[study.row]]
quantity  = "how even it is"
run       = "half"
column    = "penetration"
operation = "spread"
where     = { from = 0.1, to = 0.2 }
reference = 0.6666666667
tolerance = 1e-9

[[study.row]]
quantity  = "how far from a stiffer one"
run       = "half"
column    = "penetration"
operation = "deviation"
against   = "stiffer"
where     = { from = 0.1, to = 0.2 }
reference = 0.25
tolerance = 1e-9

[[study.row]]
quantity  = "how far where that is not"
run       = "half"
column    = "time"
operation = "deviation"
against   = "stiffer"
where     = { column = "penetration", from = 0.1, to = 0.2 }
reference = 0.2
tolerance = 1e-9

[[study.row]]
quantity  = "of a run that is not short"
run       = "whole"
column    = "penetration"
operation = "max"
max       = 0.1
"#;

#[test]
fn rows_are_taken_from_a_run_as_far_as_it_came() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path(), STOPPED);
    let output = validate(dir.path(), &["--short"]);
    let text = printed(&output);
    assert_eq!(
        (output.status.code(), text.lines().last()),
        (Some(77), Some("5 passed, 4 failed")),
        "{text}"
    );
    let row = |quantity: &str| text.lines().find(|line| line.contains(quantity)).unwrap().to_owned();
    assert!(row("mean depth").contains(" 4.2 "), "{text}");
    assert!(
        row("deeper, reported").contains(" none ") && row("deeper, reported").contains(" not reached "),
        "{text}"
    );
    assert!(
        row("deeper, judged").contains("FAILED, not reached") && row("judged").contains("penetration 0.95"),
        "{text}"
    );
    assert!(row("deeper, reported").contains("stopped at t = 0.4750"), "{text}");
    // What has no end says nothing about the whole, and that a solver gives up is no failure load.
    assert!(
        row("largest to its end").contains("FAILED, not reached") && row("at its end").contains("FAILED, not reached")
    );
    assert!(
        row("no kink").contains("no kink before its end") && row("no kink").contains(" FAILED "),
        "{text}"
    );
    assert!(
        row("where it stops").contains("known failure") && row("how even it is").contains(" passed "),
        "{text}"
    );
    // At the same penetration the stiffer one is at 1.25 times the time, a fifth of it away from ours.
    assert!(
        row("from a stiffer one").contains(" passed ") && row("where that is not").contains(" passed "),
        "{text}"
    );
    let table = fs::read_to_string(dir.path().join("out/table.csv")).unwrap();
    assert!(table.contains("\"passed\",\"80\""), "{table}");
}
