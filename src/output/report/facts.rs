//! Effects, work of the solver, wall time and characteristic numbers as text.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::case::Case;
use crate::case::schema::Effect;
use crate::model::{Model, characteristic};
use crate::output::columns::cells;
use crate::output::numbers::{count, counted, duration, pretty_unit, significant};
use crate::run::summary::Summary;

/// Characteristic numbers: name, unit, meaning. A name that ends with `_` matches all names that start with it.
const CHARACTERISTIC: &str = "\
added_mass_kg_m | kg/m | mass of the fluid around that moves across with the beam, per length
area_change_estimate | 1 | how far pressure is expected to close a bladder, as a share of its cross-section
axial_stiffness_n | N | force that would double the beam's length, EA
base_acceleration_m_s2 | m/s^2 | acceleration of the shaken root
bending_stiffness_n_m2 | N m^2 | resistance to bending, EI
bladder_compliance_m3_pa | m^3/Pa | volume that a bladder takes up per pressure
bladder_fill | 1 | share of the beam's length that bladders take up
bladder_resistance_pa_s_m3 | Pa s/m^3 | pressure drop along a bladder per flow
bladder_tube_time_s | s | time in which a bladder empties through its tube
euler_load_n | N | compression under which the beam buckles (Euler)
f_u | 1 | how fast the drive is for the fluid: forcing frequency times fluid time
first_axial_frequency_hz | Hz | lowest frequency of waves along the beam
first_bending_damping_ratio | 1 | damping ratio of that vibration by relaxation
first_bending_frequency_hz | Hz | lowest frequency of bending
first_bending_frequency_in_fluid_hz | Hz | the same with the added mass of the fluid around
first_bending_frequency_in_shear_hz | Hz | the same with shear, exact between pins
first_bending_frequency_relaxing_hz | Hz | the same of a solid that relaxes, stiffer than in the long term
force_scale_n | N | force that is expected in the beam
forcing_frequency_hz | Hz | frequency of the drive
gyration_radius_squared_m2 | m^2 | squared radius of gyration of a section, y11
instantaneous_modulus_pa | Pa | Young's modulus at once, before anything relaxes
inertial_compression_n_m | N/m | load along the beam by shaking its root
largest_strain_estimate | 1 | expected strain; the model requires small values
mass_factor | 1 | mass over that of a solid beam of the same size
mass_per_length_kg_m | kg/m | mass per length, m
mathieu_frequency_ratio | 1 | drive over twice the first bending frequency; near 1 shaking along makes bending grow
mathieu_growth_bound_per_s | 1/s | bound of that growth, on the safe side; damping that exceeds it keeps the beam straight
mathieu_growth_rate_per_s | 1/s | growth rate of the first bending mode under axial shaking, without fluid; 0 means stable
mathieu_modulation | 1 | how strongly shaking along changes the bending stiffness
reynolds_estimate | 1 | inertia over viscosity in the tubes; creeping flow requires small values
self_weight_buckling_load_n_m | N/m | load along the beam under which it buckles
shear_flexibility | 1 | shear over bending, EI/(kGA l^2); small where sections stay across the beam
shear_stiffness_n | N | resistance to shear, kGA
slenderness | 1 | length over height
storage_modulus_from_pa | Pa | storage modulus at the lower end of the loss factor's band
storage_modulus_to_pa | Pa | storage modulus at its upper end
t_f_s | s | time scale of the fluid, t_f*
t_s_over_t_f | 1 | time of the solid over that of the fluid
t_s_s | s | time scale of the solid, t_s*
tube_resistance_pa_s_m3 | Pa s/m^3 | pressure drop along a tube per flow
womersley | 1 | tube radius over viscous depth of one cycle; without tube inertia the model requires less than 1
slowest_time_of_network_ | s | longest time constant of pressure equalization in a network";

/// Rows of the table: name, unit, meaning.
fn known() -> impl Iterator<Item = [&'static str; 3]> {
    CHARACTERISTIC.lines().map(cells)
}

/// Unit and meaning of a characteristic number.
pub fn meaning(name: &str) -> Option<[&'static str; 2]> {
    let fits = |key: &str| name == key || key.ends_with('_') && name.starts_with(key);
    known()
        .find(|[key, ..]| fits(key))
        .map(|[_, unit, about]| [unit, about])
}

