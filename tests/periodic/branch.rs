//! Branches of cycles through folds, compared with closed forms.

use std::f64::consts::TAU;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::floquet::{self, CycleStability};
use slcbeam::run::periodic::{PeriodicScene, shoot};
use slcbeam::run::stop::StopFlag;
use slcbeam::study::evaluations::Evaluations;
use slcbeam::study::stability::special_points::SpecialKind;
use slcbeam::study::stability::{CycleMember, CyclePath, MemberKind, PathRequest, along};

/// Height of the strip [m].
const HEIGHT: f64 = 1e-3;
/// Backbone of a clamped-clamped rectangle with fixed ends: ω/ω₀ = 1 + 0.269735 (a/h)².
const BACKBONE: f64 = 0.269735;

/// A clamped-clamped strip under a uniform force per length [N/m] at a frequency [Hz].
fn strip(force: f64, frequency: f64) -> Case {
    let sine = json!({"sine": {"amplitude": force, "frequency_hz": frequency}});
    let text: Value = json!({
        "name": "strip",
        "beam": {"length_m": 0.1, "height_m": HEIGHT, "width_m": 0.01, "young_modulus_pa": 2e6, "density_kg_m3": 1000,
                 "damping": {"drag_n_s_m2": 0.00058}},
        "loads": [{"force_x_n_m": {"signal": sine}}],
        "ends": {"root": "clamped", "tip": "clamped"},
        "formulation": "conservative",
        "effects": {"finite_rotation": "off", "axial_inertia": "off", "rotary_inertia": "off"},
        "mesh": {"segments": 12, "cells_per_segment": 1},
        "time": {"end_s": 1}
    });
    case::parse(&text.to_string(), "strip.json".as_ref(), ".".as_ref(), &[]).unwrap()
}

fn amplitude(member: &CycleMember) -> f64 {
    member.quantities["midspan_u1_m"].window_max_abs.unwrap()
}

/// Cycles of the strip at frequencies [Hz].
fn sweep(force: f64, frequencies: &[f64]) -> CyclePath {
    let cases: Vec<_> = frequencies.iter().map(|f| (*f, strip(force, *f))).collect();
    let request = PathRequest {
        pointer: "/loads/0/force_x_n_m/signal/sine/frequency_hz",
        logarithmic: false,
        cases: &cases,
        case_at: &|frequency| Ok(strip(force, frequency)),
    };
    along(&request, &Evaluations::default(), &StopFlag::default(), &|_| {}).unwrap()
}

/// Slow flow of a Duffing oscillator at the detuning σ [1/s], with decay d and F = f/(2 ω₀) in units of the amplitude:
/// `u ((σ - κ u)² + d²) = F²`, u = a². Folds are where `(σ - κ u)(σ - 3 κ u) + d² = 0`.
struct SlowFlow {
    frequency: f64,
    decay: f64,
    kappa: f64,
    /// Amplitude of resonance per unit of force.
    gain: f64,
}

impl SlowFlow {
    /// From a cycle at a small force.
    fn new() -> Self {
        let small = 1e-9;
        let found = sweep(small, &[4.0]);
        let multipliers = &found.members[0].floquet.multipliers;
        let first = multipliers
            .iter()
            .min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz))
            .unwrap();
        let decay = -first.growth_per_s;
        let frequency = (first.frequency_hz * TAU).hypot(decay) / TAU;
        let peak = sweep(small, &[frequency]);
        Self {
            frequency,
            decay,
            kappa: BACKBONE * frequency * TAU / HEIGHT.powi(2),
            gain: amplitude(&peak.members[0]) / small,
        }
    }

    /// Force at which the two folds meet: that of the peak `κ a² = 8 d/(3 √3)`, which is `f² = 256 d³/(9 √3 g)` with `κ = 3 g/(8 ω₀)`.
    fn threshold(&self) -> f64 {
        (8.0 * self.decay / (27.0_f64.sqrt() * self.kappa)).sqrt() / self.gain
    }

    /// Frequencies [Hz] of the folds, the upper one first.
    fn folds(&self, force: f64) -> [f64; 2] {
        let peak = force * self.gain;
        // beyond F² = 2 d³/κ each branch of the condition of the folds, σ = 2 κ u ± √(κ² u² - d²), meets the curve once; F = f/(2 ω)
        [-1.0, 1.0].map(|sign| {
            let sigma = |u: f64| 2.0 * self.kappa * u + sign * ((self.kappa * u).powi(2) - self.decay.powi(2)).sqrt();
            let at_resonance = |u: f64| peak / (1.0 + sigma(u) / (TAU * self.frequency));
            let open = |u: f64| {
                u * ((sigma(u) - self.kappa * u).powi(2) + self.decay.powi(2)) - (at_resonance(u) * self.decay).powi(2)
            };
            let (mut low, mut high) = (self.decay / self.kappa, peak * peak);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if open(middle) * open(low) > 0.0 {
                    low = middle
                } else {
                    high = middle
                }
            }
            self.frequency + sigma(low) / TAU
        })
    }
}

