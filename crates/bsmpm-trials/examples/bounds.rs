//! Computes bounds of limit loads for cases in `cases/`.

#[path = "../tests/support/bounds.rs"]
mod bounds;
#[path = "../tests/support/conic.rs"]
mod conic;
#[path = "../tests/support/footings.rs"]
mod footings;
#[path = "../tests/support/limit_analysis.rs"]
mod limit_analysis;
#[path = "../tests/support/slips.rs"]
mod slips;

use bounds::{pipe, pit, plate, strip};
use footings::{FLAT, Footing, SPUDCAN};

fn main() {
    blocks();
    footings();
}

fn blocks() {
    println!(
        "| nodes | strip on one clay, on half as strong, on a quarter | pipe, H = D, 2 D, 3 D | plate, H = B, 2 B, 3 B |"
    );
    println!("| --- | --- | --- | --- |");
    for nodes in [4, 6, 8] {
        let strips = [1.0, 0.5, 0.25]
            .map(|ratio| format!("{:.3}", strip(ratio, nodes)))
            .join(", ");
        let pipes = [1.0, 2.0, 3.0]
            .map(|depth| format!("{:.3}", pipe(depth, nodes)))
            .join(", ");
        let plates = [1.0, 2.0, 3.0]
            .map(|depth| format!("{:.3}", plate(depth, 0.25, nodes)))
            .join(", ");
        println!("| 1/{nodes} of the width | {strips} | {pipes} | {plates} |");
    }
    println!("\n| nodes, m | first pit, second pit |\n| --- | --- |");
    for spacing in [2.0, 1.0, 0.8] {
        println!("| {spacing} | {:.3}, {:.3} |", pit(1, spacing), pit(2, spacing));
    }
}

fn footings() {
    println!("\n| N, lower and upper bound | cells of B/40 at the edge | B/100 |\n| --- | --- | --- |");
    let disc = Footing {
        round: true,
        rough: false,
        outline: FLAT,
        depth: 0.0,
        side: 0.0,
        below: 1.0,
    };
    row("smooth disc", &disc);
    row("rough disc", &Footing { rough: true, ..disc });
    for below in [1.0, 0.5, 0.25] {
        row(
            &format!("smooth strip, {below} of the strength below"),
            &Footing {
                round: false,
                below,
                ..disc
            },
        );
    }
    let depths = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.5, 1.0];
    let layers = depths.map(|z| (0.25, z));
    let one_clay = [0.0, 0.125, 0.5, 1.0].map(|z| (1.0, z));
    for (below, z) in layers.into_iter().chain(one_clay) {
        let spudcan = Footing {
            outline: SPUDCAN,
            depth: 2.0 * z,
            side: 0.3,
            below,
            ..disc
        };
        row(&format!("spudcan, z = {z} B, {below} of the strength below"), &spudcan);
    }
}

fn row(what: &str, footing: &Footing) {
    let bounds = [(0.05, 0.2), (0.02, 0.08)].map(|(finest, growth)| {
        let mesh = footing.mesh(finest, growth);
        format!("{:.3}, {:.3}", mesh.lower_bound(), mesh.upper_bound())
    });
    println!("| {what} | {} | {} |", bounds[0], bounds[1]);
}
