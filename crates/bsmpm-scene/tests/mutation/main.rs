//! Every key of the schema removed, renamed, retyped and set to extreme values (bad input): what the schema
//! refuses is refused at its place, the rest gives a case or errors; never a panic.

mod written;

use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm_scene::schema::{Kind, Presence, ROOT, Table};
use bsmpm_scene::{Case, Error, Geometry, Place, seed};
use std::collections::HashSet;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use written::{STRESS, Written};

const FULL: &str = include_str!("../full.toml");
const WET_SOLID: &str = include_str!("../bad_cases/wet_solid.toml");
const STATIC: &str = include_str!("../bad_cases/static.toml");
const RUBBING: &str = include_str!("../bad_cases/rubbing.toml");
const SEEPING: &str = include_str!("../bad_cases/seeping.toml");
const SOLID: &str = include_str!("../bad_cases/solid.toml");

/// Values that a key may be given by mistake.
const VALUES: [&str; 22] = [
    "nan",
    "+nan",
    "inf",
    "-inf",
    "-0.0",
    "0",
    "-1",
    "0.5",
    "1e308",
    "-1e308",
    "5e-324",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999999",
    "true",
    "\"\"",
    "\"abc\"",
    STRESS,
    "[]",
    "[1, 2, 3]",
    "{}",
    "1979-05-27",
];

/// The least that suction above a level needs.
const SUCTION: &str = r#"geometry = "plane-strain"
analysis = { type = "consolidation", end = "1 d", dt = "1 h" }
grid = { lower = [0.0, 0.0], upper = [2.0, 2.0], cell = 1, degree = "quadratic" }
water = { level = 0.5, suction = "5 kPa", drainage = "coupled" }
gravity = { acceleration = [0.0, -9.81] }
boundary = { bottom = "fixed" }
stabilisation = { method = "consistent-f-bar" }

[material.silt]
model        = "elastic"
young        = "1 MPa"
poisson      = 0.3
unit_weight  = "18 kN/m3"
porosity     = 0.5
permeability = "1e-6 m/s"
retention    = { curve = [[0.0, 1.0, 1.0], ["50 cm", 0.8, 0.3], [10.0, 0.3, 1e-4]], residual = 0.1 }

[[body]]
material = "silt"
box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
points_per_cell = 3
"#;

