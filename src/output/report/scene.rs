//! Drawing of a case: beam, rows of bladders, tubes, ports, turbines, loads, ends; lengths in meters.

use serde_json::{Value, json};

use super::signals::{describe, is_zero, peak};
use super::structure;
use crate::case::schema::{AccumulatorKind, BladderEnd, Bladders, ChainEnd, Load, Rectifier};
use crate::case::spans;
use crate::case::wiring::{PortQuantity, Wiring, WiringPoint, WiringTube};
use crate::case::{Case, ResolvedEnd, Rotation, Translation};
use crate::functions::{Profile, Signal};
use crate::model::{ContactFace, ContactLaw, ResolvedNetwork};
use crate::output::numbers::{quantity, significant, trimmed};

/// Number of places along the beam at which a load is drawn.
const PLACES: usize = 41;

/// Drawing of a case; `None` if the case has no length.
pub fn to_json(case: &Case) -> Option<Value> {
    let beam = &case.beam;
    if !(beam.length_m > 0.0 && beam.height_m > 0.0) {
        return None;
    }
    let end_s = case.time.end_s;
    let segments = spans::segments(case);
    let heights: Vec<f64> = segments.iter().map(|one| one.beam.height_m).collect();
    let height = heights.iter().copied().reduce(f64::max).unwrap_or(beam.height_m);
    // of each segment, if they differ
    let graded = !segments.is_empty();
    let both_rows = |size: fn(&Bladders) -> f64| {
        let of = |rows: &[Bladders; 2]| rows.each_ref().map(size);
        let all = segments.iter().map(|one| one.bladders.as_ref().map_or([0.0; 2], of));
        graded.then(|| all.collect::<Vec<_>>())
    };
    let volume = |b: &Bladders| format!("{} ml", significant(b.length_m * b.height_m * b.width_m * 1e6, 3));
    let mut scene = json!({
        "length": beam.length_m,
        "borders": graded.then(|| spans::segment_ends(case)),
        "height": height,
        "heights": graded.then_some(heights),
        "line": beam.line_height(),
        "width": beam.width_m,
        "size": format!(
            "{} long, {} high, {} wide",
            q(beam.length_m, "m"), q(height, "m"), q(beam.width_m, "m")
        ),
        "bladders": case.bladders.as_ref().zip(ResolvedNetwork::from_case(case).ok()?).map(|(b, network)| json!({
            "per_row": b.per_row,
            "present": (0..2 * b.per_row).map(spans::bladders(case)).collect::<Vec<_>>(),
            "heights": both_rows(|b| b.height_m),
            "widths": both_rows(|b| b.width_m),
            "length": b.length_m,
            "height": b.height_m,
            "width": b.width_m,
            "volume": volume(b),
            "volumes": graded.then(|| segments.iter().map(|one| one.bladders.as_ref().map(|rows| rows.each_ref().map(volume))).collect::<Vec<_>>()),
            "network": network.component_of_bladder,
            "outlines": case.section.as_ref().and_then(super::cell::outlines),
        })),
        "wiring": case.bladders.as_ref().and(wiring(case)),
        "ends": [end(&case.ends.root.resolve(), case.ends.root.form().0, end_s), end(&case.ends.tip.resolve(), case.ends.tip.form().0, end_s)],
        "loads": case.loads.iter().map(|l| load(l, end_s)).collect::<Vec<_>>(),
        "obstacles": ContactLaw::all(case, &segments).iter().map(obstacle).collect::<Vec<_>>(),
    });
    if case.is_structure() {
        structure::add(&mut scene, case);
    }
    Some(scene)
}

/// A wall or a circle: its face and its description.
fn obstacle(law: &ContactLaw) -> Value {
    let stiffness = match law.at {
        None => format!("all along, {}", q(law.pressing.stiffness, "Pa")),
        Some(at) => format!(
            "at {} of the length, {}",
            trimmed(&significant(at, 3)),
            q(law.pressing.stiffness, "N/m")
        ),
    };
    let lossy = [("damping", law.pressing.damping), ("friction", law.pressing.friction)];
    let lossy = lossy
        .iter()
        .filter(|(_, size)| *size > 0.0)
        .map(|(what, _)| format!(", with {what}"));
    let words = format!("“{}”: {stiffness}{}", law.name, lossy.collect::<String>());
    match law.face {
        ContactFace::Wall { point, normal } => {
            json!({"point": [point.x, point.z], "normal": [normal.x, normal.z], "words": words})
        }
        ContactFace::Circle { center, radius, side } => {
            let around = if side < 0.0 { ", around the beam" } else { "" };
            let words = format!("{words}, radius {}{around}", q(radius, "m"));
            json!({"center": [center.x, center.z], "radius": radius, "words": words})
        }
    }
}

