//! The deformed cell agrees with the computed compliance.

mod common;

use common::paper;
use slcbeam_section::coefficients::Options;

#[test]
fn faces_of_the_period_part_by_stretch_and_curvature() {
    let section = paper(0.49, 0.0025);
    let options = Options {
        meshes: 2,
        ..Options::default()
    };
    let picture = section.picture(&options).unwrap();
    let levels = section.levels(&options).unwrap();
    let half = section.pitch_m / 2.0;
    let node = |z: f64, x: f64| {
        let near = |p: &[f64; 2]| (p[0] - z).hypot(p[1] - x) < 1e-9;
        picture.nodes_m.iter().position(near).unwrap()
    };
    let top = section.height_m / 2.0;
    for (load, u) in picture.displacements_m.iter().enumerate() {
        let jump = |x: f64| u[node(half, x)][0] - u[node(-half, x)][0];
        let c = &levels[0].compliance;
        // Sum of four displacements of the size of the jump.
        let size = section.pitch_m * (c[0][load].abs() + top * c[1][load].abs());
        assert!(((jump(top) + jump(-top)) / 2.0 - section.pitch_m * c[0][load]).abs() < 1e-9 * size);
        assert!(((jump(top) - jump(-top)) / (2.0 * top) - section.pitch_m * c[1][load]).abs() < 1e-9 * size / top);
    }
    let edges = picture.triangles.len() * 3;
    assert!(picture.outline.len() < edges && picture.materials.len() == picture.triangles.len());
    assert!(picture.triangles.iter().flatten().all(|&k| k < picture.nodes_m.len()));
}