/// Frequencies [Hz] from one to another, in equal steps.
fn spread(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|k| from + (to - from) * k as f64 / (count - 1) as f64)
        .collect()
}

fn special(path: &CyclePath, kind: SpecialKind) -> Vec<&CycleMember> {
    let of_kind = |m: &&CycleMember| m.special.is_some_and(|special| special.kind == kind);
    path.members.iter().filter(of_kind).collect()
}

/// Source: backbone of a clamped-clamped rectangle with fixed ends, ω/ω₀ = 1 + 0.269735 (a/h)², and the slow flow of a Duffing
/// oscillator. Goal: at three times the force of the threshold the upper fold is on the backbone and the lower one where the slow flow
/// says; a value between the folds has three cycles, the middle one unstable. Tolerance: the mesh error of the membrane force, 2 % at 12
/// cells (1 % at 24), and terms of higher order in the relative detuning of 1.4 %.
#[test]
fn a_hardening_beam_folds_where_its_backbone_says() {
    let flow = SlowFlow::new();
    let force = 3.0 * flow.threshold();
    let frequencies = spread(flow.frequency - 0.01, flow.frequency + 0.11, 7);
    let path = sweep(force, &frequencies);
    assert_eq!(path.missing, []);
    let folds = special(&path, SpecialKind::Fold);
    assert_eq!(folds.len(), 2);
    let backbone = (folds[0].value / flow.frequency - 1.0) / (BACKBONE * (amplitude(folds[0]) / HEIGHT).powi(2));
    println!("upper fold over backbone: {backbone}");
    assert!((backbone - 1.0).abs() < 0.03, "{backbone}");
    let [upper, lower] = flow.folds(force);
    for (fold, expected, tolerance) in [(folds[0], upper, 0.03), (folds[1], lower, 0.02)] {
        let (found, expected) = (fold.value - flow.frequency, expected - flow.frequency);
        println!("fold at {found} Hz above the linear frequency, slow flow {expected} Hz");
        assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected}");
        let (re, im) = fold.special.unwrap().multiplier.unwrap();
        assert!(im == 0.0 && (re - 1.0).abs() < 1e-4, "{re} {im}");
    }
    for frequency in frequencies {
        let there = path
            .members
            .iter()
            .filter(|m| m.value == frequency && m.kind == MemberKind::Requested);
        let stable: Vec<bool> = there
            .map(|m| m.floquet.verdict.stability == CycleStability::Stable)
            .collect();
        let between = (folds[1].value..folds[0].value).contains(&frequency);
        let expected = if between { vec![true, false, true] } else { vec![true] };
        assert_eq!(stable, expected, "{frequency}");
    }
}

/// Source: jump threshold of a Duffing oscillator, f² = 256 d³/(9 √3 g). Goal: no fold at 0.95 of it, and every requested frequency once, in
/// order; two folds at 1.05 of it.
#[test]
fn folds_begin_at_the_jump_threshold() {
    let flow = SlowFlow::new();
    let frequencies = spread(flow.frequency - 0.01, flow.frequency + 0.03, 5);
    let below = sweep(0.95 * flow.threshold(), &frequencies);
    assert_eq!(special(&below, SpecialKind::Fold).len(), 0);
    let requested = below.members.iter().filter(|m| m.kind == MemberKind::Requested);
    assert_eq!(requested.map(|m| m.value).collect::<Vec<_>>(), frequencies);
    let above = sweep(1.05 * flow.threshold(), &frequencies);
    assert_eq!(special(&above, SpecialKind::Fold).len(), 2);
}

/// Goal: near a resonance whose vibration builds up over tens of periods, the cycle is found from rest: that to which the motion settles.
#[test]
fn a_slow_build_up_is_simulated_until_a_cycle_is_found() {
    let drive = ["/loads/0/body_x_m_s2/signal/sine/frequency_hz=28.6".to_owned()];
    let case = case::load("cases/clamped-strip.json".as_ref(), &drive).unwrap();
    let scene = PeriodicScene::new(&case, None).unwrap();
    let mut cycle = shoot(&scene, None).unwrap();
    assert!(cycle.search.periods > 24, "{:?}", cycle.search);
    let found = floquet::multipliers(&scene, &mut cycle, 4);
    assert!(found.verdict.stability == CycleStability::Stable);
}

/// Cycles of a shipped or given case along a number.
fn along_number(pointer: &str, values: &[f64], case_at: &dyn Fn(f64) -> Case) -> CyclePath {
    let cases: Vec<_> = values.iter().map(|value| (*value, case_at(*value))).collect();
    let request = PathRequest {
        pointer,
        logarithmic: false,
        cases: &cases,
        case_at: &|value| Ok(case_at(value)),
    };
    along(&request, &Evaluations::default(), &StopFlag::default(), &|_| {}).unwrap()
}