pub fn q(x: f64, unit: &str) -> String {
    trimmed(&quantity(x, unit, 3))
}

/// Chains, tubes, ports and turbines, by indices of bladders and names of junctions.
fn wiring(case: &Case) -> Option<Value> {
    let found = Wiring::from_case(case).ok()?;
    let end_s = case.time.end_s;
    let point = |point: &WiringPoint| match *point {
        WiringPoint::Bladder(bladder, end) => json!({"bladder": bladder, "outlet": end == BladderEnd::Outlet}),
        WiringPoint::Junction(_) => json!({"junction": found.label(*point)}),
    };
    let valve = |opening: &Signal| match opening {
        Signal::Constant(o) if *o >= 1.0 => None,
        Signal::Constant(o) => Some(format!("valve open to {}", q(*o, "1"))),
        moving => Some(format!("valve, opening {}", describe(moving, "1"))),
    };
    let written = case.network.iter().flat_map(|network| &network.chains);
    let chains = written.zip(&found.chains).map(|(chain, bladders)| {
        let ends = chain.ends.iter().map(|e| match e {
            ChainEnd::Sealed => json!({"kind": "sealed"}),
            ChainEnd::Connected => json!({"kind": "connected"}),
            ChainEnd::PressurePa(p) => json!({"kind": "pressure", "words": pressure(p)}),
            ChainEnd::FlowM3S(f) => json!({"kind": "flow", "words": flow(f, end_s)}),
            ChainEnd::VolumeM3(v) => json!({"kind": "flow", "words": volume(v, end_s)}),
        });
        json!({"bladders": bladders, "ends": ends.collect::<Vec<_>>(), "valve": valve(&chain.opening)})
    });
    let within = |tube: &WiringTube| {
        let check = tube.check_valve.map(|valve| match valve.cracking_pressure_pa {
            0.0 => "check valve".to_owned(),
            cracking => format!("check valve, opens at {}", q(cracking, "Pa")),
        });
        let pump =
            tube.pump
                .and_then(|pump| Some((&pump.curve, pump.signal()?.1)))
                .map(|(curve, signal)| match curve {
                    None => format!("pump, {}", describe(signal, "Pa")),
                    Some(_) => format!("pump with a curve, factor {}", describe(signal, "1")),
                });
        let pilot = tube
            .pilot
            .map(|(_, pilot)| format!("valve, opened by {}", pilot.vessel));
        let all: Vec<String> = [valve(tube.opening), pilot, check, pump]
            .into_iter()
            .flatten()
            .collect();
        (!all.is_empty()).then(|| all.join("; "))
    };
    let tubes = found
        .tubes
        .iter()
        .map(|t| json!({"from": point(&t.points[0]), "to": point(&t.points[1]), "valve": within(t)}));
    let accumulators = found.accumulators.iter().map(|(at, one)| {
        let words = match &one.kind {
            AccumulatorKind::Elastic { compliance_m3_pa, .. } => {
                format!("accumulator, {} m³/Pa", significant(*compliance_m3_pa, 3))
            }
            AccumulatorKind::Tank { volume_m3 } => format!("tank, {}", litres(*volume_m3)),
            AccumulatorKind::Gas { volume_m3, .. } => {
                format!("accumulator, {} of gas", litres(*volume_m3))
            }
            AccumulatorKind::Curve { volume_m3, .. } => {
                let largest = volume_m3.last().copied().unwrap_or_default();
                format!("accumulator, pressure curve up to {}", litres(largest))
            }
        };
        json!({"name": one.name, "at": point(at), "kind": "accumulator", "words": words})
    });
    let ports = found.ports.iter().map(|p| {
        let (kind, words) = match p.given {
            PortQuantity::Pressure(signal) => ("pressure", pressure(signal)),
            PortQuantity::Flow(signal) => ("flow", flow(signal, end_s)),
            PortQuantity::Volume(signal) => ("flow", volume(signal, end_s)),
        };
        json!({"name": p.name, "at": point(&p.at), "kind": kind, "words": words})
    });
    let turbines = found.turbines.iter().map(|([from, to], t)| {
        json!({"name": t.name, "from": point(from), "to": point(to), "rectified": t.rectifier != Rectifier::Ideal})
    });
    Some(json!({
        "chains": chains.collect::<Vec<_>>(),
        "junctions": found.junctions,
        "tubes": tubes.collect::<Vec<_>>(),
        "ports": ports.chain(accumulators).collect::<Vec<_>>(),
        "turbines": turbines.collect::<Vec<_>>(),
    }))
}

fn pressure(signal: &Signal) -> String {
    if is_zero(signal) {
        return "open, p = 0".into();
    }
    format!("p = {}", describe(signal, "Pa"))
}

