//! Every rule of a section is reported with its location; several violations are reported at once.

mod common;

use common::{paper, with_shapes};
use slcbeam_section::coefficients::Options;
use slcbeam_section::error::Error;
use slcbeam_section::input::{Material, Region, RegionShape, Row, Section, Shape};

const OTHER: Material = Material {
    young_modulus_pa: 1e9,
    poisson_ratio: 0.3,
    density_kg_m3: 1000.0,
    law: None,
};

/// Locations of a section's faults, in order.
fn places(section: &Section) -> Vec<String> {
    section.faults().into_iter().map(|f| f.place).collect()
}

fn changed(change: impl FnOnce(&mut Section)) -> Section {
    let mut section = paper(0.45, 0.001);
    change(&mut section);
    section
}

fn region(shape: RegionShape) -> Region {
    Region { shape, material: OTHER }
}

#[test]
fn sizes_and_materials() {
    assert_eq!(places(&paper(0.45, 0.001)), [""; 0]);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(places(&changed(|s| s.height_m = bad)), ["/height_m"]);
        assert_eq!(
            places(&changed(|s| s.material.young_modulus_pa = bad)),
            ["/material/young_modulus_pa"]
        );
    }
    for nu in [0.5, -1.0, 0.7, f64::NAN] {
        assert_eq!(
            places(&changed(|s| s.material.poisson_ratio = nu)),
            ["/material/poisson_ratio"]
        );
    }
    assert_eq!(places(&changed(|s| s.width_m = 0.04)), ["/bladders/length_m"]);
}

#[test]
fn bladders_need_room() {
    let round = |center, radius_m| with_shapes(0.45, Some((center, Shape::Circle { radius_m })), None);
    assert_eq!(places(&round(0.0053, 0.0049)), [""; 0]);
    assert_eq!(
        places(&round(0.0053, 0.005)),
        ["/bladders/upper"],
        "neighbours touch, and so do those that mirror them"
    );
    assert_eq!(places(&round(0.0068, 0.004)), ["/bladders/upper"], "the skin is gone");
    assert_eq!(places(&round(0.003, 0.0031)), ["/bladders/lower"], "rows overlap");
    let inner = with_shapes(
        0.45,
        Some((0.0, Shape::Circle { radius_m: 0.004 })),
        Some((0.0, Shape::Circle { radius_m: 0.001 })),
    );
    assert_eq!(places(&inner), ["/bladders/lower"], "one in the other");
}

#[test]
fn shapes() {
    let of = |shape| places(&with_shapes(0.45, Some((0.005, shape)), None));
    let fillet = |fillet_m| Shape::RoundedRectangle {
        along_m: 0.006,
        high_m: 0.007,
        fillet_m,
    };
    assert_eq!(of(fillet(0.003)), [""; 0]);
    assert_eq!(of(fillet(0.0031)), ["/bladders/upper/shape/rounded_rectangle/fillet_m"]);
    assert_eq!(of(fillet(-0.001)), ["/bladders/upper/shape/rounded_rectangle/fillet_m"]);
    assert_eq!(
        of(Shape::Ellipse {
            along_m: 0.0,
            high_m: f64::NAN
        })
        .len(),
        2
    );
    let polygon = |points: &[[f64; 2]]| {
        of(Shape::Polygon {
            points_m: points.iter().map(|p| [p[0] * 1e-3, p[1] * 1e-3]).collect(),
        })
    };
    let place = ["/bladders/upper/shape/polygon/points_m"];
    assert_eq!(polygon(&[[-2.0, -2.0], [2.0, -2.0], [0.0, 2.0]]), [""; 0]);
    assert_eq!(
        polygon(&[[-2.0, -2.0], [2.0, 2.0], [2.0, -2.0], [-2.0, 2.0]]),
        place,
        "a bow tie"
    );
    assert_eq!(polygon(&[[-2.0, -2.0], [2.0, -2.0]]), place);
    assert_eq!(polygon(&[[-2.0, -2.0], [0.0, 0.0], [2.0, 2.0]]), place, "no area");
    assert_eq!(
        polygon(&[[-2.0, -2.0], [2.0, -2.0], [2.0, -2.0], [0.0, 2.0]]),
        place,
        "a corner twice"
    );
    assert_eq!(
        places(&changed(|s| s.bladders.upper = Row::Mirrored)),
        ["/bladders/upper"]
    );
}

