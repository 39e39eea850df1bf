//! Every exact result, and the error estimates from the meshes.

use slcbeam_section::verify::{LEAST_ORDER, ROUND_OFF, verify};

#[test]
fn exact_results_are_met_or_approached_with_the_order_of_the_element() {
    let rows = verify().unwrap();
    for row in &rows {
        println!(
            "{:<72} {:>14.7e} {:>10.2e} order {:?}",
            row.name,
            row.exact,
            row.error(),
            row.order
        );
        assert!(row.error() <= row.tolerance, "{row:?}");
        if let Some(estimate) = row.estimate() {
            assert!(row.order.is_none_or(|order| order > LEAST_ORDER), "{row:?}");
            assert!(
                estimate.max(ROUND_OFF) >= row.error(),
                "the estimate is below the error: {row:?}"
            );
        }
    }
    // Results exact by construction are checked to rounding errors; most of the others are approximated.
    let exact = rows.iter().filter(|row| row.estimate().is_none()).count();
    assert!(exact > 30 && rows.len() - exact > 20, "{exact} of {}", rows.len());
}