/// Characteristic numbers of a case without a run; empty if the case has no model.
pub fn characteristic_of(case: &Case) -> Vec<Value> {
    Model::new(case).map_or(vec![], |model| characteristic(&characteristic::numbers(case, &model)))
}

/// Rows: name, value, meaning.
pub fn characteristic(numbers: &BTreeMap<String, f64>) -> Vec<Value> {
    let row = |(name, value): (&String, &f64)| {
        let [unit, about] = meaning(name).unwrap_or(["1", ""]);
        let text = format!("{} {}", significant(*value, 4), pretty_unit(unit));
        json!({"name": name, "value": text.trim_end(), "about": about})
    };
    numbers.iter().map(row).collect()
}

/// Choices besides effects.
const OTHERS: [(&str, &str); 2] = [
    ("max_order", "Highest order of the time integration."),
    ("method", "Method of the time integration."),
];

/// Rows: name, choice, reason, description.
pub fn effects(summary: &Summary) -> Vec<Value> {
    let described = |name: &str| {
        let effect = Effect::ALL.iter().find(|effect| effect.name() == name);
        let other = OTHERS.iter().find(|other| other.0 == name).map(|other| other.1);
        let text = effect.map(|effect| effect.note().trim()).or(other);
        text.unwrap_or_default().replace('`', "")
    };
    let row = |(name, chosen): (&String, &crate::run::summary::ProgramChoice)| json!({"name": name, "value": chosen.value, "reason": chosen.reason, "about": described(name)});
    summary.effects.iter().map(row).collect()
}

/// Sentences about the work of the integrator, and the parts of the wall time.
pub fn work(summary: &Summary) -> Value {
    let c = &summary.solver;
    let wall = &summary.wall_s;
    let known = wall.known();
    let parts: Vec<Value> = wall
        .until_known()
        .iter()
        .filter(|(_, s)| known > 0.0 && *s > 0.0)
        .map(|(words, s)| json!({"words": words, "seconds": s, "text": duration(*s), "share": s / known}))
        .collect();
    let rejected = match c.error_test_failures + c.newton_failures {
        0 => "none had to be repeated".to_string(),
        k => format!(
            "{} had to be repeated with a smaller step ({} because the error was too large, {} because the equations did not \
             converge)",
            count(k),
            count(c.error_test_failures),
            count(c.newton_failures)
        ),
    };
    let mut sentences = vec![
        format!("{}; {rejected}.", counted(c.steps, "step")),
        format!(
            "{} of the {} equations, {}, {}, {}.",
            counted(c.residual_evaluations, "evaluation"),
            count(summary.unknowns as u64),
            counted(c.jacobian_evaluations, "Jacobian"),
            counted(c.factorizations, "factorisation"),
            counted(c.linear_solves, "linear solve"),
        ),
    ];
    if c.pivot_refreshes > 0 {
        sentences.push(format!(
            "Pivots were chosen anew {}.",
            counted(c.pivot_refreshes, "time")
        ));
    }
    if c.restarts > 0 {
        sentences.push(format!(
            "The integration started anew {}, where something jumps.",
            counted(c.restarts, "time")
        ));
    }
    json!({"sentences": sentences, "parts": parts, "total": duration(known), "orders": c.steps_by_order})
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

    use super::*;
    use crate::case;
    use crate::discrete::System;

    /// Goal: exactly the characteristic numbers of the cases are described.
    #[test]
    fn characteristic_numbers_are_those_of_cases() {
        let all = fs::read_dir("cases")
            .expect("cases")
            .map(|entry| entry.expect("a file").path());
        let cases = all.filter_map(|path| case::load(&path, &[]).ok());
        let there: BTreeSet<String> = cases
            .flat_map(|case| characteristic::numbers(&case, &System::new(&case).expect("a system").model).into_keys())
            .map(|name| match name.split_once("network_") {
                Some((before, _)) => format!("{before}network_"),
                None => name,
            })
            .collect();
        let described = known().map(|[name, ..]| name.to_string()).collect();
        assert_eq!(there, described);
    }
}
