//! Tests that the parameters of materials arrive, and that strength reduction divides their strength.

use super::{FULL, STATIC, set, valid};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Law, LayeredMaterial, Match, Material, Separation};
use bsmpm_scene::Case;

/// Laws by their words, with what is not given left at its default; strength is divided by the factor of the case.
#[test]
fn cones_and_cylinders() {
    let law = |text: &str| {
        valid(
            FULL,
            &[&format!(
                "material.clay={{ young = 1e7, poisson = 0.3, density = 2e3, {text} }}"
            )],
        )
    };
    let case = law("model = \"von-mises\", yield_stress = \"10 kPa\", hardening = 5e4");
    let LayeredMaterial::Uniform(Material::VonMises(clay)) = &case.materials[1].material else {
        panic!()
    };
    assert_eq!((clay.parameters(), clay.elastic().young), (vec![8e3, 4e4], 1e7));
    assert_eq!(case.materials[1].material.state()[0].name, "hardening_strain");
    let note = case
        .notes
        .iter()
        .find(|note| note.key == "material.clay")
        .expect("a note of what is left");
    assert!(note.value.starts_with("yield_stress = 8000.0"), "{}", note.value);
    for (given, fit) in [("", Match::PlaneStrain), (", fit = \"inner\"", Match::Inner)] {
        let case = law(&format!(
            "model = \"drucker-prager\", friction_angle = 30, cohesion = 1e3{given}"
        ));
        let LayeredMaterial::Uniform(Material::DruckerPrager(clay)) = &case.materials[1].material else {
            panic!()
        };
        let [friction, dilation, cohesion] = clay.parameters()[..] else {
            panic!()
        };
        assert!(clay.fit() == fit && cohesion == 800.0 && dilation == 0.0);
        let weaker = if fit == Match::Inner { "99.0 %" } else { "96.1 %" };
        assert!(
            case.warnings.iter().any(|warning| warning.contains(weaker)),
            "{:?}",
            case.warnings
        );
        assert!((friction.tan() * 1.25 - f64::to_radians(30.0).tan()).abs() < 1e-14);
    }
    let case =
        law("model = \"von-mises\", yield_stress = { value = 1e4, at_y = 2.0, per_metre = 1e3 }, hardening = 5e4");
    let clay = &case.materials[1].material;
    let yield_stress = |y: f64| clay.at(y - case.grid.lower()[1]).parameters()[0];
    assert_eq!((yield_stress(2.0), yield_stress(1.0)), (8e3, 8.8e3));
    assert_eq!((clay.state().len(), clay.hardens(), clay.is_graded()), (1, true, true));
    let negative = "material.clay={ model = \"von-mises\", young = 1e7, poisson = 0.3, density = 2e3, \
                    yield_stress = { value = 1e4, at_y = 2.0, per_metre = -1e5 } }";
    let message = format!("{:?}", set(FULL, &[negative]).expect_err("no strength below"));
    assert!(message.contains("allowed: yield_stress > 0"), "{message}");
}

/// Faces that rub lose strength as the ground does; a word stands for a face without friction.
#[test]
fn friction_of_faces_is_strength() {
    let case = valid(
        FULL,
        &[
            "boundary.bottom={ friction_coefficient = 0.5 }",
            "boundary.left=contact",
        ],
    );
    let found = |axis: usize| case.contacts[axis][0].map(|contact| (contact.friction, contact.lifts));
    assert_eq!((found(0), found(1)), (Some((0.0, true)), Some((0.4, true))));
    assert!(
        case.notes
            .iter()
            .any(|note| note.key == "boundary.bottom.friction_coefficient" && note.value == "0.4")
    );
    let held = valid(
        FULL,
        &[
            "boundary.bottom={ friction_coefficient = 0.5, separates = false }",
            "strength_reduction.factor=1.0",
        ],
    );
    assert_eq!(
        held.contacts[1][0].map(|contact| (contact.friction, contact.lifts)),
        Some((0.5, false))
    );
}