#[test]
fn regions() {
    let with = |shapes: &[RegionShape]| places(&changed(|s| s.regions = shapes.iter().cloned().map(region).collect()));
    let layer = |a, b| RegionShape::Layer { high_m: [a, b] };
    assert_eq!(with(&[layer(0.0098, 0.0108), layer(-0.0005, 0.0005)]), [""; 0]);
    assert_eq!(
        with(&[layer(0.0098, 0.0109)]),
        ["/regions/0/shape"],
        "beyond the surface"
    );
    assert_eq!(with(&[layer(0.0005, 0.0005)]), ["/regions/0/shape/layer/high_m"]);
    assert_eq!(
        with(&[layer(0.008, 0.0108)]),
        ["/regions/0/shape"],
        "crosses the bladder"
    );
    assert_eq!(
        with(&[layer(-0.0005, 0.0002), layer(0.0001, 0.0005)]),
        ["/regions/1/shape"],
        "overlap"
    );
    assert_eq!(
        with(&[layer(-0.0005, 0.0002), layer(0.0002, 0.0005)]),
        [""; 0],
        "a common border"
    );
    assert_eq!(
        with(&[layer(-0.0005, 0.0005), layer(-0.0005, 0.0005)]),
        ["/regions/1/shape"],
        "the same twice"
    );
    let fibre = RegionShape::Circle {
        center_m: [0.0, 0.0],
        radius_m: 0.0002,
    };
    assert_eq!(
        with(&[layer(-0.0005, 0.0005), fibre]),
        ["/regions/1/shape"],
        "one in the other"
    );
}

#[test]
fn all_faults_are_found_at_once() {
    let section = changed(|s| {
        s.pitch_m = -1.0;
        s.material.poisson_ratio = 0.5;
        s.bladders.length_m = 0.2;
        s.bladders.upper = Row::None;
        s.regions = vec![region(RegionShape::Circle {
            center_m: [0.0, 0.0],
            radius_m: -1.0,
        })];
    });
    let all = [
        "/pitch_m",
        "/material/poisson_ratio",
        "/bladders/length_m",
        "/regions/0/shape/circle/radius_m",
    ];
    assert_eq!(places(&section), all);
    let Err(Error::Section(faults)) = section.coefficients(&Options::default()) else {
        panic!("solved")
    };
    assert_eq!(faults.len(), 4);
}

#[test]
fn json_in_and_out() {
    let text = r#"{"height_m": 0.0216, "width_m": 0.05, "pitch_m": 0.01,
      "material": {"young_modulus_pa": 2e6, "poisson_ratio": 0.45, "density_kg_m3": 950},
      "bladders": {"length_m": 0.046, "upper": {"center_m": 0.0049, "shape":
        {"rounded_rectangle": {"along_m": 0.0078, "high_m": 0.0078, "fillet_m": 0.001}}}, "lower": "mirrored"}}"#;
    let section: Section = serde_json::from_str(text).unwrap();
    assert_eq!(section, paper(0.45, 0.001));
    assert_eq!(
        serde_json::from_str::<Section>(&serde_json::to_string(&section).unwrap()).unwrap(),
        section
    );
    let wrong = serde_json::from_str::<Section>(&text.replace("mirrored", "both"))
        .unwrap_err()
        .to_string();
    assert!(wrong.contains("unknown variant `both`"), "{wrong}");
    let extra = serde_json::from_str::<Section>(&text.replace("\"center_m\"", "\"centre_m\""))
        .unwrap_err()
        .to_string();
    assert!(extra.contains("unknown field `centre_m`"), "{extra}");
    let schema = serde_json::to_string(&schemars::schema_for!(Section)).unwrap();
    assert!(schema.contains("rounded_rectangle") && schema.contains("mirrored"));
}
