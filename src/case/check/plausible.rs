//! Values beyond the range of plausible devices: almost always a wrong unit.

use crate::case::faults::Violations;
use crate::case::numbers::{plain, rounded};
use crate::case::schema::{Case, CrossSection};
use crate::error::{Code, Violation};

const MILLIMETRES: &str = "lengths are in metres; is this in millimetres?";

/// Accepted range of a value, and the suspected cause of values outside it.
struct Range {
    low: f64,
    high: f64,
    unit: &'static str,
    hint: &'static str,
}

impl Range {
    const fn new(low: f64, high: f64, unit: &'static str, hint: &'static str) -> Self {
        Self { low, high, unit, hint }
    }

    fn times(&self, size: f64) -> Self {
        Self::new(self.low * size, self.high * size, self.unit, self.hint)
    }
}

const BEAM_LENGTH: Range = Range::new(1e-6, 1e3, "m", MILLIMETRES);
const SECTION: Range = Range::new(1e-7, 10.0, "m", MILLIMETRES);
const BLADDER: Range = Range::new(1e-8, 10.0, "m", MILLIMETRES);
const TUBE_LENGTH: Range = Range::new(1e-7, 1e3, "m", MILLIMETRES);
const RADIUS: Range = Range::new(1e-9, 0.5, "m", MILLIMETRES);
const MODULUS: Range = Range::new(1e2, 1e13, "Pa", "moduli are in Pa; is this in MPa or GPa?");
const SOLID_DENSITY: Range = Range::new(0.1, 3e4, "kg/m^3", "is this in g/cm^3?");
const FLUID_DENSITY: Range = Range::new(0.0, 3e4, "kg/m^3", "densities are in kg/m^3");
const BULK_MODULUS: Range = Range::new(1e4, 1e12, "Pa", "moduli are in Pa; water has 2.2e9");
const VISCOSITY: Range = Range::new(1e-7, 1e5, "Pa s", "is this in mPa s? water has 1e-3 Pa s");
const PERMEABILITY: Range = Range::new(1e-36, 10.0, "m^4", "a circle has pi r^4/8, r in metres");
const SOFTNESS: Range = Range::new(
    1e-25,
    1e-3,
    "m^2/Pa",
    "area in m^2 per pressure in Pa; is this per MPa or in mm^2?",
);
const FACTOR: Range = Range::new(
    1e-6,
    1e5,
    "1",
    "a ratio to the full section, near 1; above with stiff layers",
);
/// Range of the shear stiffness relative to Young's modulus times the area of the full section.
const SHEAR: Range = Range::new(
    1e-6,
    1e3,
    "N",
    "a force: about 5/6 of the area times the shear modulus, which is a third of Young's modulus of an incompressible \
     solid",
);
const RELAXATION: Range = Range::new(1e-9, 1e9, "s", "times are in seconds");
const DURATION: Range = Range::new(1e-9, 1e7, "s", "times are in seconds");

/// Pointers of the reference values of [`SHEAR`].
const FULL_SECTION: [&str; 3] = ["/beam/young_modulus_pa", "/beam/height_m", "/beam/width_m"];

/// Largest ratio of length to height of the beam: dry, and with bladders.
const MOST_SLENDER: [f64; 2] = [1e5, 4e3];
/// Longest tube, in lengths of the beam.
const LONGEST_TUBE: f64 = 100.0;

