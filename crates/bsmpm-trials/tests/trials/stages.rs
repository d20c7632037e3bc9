//! Compares stages with closed forms.

use crate::support::cases::{SLIDING_BLOCK, changed};
use crate::support::results::{agree, at, history, last_frame, manifest};
use crate::support::{Scratch, shipped};

/// Pa, N/m3, m: constrained modulus, unit weight and thickness of the lifts; so stiff that strains are small.
const MODULUS: f64 = 1.2e11;
const WEIGHT: f64 = 2e4;
const LIFT: f64 = 2.0;
/// Lifts of the column, the first one there from the start.
const LIFTS: usize = 4;

/// A column of four lifts between smooth walls, with `stages`, and the displacement of every interface.
fn column(stages: &str, cell: f64) -> String {
    let body = |k: usize| {
        let [from, to] = [k, k + 1].map(|k| k as f64 * LIFT);
        format!(
            "[[body]]\nname = \"lift-{k}\"\nmaterial = \"soil\"\nbox = {{ lower = [0, {from}], upper = [2, {to}] }}\n\
             points_per_cell = 3\n[[history]]\nquantity = \"displacement\"\nat = [1, {to}]\nname = \"top-{k}\"\n"
        )
    };
    let bodies: String = (0..LIFTS).map(body).collect();
    format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nend = 4\nsteps = 4\n\
         [grid]\nlower = [0, 0]\nupper = [2, 10]\ncell = {cell}\ndegree = \"quadratic\"\n\
         [material.soil]\nmodel = \"elastic\"\nyoung = \"100 GPa\"\npoisson = 0.25\nunit_weight = \"20 kN/m3\"\n\
         [gravity]\nacceleration = [0, -9.81]\n[boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n\
         [solver]\ntolerance = 1e-14\nforce_tolerance = 1e-9\nbackground = 0\n\
         [[history]]\nquantity = \"mass\"\n[[history]]\nquantity = \"energy\"\n{bodies}{stages}"
    )
}

fn run(case: &str) -> bsmpm_io::table::Columns {
    let scratch = Scratch::with_case(case);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    history(&scratch.path("out"))
}

/// A lift settles under itself and what follows: the top of the lift i of thickness h at z = i h by
/// gamma/M (z (H - z) + h z - h²/2), in the limit of thin ones gamma z (H - z)/M.
#[test]
fn an_embankment_in_lifts_settles_as_layers_that_are_placed_one_after_the_other() {
    let stages: String = (1..LIFTS)
        .map(|k| format!("[[stage]]\nat = {k}\nadd = [\"lift-{k}\"]\n"))
        .collect();
    let [coarse, found] = [0.5, 0.25].map(|cell| run(&column(&stages, cell)));
    let height = LIFTS as f64 * LIFT;
    for k in 0..LIFTS {
        let z = (k + 1) as f64 * LIFT;
        let exact = WEIGHT / MODULUS * (z * (height - z) + LIFT * z - 0.5 * LIFT * LIFT);
        // What is followed is off by the curvature of the motion: of second order.
        let [first, second] =
            [&coarse, &found].map(|found| (at(found, &format!("top-{k}-y"), 4.0) / -exact - 1.0).abs());
        assert!(
            second < 2e-4 && second < first / 3.0,
            "top of lift {k}: off by {first:e}, {second:e} in half the cells"
        );
        let mass = WEIGHT / 9.81 * 2.0 * LIFT * (k + 1) as f64;
        assert!((at(&found, "mass", (k + 1) as f64) / mass - 1.0).abs() < 1e-12);
    }
    assert_eq!(at(&found, "top-3-y", 3.0), 0.0, "it is not there yet");
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&found, name, 4.0));
    assert!(closure.abs() < 1e-6 * external, "{closure:e} of {external:e}");
}