#[test]
fn layers_by_height_and_reduced_strength() {
    let case = valid(FULL, &["grid.lower=[-1, -1]", "grid.cell=0.5"]);
    let law = |y: f64| match case.materials[3].material.at(y + 1.0).as_ref() {
        Material::MohrCoulomb(law) => law.clone(),
        other => panic!("{other:?}"),
    };
    for (y, young, friction, cohesion) in [
        (3.0, 1e7, 30.0, 1e3),
        (2.0, 1.2e7, 30.5, 1.5e3),
        (3.5, 9e6, 29.75, 750.0),
    ] {
        let law = law(y);
        let [angle, dilation, strength] = law.parameters()[..] else {
            panic!()
        };
        let tan: f64 = angle.tan();
        let expected: f64 = f64::to_radians(friction).tan() / 1.25;
        assert!(
            (law.elastic().young / young - 1.0).abs() < 1e-14 && (tan / expected - 1.0).abs() < 1e-14,
            "y = {y}"
        );
        assert!((strength / (cohesion / 1.25) - 1.0).abs() < 1e-14 && dilation == 0.0);
    }
    assert_eq!(
        case.materials[3].material.elastic().young,
        1.3e7,
        "stiffest at the lowest place of a body, y = 1.5"
    );
    assert!(!case.materials[0].material.is_graded());
    let note = |case: &Case, name: &str| case.notes.iter().find(|note| note.key == name).unwrap().value.clone();
    assert!(note(&case, "material.clay").ends_with("dilation_angle = 0.000000 deg, cohesion = 16000.000000 Pa"));
    let till = note(&case, "material.till");
    assert!(
        till.contains("cohesion = 1400.000000 Pa at y = 1.5; friction_angle = ") && till.ends_with("at y = 2.5"),
        "{till}"
    );
    let case = valid(FULL, &["strength_reduction.factor=1.4"]);
    assert_eq!(case.strength_reduction, Some(1.4));
    assert!(note(&case, "material.clay").ends_with("cohesion = 14285.714286 Pa"));
    let plain = FULL.replace("[strength_reduction]\nfactor = 1.25\n", "");
    let case = valid(&plain, &["material.till.cohesion.value=2e3"]);
    let cohesion = |y: f64| match case.materials[3].material.at(y).as_ref() {
        Material::MohrCoulomb(law) => law.parameters()[2],
        other => panic!("{other:?}"),
    };
    assert_eq!(
        (case.strength_reduction, cohesion(3.0), cohesion(1.5)),
        (None, 2e3, 2750.0)
    );
}

/// What a search for the factor of safety takes as its reference: the same stiffness, and no strength.
#[test]
fn strength_that_falls_in_a_stage_takes_the_friction_of_rigid_bodies_and_strips_with_it() {
    let base = "footing.interface={ friction_coefficient = 0.5 }";
    let case = valid(FULL, &[base, "stage.0.strength_reduction=2.5"]);
    // Of the start, and from 0.25 s on.
    let friction = |t: f64| {
        let boundary = bsmpm_scene::model::model_at::<PlaneStrain, 2>(&case, t)
            .unwrap()
            .boundary;
        [
            boundary.rigid[0].friction,
            boundary.strips[0].contact.expect("it has friction").law.friction,
        ]
    };
    let start = friction(0.0);
    let later = friction(0.3);
    assert!(
        (start[0] - 0.4 / 1.25).abs() < 1e-15 && (start[1] - 0.5 / 1.25).abs() < 1e-15,
        "{start:?}"
    );
    assert!(
        (later[0] - 0.4 / 2.5).abs() < 1e-15 && (later[1] - 0.5 / 2.5).abs() < 1e-15,
        "{later:?}"
    );
}

#[test]
fn strength_reduction_makes_every_material_elastic_and_stiffer() {
    let set = ["strength_reduction.elastic=true", "strength_reduction.stiffness=20"];
    let own = valid(FULL, &[]);
    let case = valid(FULL, &set);
    let is_elastic = |material: &Material| matches!(material, Material::Hencky(_));
    for (own, made) in own.materials.iter().zip(&case.materials) {
        for height in [2.5, 3.0, 4.0] {
            let own = own.material.at(height);
            let made = made.material.at(height);
            assert!(is_elastic(&made), "{made:?}");
            let own = own.elastic();
            let made = made.elastic();
            assert!((made.young / (20.0 * own.young) - 1.0).abs() < 1e-14 && made.poisson == own.poisson);
        }
    }
    assert!(!own.materials.iter().all(|named| is_elastic(&named.material.at(3.0))));
    assert!(case.warnings.iter().all(|warning| !warning.starts_with("W0601")));
    let note = case.notes.iter().find(|note| note.key == "material.clay").unwrap();
    assert!(note.value.contains("young x 20, elastic"), "{note:?}");
}

/// A search for the factor of safety loads every trial from zero, also of a case that begins with a stress.
#[test]
fn strength_reduction_leaves_the_stress_at_the_start_out_and_lets_loads_grow() {
    let at_once = ["traction.0.ramp=0.0"];
    let own = valid(FULL, &at_once);
    let case = valid(FULL, &[&at_once[..], &["strength_reduction.unloaded=true"]].concat());
    let ramps = |case: &Case| (case.gravity.as_ref().unwrap().ramp, case.tractions[0].ramp);
    assert!(own.initial.is_some() && ramps(&own) == (0.0, 0.0));
    assert!(case.initial.is_none() && ramps(&case) == (case.analysis.end, case.analysis.end));
    // What grows by itself keeps its time.
    assert_eq!(case.point_loads[0].ramp, own.point_loads[0].ramp);
    let noted: Vec<_> = case
        .notes
        .iter()
        .filter(|note| note.reason.starts_with("strength_reduction.unloaded"))
        .collect();
    assert!(noted.len() == 2 && noted[0].key == "gravity.ramp", "{noted:?}");
}