/// Changes of [`FULL`] to what excludes what is there.
const OTHERWISE: [&[(&str, &str)]; 7] = [
    &[
        ("geometry = \"plane-strain\"", "geometry = \"plane-strain\"\naccuracy = \"draft\""),
        ("\nk0 = 0.5", "\nk0 = 0.5\nequilibrium = \"plastic\""),
        ("reset_displacements = true", "reset_displacements = true\nstrength_reduction = 1.2"),
        ("interface = \"smooth\"", "interface = \"smooth\"\nname = \"strip\""),
        ("components = \"all\"", "components = \"all\"\nname = \"plate\""),
        ("\nramp = \"0.5 s\"", "\nramp = \"0.5 s\"\nname = \"surcharge\""),
        ("\nramp = 0.5\n", "\nramp = 0.5\nname = \"push\"\n"),
        (
            "remove = [\"fill\"]",
            "remove = [\"fill\"]\nactivate = [\"push\"]\ndeactivate = [\"surcharge\"]\n\
             boundary = { left = \"fixed\", right = \"free\", bottom = \"roller\", top = \"free\" }\n\
             materials = [{ from = \"block\", to = \"block\" }]",
        ),
    ],
    &[
        ("dt   = \"10 ms\"", "steps = 100\nspectral_radius = 0.8\nmass = \"consistent\"\nwall_velocity = \"relaxed\""),
        ("\"tresca\"", "\"von-mises\""),
        (
            "stress = [0.0, \"-20 kPa\"]\nramp = \"0.5 s\"",
            "stress_path = [[\"0.2 s\", 1.0, \"-1 kPa\"], [1.0, 0.0, 2.0]]",
        ),
        ("cohesion    = 2e4", "yield_stress = 2e4\nhardening = 1e3"),
        ("every  = \"0.1 s\"", "every_steps = 20\ncheckpoint = { wall = \"10 min\", every_steps = 50, keep = 3 }"),
        ("quantity = \"heave\"", "quantity = \"height\"\nat_x = 1.0"),
        ("bottom = \"fixed\"", "bottom = { friction_coefficient = 0.3, separates = true }"),
    ],
    &[
        ("dt   = \"10 ms\"", "dt = 0.01\nnewmark_gamma = 0.6"),
        ("stress = [0.0, \"-20 kPa\"]\nramp = \"0.5 s\"", "pressure_path = [[\"0.2 s\", \"1 kPa\"], [1.0, 0.0]]"),
        ("\"tresca\"", "\"modified-cam-clay\""),
        (
            "cohesion    = 2e4",
            "kappa_star = 0.02\nlambda_star = 0.1\ncritical_state_ratio = 1.2\npreconsolidation = \"50 kPa\"",
        ),
        ("model    = \"mohr-coulomb\"", "model = \"drucker-prager\""),
        ("separation = \"plastic\"", "fit = \"inner\""),
        ("cell  = [0.5, \"50 cm\"]", "knots = { x = [0, 0.5, 1.5, \"4 m\"], y = [0, 1, 2, 3] }"),
    ],
    &[
        ("\nk0 = 0.5", "\ngravity = \"elastic\""),
        ("k0          = 0.6\n", ""),
        ("model    = \"mohr-coulomb\"", "model = \"mohr-coulomb-softening\""),
        (
            "separation = \"plastic\"",
            "residual_friction_angle = 20\nresidual_dilation_angle = 5\nresidual_cohesion = 10\nsoftening_strain = 0.2\n\
             softening = \"exponential\"\nband_width = 0.1",
        ),
        ("factor = 1.25", "factor = 1.25\nelastic = false\nstiffness = 1.5\nunloaded = false"),
    ],
    &[
        ("displacement = [0.0, \"-10 cm\"]", "velocity = [0.0, -0.1]"),
        ("path     = [[\"0.5 s\", -0.1, 0.0], [1.0, 0.0, \"5 cm\"]]", "velocity = [-0.1, 0.0]"),
        ("density = \"0.5 t/m3\"", "mass = 50"),
        ("\"tresca\"", "\"modified-cam-clay\""),
        ("cohesion    = 2e4", "kappa = 0.04\nlambda = 0.2\nvoid_ratio = 1.0\ncritical_state_ratio = 1.2\nocr = 1.5"),
        ("factor = 1.25", "factor = 1.0"),
        ("velocity = [0.0, \"-10 mm/s\"]", "displacement = [-0.1, 0.0]"),
        (
            "{ circle = { centre = [2.75, 2.0], radius = \"10 cm\" } }",
            "{ polygon = [[2.6, 1.6], [2.9, 1.6], [2.9, 1.9]] }",
        ),
    ],
    &[
        ("path     = [[\"0.5 s\", -0.1, 0.0], [1.0, 0.0, \"5 cm\"]]", "displacement = [-0.1, \"1 cm\"]"),
        ("ramp    = \"0.25 s\"", "amplitude = [[\"0.2 s\", 1.0], [1.0, 0.0]]"),
        ("ramp = \"0.5 s\"", "amplitude = [[\"0.2 s\", 1.5], [0.5, 0.0]]"),
        (
            "stress = [0.0, \"-20 kPa\"]",
            "stress = { value = [0.0, \"-20 kPa\"], at_y = 1.25, per_metre = [\"1 kPa/m\", -500] }",
        ),
        ("ramp = 0.5\n", "amplitude = [[0.0, 1.0]]\n"),
        ("displacement = [0.0, \"-10 cm\"]", "path = [[0.5, 0.0, -0.1], [\"1 s\", 0.0, \"-20 cm\"]]"),
        ("\"tresca\"", "\"sensitive-clay\""),
        (
            "cohesion    = 2e4",
            "cohesion = 2e4\nsensitivity = 4\nsoftening_strain = 20\nrate_parameter = 0.1\nreference_rate = 1e-4",
        ),
    ],
    &[
        ("from = [0.0, 1.25]\nto   = [1.0, 1.25]", "circle = { centre = [2.75, 2.0], radius = \"10 cm\" }"),
        ("stress = [0.0, \"-20 kPa\"]", "pressure = { value = 1e3, at_y = 3.0, per_metre = \"10 kPa/m\" }"),
        ("velocity = [0.0, \"-1 m/s\"]", "spin = { rate = 2.0, about = [1.5, \"2 m\"] }"),
        ("\"tresca\"", "\"mu-i\""),
        (
            "cohesion    = 2e4",
            "damping = { ratio = 0.05, frequency = 2.0 }\nmu_s = 0.38\nmu_2 = 0.64\n\
             inertial_number = 0.28\ngrain_diameter = \"1 mm\"\ngrain_density = 2500",
        ),
        ("force = [0.0, \"-1 kN/m\"]\nramp = 0.5", "force_path = [[\"0.2 s\", 1.0, \"-1 kN/m\"], [1.0, 0.0, 2.0]]"),
        (
            "force   = [0.0, \"-1 kN/m\"]\nmoment  = 100.0\nramp    = \"0.25 s\"",
            "force_path = [[\"0.2 s\", 1.0, \"-1 kN/m\"], [1.0, 0.0, 2.0]]",
        ),
    ],
];

