//! Tests that doubtful values have warnings.

use super::{FULL, ROUND, STATIC, valid};

#[test]
fn doubtful_cases_are_warned_of() {
    let rows = [
        (FULL, "gravity.acceleration=[0, -9.8]", "W0205"),
        (
            FULL,
            "material.sand.young=500",
            "W0101: material.sand.young: a modulus of 500 Pa (0.5 kPa)",
        ),
        (FULL, "material.sand.young=2e13", "W0302"),
        (FULL, "material.clay.poisson=0.49999", "W0303: material.clay: "),
        (FULL, "material.clay.cohesion=0", "W0309"),
        (FULL, "material.clay.unit_weight=18", "(unit weight 0.018 kN/m3)"),
        (FULL, "body.0.points_per_cell=1", "W0210"),
        (FULL, "body.1.box.lower.1=0.9", "W0213: body.0 and body.1 overlap"),
        (FULL, "body.1.material=sand", "W0313: material.clay: "),
        (STATIC, "gravity={acceleration=[0, -9.81], ramp=5}", "W0207"),
        (FULL, "traction.0.ramp=5", "W0402"),
        (FULL, "traction.0.ramp=0", "W0405: traction.0: "),
        (FULL, "point_load.0.ramp=0", "W0405: point_load.0: "),
        (FULL, "prescribed.1.path.1.0=2", "W0403: prescribed.1.path: "),
        (
            FULL,
            "material.till.dilation_angle=30.5",
            "W0308: material.till.dilation_angle: ",
        ),
        (
            FULL,
            "body.3.polygon=[[2.5, 1.0], [3.75, 1.0], [3, 2.5], [2.5, 2.5]]",
            "W0213",
        ),
        (STATIC, "strength_reduction.factor=2", "W0601"),
        (FULL, "output.every=5", "W0661"),
        (STATIC, "material.soil.poisson=0.46", "W0315"),
        (STATIC, "gravity.acceleration=[0, -9.81]", "W0314"),
        (STATIC, "title=x", "W0674"),
    ];
    for (text, change, says) in rows {
        let warnings = valid(text, &[change]).warnings;
        assert!(
            warnings.iter().any(|warning| warning.contains(says)),
            "{change}: {warnings:?}"
        );
    }
    let of_cubic = |points: &str| {
        valid(
            FULL,
            &["grid.degree=cubic", &format!("body.*.points_per_cell={points}")],
        )
        .warnings
    };
    let warned = |points: &str| of_cubic(points).iter().any(|warning| warning.starts_with("W0209"));
    assert!(warned("2") && !warned("3"));
    let at_axis = |set: &[&str]| {
        valid(ROUND, set)
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0234"))
    };
    let ring = [
        "grid.degree=cubic",
        "body.0.box.lower=[0.25, 0.0]",
        "point_load.0.at=[0.5, 1.0]",
    ];
    assert!(at_axis(&ring[..1]) && !at_axis(&ring) && !at_axis(&[]));
    let plastic = FULL.replace("[stabilisation]\nmethod = \"f-bar\"", "");
    assert!(
        valid(&plastic, &[])
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0315: stabilisation: material.sand"))
    );
}