/// Traffic drives on the lifts once they are there, and no more as the last one is taken away: the top goes down by
/// q H/M under it, and what is left comes back. On two ranks, and over a restart with the load not yet there, the same.
#[test]
fn a_load_acts_on_what_a_stage_has_placed() {
    const LOAD: f64 = 1e6;
    let stages = "[[stage]]\nat = 1\nadd = [\"lift-1\", \"lift-2\", \"lift-3\"]\n\
                  [[stage]]\nat = 2\nactivate = [\"traffic\"]\n\
                  [[stage]]\nat = 3\ndeactivate = [\"traffic\"]\nremove = [\"lift-3\"]\n\
                  [[traction]]\nname = \"traffic\"\nfrom = [0, 8]\nto = [2, 8]\npressure = \"1 MPa\"\n";
    let scratch = Scratch::with_case(&column(stages, 0.5));
    let out = |name: &str| scratch.path(name);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "two"]).expect(0);
    let [one, two] = ["one", "two"].map(|name| history(&out(name)));
    let moved = |column: &str, t: f64| at(&one, column, t) - at(&one, column, 2.0);
    let expected = -LOAD * LIFT * LIFTS as f64 / MODULUS;
    assert!(
        (moved("top-3-y", 3.0) / expected - 1.0).abs() < 1e-3,
        "{:e} {expected:e}",
        moved("top-3-y", 3.0)
    );
    // Without the load and the last lift: the ground rises by what its weight had pressed it down.
    let rise = WEIGHT * LIFT * LIFT / MODULUS;
    assert!(
        (moved("top-0-y", 4.0) / rise - 1.0).abs() < 1e-3,
        "{:e} {rise:e}",
        moved("top-0-y", 4.0)
    );
    for (t, column) in [(3.0, "top-3-y"), (4.0, "top-2-y")] {
        assert!(
            (at(&two, column, t) / at(&one, column, t) - 1.0).abs() < 1e-9,
            "{column}"
        );
    }
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch
        .mpirun(1, &[&part[..], &["--max-steps", "1"]].concat())
        .expect(75);
    scratch.mpirun(1, &part).expect(0);
    let text = |name: &str| std::fs::read_to_string(out(name).join("history.csv")).unwrap();
    assert!(text("one") == text("part"));
}

/// What lay above by the thickness d lets the ground at z rise by gamma d z/M, in one stage or two.
#[test]
fn ground_heaves_by_what_is_taken_away_in_one_stage_or_two() {
    let stage = |t: usize, names: &str| format!("[[stage]]\nat = {t}\nremove = [{names}]\n");
    let reset = "[[stage]]\nat = 1\nreset_displacements = true\n";
    let once = run(&column(&(reset.to_owned() + &stage(2, "\"lift-2\", \"lift-3\"")), 0.5));
    let twice = run(&column(
        &(reset.to_owned() + &stage(2, "\"lift-3\"") + &stage(3, "\"lift-2\"")),
        0.5,
    ));
    for k in 0..2 {
        let name = format!("top-{k}-y");
        let exact = WEIGHT * 2.0 * LIFT * (k + 1) as f64 * LIFT / MODULUS;
        let [one, two] = [&once, &twice].map(|found| at(found, &name, 4.0));
        // The points' quadrature beside the new surface: 2.0e-4.
        assert!((one / exact - 1.0).abs() < 3e-4, "{one:e}, exactly {exact:e}");
        assert!(
            (one / two - 1.0).abs() < 1e-6,
            "{one:e} at once, {two:e} one after the other"
        );
        assert!(
            at(&once, &name, 2.0).abs() < 1e-4 * exact,
            "displacements count from the stage that resets them"
        );
    }
}

