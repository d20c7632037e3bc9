//! Tests that a preset takes cells that resolve the waves of a record.

use super::valid;

/// A bar of 64 m between rollers; a pulse of 95 % of its energy below 1.664 times 2 Hz runs along it at 60 m/s.
fn pulsed(frequency: f64) -> String {
    let pulse = |t: f64| {
        let x = (std::f64::consts::PI * frequency * (t - 0.6)).powi(2);
        (1.0 - 2.0 * x) * (-x).exp()
    };
    let rows: Vec<String> = (1..=240)
        .map(|k| 0.005 * f64::from(k))
        .map(|t| format!("[{t:?}, {:?}]", pulse(t)))
        .collect();
    format!(
        r#"
        geometry = "plane-strain"
        [analysis]
        type = "dynamic"
        end = 4.0
        [grid]
        lower = [0.0, 0.0]
        upper = [64.0, 16.0]
        [material.elastic]
        model = "elastic"
        young = 6.48e6
        poisson = 0.0
        density = 1800.0
        [[body]]
        material = "elastic"
        box = {{ lower = [0.0, 0.0], upper = [64.0, 16.0] }}
        [boundary]
        right = "absorbing"
        bottom = "roller"
        top = "roller"
        [[traction]]
        from = [0.0, 0.0]
        to = [0.0, 16.0]
        stress = [1000.0, 0.0]
        amplitude = [{}]
        "#,
        rows.join(", ")
    )
}

/// Wavelength 60/(1.664 f), 8 cells of it with the consistent mass that an elastic case has and 24 with the lumped one.
#[test]
fn waves_of_a_table_ask_for_cells() {
    let edge = |frequency: f64, overrides: &[&str]| {
        let case = valid(&pulsed(frequency), overrides);
        assert!(
            case.warnings.iter().all(|warning| !warning.contains("wavelength")),
            "{:?}",
            case.warnings
        );
        case.grid.axes[0].longest()
    };
    let wanted = |frequency: f64, fewest: f64| 60.0 / (1.664 * frequency * fewest);
    // Bodies alone want 1.6 m.
    assert!((edge(1.0, &["accuracy=draft"]) - 1.6).abs() < 1e-9);
    let lumped = ["accuracy=draft", "analysis.mass=lumped"];
    for (found, wanted) in [
        (edge(2.0, &lumped), wanted(2.0, 24.0)),
        (edge(4.0, &["accuracy=draft"]), wanted(4.0, 8.0)),
    ] {
        assert!(found <= 1.02 * wanted && found > 0.9 * wanted, "{found} {wanted}");
    }
    let slow = valid(&pulsed(16.0), &["accuracy=draft"]);
    assert!((slow.grid.axes[0].longest() - 0.4).abs() < 1e-9);
    let warned = |case: &bsmpm_scene::Case| {
        case.warnings
            .iter()
            .filter(|warning| warning.contains("wavelength"))
            .count()
    };
    assert_eq!(warned(&slow), 1);
}
