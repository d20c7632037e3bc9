//! Upper bounds of what scenes of `cases/` carry, by the spacing of the nodes between which blocks may slide:
//! `cargo run --release -p bsmpm-trials --example bounds`, minutes. `cases/results/scenes.md` has what it prints.

#[path = "../tests/support/bounds.rs"]
mod bounds;
#[path = "../tests/support/slips.rs"]
mod slips;

use bounds::{pipe, pit, plate, strip};

fn main() {
    println!(
        "| nodes | strip on one clay, on half as strong, on a quarter | pipe, H = D, 2 D, 3 D | plate, H = B, 2 B, 3 B |"
    );
    println!("| --- | --- | --- | --- |");
    for nodes in [4, 6, 8] {
        let strips = [1.0, 0.5, 0.25].map(|ratio| format!("{:.3}", strip(ratio, nodes))).join(", ");
        let pipes = [1.0, 2.0, 3.0].map(|depth| format!("{:.3}", pipe(depth, nodes))).join(", ");
        let plates = [1.0, 2.0, 3.0].map(|depth| format!("{:.3}", plate(depth, 0.25, nodes))).join(", ");
        println!("| 1/{nodes} of the width | {strips} | {pipes} | {plates} |");
    }
    println!("\n| nodes, m | first pit, second pit |\n| --- | --- |");
    for spacing in [2.0, 1.0, 0.8] {
        println!("| {spacing} | {:.3}, {:.3} |", pit(1, spacing), pit(2, spacing));
    }
}
