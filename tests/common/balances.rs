//! Balances of a run.

use slcbeam::run::summary::Summary;

/// Asserts that energy, momentum and angular momentum close to a part, and prints by how much they do not.
pub fn close(what: &str, summary: &Summary, most: f64) {
    let b = &summary.balances;
    let open = [
        b.energy_residual_relative,
        b.momentum_residual_relative,
        b.angular_momentum_residual_relative,
    ];
    let told = open.map(|part| format!("{part:.1e}")).join(", ");
    println!("{what}: energy, momentum, angular momentum {told}");
    assert!(open.iter().all(|part| part.abs() < most), "{what}: {told}");
}