/// Half of a tunnel in ground whose stress is alike in all directions: a plug of soil, and a pressure where it was.
fn tunnel(share: f64) -> String {
    let corner = |k: usize| {
        let (sin, cos) = (k as f64 * std::f64::consts::PI / 24.0).sin_cos();
        format!("[{}, {}]", sin.max(0.0), 5.0 - cos)
    };
    let corners: Vec<String> = (0..=24).map(corner).collect();
    format!(
        "geometry = \"plane-strain\"\nanalysis = {{ type = \"quasi-static\", end = 2, steps = 8 }}\n\
         grid = {{ lower = [0, 0], upper = [8, 10.5], cell = 0.25, degree = \"quadratic\" }}\n\
         boundary = {{ bottom = \"fixed\", left = \"roller\", right = \"roller\" }}\n\
         gravity = {{ acceleration = [0, -9.81] }}\ninitial = {{ k0 = 1.0 }}\n\
         [material.soil]\nmodel = \"elastic\"\nyoung = \"20 MPa\"\npoisson = 0.3\nunit_weight = {WEIGHT}\n\
         [[body]]\nmaterial = \"soil\"\nbox = {{ lower = [0, 0], upper = [8, 10] }}\npoints_per_cell = 3\n\
         subtract = [{{ circle = {{ centre = [0, 5], radius = 1 }} }}]\n\
         [[body]]\nname = \"plug\"\nmaterial = \"soil\"\npolygon = [{}]\npoints_per_cell = 3\n\
         [[traction]]\nname = \"air\"\ncircle = {{ centre = [0, 5], radius = 1 }}\n\
         pressure = {{ value = 0, at_y = 10, per_metre = {} }}\n\
         [[stage]]\nat = 1\nremove = [\"plug\"]\nactivate = [\"air\"]\n\
         [[history]]\nquantity = \"max-displacement\"\n[[history]]\nquantity = \"reaction\"\nface = \"bottom\"\n",
        corners.join(", "),
        share * WEIGHT
    )
}

/// What presses as the soil did that it replaces leaves the ground at rest, and the floor with the weight of all of it;
/// half of it, half of what the ground moves without any.
#[test]
fn a_tunnel_that_a_pressure_holds_stays_as_it_was() {
    let [whole, half, none] = [1.0, 0.5, 1e-9].map(|share| run(&tunnel(share)));
    let moved = |found| at(found, "max-displacement", 2.0);
    let [rest, halved] = [&whole, &half].map(|found| moved(found) / moved(&none));
    // The points' quadrature beside the circle.
    assert!(rest < 0.01 && (halved - 0.5).abs() < 0.01, "{rest}, {halved}");
    let floor = |found, t: f64| at(found, "reaction-y", t);
    let plug = 0.5 * std::f64::consts::PI * WEIGHT;
    for (found, share) in [(&whole, 0.0), (&half, 0.5), (&none, 1.0)] {
        let lost = (floor(found, 0.0) - floor(found, 2.0)) / plug;
        assert!(
            (lost - share).abs() < 0.05,
            "{lost} of the plug's weight, exactly {share}"
        );
    }
}

/// Half of the sliding block is gone at 0.02 s, and another one falls from 0.03 s on.
fn staged_block() -> String {
    let halved = changed(SLIDING_BLOCK, "upper = [0.5, 0.2] }", "upper = [0.3, 0.2] }");
    let body = |name: &str, lower: &str, upper: &str, velocity: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"rubber\"\nbox = {{ lower = {lower}, upper = {upper} }}\n\
             points_per_cell = 2\nvelocity = {velocity}\n"
        )
    };
    halved
        + &body("half", "[0.3, 0.0]", "[0.5, 0.2]", "[4.0, 0.0]")
        + &body("late", "[0.75, 0.0]", "[0.95, 0.15]", "[-1.0, 0.0]")
        + "[[stage]]\nname = \"half\"\nat = \"0.02 s\"\nremove = [\"half\"]\n\
           [[stage]]\nat = \"0.03 s\"\nadd = [\"late\"]\nreset_displacements = true\n\
           [[history]]\nquantity = \"energy\"\n[[history]]\nquantity = \"displacement\"\nat = [0.15, 0.1]\n"
}

#[test]
fn a_dynamic_run_goes_on_to_the_bit_before_at_and_after_a_stage_and_ranks_agree() {
    let scratch = Scratch::with_case(&staged_block());
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole1"]).expect(0);
    scratch.goes_on(3, &["19", "20", "21", "30"]);
    let [one, whole, part] = ["whole1", "whole3", "part3"].map(|name| scratch.path(name));
    assert!(last_frame(&whole) == last_frame(&part));
    let stages = manifest(&part).stages;
    assert_eq!(stages, manifest(&whole).stages);
    let reported: Vec<_> = stages
        .iter()
        .map(|stage| (stage.step, stage.removed, stage.added, stage.reset))
        .collect();
    assert_eq!(reported, [(20, 64, 0, false), (30, 0, 48, true)]);
    agree(&whole, &one);
    let found = history(&scratch.path("whole1"));
    let [before, after] = [0.02, 0.021].map(|t| at(&found, "mass", t));
    assert!((after / before - 0.5).abs() < 1e-12);
    let [closure, external] = ["energy-closure", "energy-kinetic"].map(|name| at(&found, name, 0.05));
    assert!(closure.abs() < 1e-6 * external, "{closure:e} of {external:e}");
    assert!(at(&found, "displacement-x", 0.03) > 0.05 && at(&found, "displacement-x", 0.031).abs() < 0.01);
}