/// Also where friction varies with the height, and whatever the strength is divided by.
#[test]
fn a_material_without_cohesion_may_close_its_gaps() {
    let separation = |case: &Case, material: usize| case.materials[material].material.separation();
    let case = valid(FULL, &[]);
    assert_eq!(
        [0, 1, 2, 3].map(|material| separation(&case, material)),
        [Separation::Forgotten; 4]
    );
    let sand = ["material.sand.cohesion=0", "material.sand.separation=gap"];
    let till = ["material.till.cohesion=0", "material.till.separation=gap"];
    let case = valid(FULL, &[sand, till].concat());
    assert_eq!(case.strength_reduction, Some(1.25));
    assert_eq!(
        [0, 3].map(|material| separation(&case, material)),
        [Separation::Closing; 2]
    );
    assert_eq!(case.materials[3].material.at(2.5).separation(), Separation::Closing);
}

/// Modified Cam-clay: its numbers, by the height too, where its linear moduli hold, and what it needs to begin with.
#[test]
fn cam_clay_and_its_start() {
    let keys = "young = 1e7, poisson = 0.3, density = 2e3, model = \"modified-cam-clay\", kappa_star = 0.02, \
    lambda_star = 0.1, critical_state_ratio = 1.2";
    let whole = ["strength_reduction.factor=1.0", "initial.k0=0.5"];
    let with = |text: &str| {
        set(
            FULL,
            &[&whole[..], &[&format!("material.clay={{ {keys}, {text} }}")]].concat(),
        )
    };
    let case = with("ocr = 2").expect("a valid case");
    let LayeredMaterial::Uniform(Material::CamClay(clay)) = &case.materials[1].material else {
        panic!()
    };
    assert_eq!(clay.parameters(), [0.02, 0.1, 1.2, 0.0, 2.0]);
    // K = p/kappa of Cauchy's pressure is p/(kappa/(1 - kappa)) of Kirchhoff's.
    let pressure = 1e7 / 1.2 * 0.02 / 0.98;
    assert!((clay.reference_pressure() / pressure - 1.0).abs() < 1e-14);
    assert!(
        case.notes.iter().any(|note| note.value.contains("p = 170068")),
        "{:?}",
        case.notes
    );
    let grows = "preconsolidation = { value = \"50 kPa\", at_y = 2.0, per_metre = 5e3 }";
    let graded = &with(grows).expect("a valid case").materials[1].material;
    assert_eq!(
        (graded.at(1.0).parameters()[3], graded.is_linear(), graded.softens()),
        (55e3, false, true)
    );
    for (text, reported) in [
        ("poisson = 0.3", "duplicate key"),
        ("k0 = 0.5", "E0305"),
        ("ocr = 0.9", "E0010"),
        ("ocr = 2, preconsolidation = 1e5", "E0016"),
        ("ocr = 2, cohesion = 1e3", "E0304"),
    ] {
        let message = format!("{:?}", with(text).expect_err("refused"));
        assert!(message.contains(reported), "{text}: {message}");
    }
    let clay = format!("material.clay={{ {keys}, ocr = 2 }}");
    let text = FULL
        .replace("k0          = 0.6\n", "")
        .replace("factor = 1.25", "factor = 1.0");
    let refused = |sets: &[&str], reported: &str| {
        let message = format!(
            "{:?}",
            set(&text, &[&[clay.as_str()], sets].concat()).expect_err("refused")
        );
        assert!(message.contains(reported), "{sets:?}: {message}");
    };
    refused(&["material.clay.lambda_star=0.02"], "E0307");
    refused(&["initial.gravity=elastic"], "E0318");
    refused(&["strength_reduction.factor=1.25"], "E0312");
    refused(&["strength_reduction.unloaded=true"], "E0318");
    // Under the weight of others, but with none of its own.
    let weightless = "material.soil={ young = 1e7, poisson = 0.3, model = \"modified-cam-clay\", kappa_star = 0.02, \
                      lambda_star = 0.1, critical_state_ratio = 1.2, ocr = 2 }";
    let weight = "gravity.acceleration=[0.0, -9.81]";
    let start = "initial.k0=0.5";
    let fill = "material.fill={ model = \"elastic\", young = 1e7, poisson = 0.3, density = 2e3 }";
    let body = "body.1={ material = \"fill\", box = { lower = [0.0, 1.0], upper = [2.0, 2.0] }, points_per_cell = 3 }";
    let message = format!(
        "{:?}",
        set(STATIC, &[weightless, fill, body, weight, start]).expect_err("no pressure")
    );
    assert!(message.contains("material.soil has no weight"), "{message}");
}

/// mu(I): its numbers in SI.
#[test]
fn granular_flow_has_its_numbers() {
    let keys = "model = \"mu-i\", young = 1e7, poisson = 0.3, density = 1.5e3, mu_s = 0.38, inertial_number = 0.3, \
                grain_diameter = \"2 mm\"";
    let with = |fast: &str| {
        set(
            FULL,
            &[
                "strength_reduction.factor=1.0",
                &format!("material.clay={{ {keys}, mu_2 = {fast}, grain_density = 2.6e3 }}"),
            ],
        )
    };
    let flow = with("0.64").expect("a valid case").materials[1].material.clone();
    assert_eq!(flow.parameters(), [0.38, 0.64, 0.3, 0.002, 2.6e3]);
    let message = format!("{:?}", with("0.3").expect_err("faster is not weaker"));
    assert!(message.contains("mu_s = 0.38"), "{message}");
}
