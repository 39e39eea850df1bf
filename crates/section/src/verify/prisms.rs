//! Comparison: sections without bladders. Extension, bending with anticlastic curvature, and shear, of one material and
//! of layers.

use super::{Comparison, material};
use crate::cell::{Cell, Kind, Response};
use crate::coefficients::{Numbers, Options};
use crate::error::Error;
use crate::finite::{Drive, Law};
use crate::input::{Bladders, Region, RegionShape, Row, Section};
use crate::level::Level;
use crate::mesh::Fineness;

const HEIGHT: f64 = 0.02;
const WIDTH: f64 = 0.05;
const YOUNG: f64 = 2e6;

fn solid(nu: f64) -> Section {
    Section {
        height_m: HEIGHT,
        width_m: WIDTH,
        pitch_m: 0.01,
        material: material(YOUNG, nu),
        bladders: Bladders {
            length_m: WIDTH,
            upper: Row::None,
            lower: Row::None,
        },
        regions: Vec::new(),
        three_d: false,
    }
}

/// Layers as (lower height, Young's modulus); the last one extends to the top.
struct Layers(Vec<(f64, f64)>);

impl Layers {
    fn spans(&self) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
        let tops = self.0.iter().skip(1).map(|l| l.0).chain([HEIGHT / 2.0]);
        self.0.iter().zip(tops).map(|(&(from, e), to)| ([from, to], e))
    }

    /// Integral of E x^n over the section.
    fn moment(&self, n: i32) -> f64 {
        let power = n + 1;
        self.spans()
            .map(|([a, b], e)| WIDTH * e * (b.powi(power) - a.powi(power)) / f64::from(power))
            .sum()
    }

    /// kGA of layers of equal nu: shear stress from equilibrium, its energy by Simpson's rule on a fine grid.
    fn shear(&self, nu: f64) -> f64 {
        let neutral = self.moment(1) / self.moment(0);
        let ei = self.moment(2) - neutral * self.moment(1);
        let n = 400;
        let mut below = 0.0;
        let mut energy = 0.0;
        for ([a, b], e) in self.spans() {
            let first = |x: f64| below + e * ((x - neutral).powi(2) - (a - neutral).powi(2)) / 2.0;
            let h = (b - a) / f64::from(n);
            for k in 0..n {
                let x = a + f64::from(k) * h;
                let mean = (first(x).powi(2) + 4.0 * first(x + h / 2.0).powi(2) + first(x + h).powi(2)) / 6.0;
                energy += WIDTH * h * mean * 2.0 * (1.0 + nu) / e;
            }
            below = first(b);
        }
        ei * ei / energy
    }
}

fn compare_one(name: &str, section: &Section, layers: &Layers, nu: f64) -> Result<Vec<Comparison>, Error> {
    let levels = section.levels(&Options::default())?;
    let of = |value: &dyn Fn(&Level) -> f64| levels.iter().map(value).collect::<Vec<_>>();
    let (m0, m1, m2) = (layers.moment(0), layers.moment(1), layers.moment(2));
    let det = m0 * m2 - m1 * m1;
    let source = "Saint-Venant";
    let mut rows = vec![
        Comparison::new(
            format!("{name}: stretch per force [1/N]"),
            source,
            m2 / det,
            of(&|l| l.compliance[0][0]),
        )
        .held_exactly(),
        Comparison::new(
            format!("{name}: curvature per moment [1/(N m^2)]"),
            source,
            m0 / det,
            of(&|l| l.compliance[1][1]),
        )
        .held_exactly(),
        Comparison::new(
            format!("{name}: shear stiffness [N]"),
            "shear stress by equilibrium",
            layers.shear(nu),
            of(&|l| l.shear_stiffness),
        ),
    ];
    if m1.abs() > 1e-9 * m0 * HEIGHT {
        let name = format!("{name}: curvature per force [1/(N m)]");
        rows.push(Comparison::new(name, source, -m1 / det, of(&|l| l.compliance[0][1])).held_exactly());
    }
    Ok(rows)
}