/// A case that seeks a limit load.
const LIMIT_LOAD: &str = r#"geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 4, purpose = "limit-load" }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
grid = { lower = [0.0, 0.0], upper = [4.0, 2.5], cell = 0.25, degree = "quadratic" }
material.clay = { model = "tresca", young = "5 MPa", poisson = 0.49, cohesion = "10 kPa" }
body = [{ material = "clay", box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }, points_per_cell = 2 }]
footing = { from = [0.0, 2.0], to = [1.0, 2.0], displacement = [0.0, -0.1], interface = "smooth" }
stabilisation = { method = "consistent-f-bar" }
"#;

fn bases() -> Vec<String> {
    let later =
        format!("{STATIC}\n[strength_reduction]\nfactor = 1.2\nstage = \"end\"\nsteps = 5\ndrainage = \"drained\"\n");
    let wet = |table: &str| {
        let soil = "poisson = 0.3\nunit_weight = \"19 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"";
        let fields = "every = 0.5\nfields = [\"pore-pressure\"]";
        let rest =
            "[gravity]\nacceleration = [0.0, -9.81]\n\n[[history]]\nquantity = \"pore-pressure\"\nat = [1.0, 0.5]";
        let dry = STATIC.replacen("poisson = 0.3", soil, 1).replacen("every = 0.5", fields, 1);
        format!("{dry}\n[water]\n{table}\nunit_weight = \"10 kN/m3\"\n\n{rest}\n")
    };
    let still = [
        "level = 0.75",
        "level_path = [[0.0, \"2 m\"], [1.0, 0.5]]",
        "line = [[0.0, 0.75], [\"2 m\", 0.5]]",
        "line_path = [[0, 0, 0.75], [0, \"2 m\", 0.5], [1, 0, 1], [1, 2, 0.5]]",
    ];
    let retired = "background_kind = \"strain\"\nbackground_cells = \"occupied\"";
    let retired = format!("{STATIC}\n[solver]\nextension = \"linear\"\n{retired}\n");
    let mut bases = vec![
        LIMIT_LOAD.to_owned(),
        FULL.to_owned(),
        STATIC.to_owned(),
        later,
        retired,
        RUBBING.to_owned(),
        SEEPING.to_owned(),
    ];
    bases.extend(still.map(wet));
    let ratio = STATIC.replacen("poisson = 0.3", "poisson = 0.3\nunit_weight = \"19 kN/m3\"\nru = 0.3", 1);
    bases.push(format!("{ratio}\n[gravity]\nacceleration = [0.0, -9.81]\n"));
    bases.push(SUCTION.to_owned());
    bases.push(SOLID.to_owned());
    bases.push(WET_SOLID.to_owned());
    let knots = "knots = { x = [0.0, 0.5, 1.5, 4.0], y = [0.0, 1.0, 2.0, 3.0], z = [0.0, 1.0, 1.0, 3.0] }";
    let otherwise = SOLID.replacen("cell  = [0.5, 1.0, 0.5]", knots, 1);
    let plate = "rectangle    = { lower = [0.5, 2.0, 1.0], upper = [1.5, 3.0, 1.0] }";
    let disc = "disc = { centre = [1.25, 0.5, 1.0], radius = 0.25, normal = \"z\" }";
    let otherwise = otherwise.replacen(plate, "disc = { centre = [1.0, 2.5, 1.0], radius = 0.25 }", 1);
    let base = "base = [[2.0, 0.0, 2.5], [4.0, 0.0, 2.5], [2.0, 3.0, 2.6], [4.0, 3.0, 2.75]]";
    let otherwise = otherwise.replacen("level = 2.5", base, 1);
    let ball = "sphere = { centre = [3.5, 0.5, 2.0], radius = 0.25 }";
    let ground = "terrain = { top = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0], [4.0, 3.0, 0.0]] }";
    let otherwise = otherwise.replacen(ball, ground, 1);
    bases.push(otherwise.replacen(disc, "rectangle = { lower = [0.5, 0.0, 1.0], upper = [1.5, 1.0, 1.0] }", 1));
    for changes in OTHERWISE {
        let mut text = FULL.to_owned();
        for (part, by) in changes {
            assert_eq!(text.matches(part).count(), 1, "{part}");
            text = text.replacen(part, by, 1);
        }
        bases.push(text);
    }
    bases
}

