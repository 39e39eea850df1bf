//! Every exact result, and what the meshes say of themselves.

use slcbeam_section::verify::verify;

#[test]
fn exact_results() {
    let rows = verify().unwrap();
    for row in &rows {
        println!("{:<70} {:>14.7e} {:>10.2e} order {:?} {}", row.name, row.exact, row.error(), row.order, row.is_covered());
    }
}