/// Checks dimensions, material properties and durations against their plausible ranges.
pub(super) fn sizes(case: &Case, faults: &mut Violations) {
    let mut look = |pointer: &str, value: f64, range: &Range| look(pointer, value, range, faults);
    let beam = &case.beam;
    look("/beam/length_m", beam.length_m, &BEAM_LENGTH);
    look("/beam/height_m", beam.height_m, &SECTION);
    look("/beam/width_m", beam.width_m, &SECTION);
    look("/beam/young_modulus_pa", beam.young_modulus_pa, &MODULUS);
    look("/beam/density_kg_m3", beam.density_kg_m3, &SOLID_DENSITY);
    look("/beam/axial_stiffness_factor", beam.axial_stiffness_factor, &FACTOR);
    look("/beam/bending_stiffness_factor", beam.bending_stiffness_factor, &FACTOR);
    look("/beam/mass_factor", beam.mass_factor.unwrap_or(1.0), &FACTOR);
    let branches = beam.viscoelasticity.iter().flat_map(|relaxing| &relaxing.prony);
    for (k, branch) in branches.enumerate() {
        look(
            &format!("/beam/viscoelasticity/prony/{k}/time_s"),
            branch.time_s,
            &RELAXATION,
        );
    }
    look("/time/end_s", case.time.end_s, &DURATION);
    if let Some(fluid) = &case.fluid {
        look("/fluid/density_kg_m3", fluid.density_kg_m3, &FLUID_DENSITY);
        look(
            "/fluid/bulk_modulus_pa",
            fluid.bulk_modulus_pa.unwrap_or(BULK_MODULUS.high),
            &BULK_MODULUS,
        );
        look("/fluid/viscosity_pa_s", fluid.viscosity_pa_s, &VISCOSITY);
    }
    if let Some(bladders) = &case.bladders {
        look("/bladders/length_m", bladders.length_m, &BLADDER);
        look("/bladders/height_m", bladders.height_m, &BLADDER);
        look("/bladders/width_m", bladders.width_m, &BLADDER);
        look(
            "/bladders/area_per_pressure_m2_per_pa",
            bladders.area_per_pressure_m2_per_pa,
            &SOFTNESS,
        );
        if let Some(permeability) = bladders.permeability_m4 {
            look("/bladders/permeability_m4", permeability, &PERMEABILITY);
        }
        for (key, size) in bladders.cross_section.iter().flat_map(sides) {
            look(&format!("/bladders/cross_section/{key}"), size, &BLADDER);
        }
    }
    if let Some(tubes) = &case.tubes {
        look("/tubes/length_m", tubes.length_m, &TUBE_LENGTH);
        look("/tubes/radius_m", tubes.radius_m, &RADIUS);
        if let Some(permeability) = tubes.permeability_m4 {
            look("/tubes/permeability_m4", permeability, &PERMEABILITY);
        }
    }
    for (i, tube) in case.network.iter().flat_map(|network| &network.tubes).enumerate() {
        let tube_at = format!("/network/tubes/{i}");
        if let Some(length) = tube.length_m {
            look(&format!("{tube_at}/length_m"), length, &TUBE_LENGTH);
        }
        if let Some(permeability) = tube.permeability_m4 {
            look(&format!("{tube_at}/permeability_m4"), permeability, &PERMEABILITY);
        }
        for (key, size) in tube.cross_section.iter().flat_map(sides) {
            look(&format!("{tube_at}/cross_section/{key}"), size, &RADIUS);
        }
    }
    if let Some(shear) = beam.shear_stiffness_n.filter(|_| faults.are_sound(&FULL_SECTION)) {
        let full = beam.young_modulus_pa * beam.height_m * beam.width_m;
        self::look("/beam/shear_stiffness_n", shear, &SHEAR.times(full), faults);
    }
}

fn look(pointer: &str, value: f64, range: &Range, faults: &mut Violations) {
    if (range.low..=range.high).contains(&value) {
        return;
    }
    let fault = Violation::new(
        Code::Implausible,
        pointer,
        format!("{} {} is not a plausible size", plain(value), unit(range)),
    );
    let allowed = format!("{} to {} {}", plain(range.low), plain(range.high), unit(range));
    faults.push_beside(&[], fault.allowed(allowed.trim_end()).hint(range.hint));
}

/// Checks ratios of lengths: length to height of the beam, and length of tubes at bladders to length of the beam.
pub(super) fn proportions(case: &Case, faults: &mut Violations) {
    let beam = &case.beam;
    let slenderness = beam.length_m / beam.height_m;
    let most = MOST_SLENDER[usize::from(case.bladders.is_some())];
    if slenderness > most {
        let what = format!("a beam {} times as long as it is high", slenderness.round());
        let fault = Violation::new(Code::Implausible, "/beam/length_m", what);
        let fault = fault.allowed(format!("up to {most} times the height"));
        faults.push_beside(&["/beam/height_m"], fault.hint(MILLIMETRES));
    }
    if case.bladders.is_none() {
        return;
    }
    let shared = case
        .tubes
        .iter()
        .map(|tubes| ("/tubes/length_m".to_owned(), tubes.length_m));
    let single = case.network.iter().flat_map(|network| &network.tubes).enumerate();
    let single = single.filter_map(|(i, t)| Some((format!("/network/tubes/{i}/length_m"), t.length_m?)));
    for (pointer, length) in shared.chain(single) {
        let longest = LONGEST_TUBE * beam.length_m;
        if length > longest {
            let fault = Violation::new(
                Code::Implausible,
                pointer,
                format!("a tube of {} m on a beam of {} m", plain(length), plain(beam.length_m)),
            );
            let fault = fault.allowed(format!("up to {} m", rounded(longest)));
            faults.push_beside(&["/beam/length_m"], fault.hint(MILLIMETRES));
        }
    }
}

fn unit(range: &Range) -> &'static str {
    if range.unit == "1" { "" } else { range.unit }
}

fn sides(section: &CrossSection) -> Vec<(&'static str, f64)> {
    match *section {
        CrossSection::Circle { radius_m } => vec![("circle/radius_m", radius_m)],
        CrossSection::Rectangle { height_m, width_m } => {
            vec![("rectangle/height_m", height_m), ("rectangle/width_m", width_m)]
        }
        CrossSection::Ellipse {
            semi_axis_a_m,
            semi_axis_b_m,
        } => {
            vec![
                ("ellipse/semi_axis_a_m", semi_axis_a_m),
                ("ellipse/semi_axis_b_m", semi_axis_b_m),
            ]
        }
        CrossSection::Triangle { side_m } => vec![("triangle/side_m", side_m)],
    }
}