/// Compares prisms of one material and of layers.
pub fn layers() -> Result<Vec<Comparison>, Error> {
    let bottom = -HEIGHT / 2.0;
    let mut rows = Vec::new();
    for nu in [0.3, 0.49, 0.4999] {
        let section = solid(nu);
        let name = format!("rectangle, nu {nu}");
        rows.extend(compare_one(&name, &section, &Layers(vec![(bottom, YOUNG)]), nu)?);
        let mut lateral = Vec::new();
        for mesh in section.meshes(&Options::default())? {
            let response = Response::new(&Cell::new(&section, &mesh), Kind::Hollow)?;
            lateral.push(response.unit_curvature()?[3]);
        }
        let name = format!("{name}: anticlastic over axial curvature [1]");
        rows.push(Comparison::new(name, "Saint-Venant", -nu, lateral).held_exactly());
    }
    let layer = |high_m, e, nu| Region {
        shape: RegionShape::Layer { high_m },
        material: material(e, nu),
    };
    // Stiff skins on both sides of a soft core.
    let (nu, skin, core) = (0.4, 0.002, 2e4);
    let sandwich = Layers(vec![(bottom, YOUNG), (bottom + skin, core), (-bottom - skin, YOUNG)]);
    let filled = Section {
        regions: vec![layer([bottom + skin, -bottom - skin], core, nu)],
        ..solid(nu)
    };
    rows.extend(compare_one("sandwich, core a hundredth", &filled, &sandwich, nu)?);
    let (nu, stiff) = (0.45, 4e7);
    let two = Layers(vec![(bottom, stiff), (bottom + 0.005, YOUNG)]);
    let sheet = Section {
        regions: vec![layer([bottom, bottom + 0.005], stiff, nu)],
        ..solid(nu)
    };
    rows.extend(compare_one("stiff sheet below", &sheet, &two, nu)?);
    // With regions, the side walls use the filled cell.
    let half = Section {
        bladders: Bladders {
            length_m: 0.4 * WIDTH,
            upper: Row::None,
            lower: Row::None,
        },
        ..sheet
    };
    rows.extend(compare_one("stiff sheet below, side walls", &half, &two, nu)?);
    Ok(rows)
}

/// Patch test: regions of equal material change only the mesh.
pub fn patches() -> Result<Vec<Comparison>, Error> {
    let nu = 0.49;
    let same = |shape| Region {
        shape,
        material: material(YOUNG, nu),
    };
    let regions = vec![
        same(RegionShape::Circle {
            center_m: [0.001, -0.003],
            radius_m: 0.0021,
        }),
        same(RegionShape::Polygon {
            points_m: vec![[-0.004, 0.002], [0.003, 0.001], [0.0015, 0.008], [0.001, 0.004]],
        }),
    ];
    let section = Section { regions, ..solid(nu) };
    let numbers: Vec<Numbers> = section
        .levels(&Options::default())?
        .iter()
        .map(|l| Numbers::new(&section, l))
        .collect();
    let of = |value: fn(&Numbers) -> f64| numbers.iter().map(value).collect::<Vec<_>>();
    Ok(vec![
        Comparison::new(
            "patch test in extension: f_e [1]",
            "uniform stress",
            1.0,
            of(|n| n.axial_stiffness_factor),
        )
        .held_exactly(),
        Comparison::new(
            "patch test in bending: f_i [1]",
            "linear stress",
            1.0,
            of(|n| n.bending_stiffness_factor),
        )
        .held_exactly(),
        Comparison::new(
            "patch test: coupling of force and curvature [1]",
            "symmetry",
            0.0,
            of(|n| n.force_curvature_coupling),
        )
        .held_exactly(),
    ])
}

/// Compares blocks at finite strain.
pub fn finite_strain() -> Result<Vec<Comparison>, Error> {
    let mut rows = Vec::new();
    let section = solid(0.49);
    let (mu, bulk, area) = (
        section.material.shear_modulus(),
        section.material.bulk_modulus(),
        WIDTH * HEIGHT,
    );
    for (name, law) in [
        ("neo-Hookean", Law::NeoHookean),
        ("Mooney-Rivlin, half", Law::MooneyRivlin { second: 0.5 }),
        ("Saint-Venant-Kirchhoff", Law::SaintVenantKirchhoff),
    ] {
        let stress = law.bar(mu, bulk, 1.3).ok_or(Error::Singular)?[1];
        let force = |meshes| {
            let cell = section.finite(
                law,
                &Options {
                    meshes,
                    ..Options::default()
                },
            )?;
            Ok(cell.equilibrium(Drive::Strain([0.3, 0.0]), [0.0; 2])?.resultants[0])
        };
        let computed = (1..=3).map(force).collect::<Result<Vec<_>, Error>>()?;
        let name = format!("block stretched by 30 %, {name}: force [N]");
        rows.push(Comparison::new(name, "uniaxial stress", area * stress, computed).held_exactly());
    }
    Ok(rows)
}

/// Compares a block with side walls in three dimensions.
pub fn three_dimensions() -> Result<Vec<Comparison>, Error> {
    let section = Section {
        bladders: Bladders {
            length_m: 0.8 * WIDTH,
            upper: Row::None,
            lower: Row::None,
        },
        ..solid(0.49)
    };
    let mut computed = [Vec::new(), Vec::new()];
    for layers in 1..=3 {
        let (c, _) = section.spatial(&Fineness::default(), layers)?;
        (0..2).for_each(|k| computed[k].push(c[k][k]));
    }
    let area = WIDTH * HEIGHT;
    let exact = [1.0 / (YOUNG * area), 12.0 / (YOUNG * area * HEIGHT * HEIGHT)];
    let names = ["stretch per force [1/N]", "curvature per moment [1/(N m^2)]"];
    let row = |((name, exact), computed): ((&str, f64), Vec<f64>)| {
        let name = format!("block in three dimensions: {name}");
        Comparison::new(name, "Saint-Venant", exact, computed).held_exactly()
    };
    Ok(names.into_iter().zip(exact).zip(computed).map(row).collect())
}