/// A volume in microliters, from 10 ml on in milliliters. The scripts of the page use the same units beside axes.
fn litres(volume_m3: f64) -> String {
    match volume_m3.abs() < 1e-5 {
        true => format!("{} µl", significant(volume_m3 * 1e9, 3)),
        false => format!("{} ml", significant(volume_m3 * 1e6, 3)),
    }
}

/// Flow through a port.
fn flow(signal: &Signal, end_s: f64) -> String {
    match signal {
        Signal::Constant(x) => format!("{}/s", litres(*x)),
        _ => format!("flow up to {}/s", litres(largest(signal, end_s))),
    }
}

/// Volume injected through a port.
fn volume(signal: &Signal, end_s: f64) -> String {
    format!("syringe, up to {}", litres(largest(signal, end_s)))
}

/// Largest magnitude of a volume or flow, computed in microliters.
fn largest(signal: &Signal, end_s: f64) -> f64 {
    let scaled = Signal::Product(vec![Signal::Constant(1e9), signal.clone()]);
    peak(&scaled, end_s).abs() * 1e-9
}

/// An end: its form, constraints, prescribed motions and loads.
pub fn end(resolved: &ResolvedEnd, form: &str, end_s: f64) -> Value {
    let driven = |signal: &Signal, unit: &str| (!is_zero(signal)).then(|| describe(signal, unit));
    let motion = |t: &Translation| match t {
        Translation::Displacement(s) => driven(s, "m"),
        Translation::Force(_) => None,
    };
    let force = |t: &Translation| match t {
        Translation::Force(s) => driven(s, "N").map(|w| json!({"words": w, "sign": peak(s, end_s).signum()})),
        Translation::Displacement(_) => None,
    };
    let held = |t: &Translation| matches!(t, Translation::Displacement(_));
    let (slope, moment) = match &resolved.rotation {
        Rotation::Slope(s) => (driven(s, "rad"), None),
        Rotation::Moment(s) => (None, driven(s, "N m")),
    };
    let follower = resolved.follower.as_ref().map(|f| {
        let normal = driven(&f.normal, "N").map(|w| format!("along the end: {w}"));
        let shear = driven(&f.shear, "N").map(|w| format!("across the end: {w}"));
        normal.into_iter().chain(shear).collect::<Vec<_>>().join("; ")
    });
    json!({
        "form": form,
        "held": {
            "across": held(&resolved.transverse), "along": held(&resolved.axial),
            "slope": matches!(resolved.rotation, Rotation::Slope(_)),
        },
        "moves": {"across": motion(&resolved.transverse), "along": motion(&resolved.axial), "slope": slope},
        "force": {"across": force(&resolved.transverse), "along": force(&resolved.axial)},
        "moment": moment,
        "follower": follower.filter(|f| !f.is_empty()),
    })
}

/// A load with its shape along the beam, scaled to 1.
pub fn load(load: &Load, end_s: f64) -> Value {
    let Some((name, distributed)) = load.distributed() else {
        let Load::Gravity { x_m_s2, z_m_s2 } = load else {
            return Value::Null;
        };
        let size = q(x_m_s2.hypot(*z_m_s2), "m/s^2").replace("^2", "²");
        return json!({"kind": "gravity", "x": x_m_s2, "z": z_m_s2, "words": format!("gravity {size}")});
    };
    let [kind, what, unit] = words_of(name);
    let sign = match peak(&distributed.signal, end_s) {
        p if p < 0.0 => -1.0,
        _ => 1.0,
    };
    let values: Vec<f64> = (0..PLACES)
        .map(|k| sign * distributed.profile.value(k as f64 / (PLACES - 1) as f64))
        .collect();
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let shape = match &distributed.profile {
        Profile::Constant(x) if *x == 1.0 => "",
        _ => ", its shape along the beam as drawn",
    };
    let scaled: Vec<f64> = values
        .iter()
        .map(|x| if largest > 0.0 { x / largest } else { 0.0 })
        .collect();
    json!({"kind": kind, "values": scaled, "words": format!("{what}: {}{shape}", describe(&distributed.signal, &unit.replace("^2", "²")))})
}

/// Direction of a distributed load in the drawing, its description and unit, by its name in the case.
pub fn words_of(name: &str) -> [&'static str; 3] {
    match name {
        "force_x_n_m" => ["across", "force across", "N/m"],
        "force_z_n_m" => ["along", "force along", "N/m"],
        "force_normal_n_m" => ["across", "force normal to the beam", "N/m"],
        "force_tangential_n_m" => ["along", "force tangential to the beam", "N/m"],
        "body_x_m_s2" => ["across", "body force across", "m/s^2"],
        "body_z_m_s2" => ["along", "body force along", "m/s^2"],
        "rest_curvature_1_m" => ["moment", "curvature at rest", "1/m"],
        _ => ["moment", "couple", "N"],
    }
}
