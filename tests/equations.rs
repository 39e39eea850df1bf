//! Every equation of the model has a test: the index, and a direct check of each law against what it was derived from.
//!
//! Goal: the lines of code that carry a tag say what `docs/model.md` says under the same tag.

#[path = "common/files.rs"]
mod files;

use std::fs;
use std::path::Path;

use files::files;
use slcbeam::case::{self, Case};
use slcbeam::dae::BeamDae;
use slcbeam::discrete::residual::{self, fluid::bridge_drops};
use slcbeam::discrete::{System, TimeData, Workspace};
use slcbeam::functions;
use slcbeam::model::network::CheckValveLaw;
use slcbeam::model::{AreaLaw, CouplingLaw, Model, audit, bladder, duct, relaxation_times};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Balances, Status};

/// Tag, file, test.
const INDEX: &[(&str, &str, &str)] = &[
    ("[E1]", "tests/equations.rs", "the_section_of_the_papers_beam"),
    ("[E2]", "tests/equations.rs", "areas_take_the_slope_of_their_sign"),
    (
        "[E3]",
        "tests/equations.rs",
        "reciprocal_strains_and_areas_share_one_potential",
    ),
    ("[E4]", "tests/equations.rs", "permeabilities_of_known_ducts"),
    ("[E5]", "tests/equations.rs", "body_forces_act_on_the_mass"),
    ("[E6]", "tests/equations.rs", "a_valve_is_in_series_with_its_half_cells"),
    ("[E7]", "tests/equations.rs", "check_valves_are_passive"),
    ("[E8]", "tests/equations.rs", "pressures_give_back_their_areas"),
    ("[E9]", "tests/equations.rs", "flows_follow_pressures_and_lose_nothing"),
    ("[E10]", "tests/equations.rs", "a_bridge_rectifies"),
    ("[E11]", "tests/equations.rs", "a_circle_has_one_curvature"),
    ("[E12]", "tests/equations.rs", "a_circle_has_one_moment_and_no_shear"),
    (
        "[E13]",
        "tests/equations.rs",
        "balances_close_for_every_formulation_and_coupling",
    ),
    (
        "[E14]",
        "tests/equations.rs",
        "balances_close_for_every_formulation_and_coupling",
    ),
    (
        "[E15]",
        "tests/equations.rs",
        "balances_close_for_every_formulation_and_coupling",
    ),
    ("[E16]", "tests/equations.rs", "means_weigh_as_their_transpose"),
    (
        "[E17]",
        "tests/equations.rs",
        "balances_close_for_every_formulation_and_coupling",
    ),
    ("[E18]", "tests/equations.rs", "a_bridge_rectifies"),
    (
        "[E19]",
        "tests/equations.rs",
        "balances_close_for_every_formulation_and_coupling",
    ),
    ("[E20]", "tests/equations.rs", "two_bladders_relax_in_half_their_time"),
    ("[E21]", "tests/equations.rs", "the_audit_of_the_papers_coupling"),
    (
        "[E22]",
        "tests/equations.rs",
        "a_rigid_motion_leaves_the_unknowns_alone",
    ),
    ("[E23]", "tests/effects/exact.rs", "sealed_bladders_need_no_unknowns"),
    ("[E24]", "tests/effects/exact.rs", "a_beam_shaken_along_is_a_bar"),
    ("[E25]", "tests/effects/uniform.rs", "a_closed_network_has_one_pressure"),
    (
        "[E26]",
        "tests/effects/rotation.rs",
        "small_rotations_err_with_the_square_of_the_angle",
    ),
    (
        "[E27]",
        "tests/effects/waves.rs",
        "axial_waves_vanish_with_the_square_of_the_frequency",
    ),
    (
        "[E28]",
        "tests/effects/stretch.rs",
        "stretch_vanishes_with_the_inverse_of_the_stiffness",
    ),
    (
        "[E29]",
        "tests/equilibrium/fluid.rs",
        "static_jacobian_is_that_of_differences",
    ),
    (
        "[E30]",
        "tests/equilibrium/paths.rs",
        "stubby_column_loses_load_as_it_buckles",
    ),
    ("[E31]", "tests/modes/physics.rs", "a_run_swings_and_decays_as_its_mode"),
    ("[E32]", "tests/modes/spectral.rs", "dense_and_sparse_agree"),
    ("[E33]", "tests/modes/physics.rs", "shapes_are_alike_or_orthogonal"),
    ("[E34]", "tests/modes/spectral.rs", "errors_are_within_their_bounds"),
    ("[E35]", "tests/modes/physics.rs", "passive_as_the_audit_has_it"),
    (
        "[E45]",
        "tests/modes/physics.rs",
        "half_the_cells_tell_the_error_of_the_mesh",
    ),
    ("[E44]", "tests/modes/physics.rs", "eigenvalues_move_as_differences_say"),
    (
        "[E42]",
        "tests/equilibrium/paths.rs",
        "column_buckles_onto_the_stable_branch",
    ),
    (
        "[E43]",
        "tests/equilibrium/derivatives.rs",
        "sensitivities_are_those_of_differences",
    ),
    (
        "[E36]",
        "tests/periodic/floquet.rs",
        "carried_disturbances_are_differences_of_the_period_map",
    ),
    (
        "[E37]",
        "tests/periodic/shooting.rs",
        "the_cycle_is_the_tail_of_a_long_run",
    ),
    (
        "[E38]",
        "tests/periodic/floquet.rs",
        "multipliers_of_what_nothing_drives_are_those_of_its_modes",
    ),
    ("[E39]", "tests/periodic/floquet.rs", "growth_in_the_tongue_is_mathieus"),
    (
        "[E40]",
        "tests/sensitivity/exact.rs",
        "difference_formula_is_of_fourth_order",
    ),
    ("[E41]", "tests/sensitivity/exact.rs", "tangent_is_the_jacobian_applied"),
    (
        "[E48]",
        "tests/laws/nonlinear.rs",
        "a_beam_under_pressure_bends_as_its_cell",
    ),
    (
        "[E47]",
        "tests/physics/flight.rs",
        "a_falling_beam_reaches_the_velocity_of_its_drag",
    ),
    (
        "[E46]",
        "tests/physics/loads.rs",
        "a_load_has_its_force_and_moment_on_every_mesh",
    ),
    (
        "[E49]",
        "tests/laws/attachments/mod.rs",
        "a_cantilever_with_a_tip_mass_swings_as_slowly_as_it_must",
    ),
    (
        "[E50]",
        "tests/laws/attachments/mod.rs",
        "a_rotational_spring_at_a_pinned_root_swings_as_it_must",
    ),
    ("[E51]", "tests/laws/tubes.rs", "the_impedance_of_a_tube_is_womersleys"),
    ("[E52]", "tests/laws/tubes.rs", "friction_is_churchills"),
    (
        "[E53]",
        "tests/laws/surroundings.rs",
        "frequencies_fall_with_the_added_mass",
    ),
    ("[E54]", "tests/gas/main.rs", "a_bladder_blows_down_through_a_capillary"),
    ("[E55]", "tests/gas/main.rs", "a_bladder_blows_down_through_a_capillary"),
    ("[E56]", "tests/gas/main.rs", "balances_close_with_compression"),
    (
        "[E57]",
        "tests/viscoelastic/branches.rs",
        "loss_factors_are_constant_over_their_band",
    ),
    ("[E58]", "tests/viscoelastic/main.rs", "held_strains_relax_exactly"),
    (
        "[E59]",
        "tests/rest_curvature.rs",
        "what_nothing_acts_on_has_its_own_shape",
    ),
    ("[E60]", "tests/components/stores.rs", "vessels_fill_as_their_laws_say"),
    (
        "[E61]",
        "tests/contact/bodies.rs",
        "a_beam_that_falls_flat_bounces_as_one_body",
    ),
    ("[E62]", "tests/contact/main.rs", "a_stop_holds_a_cantilever"),
    ("[E63]", "tests/shear/statics.rs", "a_large_tip_force"),
    ("[E64]", "tests/gas/vessels.rs", "valves_and_pumps_work_with_air"),
    ("[E65]", "tests/gas/moving.rs", "balances_close_with_inertia"),
    ("[E66]", "tests/gas/moving.rs", "air_swings_between_tanks"),
    ("[E67]", "tests/gas/vessels.rs", "a_tank_blows_down"),
    (
        "[E68]",
        "tests/laws/attachments/followers.rs",
        "a_column_that_a_follower_pushes_at_a_place",
    ),
    (
        "[E69]",
        "tests/laws/attachments/solids.rs",
        "a_cantilever_swings_with_a_body",
    ),
    (
        "[E70]",
        "tests/laws/attachments/solids.rs",
        "a_weight_beside_the_tip_bends_the_beam",
    ),
    ("[E71]", "tests/laws/closing.rs", "walls_hold_what_suction_leaves"),
    (
        "[E72]",
        "tests/laws/sloshing.rs",
        "the_impedance_of_a_rectangular_duct_is_exact_at_both_ends",
    ),
    (
        "[E73]",
        "tests/laws/sloshing.rs",
        "the_impedance_of_a_rectangular_duct_is_exact_at_both_ends",
    ),
    ("[E74]", "tests/laws/sloshing.rs", "fluid_swings_along_a_bladder"),
    (
        "[E75]",
        "tests/optimize/cycles.rs",
        "derivatives_of_a_cycle_are_those_of_differences",
    ),
    (
        "[E76]",
        "tests/optimize/cycles.rs",
        "derivatives_of_a_cycle_are_those_of_differences",
    ),
    ("[E77]", "tests/modes/fourth.rs", "frequencies_are_of_fourth_order"),
    ("[E78]", "tests/modes/fourth.rs", "frequencies_are_of_fourth_order"),
    ("[E79]", "tests/modes/fourth.rs", "tension_is_of_fourth_order"),
    ("[E80]", "tests/solvers/corotation.rs", "a_matrix_turns_with_the_beam"),
    (
        "[E81]",
        "tests/modes/response.rs",
        "a_cantilever_answers_as_its_closed_form",
    ),
    (
        "[E82]",
        "tests/modes/response.rs",
        "a_state_space_model_has_the_same_response",
    ),
    (
        "[E83]",
        "tests/laws/spans.rs",
        "a_stepped_cantilever_bends_as_its_closed_form",
    ),
    (
        "[E84]",
        "tests/laws/foundation.rs",
        "a_beam_on_a_foundation_bends_as_its_closed_form",
    ),
    ("[E85]", "tests/contact/circles.rs", "a_cantilever_lies_on_a_former"),
    (
        "[E86]",
        "tests/laws/rotating_frame.rs",
        "a_beam_on_a_hub_moves_as_in_axes_at_rest",
    ),
    (
        "[E87]",
        "tests/laws/pump_curves.rs",
        "a_pump_works_where_its_curve_meets_the_tube",
    ),
    ("[E88]", "tests/laws/network.rs", "two_tanks_drain_into_each_other"),
    (
        "[E89]",
        "tests/laws/eccentric.rs",
        "force_and_moment_are_coupled_by_the_offset",
    ),
    (
        "[E90]",
        "tests/laws/other_pressure.rs",
        "closed_volumes_have_the_pressures_of_their_compliance",
    ),
    (
        "[E91]",
        "tests/laws/moment_curvature.rs",
        "a_moment_bends_a_cantilever_to_an_arc",
    ),
    (
        "[E92]",
        "tests/modes/bands.rs",
        "the_papers_beam_has_the_waves_of_its_transfer_matrix",
    ),
    (
        "[E93]",
        "tests/modes/bands.rs",
        "a_bar_with_masses_has_the_gaps_of_its_closed_form",
    ),
    (
        "[E94]",
        "tests/periodic/branch.rs",
        "a_hardening_beam_folds_where_its_backbone_says",
    ),
    (
        "[E95]",
        "tests/modes/reduced.rs",
        "a_model_of_the_actuator_has_few_states",
    ),
    ("[E96]", "tests/modes/reduced.rs", "a_response_has_the_stated_error"),
    (
        "[E97]",
        "tests/periodic/self_oscillation.rs",
        "a_limit_cycle_is_the_end_of_a_long_run",
    ),
    (
        "[E98]",
        "tests/modes/response_derivatives.rs",
        "peaks_move_as_differences_of_the_command_say",
    ),
    (
        "[E99]",
        "tests/periodic/harmonic.rs",
        "a_shaken_beam_answers_as_in_a_run",
    ),
    ("[E100]", "tests/periodic/backbone.rs", "a_clamped_strip_hardens"),
    (
        "[E101]",
        "tests/modes/power.rs",
        "a_small_cycle_has_the_mean_powers_of_the_response",
    ),
    ("[E102]", "tests/laws/snapping.rs", "a_snapping_dome_follows_its_curve"),
    ("[E103]", "tests/laws/snapping.rs", "a_vessel_opens_a_valve"),
    (
        "[E104]",
        "tests/structures/rearranged.rs",
        "a_hinge_yields_by_its_spring_and_its_stop",
    ),
    (
        "[E105]",
        "tests/structures/mechanisms.rs",
        "a_flexible_four_bar_turns_as_by_spectral_elements",
    ),
    (
        "[E106]",
        "tests/structures/mechanisms.rs",
        "a_flexible_slider_crank_moves_as_by_spectral_elements",
    ),
    (
        "[E107]",
        "tests/structures/touching.rs",
        "beams_pressed_together_overlap_by_the_law",
    ),
    ("[E108]", "tests/structures/ledgers.rs", "ledgers_of_beams_close"),
    (
        "[E109]",
        "tests/components/controllers.rs",
        "a_sampled_pi_law_follows_its_recursion",
    ),
    (
        "[E110]",
        "tests/components/controllers.rs",
        "a_relay_swings_with_the_period_of_its_band",
    ),
    (
        "[E111]",
        "tests/components/controllers.rs",
        "a_ramp_moves_a_volume_without_jumps",
    ),
];