/// Goal: shaken along harder, the paper's beam loses its stability by a period doubling; cycles 0.1 % below are stable, those above are
/// not.
#[test]
fn a_parametric_resonance_begins_at_a_period_doubling() {
    let pointer = "/ends/root/clamped/u3_m/sine/amplitude";
    let at = |value: f64| {
        let sets = ["/mesh/cells_per_segment=1".into(), format!("{pointer}={value}")];
        case::load("cases/valves-open.json".as_ref(), &sets).unwrap()
    };
    let path = along_number(pointer, &[0.02, 0.026, 0.032], &at);
    let found = special(&path, SpecialKind::PeriodDoubling);
    assert_eq!(found.len(), 1, "{path:?}");
    let value = found[0].value;
    println!("period doubling at {value} m");
    // μ + 1 has the square root of the distance, hence 0.05
    let (re, im) = found[0].special.unwrap().multiplier.unwrap();
    assert!((re + 1.0).hypot(im) < 0.05, "{re} {im}");
    for (factor, unstable) in [(0.999, false), (1.001, true)] {
        let scene = PeriodicScene::new(&at(value * factor), None).unwrap();
        let mut cycle = shoot(&scene, None).unwrap();
        let verdict = floquet::multipliers(&scene, &mut cycle, 2).verdict;
        assert_eq!(
            verdict.stability == CycleStability::Unstable,
            unstable,
            "{}",
            verdict.words
        );
    }
    let stable = |m: &CycleMember| m.floquet.verdict.stability != CycleStability::Unstable;
    let requested = path.members.iter().filter(|m| m.kind == MemberKind::Requested);
    let expected: Vec<bool> = requested.clone().map(|m| m.value < found[0].value).collect();
    assert_eq!(requested.map(stable).collect::<Vec<_>>(), expected);
}

/// Source: Beck's column flutters at the follower load 20.0509 EI/l²; drag on all modes alike does not change this load in the limit of
/// small drag. Goal: the cycle under a load with a small oscillation has a Neimark-Sacker point there, within the mesh error.
#[test]
fn a_column_under_a_follower_load_flutters_at_a_neimark_sacker_point() {
    let stiffness = 2e6 * 0.01 * HEIGHT.powi(3) / 12.0 / 0.01;
    let at = |load: f64| {
        let oscillation = json!({"sine": {"amplitude": 1e-6 * stiffness, "frequency_hz": 30}});
        let force = json!({"sum": [-load * stiffness, oscillation]});
        let text = json!({
            "name": "column",
            "beam": {"length_m": 0.1, "height_m": HEIGHT, "width_m": 0.01, "young_modulus_pa": 2e6, "density_kg_m3": 1000,
                     "damping": {"drag_n_s_m2": 0.0058}},
            "ends": {"root": "clamped", "tip": {"free": {"follower_normal_n": force}}},
            "formulation": "conservative",
            "effects": {"axial_inertia": "off", "rotary_inertia": "off"},
            "mesh": {"segments": 16, "cells_per_segment": 1},
            "time": {"end_s": 1}
        });
        case::parse(&text.to_string(), "column.json".as_ref(), ".".as_ref(), &[]).unwrap()
    };
    let path = along_number("/load", &[19.0, 20.0, 21.0], &at);
    let found = special(&path, SpecialKind::NeimarkSacker);
    assert_eq!(found.len(), 1, "{path:?}");
    println!("flutter at {} EI/l²", found[0].value);
    assert!((found[0].value / 20.0509 - 1.0).abs() < 0.025, "{}", found[0].value);
}

/// Goal: if a search from rest finds no cycle at the first value, inside a fold, the branch that begins at the next one is followed back
/// through both folds.
#[test]
fn a_branch_behind_a_value_without_a_cycle_is_followed_back() {
    let pointer = "/loads/0/body_x_m_s2/signal/sine/frequency_hz";
    let at = |frequency: f64| case::load("cases/clamped-strip.json".as_ref(), &[format!("{pointer}={frequency}")]);
    let values = [28.5, 29.0, 29.5];
    let cases: Vec<_> = values.iter().map(|value| (*value, at(*value).unwrap())).collect();
    let request = PathRequest {
        pointer,
        logarithmic: false,
        cases: &cases,
        case_at: &at,
    };
    let found = along(&request, &Evaluations::default(), &StopFlag::default(), &|_| {}).unwrap();
    let passages = |value: f64| {
        let requested = |m: &&CycleMember| m.kind == MemberKind::Requested && m.value == value;
        found.members.iter().filter(requested).count()
    };
    assert_eq!([29.0, 29.5].map(passages), [3, 1]);
    assert_eq!(passages(28.5) + found.missing.len(), 1, "{:?}", found.missing);
    let fold = |m: &&CycleMember| m.special.is_some_and(|s| s.kind == SpecialKind::Fold);
    assert_eq!(found.members.iter().filter(fold).count(), 2);
}
