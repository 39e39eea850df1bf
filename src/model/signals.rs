//! Iteration over all signals of a model, and their replacement.

use super::{AmbientFluid, AttachedBody, DistributedLoad, FrameRotation, Model, ResolvedNetwork};
use crate::case::{ResolvedEnd, Rotation, Translation};
use crate::functions::{Jet, Signal, SmoothTime};

impl Model {
    /// Replaces all signals: those of valves by `opening`; those of ends, loads, streams, a frame, ports, sources and pumps
    /// by `load`.
    pub fn replace_signals(&mut self, load: impl Fn(&Signal) -> Signal, opening: impl Fn(&Signal) -> Signal) {
        self.each_signal_mut(|signal, valve| *signal = if valve { opening(signal) } else { load(signal) });
    }

    /// Visits every signal, always in the same order; the flag is true for a valve.
    pub fn each_signal_mut(&mut self, mut visit: impl FnMut(&mut Signal, bool)) {
        let mut replace = |signal: &mut Signal| visit(signal, false);
        for end in &mut self.ends {
            for motion in [&mut end.transverse, &mut end.axial] {
                match motion {
                    Translation::Displacement(s) | Translation::Force(s) => replace(s),
                }
            }
            match &mut end.rotation {
                Rotation::Slope(s) | Rotation::Moment(s) => replace(s),
            }
            if let Some(follower) = &mut end.follower {
                replace(&mut follower.normal);
                replace(&mut follower.shear);
            }
        }
        self.loads.iter_mut().for_each(|load| replace(&mut load.signal));
        self.structure
            .iter_mut()
            .for_each(|structure| replace(&mut structure.rest));
        let forces = self
            .attachments
            .iter_mut()
            .flat_map(|attachment| &mut attachment.forces);
        forces.for_each(|force| replace(&mut force.signal));
        let stream = self.surroundings.as_mut().and_then(|around| around.stream.as_mut());
        stream.into_iter().flatten().for_each(&mut replace);
        self.frame
            .iter_mut()
            .for_each(|frame| replace(&mut frame.angular_velocity));
        if let Some(wet) = &mut self.wet {
            let network = &mut wet.network;
            network.ports.iter_mut().for_each(|port| replace(&mut port.pressure));
            let sources = network.sources.iter_mut();
            sources.for_each(|source| replace(source.feed.signal_mut()));
            let pumps = network.links.iter_mut().filter_map(|link| link.pump.as_mut());
            pumps.for_each(|pump| replace(&mut pump.pressure));
            network.gravity.iter_mut().for_each(replace);
            let valves = network.links.iter_mut().filter_map(|link| link.opening.as_mut());
            valves.for_each(|signal| visit(signal, true));
        }
    }

    /// Fixes every signal at its value at an instant [s].
    pub fn freeze(&mut self, t: f64) {
        let at = |signal: &Signal| Signal::Constant(signal.jet(SmoothTime { t, within: t }).value);
        self.replace_signals(at, at);
    }

    /// Value and derivatives of a signal; derivatives are 0 in a still model.
    pub fn jet(&self, signal: &Signal, clock: SmoothTime) -> Jet {
        match signal.jet(clock) {
            moving if !self.still => moving,
            Jet { value, .. } => Jet::constant(value),
        }
    }

    /// Visits all signals of the model.
    pub fn each_signal(&self, visit: impl FnMut(&Signal)) {
        each_signal(
            &self.ends,
            &self.loads,
            &self.attachments,
            self.surroundings.as_ref(),
            self.frame.as_ref(),
            self.wet.as_ref().map(|wet| &wet.network),
            visit,
        );
    }
}

/// Visits all signals: of ends, loads, attachments, a stream, a frame, valves, ports, sources and pumps.
pub fn each_signal(
    ends: &[ResolvedEnd],
    loads: &[DistributedLoad],
    attachments: &[AttachedBody],
    around: Option<&AmbientFluid>,
    frame: Option<&FrameRotation>,
    network: Option<&ResolvedNetwork>,
    mut visit: impl FnMut(&Signal),
) {
    for end in ends {
        for motion in [&end.transverse, &end.axial] {
            match motion {
                Translation::Displacement(s) | Translation::Force(s) => visit(s),
            }
        }
        match &end.rotation {
            Rotation::Slope(s) | Rotation::Moment(s) => visit(s),
        }
        if let Some(follower) = &end.follower {
            visit(&follower.normal);
            visit(&follower.shear);
        }
    }
    for load in loads {
        visit(&load.signal);
    }
    for force in attachments.iter().flat_map(|attachment| &attachment.forces) {
        visit(&force.signal);
    }
    let stream = around.and_then(|around| around.stream.as_ref());
    stream.into_iter().flatten().for_each(&mut visit);
    frame.iter().for_each(|frame| visit(&frame.angular_velocity));
    if let Some(network) = network {
        network
            .links
            .iter()
            .filter_map(|l| l.opening.as_ref())
            .for_each(&mut visit);
        network.ports.iter().map(|p| &p.pressure).for_each(&mut visit);
        network.sources.iter().map(|s| s.feed.signal()).for_each(&mut visit);
        let pumps = network.links.iter().filter_map(|link| link.pump.as_ref());
        pumps.map(|pump| &pump.pressure).for_each(&mut visit);
        network.gravity.iter().for_each(&mut visit);
    }
}