/// Pa, m: constrained modulus of `soil`, height of the column, and what presses on it.
const SOFT: f64 = 1.2e8;
const COLUMN: f64 = 8.0;
const PRESSURE: f64 = 1e4;

/// A weightless column that a load compresses, a prop then holds while it stiffens to twice its modulus, and both let
/// go of again.
pub const SWITCHED: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
end = 5
steps = 10
[grid]
lower = [0, 0]
upper = [2, 10]
cell = 0.5
degree = "quadratic"
[material.soil]
model = "elastic"
young = "100 MPa"
poisson = 0.25
[material.other]
model = "elastic"
young = "200 MPa"
poisson = 0.25
[[body]]
material = "soil"
box = { lower = [0, 0], upper = [2, 8] }
points_per_cell = 3
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[solver]
tolerance = 1e-14
force_tolerance = 1e-9
background = 0
[[traction]]
name = "load"
from = [0, 8]
to = [2, 8]
stress = [0, "-10 kPa"]
ramp = 0.5
[[prescribed]]
name = "prop"
from = [0, 8]
to = [2, 8]
displacement = [0, 0]
components = "normal"
[[stage]]
name = "loaded"
at = 1
activate = ["load"]
[[stage]]
name = "held"
at = 2
activate = ["prop"]
materials = [{ from = "soil", to = "other" }]
[[stage]]
at = 3
deactivate = ["load"]
[[stage]]
at = 4
deactivate = ["prop"]
[[history]]
quantity = "displacement"
at = [1, 8]
name = "top"
[[history]]
quantity = "stress"
at = [1, 4]
[[history]]
quantity = "energy"
"#;

/// By `q H/M` under the load, as far while the prop holds it, and back by half as much with twice the modulus.
#[test]
fn loads_props_and_laws_act_while_stages_say_so_and_runs_go_on_to_the_bit() {
    let scratch = Scratch::with_case(SWITCHED);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let found = history(&scratch.path("whole"));
    let settled = PRESSURE * COLUMN / SOFT;
    assert_eq!(at(&found, "top-y", 1.0), 0.0, "nothing acts before its stage");
    for (t, exact) in [(2.0, settled), (3.0, settled), (4.0, settled), (5.0, settled / 2.0)] {
        let top = -at(&found, "top-y", t);
        // Strains are 8e-5, and so is what they change.
        assert!((top / exact - 1.0).abs() < 3e-4, "at {t}: {top:e}, exactly {exact:e}");
    }
    let moved = at(&found, "top-y", 3.0) - at(&found, "top-y", 2.0);
    assert!(
        moved.abs() < 1e-9 * settled,
        "another law at the same stress moves nothing: {moved:e}"
    );
    assert!(
        (at(&found, "stress-yy", 4.0) / -PRESSURE - 1.0).abs() < 1e-3,
        "the prop holds what the load pressed"
    );
    assert!(at(&found, "stress-yy", 5.0).abs() < 1e-6 * PRESSURE);
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&found, name, 5.0));
    assert!(closure.abs() < 1e-6 * external, "{closure:e} of {external:e}");
    let reported = manifest(&scratch.path("whole")).stages;
    assert_eq!(
        (&reported[1].applied[..], &reported[1].exchanged[..]),
        (&["prop".into()][..], &["soil follows other".into()][..])
    );
    repeats(
        &scratch,
        &["top-y", "stress-xx", "stress-yy"],
        &["3", "4", "5", "6", "8", "9"],
    );
}