#[test]
fn every_equation_has_a_test() {
    let source: String = files("src", &["rs"])
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    for (tag, file, test) in INDEX {
        assert!(source.contains(&format!("`{tag}` ")), "{tag} is defined nowhere");
        let tests = fs::read_to_string(file).unwrap();
        assert!(
            tests.contains(&format!("#[test]\nfn {test}()")),
            "{tag}: no test {test} in {file}"
        );
    }
    for k in 1..1000 {
        let tag = format!("[E{k}]");
        let mut docs = ["///", "//!"].iter();
        let defined = docs.any(|doc| source.contains(&format!("{doc} `{tag}` ")));
        let indexed = INDEX.iter().any(|(own, ..)| *own == tag);
        assert_eq!(
            defined, indexed,
            "an equation is missing in the index, or in the source: {tag}"
        );
    }
}

/// A shipped case with everything in it, unless effects are named.
fn load(name: &str, sets: &[&str]) -> Case {
    let mut sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    sets.insert(0, r#"/effects="full""#.into());
    match case::load(Path::new(&format!("cases/{name}.json")), &sets) {
        Ok(case) => case,
        Err(error) => panic!("{error}: {error:?}"),
    }
}

/// Relative agreement.
fn close(value: f64, exact: f64, tolerance: f64) {
    let error = (value - exact).abs() / exact.abs().max(f64::MIN_POSITIVE);
    assert!(error <= tolerance, "{value} instead of {exact}: {error:.1e}");
}

/// Evaluates a system at a state in SI units whose rates are zero.
fn evaluated(system: &System, y: &[f64]) -> Workspace<f64> {
    let mut now = TimeData::new(system);
    now.update(system, functions::SmoothTime { t: 0.0, within: 0.0 });
    let mut w = Workspace::new(system);
    residual::evaluate(system, &now, y, &vec![0.0; y.len()], &mut w);
    w
}

/// `[E1]` Arithmetic of the paper's beam, filled with water (m, EA, EI, y11 to the digits that its data have).
#[test]
fn the_section_of_the_papers_beam() {
    let section = Model::new(&load("wiring-2", &[])).unwrap().section;
    close(section.mass_factor, 1.0273, 5e-5);
    close(
        section.mass_per_length,
        950.0 * 0.05 * 0.0216 * section.mass_factor,
        1e-15,
    );
    close(section.axial_stiffness, 1144.8, 1e-12);
    close(section.bending_stiffness, 0.0503885, 1e-6);
    close(section.gyration_radius_squared, 2.2709e-5, 2e-5);
    // An empty honeycomb weighs what the paper's factor says.
    close(
        Model::new(&load("bend-dry", &[])).unwrap().section.mass_factor,
        0.481,
        1e-15,
    );
}

/// `[E2]` (A.15, A.16) as a table of signs; the smoothed kink leaves at most the half differences times its widths.
#[test]
fn areas_take_the_slope_of_their_sign() {
    let case = load("wiring-2", &[]);
    let [law, _] = Model::new(&case).unwrap().wet.unwrap().area;
    let (opening, closing) = (3.75e-6, 6.54e-6);
    let (tension, compression) = (3.64e-8, 6.31e-8);
    let moment = 0.1;
    let error = law.moment_half_difference * law.moment_width;
    assert!(
        error < 2e-3 * opening * moment,
        "the kink is too wide to be told from the slopes"
    );
    for (row, sign, slope) in [
        (1.0, 1.0, opening),
        (1.0, -1.0, closing),
        (-1.0, 1.0, closing),
        (-1.0, -1.0, opening),
    ] {
        let area: f64 = law.of_moment(sign * moment, row);
        assert!(
            (area - row * sign * slope * moment).abs() <= error,
            "row {row}, M of sign {sign}: {area}"
        );
    }
    let (force, error) = (10.0, law.force_half_difference * law.force_width);
    for (sign, slope) in [(1.0, tension), (-1.0, compression)] {
        let area: f64 = law.of_force(sign * force);
        assert!((area - sign * slope * force).abs() <= error, "N of sign {sign}: {area}");
    }
}

/// `[E3]` Strains and areas are derivatives of g*; with the kink too, whose terms the published law lacks.
#[test]
fn reciprocal_strains_and_areas_share_one_potential() {
    let case = load(
        "wiring-2",
        &["/bladders/coupling=\"reciprocal_kinked\"", "/bladders/kink_width=0.01"],
    );
    let model = Model::new(&case).unwrap();
    let wet = model.wet.unwrap();
    let (laws, section) = (wet.area, model.section);
    let law = laws[0];
    let ratio = wet.bladder_length * wet.per_row as f64 / model.length;
    // g* less its elastic part, over phi_b l_b.
    let potential = |[n, m, pu, pd]: [f64; 4]| -> f64 {
        [(pu, 1.0), (pd, -1.0)]
            .into_iter()
            .map(|(p, row): (f64, f64)| 0.5 * law.per_pressure * p * p + p * (law.of_moment(m, row) + law.of_force(n)))
            .sum()
    };
    let kinks = [law.force_width, law.moment_width];
    assert_eq!(
        kinks,
        [
            0.01 * section.axial_stiffness,
            0.01 * section.bending_stiffness / model.length
        ]
    );
    for (n, m) in [(5.0, 2e-3), (-20.0, 1e-3), (3.0, -4e-3), (0.1, 1e-5)] {
        let at = [n, m, 3e3, -1e3];
        let slope = |k: usize, step: f64| {
            let (mut up, mut down) = (at, at);
            up[k] += step;
            down[k] -= step;
            (potential(up) - potential(down)) / (2.0 * step)
        };
        // Steps of 1e-3 of the kink's width: central differences err by 1e-6 of the slope's change over it.
        let stretch = wet.coupling.stretch(&laws, n, at[2], at[3]);
        close(stretch, ratio * slope(0, 1e-3 * kinks[0]), 1e-6);
        let curvature = wet.coupling.curvature(&laws, m, at[2], at[3]);
        close(curvature, ratio * slope(1, 1e-3 * kinks[1]), 1e-6);
        for (k, row) in [(2, 1.0), (3, -1.0)] {
            close(
                law.per_pressure * at[k] + law.of_moment(m, row) + law.of_force(n),
                slope(k, 1.0),
                1e-8,
            );
        }
    }
    let published = CouplingLaw::new(
        &load("wiring-2", &[]).beam,
        load("wiring-2", &[]).bladders.as_ref().unwrap(),
    );
    // (A.24), (A.26): 100 bladders a metre, 2 MPa.
    close(published.stretch(&laws, 0.0, 3e3, 1e3), 100.0 * 0.01 * 4e3 / 2e6, 1e-15);
    close(
        published.curvature(&laws, 0.0, 3e3, 1e3),
        100.0 * 0.00381467 * 2e3 / 2e6,
        1e-12,
    );
}

/// `[E4]` Square (White, *Viscous Fluid Flow*), a wide slot, and an ellipse that is a circle.
#[test]
fn permeabilities_of_known_ducts() {
    use slcbeam::case::schema::CrossSection;
    close(duct::rectangle(2.0, 2.0), 0.0351443 * 16.0, 2e-6);
    // Edges of a slot a x b take away 0.630 b of its width.
    close(duct::rectangle(50.0, 1.0), (50.0 - 0.6302) / 12.0, 1e-5);
    let ellipse = CrossSection::Ellipse {
        semi_axis_a_m: 0.3,
        semi_axis_b_m: 0.3,
    };
    close(duct::permeability(&ellipse), duct::circle(0.3), 1e-14);
    close(
        duct::permeability(&CrossSection::Triangle { side_m: 2.0 }),
        3f64.sqrt() / 20.0,
        1e-14,
    );
}

/// `[E5]` (A.6): gravity is m g in N/m, a contact load what it says.
#[test]
fn body_forces_act_on_the_mass() {
    let loads = ["/loads=[{\"gravity\": {\"x_m_s2\": 2, \"z_m_s2\": -9.81}}, {\"force_x_n_m\": {\"signal\": 7}}]"];
    let system = System::new(&load("bend-dry", &loads)).unwrap();
    let m = system.model.section.mass_per_length;
    let mut now = TimeData::new(&system);
    now.update(&system, functions::SmoothTime { t: 0.0, within: 0.0 });
    assert!(now.force.iter().all(|f| (f.x - (2.0 * m + 7.0)).abs() < 1e-14));
    assert!(now.force.iter().all(|f| (f.z + 9.81 * m).abs() < 1e-14));
}

/// `[E6]` Two half cells and a tube in series; the valve scales the tube's conductance; nothing flows when closed.
#[test]
fn a_valve_is_in_series_with_its_half_cells() {
    let (mu, lb, lc, q1b, q1c) = (8.68e-4, 0.046, 0.02, 1.55e-12, 6.72e-13);
    // Two finite volumes a bladder: half a cell is a quarter of it.
    let (half, tube) = (0.25 * mu * lb / q1b, mu * lc / q1c);
    for opening in [1.0, 0.3, 1e-9, 0.0] {
        let set = format!("/network/tubes/0/opening={opening:?}");
        let system = System::new(&load("two-bladders", &[&set])).unwrap();
        let mut now = TimeData::new(&system);
        now.update(&system, functions::SmoothTime { t: 0.0, within: 0.0 });
        let exact = if opening > 0.0 {
            1.0 / (2.0 * half + tube / opening)
        } else {
            0.0
        };
        // A valve that never opens is no link.
        close(now.conductance.first().copied().unwrap_or(0.0), exact, 1e-13);
    }
}

/// A valve with numbers of all sizes.
const VALVE: CheckValveLaw = CheckValveLaw {
    cracking_pressure: 20.0,
    forward: 1e-9,
    reverse: 1e-13,
    width: 5.0,
};

/// `[E7]` No flow without a drop, never against it; forward slope beyond opening, reverse slope below cracking.
#[test]
fn check_valves_are_passive() {
    assert_eq!(VALVE.flow(0.0), 0.0);
    for k in -400..=400 {
        let drop = f64::from(k);
        assert!(VALVE.flow(drop) * drop >= 0.0, "{drop}");
        assert!(VALVE.flow(drop + 1.0) > VALVE.flow(drop), "{drop}");
    }
    close(VALVE.flow(1001.0) - VALVE.flow(1000.0), VALVE.forward, 1e-9);
    close(VALVE.flow(-1000.0) - VALVE.flow(-1001.0), VALVE.reverse, 1e-6);
}

/// `[E10]`, `[E18]` The turbine's drop solves the bridge, has one sign for both signs of d, and no more than |d|.
#[test]
fn a_bridge_rectifies() {
    let conductance = 2.676e-10;
    let turbine = |d: f64| {
        let excess = |w: f64| {
            let (forward, backward) = bridge_drops(d, w);
            VALVE.flow(forward) + VALVE.flow(backward) - conductance * w
        };
        let (mut low, mut high) = (0.0, d.abs());
        assert!(excess(low) >= 0.0 && excess(high) <= 0.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        low
    };
    for d in [1.0, 40.0, 100.0, 5000.0] {
        let w = turbine(d);
        assert!((w - turbine(-d)).abs() < 1e-9 * d && (0.0..=d).contains(&w), "{d} {w}");
        let (forward, backward) = bridge_drops(d, w);
        // Around either loop: valve, turbine, valve.
        close(2.0 * forward + w, d, 1e-12);
        close(2.0 * backward + w, -d, 1e-12);
    }
    // Far beyond cracking the bridge is two valves and the turbine in series, less two cracking pressures.
    let d = 1e6;
    let series = 1.0 / (2.0 / VALVE.forward + 1.0 / conductance);
    close(
        turbine(d) * conductance,
        series * (d - 2.0 * VALVE.cracking_pressure),
        1e-3,
    );
}

/// A wet system and a state with areas, means and displacements of some size.
fn wet_state() -> (System, Vec<f64>) {
    let system = System::new(&load(
        "ring-network",
        &[
            "/bladders/coupling={\"published\": {\"slope_per_pressure_rad\": 0.0038, \"length_per_pressure_m\": 0.01}}",
            // flow in tubes creeps
            r#"/formulation="published""#,
        ],
    ))
    .unwrap();
    let y = (0..system.layout.len)
        .map(|k| system.layout.scales[k] * (1.7 * k as f64).sin())
        .collect();
    (system, y)
}

/// `[E8]` Area change = a_p p + R A_M(Mbar) + A_N(Nbar), in each cell of each row.
#[test]
fn pressures_give_back_their_areas() {
    let (system, y) = wet_state();
    let w = evaluated(&system, &y);
    let (wet, fluid) = (system.model.wet.as_ref().unwrap(), system.fluid.as_ref().unwrap());
    for bladder in 0..fluid.bladders {
        let (j, row) = if bladder < wet.per_row {
            (bladder, 1.0)
        } else {
            (bladder - wet.per_row, -1.0)
        };
        let law = wet.area_of(bladder);
        let imposed = law.of_moment(w.coupling.mean_moment[j], row) + law.of_force(w.coupling.mean_force[j]);
        for cell in fluid.cells_of(bladder) {
            let size = w.fluid.area[cell].abs() + imposed.abs();
            assert!((law.per_pressure * w.fluid.pressure[cell] + imposed - w.fluid.area[cell]).abs() < 1e-14 * size);
        }
    }
}

/// `[E9]` In a ring, what leaves a cell enters its perturbed: flows by hand, and their sum is zero.
#[test]
fn flows_follow_pressures_and_lose_nothing() {
    let (system, y) = wet_state();
    let w = evaluated(&system, &y);
    let fluid = system.fluid.as_ref().unwrap();
    // The ring is the upper row: cells one after the other, tubes between bladders.
    let cells = fluid.cells_per_bladder * system.mesh.segments;
    let inside = 1.55e-12 / (8.68e-4 * fluid.ds);
    let between = 1.0 / (1.0 / inside + 8.68e-4 * 0.02 / 6.72e-13);
    let flow = |cell: usize| {
        let tube = (cell + 1).is_multiple_of(fluid.cells_per_bladder);
        (if tube { between } else { inside }) * (w.fluid.pressure[cell] - w.fluid.pressure[(cell + 1) % cells])
    };
    let size = (0..cells).map(|c| flow(c).abs()).fold(0.0, f64::max);
    for cell in 0..cells {
        let exact = flow((cell + cells - 1) % cells) - flow(cell);
        assert!((w.fluid.inflow[cell] - exact).abs() < 1e-13 * size, "cell {cell}");
    }
    assert!(w.fluid.inflow.iter().sum::<f64>().abs() < 1e-13 * size);
}

/// A dry clamped beam whose nodes lie on a circle of curvature `kappa`, chord by chord.
fn circle(kappa: f64) -> (System, Workspace<f64>) {
    let system = System::new(&load("roll-up", &["/formulation=\"conservative\""])).unwrap();
    let (mesh, l) = (&system.mesh, &system.layout);
    let mut y = vec![0.0; l.len];
    let (mut x, mut z) = (0.0, 0.0);
    for cell in 0..mesh.cells {
        let angle = -kappa * mesh.cell_coordinate(cell);
        x += mesh.shortest * angle.sin();
        z += mesh.shortest * angle.cos();
        // The clamped root is no unknown.
        y[l.lines[0].u.start + cell] = x;
        y[l.lines[1].u.start + cell] = z - mesh.node_coordinate(cell + 1);
    }
    let w = evaluated(&system, &y);
    (system, w)
}

/// `[E11]` Chords of length h at angles that grow by κ h: stretch one, curvature κ everywhere, many turns or few.
#[test]
fn a_circle_has_one_curvature() {
    for kappa in [0.0, 5.0, -60.0, 200.0] {
        let (system, w) = circle(kappa);
        let last = system.mesh.nodes - 1;
        assert!(w.shape.strain.iter().all(|e| e.abs() < 1e-12));
        // Round-off of an angle over h.
        let error = 1e-13 / system.mesh.shortest + 1e-12 * kappa.abs();
        assert!(
            w.shape.kappa[..last].iter().all(|k| (k - kappa).abs() < error),
            "{kappa}: {:?}",
            &w.shape.kappa
        );
    }
}

/// `[E12]` On the circle M = EI κ, N = 0, and no shear but beside the free tip, whose moment is given as zero.
#[test]
fn a_circle_has_one_moment_and_no_shear() {
    let kappa = 20.0;
    let (system, w) = circle(kappa);
    let (ei, ea, last) = (
        system.model.section.bending_stiffness,
        system.model.section.axial_stiffness,
        system.mesh.cells,
    );
    for i in 0..last {
        close(w.forces.moment[i], ei * kappa, 1e-10);
    }
    assert_eq!(w.forces.moment[last], 0.0);
    for c in 0..last - 1 {
        assert!(
            w.forces.normal[c].abs() < 1e-12 * ea && w.forces.shear[c].abs() < 1e-9 * ei * kappa / system.mesh.shortest
        );
    }
    close(w.forces.shear[last - 1], ei * kappa / system.mesh.shortest, 1e-9);
}

/// `[E16]` Weights of each segment's mean sum to one, and act back on a node as the mean of the segments beside it.
#[test]
fn means_weigh_as_their_transpose() {
    let (system, y) = wet_state();
    let mesh = &system.mesh;
    let sum: f64 = (0..=mesh.cells_per_segment).map(|i| mesh.moment_weight(i)).sum();
    close(sum, 1.0, 1e-15);
    let w = evaluated(&system, &y);
    for node in 0..mesh.nodes {
        // Σ_j (w_ji l_seg/h_i) alpha_p,j over the segments that hold the node.
        let mut transposed = 0.0;
        for j in 0..mesh.segments {
            let first = j * mesh.cells_per_segment;
            if (first..=first + mesh.cells_per_segment).contains(&node) {
                let weight = mesh.moment_weight(node - first) * mesh.segment_lengths[j] / mesh.node_lengths[node];
                transposed += weight * w.coupling.pressure_curvature[j];
            }
        }
        close(
            residual::bending::pressure_curvature(&system, &w, node),
            transposed,
            1e-12,
        );
    }
}

/// `[E20]` Two equal bladders and one tube: pressures meet with R C/2, R the tube and two half bladders.
#[test]
fn two_bladders_relax_in_half_their_time() {
    let wet = Model::new(&load("two-bladders", &[])).unwrap().wet.unwrap();
    let times: Vec<f64> = relaxation_times::times(&wet).into_iter().flatten().collect();
    let resistance = 8.68e-4 * (0.046 / 1.55e-12 + 0.02 / 6.72e-13);
    assert_eq!(times.len(), 1);
    close(times[0], 0.5 * resistance * 1.75e-10 * 0.046, 1e-10);
}

/// `[E21]` Ratios by hand for the paper's numbers; the reciprocal coupling has nothing to complain of.
#[test]
fn the_audit_of_the_papers_coupling() {
    let finding = |case: &Case, name: &str| {
        audit::coupling(case, &Model::new(case).unwrap())
            .into_iter()
            .find(|f| f.name == name)
            .map(|f| (f.value, f.good))
    };
    let published = load("wiring-2", &[]);
    let (moment, good) = finding(&published, "l_b am E/psi'").unwrap();
    close(moment, 0.046 * 0.5 * (3.75e-6 + 6.54e-6) * 2e6 / 0.00381467, 1e-12);
    assert!(!good);
    close(
        finding(&published, "l_b an E/zeta'").unwrap().0,
        0.046 * 0.5 * (3.64e-8 + 6.31e-8) * 2e6 / 0.01,
        1e-12,
    );
    let reciprocal = load("wiring-2", &["/bladders/coupling=\"reciprocal\""]);
    assert_eq!(finding(&reciprocal, "l_b am E/psi'"), None);
    assert!(
        audit::coupling(&reciprocal, &Model::new(&reciprocal).unwrap())
            .iter()
            .all(|f| f.good)
    );
}

/// Balances of a short run of a case with everything in it, bent so far (a quarter of its length) that the published form's
/// own work is ten times the residual.
fn balances(formulation: &str, coupling: &str, rtol: f64) -> Balances {
    let sets = [
        format!("/formulation={formulation:?}"),
        format!("/bladders/coupling={coupling}"),
        format!("/solver/rtol={rtol:e}"),
        "/solver/max_order=2".into(),
        // wide enough for the kinked potential to stay convex under this load
        format!("/bladders/kink_width={}", if coupling.contains("kinked") { 0.5 } else { 0.01 }),
        "/time={\"end_s\": 0.02, \"output_interval_s\": 0.001}".into(),
        "/loads/0={\"force_x_n_m\": {\"signal\": {\"sine\": {\"amplitude\": 3000, \"frequency_hz\": 40, \"ramp_cycles\": 1}}}}".into(),
    ];
    let case = load("network-tour", &sets.iter().map(String::as_str).collect::<Vec<_>>());
    let outcome = dynamics::run(&case, &mut Memory::default()).unwrap();
    assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.summary.reason);
    outcome.summary.balances
}

/// `[E13]`, `[E14]`, `[E15]`, `[E17]`, `[E19]` Energy, volume, momentum and angular momentum close but for the error of the
/// integrator, which falls with its tolerance; a wrong term in forces or powers would leave a residual that does not.
#[test]
fn balances_close_for_every_formulation_and_coupling() {
    let published = "{\"published\": {\"slope_per_pressure_rad\": 0.3, \"length_per_pressure_m\": 0.004}}";
    for formulation in ["conservative", "published"] {
        for coupling in ["\"reciprocal\"", "\"reciprocal_kinked\"", published] {
            let all = |b: Balances| {
                [
                    b.energy_residual_relative,
                    b.volume_residual_relative,
                    b.momentum_residual_relative,
                    b.angular_momentum_residual_relative,
                ]
            };
            let (rough, fine) = (
                all(balances(formulation, coupling, 1e-5)),
                all(balances(formulation, coupling, 1e-9)),
            );
            println!("{formulation} {coupling}: {rough:?} {fine:?}");
            for (rough, fine) in rough.into_iter().zip(fine) {
                // Order 2: the error of the run falls by 10^(4 2/3); momentum, which Newton's iteration alone leaves open, by a hundred.
                assert!(
                    fine < 2e-5 && (fine < 0.02 * rough || fine < 1e-9),
                    "{formulation} {coupling}: {rough:.1e} {fine:.1e}"
                );
            }
        }
    }
}

/// The smoothed kink and its two derivatives belong together.
#[test]
fn the_kink_is_smooth() {
    let width = 0.1;
    for x in [-1.0, -0.05, 0.0, 0.02, 3.0] {
        let step = 1e-5;
        let slope = (bladder::kink(x + step, width) - bladder::kink(x - step, width)) / (2.0 * step);
        assert!((bladder::kink_slope(x, width) - slope).abs() < 1e-7);
        let bend: f64 = (bladder::kink_slope(x + step, width) - bladder::kink_slope(x - step, width)) / (2.0 * step);
        assert!((bladder::kink_curvature(x, width) - bend).abs() < 1e-5);
    }
    let law = |w: &AreaLaw| (w.moment_half_difference, w.force_half_difference);
    let wet = Model::new(&load("wiring-2", &["/bladders/coupling=\"reciprocal\""]))
        .unwrap()
        .wet
        .unwrap();
    assert_eq!(
        law(&wet.area[0]),
        (0.0, 0.0),
        "the reciprocal coupling takes mean slopes"
    );
}

/// `[E22]` A root on its way, unknowns zero: every node goes with it, and nothing is strained, to the last digit but the
/// round-off of coordinates. Two ends driven apart stretch the beam evenly.
#[test]
fn a_rigid_motion_leaves_the_unknowns_alone() {
    let at = |sets: &[&str]| {
        let system = System::new(&load("wiring-2", sets)).unwrap();
        let mut now = TimeData::new(&system);
        now.update(&system, functions::SmoothTime { t: 0.0123, within: 0.0 });
        let mut w = Workspace::new(&system);
        let zero = vec![0.0; system.layout.len];
        residual::evaluate(&system, &now, &zero, &zero, &mut w);
        (
            w,
            [0, 1].map(|end| now.ends[end].u[1].unwrap_or_default()),
            system.model.section.axial_stiffness,
        )
    };
    let (w, [root, _], stiffness) = at(&[]);
    assert!(root.value.abs() > 0.01 && root.rate.abs() > 0.01);
    for node in 0..w.motion.u.len() {
        assert_eq!(
            (w.motion.u[node].z, w.motion.v[node].z, w.motion.a[node].z),
            (root.value, root.rate, root.acceleration)
        );
    }
    assert!(
        w.forces.normal.iter().all(|n| n.abs() < 1e-12 * stiffness),
        "{:?}",
        w.forces.normal
    );

    let pulled = r#"/ends/tip={"clamped": {"u3_m": {"sine": {"amplitude": 0.002, "frequency_hz": 5}}}}"#;
    let (w, [root, tip], stiffness) = at(&[pulled]);
    let force = stiffness * (tip.value - root.value) / 0.1;
    for &n in &w.forces.normal {
        close(n, force, 1e-9);
    }
}

/// `[E22]` Where a root's velocity jumps the unknowns are restated: every free node stays where it is and as fast as it is.
#[test]
fn a_jerk_leaves_free_nodes_alone() {
    let zigzag = r#"/ends/root={"clamped": {"u3_m": {"table": {"times_s": [0, 0.1, 0.2], "values": [0, 0.01, 0.005], "interpolation": "linear"}}}}"#;
    let system = System::new(&load("wiring-2", &[zigzag])).unwrap();
    let (layout, last) = (system.layout.clone(), system.mesh.nodes - 1);
    let mut dae = BeamDae::new(system);
    let mut y: Vec<f64> = (0..layout.len).map(|k| 1e-3 * (k as f64).sin()).collect();
    let rates = vec![0.0; layout.len];
    let look = |dae: &mut BeamDae, y: &[f64]| {
        let (_, _, w) = dae.evaluate(0.1, y, &rates);
        (w.motion.u.clone(), w.motion.v.clone())
    };
    dae.enter_smooth_interval(0.05);
    let (u, v) = look(&mut dae, &y);
    dae.switch(0.1, 0.15, &mut y);
    let (u_after, v_after) = look(&mut dae, &y);
    close(v[0].z, 0.1, 1e-9);
    close(v_after[0].z, -0.05, 1e-9);
    for node in 1..=last {
        close(u_after[node].z, u[node].z, 1e-12);
        close(v_after[node].z, v[node].z, 1e-12);
    }
}