/// The case, if it is one: then it can be counted and its points made. Errors must have a place, but for tables that
/// are missing altogether.
fn read(text: &str) -> Result<Case, Vec<Error>> {
    let case = Case::from_text("case.toml", text, &[]).inspect_err(|errors| {
        assert!(!errors.is_empty());
        for error in errors {
            assert!(!error.message.is_empty() && !format!("{error:#}").is_empty());
            let is_whole = error.place == Place::File && (error.key.is_empty() || ROOT.key(&error.key).is_some());
            assert!(is_whole || matches!(error.place, Place::Line { .. }), "{error}");
        }
    })?;
    let counted: u64 = case.points_by_column().iter().sum();
    assert!(case.estimate(1).points == case.points() && case.points() == counted && counted > 0);
    match case.geometry {
        Geometry::Solid => seeded::<Solid, 3>(&case),
        _ => seeded::<PlaneStrain, 2>(&case),
    }
    Ok(case)
}

fn seeded<K: Kinematics<D>, const D: usize>(case: &Case) {
    for point in seed::<K, D>(case, 0..case.grid.axes[0].cells()).take(20) {
        assert!(point.volume > 0.0 && point.mass >= 0.0 && (point.x.norm() + point.v.norm() + point.mass).is_finite());
    }
}

fn line(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// An error about this key or an item of it, in this line.
#[track_caller]
fn refuses(text: &str, path: &str, says: &str, line: Option<usize>) {
    let errors = read(text).err().unwrap_or_default();
    let fits = |error: &Error| {
        let placed = line.is_none_or(|line| matches!(error.place, Place::Line { line: found, .. } if found == line));
        let about = error.key == path || error.key.strip_prefix(path).is_some_and(|item| item.starts_with('.'));
        placed && about && error.message.contains(says)
    };
    let reported: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert!(errors.iter().any(fits), "{path}, line {line:?}: ..{says}.. is not among {reported:#?}");
}

/// The text without an entry, and without the comma that it leaves in an inline table.
fn without(text: &str, written: &Written) -> String {
    let (start, end) = (written.name.as_ref().unwrap().start, written.value.end);
    let (before, after) = (&text[..start], &text[end..]);
    match (after.strip_prefix(','), before.trim_end().strip_suffix(',')) {
        (Some(after), _) => format!("{before}{after}"),
        (None, Some(before)) => format!("{before}{after}"),
        (None, None) => format!("{before}{after}"),
    }
}

#[test]
fn the_bases_hold_every_key_of_the_schema() {
    let mut held = HashSet::new();
    for base in bases() {
        read(&base).unwrap_or_else(|errors| panic!("{errors:#?}"));
        held.extend(written::all(&base).iter().map(|written| written.of));
    }
    for table in ROOT.all() {
        for key in table.keys.iter().filter(|key| key.presence != Presence::Later) {
            assert!(held.contains(&(table.header, key.name)), "no base has {} of {}", key.name, table.header);
        }
    }
}

#[test]
fn every_key_renamed_is_unknown_and_every_key_removed_is_missed_if_it_must_be_there() {
    for base in bases() {
        for written in written::all(&base) {
            let Some(name) = &written.name else { continue };
            let renamed = format!("{}qqq{}", &base[..name.end], &base[name.end..]);
            refuses(&renamed, &format!("{}qqq", written.path), "unknown key", Some(line(&base, name.start)));
            if !written.is_entry {
                continue;
            }
            let removed = without(&base, &written);
            let fills = ["\naccuracy = ", "purpose = "].iter().any(|key| base.contains(key));
            let is_filled = fills && ["points_per_cell", "degree", "method"].contains(&written.of.1);
            match written.presence {
                Presence::Required if !is_filled => refuses(&removed, &written.path, "missing", None),
                Presence::Required => {
                    _ = read(&removed).unwrap_or_else(|errors| panic!("{}: {errors:?}", written.path))
                }
                _ => _ = read(&removed),
            }
        }
    }
}

#[test]
fn i02_i07_every_value_that_the_schema_refuses_is_refused_at_its_place() {
    let (bases, mut seen) = (bases(), HashSet::new());
    let mut entries = Vec::new();
    for base in &bases {
        for written in written::all(base).into_iter().filter(|written| written.is_entry) {
            let own = &base[written.value.clone()];
            // What an earlier base has word for word is not changed once more.
            if seen.insert((base.contains("\"solid\""), written.path.clone(), own)) {
                entries.push((base, written));
            }
        }
    }
    // On all cores: it is the longest of these tests.
    let (next, accepted, refused) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    let change = || {
        while let Some((base, written)) = entries.get(next.fetch_add(1, Relaxed)) {
            let span = &written.value;
            let own = &base[span.clone()];
            let negated = own.strip_prefix('"').map_or(format!("-{own}"), |quoted| format!("\"-{quoted}"));
            for put in VALUES.iter().copied().chain([negated.as_str()]) {
                let text = format!("{}{put}{}", &base[..span.start], &base[span.end..]);
                if VALUES.contains(&put) && written.fits.refuses(put) {
                    refuses(&text, &written.path, "", Some(line(base, span.start)));
                    refused.fetch_add(1, Relaxed);
                } else {
                    accepted.fetch_add(usize::from(read(&text).is_ok()), Relaxed);
                }
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(change))));
    let [accepted, refused] = [accepted, refused].map(AtomicUsize::into_inner);
    assert!(refused > 20_000 && accepted > 300, "{accepted} accepted, {refused} refused");
}

#[test]
fn every_table_and_every_cut_of_the_text() {
    for header in FULL.lines().filter(|line| line.starts_with('[')) {
        _ = read(&FULL.replacen(header, "", 1));
        _ = read(&FULL.replacen(header, "[x]", 1));
        _ = read(&FULL.replacen(header, &format!("[{header}]"), 1));
        _ = read(&format!("{FULL}\n{header}\n"));
    }
    for end in (0..FULL.len()).step_by(3) {
        _ = read(&FULL[..end]);
        _ = read(&format!("{}{}", &FULL[..end], &FULL[(end + 7).min(FULL.len())..]));
    }
}

#[test]
fn overrides_of_every_key_of_the_schema() {
    fn paths(table: &'static Table, path: &str, found: &mut Vec<String>) {
        for key in table.keys {
            let path = format!("{path}{}", key.name);
            match &key.kind {
                Kind::Table(below) => paths(below, &format!("{path}."), found),
                Kind::Named(below) => paths(below, &format!("{path}.sand."), found),
                Kind::Tables(below) => paths(below, &format!("{path}.0."), found),
                _ => {}
            }
            found.push(path);
        }
    }
    let mut found = Vec::new();
    paths(&ROOT, "", &mut found);
    assert!(found.len() > 80, "{found:?}");
    for path in &found {
        for value in VALUES.iter().chain(&["5 mm", "free", "a.b=c", "", "[", "\"", "'x"]) {
            for suffix in ["", ".0", ".x", ".5.y", ".."] {
                _ = Case::from_text("case.toml", FULL, &[format!("{path}{suffix}={value}")]);
            }
        }
    }
}

#[test]
fn the_schema_is_sound() {
    for table in ROOT.all() {
        for key in table.keys {
            assert!(!key.doc.is_empty() && table.key(key.name).is_some_and(|first| std::ptr::eq(first, key)));
            assert_eq!(key.presence == Presence::Later, matches!(key.kind, Kind::Open), "{}", key.name);
        }
        for group in table.exclusive {
            assert!(group.keys.iter().all(|key| table.key(key).is_some()), "{:?}", group.keys);
        }
    }
}