/// The whole run on one and three ranks, to 1e-8 of the largest number of a column, and each in parts that end after so
/// many steps, to the bit.
pub fn repeats(scratch: &Scratch, columns: &[&str], stops: &[&str]) {
    let reported = manifest(&scratch.path("whole")).stages;
    for ranks in [1, 3] {
        scratch.goes_on(ranks, stops);
        let [whole, part] = ["whole", "part"].map(|name| format!("{name}{ranks}"));
        assert_eq!(manifest(&scratch.path(&part)).stages, reported);
        let [one, more] = ["whole", &whole].map(|name| history(&scratch.path(name)));
        for column in columns {
            let [one, more] = [&one, &more].map(|found| found.get(column).expect("a column"));
            let largest = one.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            let off = one.iter().zip(more).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(
                off < 1e-8 * largest,
                "{column} on {ranks} ranks differs by {off:.1e} of {largest:e}"
            );
        }
    }
}

/// Between rollers by q H/M; once one of them is gone by q (1 - nu^2) H/E, and the other way by nu/(1 - nu) of that.
#[test]
fn a_gate_that_opens_lets_a_column_give_way() {
    let a = SWITCHED.find("[[prescribed]]").expect("a prop");
    let b = SWITCHED.find("[[stage]]\nat = 3").expect("stages");
    let mut case = changed(SWITCHED, "bottom = \"fixed\"", "bottom = \"roller\"");
    case.replace_range(
        a + 1..b + 1,
        "[[stage]]\nname = \"loaded\"\nat = 1\nactivate = [\"load\"]\n[[history]]\nquantity = \"reaction\"\nface = \"right\"\n\
         [[history]]\nquantity = \"displacement\"\nat = [2, 4]\nname = \"side\"\n\
         [[stage]]\nat = 2\nboundary = { right = \"free\" }\n",
    );
    let case = changed(
        &case,
        "at = 4\ndeactivate = [\"prop\"]",
        "at = 4\nboundary = { right = { friction_coefficient = 0.0, separates = false } }",
    );
    let scratch = Scratch::with_case(&case);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let found = history(&scratch.path("whole"));
    let young = 1e8;
    let poisson = 0.25;
    let between = PRESSURE * COLUMN / SOFT;
    let free = PRESSURE * COLUMN * (1.0 - poisson * poisson) / young;
    let side = free / COLUMN * 2.0 * poisson / (1.0 - poisson);
    for (column, t, exact) in [
        ("top-y", 2.0, -between),
        ("top-y", 3.0, -free),
        ("side-x", 3.0, side),
        ("top-y", 4.0, 0.0),
    ] {
        let off = at(&found, column, t) - exact;
        assert!(
            off.abs() < 3e-4 * between,
            "{column} at {t}: off by {off:e} of {exact:e}"
        );
    }
    let wall = at(&found, "reaction-x", 2.0);
    assert!(
        (wall / (-PRESSURE * COLUMN * poisson / (1.0 - poisson)) - 1.0).abs() < 1e-3,
        "{wall}"
    );
    assert_eq!(at(&found, "reaction-x", 3.0), 0.0);
    assert_eq!(manifest(&scratch.path("whole")).stages[1].faces, ["right is free"]);
    repeats(
        &scratch,
        &["top-y", "side-x", "stress-xx", "stress-yy", "reaction-x"],
        &["4", "5", "8"],
    );
}

/// A law of less strength returns the stress that it takes over: in a column the load stays, and the sides take what
/// the deviator loses.
#[test]
fn a_weaker_law_returns_the_stress_that_it_takes_over() {
    const YIELD: f64 = 4e3;
    let weak = "model = \"von-mises\"\nyoung = \"200 MPa\"\nyield_stress = \"4 kPa\"\n";
    let found = run(&changed(
        SWITCHED,
        "[material.other]\nmodel = \"elastic\"\nyoung = \"200 MPa\"\n",
        &format!("[material.other]\n{weak}"),
    ));
    let sides = |t: f64| ["stress-xx", "stress-yy"].map(|name| -at(&found, name, t) / PRESSURE);
    let [[before, _], [after, vertical]] = [sides(2.0), sides(3.0)];
    assert!((before - 1.0 / 3.0).abs() < 1e-3, "nu/(1 - nu): {before}");
    // The law bounds the Kirchhoff stress: the Cauchy stress over J, the top's height over that of the start.
    let volume = 1.0 + at(&found, "top-y", 3.0) / COLUMN;
    assert!(
        (volume * (vertical - after) - YIELD / PRESSURE).abs() < 1e-6,
        "{vertical} - {after}"
    );
}

