//! Passes files to one fuzz target: `bsmpm-fuzz TARGET FILE...`. `scripts/fuzz` builds this program with libFuzzer.
#![cfg_attr(fuzzing, no_main)]

#[cfg(fuzzing)]
mod fuzzer {
    use bsmpm_fuzz::{Target, named};
    use std::sync::LazyLock;

    static TARGET: LazyLock<Target> = LazyLock::new(|| {
        let name = std::env::var("BSMPM_FUZZ_TARGET").unwrap_or_default();
        named(&name).unwrap_or_else(|| panic!("BSMPM_FUZZ_TARGET={name} is no target"))
    });

    libfuzzer_sys::fuzz_target!(|data: &[u8]| (TARGET.run)(data));
}

#[cfg(not(fuzzing))]
fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().ok_or("usage: bsmpm-fuzz TARGET FILE...")?;
    let target = bsmpm_fuzz::named(&name).ok_or_else(|| format!("{name} is no target"))?;
    for path in arguments {
        let data = std::fs::read(&path).map_err(|error| format!("{path}: {error}"))?;
        (target.run)(&data);
        println!("{path}: passed");
    }
    Ok(())
}