/// The same by a stage that divides the strength: of a yield stress of 8 kPa a half, and then all of it again. What has
/// flowed does not come back.
#[test]
fn a_stage_divides_the_strength_under_the_stress_that_is_there() {
    let soil = "[material.soil]\nmodel = \"elastic\"\nyoung = \"100 MPa\"\npoisson = 0.25\n";
    let yields =
        "[material.soil]\nmodel = \"von-mises\"\nyoung = \"100 MPa\"\npoisson = 0.25\nyield_stress = \"8 kPa\"\n";
    let case = changed(SWITCHED, soil, yields);
    let case = changed(
        &case,
        "activate = [\"prop\"]\nmaterials = [{ from = \"soil\", to = \"other\" }]",
        "strength_reduction = 2",
    );
    let case = changed(
        &case,
        "at = 3\ndeactivate = [\"load\"]",
        "at = 3\nstrength_reduction = 1",
    );
    let a = case.find("[[stage]]\nat = 4").expect("the last stage");
    let b = case.find("[[history]]").expect("histories");
    let c = case.find("[[prescribed]]").expect("a prop");
    let d = case.find("[[stage]]").expect("stages");
    let scratch = Scratch::with_case(&(case[..c].to_owned() + &case[d..a] + &case[b..]));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let found = history(&scratch.path("whole"));
    let deviator = |t: f64| (at(&found, "stress-xx", t) - at(&found, "stress-yy", t)) / PRESSURE;
    assert!((deviator(2.0) - 2.0 / 3.0).abs() < 1e-3, "{}", deviator(2.0));
    for t in [3.0, 5.0] {
        // The Cauchy stress is the Kirchhoff stress over J = 1 - 8e-5.
        assert!((deviator(t) - 0.4).abs() < 1e-4, "{t}: {}", deviator(t));
    }
    let reported: Vec<_> = manifest(&scratch.path("whole"))
        .stages
        .iter()
        .map(|stage| stage.strength_reduction)
        .collect();
    assert_eq!(reported, [None, Some(2.0), Some(1.0)]);
    repeats(
        &scratch,
        &["top-y", "stress-xx", "stress-yy"],
        &["3", "4", "5", "6", "7"],
    );
}

/// A run goes on with another factor until it has divided the strength by one.
#[test]
fn a_checkpoint_before_the_reduction_is_of_any_factor_and_one_after_it_of_its_own() {
    let slope = std::fs::read_to_string(shipped("short/slope_stability.toml")).unwrap();
    let case = changed(&slope, "factor = 1.3", "factor = 1.0\nstage = \"end\"\nsteps = 4");
    let case = changed(&case, "cell  = \"1 m\"", "cell = \"2 m\"");
    let scratch = Scratch::with_case(&case);
    let run = |to: &str, more: &[&str]| scratch.mpirun(1, &[&["case.toml", "-q", "-o", to][..], more].concat());
    let factor = ["--set", "strength_reduction.factor=1.2"];
    run("base", &["--max-steps", "10"]).expect(75);
    run("late", &["--max-steps", "12"]).expect(75);
    let checkpoint = |name: &str| {
        let name = scratch
            .path(name)
            .join(manifest(&scratch.path(name)).checkpoint.expect("a checkpoint"));
        name.to_str().expect("UTF-8").to_owned()
    };
    run("branch", &[&factor[..], &["--restart", &checkpoint("base")]].concat()).expect(0);
    run("whole", &factor).expect(0);
    let [branch, whole] = ["branch", "whole"].map(|name| last_frame(&scratch.path(name)));
    assert!(
        branch == whole,
        "a trial that goes on from the common part is the trial"
    );
    let refused = run("other", &[&factor[..], &["--restart", &checkpoint("late")]].concat()).expect(76);
    assert!(refused.stderr.contains("error E0722: "), "{}", refused.stderr);
}
