//! Bladders with their fluid and network.

use super::{
    AlongBladder, AreaLaw, Compression, CouplingLaw, EffectSet, LumpedNetwork, ResolvedNetwork, Section, Storage,
    StrainPotential, WallClosing, network, storage,
};
use crate::case::schema::{Bladders, Case, Effect};
use crate::case::spans::{self, SegmentValues};
use crate::case::wiring::BladderLabels;
use crate::numerics::Scalar;

/// Laws of the bladders of one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentLaw {
    /// Area changes of the cells of an upper and of a lower bladder; slopes of omitted effects are zero.
    pub area: [AreaLaw; 2],
    /// `a_x`: area of each bladder per pressure of the other one [m^2/Pa]; zero unless both exist.
    pub per_other_pressure: f64,
    /// Slopes by which pressure strains the beam; those of omitted effects are zero.
    pub strains: [AreaLaw; 2],
    /// Strains caused by pressure.
    pub coupling: CouplingLaw,
    /// `φ_b l_b` [1].
    pub length_ratio: f64,
    /// Permeability of both bladders over that of [`ResolvedNetwork::bladder_mobility`].
    pub mobility_ratio: [f64; 2],
    /// Inertia along both bladders; none if omitted.
    pub along: [Option<AlongBladder>; 2],
}

impl SegmentLaw {
    fn new(case: &Case, values: &SegmentValues, usual: &Bladders, section: &Section, asymmetry: bool) -> Self {
        let rows = values.bladders.as_ref().map_or([usual; 2], |rows| rows.each_ref());
        let area = rows.map(|bladders| AreaLaw::new(case, bladders, section, asymmetry));
        let usual = network::bladder_permeability(usual);
        let along = |bladders| case.fluid.as_ref().and_then(|fluid| AlongBladder::new(bladders, fluid));
        Self {
            area,
            per_other_pressure: match values.rows {
                [true, true] => rows[0].area_per_other_pressure_m2_per_pa,
                _ => 0.0,
            },
            strains: area,
            coupling: CouplingLaw::new(&values.beam, rows[0]),
            length_ratio: rows[0].length_m * rows[0].per_row as f64 / values.beam.length_m,
            mobility_ratio: rows.map(|bladders| network::bladder_permeability(bladders) / usual),
            along: rows.map(along),
        }
    }
}

/// Bladders with their fluid and network.
#[derive(Clone, Debug)]
pub struct Wet {
    /// Bladders in a row, `n/2`.
    pub per_row: usize,
    /// Labels of the bladders in texts.
    pub labels: BladderLabels,
    /// Length `l_b` of a bladder [m].
    pub bladder_length: f64,
    /// Area changes of the cells of an upper and of a lower bladder; slopes of omitted effects are zero.
    pub area: [AreaLaw; 2],
    /// `a_x`: area of a bladder per pressure of the other one of its segment [m^2/Pa].
    pub per_other_pressure: f64,
    /// Contact between the walls of a bladder; none if omitted.
    pub closing: Option<WallClosing>,
    /// Compression of the fluid; none for incompressible fluid.
    pub compression: Option<Compression>,
    /// Slopes by which pressure strains the beam; those of omitted effects are zero.
    pub strains: [AreaLaw; 2],
    /// Strains caused by pressure.
    pub coupling: CouplingLaw,
    /// Laws of the segments of a beam with spans or with unlike rows, of which `area`, `strains` and `coupling` are those of the case; empty for a uniform
    /// beam.
    pub segments: Vec<SegmentLaw>,
    /// Tubes, junctions, ports, turbines.
    pub network: ResolvedNetwork,
    /// True if fluid flows.
    pub flows: bool,
    /// Storage law of each bladder.
    pub storage: Vec<Storage>,
    /// Groups of bladders with a common pressure.
    pub lumped: Vec<LumpedNetwork>,
    /// True if a law depends on mean moments, which are then unknowns.
    pub takes_moments: bool,
    /// True if a law depends on mean forces, which are then unknowns.
    pub takes_forces: bool,
    /// Energy of the section beyond its quadratic part.
    pub strain_energy: Option<StrainPotential>,
}

/// `R` of the rows: upper, lower.
pub const ROWS: [f64; 2] = [1.0, -1.0];

impl Wet {
    /// The bladders of a segment: upper, lower.
    pub fn pair(&self, segment: usize) -> [usize; 2] {
        [segment, self.per_row + segment]
    }

    /// Segment of a bladder, and 0 for the upper row, 1 for the lower one.
    #[inline]
    fn segment_and_row(&self, bladder: usize) -> (usize, usize) {
        match bladder.checked_sub(self.per_row) {
            None => (bladder, 0),
            Some(segment) => (segment, 1),
        }
    }

    /// Segment and row `R` of a bladder.
    #[inline]
    pub fn place(&self, bladder: usize) -> (usize, f64) {
        let (segment, row) = self.segment_and_row(bladder);
        (segment, ROWS[row])
    }

    /// True for the rows that have a bladder: upper, lower.
    pub fn rows(&self) -> [bool; 2] {
        let mut rows = self.storage.chunks(self.per_row.max(1));
        [0, 1].map(|_| {
            rows.next()
                .is_some_and(|row| row.iter().any(|one| *one != Storage::Absent))
        })
    }

    /// `φ_b l_b` for a beam length.
    pub fn length_ratio(&self, length: f64) -> f64 {
        self.bladder_length * self.per_row as f64 / length
    }

    /// `φ_b l_b` of a segment, for a beam length.
    pub fn length_ratio_of(&self, segment: usize, length: f64) -> f64 {
        let own = self.segments.get(segment);
        own.map_or_else(|| self.length_ratio(length), |law| law.length_ratio)
    }

    /// Area law of a bladder.
    #[inline]
    pub fn area_of(&self, bladder: usize) -> &AreaLaw {
        let (segment, row) = self.segment_and_row(bladder);
        &self.areas_of(segment)[row]
    }

    /// Area laws of a segment's bladders.
    pub fn areas_of(&self, segment: usize) -> &[AreaLaw; 2] {
        self.segments.get(segment).map_or(&self.area, |law| &law.area)
    }

    /// Strains of a segment by pressure, and their slopes.
    #[inline]
    pub fn strains_of(&self, segment: usize) -> (&CouplingLaw, &[AreaLaw; 2]) {
        let own = self.segments.get(segment);
        own.map_or((&self.coupling, &self.strains), |law| (&law.coupling, &law.strains))
    }

    /// Cross-section of a bladder at rest [m^2].
    pub fn area_at_rest_of(&self, bladder: usize) -> f64 {
        self.area_of(bladder).at_rest
    }

    /// Permeability of a bladder over that of most.
    pub fn mobility_ratio(&self, bladder: usize) -> f64 {
        let (segment, row) = self.segment_and_row(bladder);
        self.segments.get(segment).map_or(1.0, |law| law.mobility_ratio[row])
    }

    /// Inertia along a bladder; none if omitted.
    pub fn along(&self, bladder: usize) -> Option<&AlongBladder> {
        let (segment, row) = self.segment_and_row(bladder);
        let own = self.segments.get(segment);
        own.map_or(self.network.along_bladders.as_ref(), |law| law.along[row].as_ref())
    }

    /// Largest compliance of a bladder, against that of the other one of its segment, over that of most.
    pub fn compliance_ratio(&self, bladder: usize) -> f64 {
        let cross = self.per_other_pressure_of(self.place(bladder).0).abs();
        (self.compliance_by(self.area_of(bladder), 0.0) + cross) / self.compliance()
    }

    /// Largest time of diffusion along a bladder over that of most bladders.
    pub fn slowest_diffusion(&self) -> f64 {
        let there = (0..self.storage.len()).filter(|bladder| self.has(*bladder) && !self.segments.is_empty());
        let ratios = there.map(|bladder| self.compliance_ratio(bladder) / self.mobility_ratio(bladder));
        ratios.reduce(f64::max).unwrap_or(1.0)
    }

    /// `a_x` of a segment [m^2/Pa].
    #[inline]
    pub fn per_other_pressure_of(&self, segment: usize) -> f64 {
        self.segments
            .get(segment)
            .map_or(self.per_other_pressure, |law| law.per_other_pressure)
    }

    /// `a_x/√(a_p,u a_p,d)`, between -1 and 1.
    pub fn pressure_correlation(&self) -> f64 {
        let [upper, lower] = self.area.map(|law| law.per_pressure);
        self.per_other_pressure / (upper * lower).sqrt()
    }

    /// Energy of a segment beyond its quadratic part; none without bladders there.
    #[inline]
    pub fn strain_energy_of(&self, segment: usize) -> Option<&StrainPotential> {
        let law = self.strain_energy.as_ref();
        law.filter(|_| self.pair(segment).into_iter().any(|bladder| self.has(bladder)))
    }

    /// True if the area of a bladder has a part by the section's energy at finite strain, or by the pressure of the other bladder.
    pub fn has_excess(&self, bladder: usize) -> bool {
        let segment = self.segment_and_row(bladder).0;
        let excess = self.strain_energy.is_some() || self.per_other_pressure_of(segment) != 0.0;
        excess && self.has(bladder)
    }

    /// Makes the areas of all bladders unknowns.
    pub fn flow_everywhere(&mut self) {
        let there = self.storage.iter_mut().filter(|storage| **storage != Storage::Absent);
        there.for_each(|storage| *storage = Storage::Flowing);
    }

    /// True if a bladder exists.
    pub fn has(&self, bladder: usize) -> bool {
        self.storage.get(bladder) != Some(&Storage::Absent)
    }

    /// Area stored per pressure at ambient pressure [m^2/Pa], with compression.
    pub fn compliance(&self) -> f64 {
        self.compliance_at(0.0)
    }

    /// Area stored per pressure at a pressure [Pa], with compression. Gas stiffens with pressure.
    pub fn compliance_at(&self, pressure: f64) -> f64 {
        self.compliance_by(&self.area[0], pressure)
    }

    fn compliance_by(&self, law: &AreaLaw, pressure: f64) -> f64 {
        match &self.compression {
            None => law.per_pressure,
            Some(compression) => law.per_pressure + law.at_rest * compression.compressibility(pressure),
        }
    }

    /// Content of a cell with an area law at a pressure [m^2]; `imposed` is the area change by bending and force.
    #[inline]
    pub fn content<T: Scalar>(&self, law: &AreaLaw, pressure: T, imposed: T) -> T {
        match &self.compression {
            None => self.swelling(law, pressure, imposed),
            Some(compression) => compression.content(law, pressure, self.swelling(law, pressure, imposed)),
        }
    }

    /// Area change of a cell with an area law at a pressure [m^2]; `imposed` is the part by bending and force.
    #[inline]
    pub fn swelling<T: Scalar>(&self, law: &AreaLaw, pressure: T, imposed: T) -> T {
        match &self.closing {
            None => pressure * law.per_pressure + imposed,
            Some(closing) => closing.swelling(law, pressure, imposed),
        }
    }

    /// Flow potential at a pressure, [E55].
    #[inline]
    pub fn potential<T: Scalar>(&self, pressure: T) -> T {
        match &self.compression {
            None => pressure,
            Some(compression) => compression.potential(pressure),
        }
    }

    /// Energy carried per volume at ambient density [Pa], [E56].
    pub fn enthalpy(&self, pressure: f64) -> f64 {
        self.compression.as_ref().map_or(pressure, |c| c.enthalpy(pressure))
    }

    /// Bladders of a case with all couplings.
    pub(super) fn new(
        case: &Case,
        bladders: &Bladders,
        section: &Section,
        network: ResolvedNetwork,
        effects: &EffectSet,
    ) -> Self {
        let mut area = [AreaLaw::new(case, bladders, section, effects.has(Effect::Asymmetry)); 2];
        if network.is_dry() {
            let compliance = network.usual_compliance(case.time.end_s);
            area.iter_mut().for_each(|law| law.per_pressure = compliance);
        }
        let fluid = case.fluid.as_ref().filter(|_| effects.has(Effect::Compressibility));
        let (storage, lumped) = storage::of_bladders(case, &network, effects);
        let values = spans::segments(case);
        let sections = Section::of_segments(case, &values);
        let segments = values
            .iter()
            .zip(&sections)
            .map(|(values, section)| SegmentLaw::new(case, values, bladders, section, effects.has(Effect::Asymmetry)));
        let segments = segments.collect();
        Self {
            per_row: bladders.per_row,
            labels: BladderLabels::from_case(case),
            bladder_length: bladders.length_m,
            area,
            per_other_pressure: bladders.area_per_other_pressure_m2_per_pa,
            closing: bladders.closing.as_ref().map(WallClosing::new),
            compression: fluid.and_then(Compression::new),
            strains: area,
            coupling: CouplingLaw::new(&case.beam, bladders),
            segments,
            network,
            flows: effects.has(Effect::Flow),
            storage,
            lumped,
            takes_moments: true,
            takes_forces: true,
            strain_energy: bladders.strain_energy.as_ref().map(StrainPotential::new),
        }
    }

    /// Removes the couplings of omitted effects. Pressure strains the beam by its own slopes, which depend on M and N
    /// where these are kinked.
    pub(super) fn reduce(&mut self, effects: &EffectSet) {
        let reciprocal = matches!(self.coupling, CouplingLaw::Reciprocal { .. });
        let bends = effects.has(Effect::PressureToCurvature)
            && reciprocal
            && self.strains.iter().any(|law| law.moment_half_difference > 0.0);
        let stretches = effects.has(Effect::PressureToStretch)
            && reciprocal
            && self.strains.iter().any(|law| law.force_half_difference > 0.0);
        self.takes_moments = effects.has(Effect::MomentToArea) || bends;
        self.strain_energy = self
            .strain_energy
            .take()
            .filter(|_| effects.has(Effect::NonlinearSection));
        self.takes_forces = effects.has(Effect::AxialStretch) && (effects.has(Effect::ForceToArea) || stretches);
        let areas = self.segments.iter_mut().map(|law| &mut law.area);
        for area in areas.chain([&mut self.area]).flatten() {
            *area = area.without(!effects.has(Effect::MomentToArea), !effects.has(Effect::ForceToArea));
        }
        for link in &mut self.network.links {
            link.tube = link.tube.and_then(|tube| tube.reduced(effects));
        }
        let along = &mut self.network.along_bladders;
        *along = along.and_then(|along| along.reduced(effects));
        for law in &mut self.segments {
            law.along = law.along.map(|along| along.and_then(|along| along.reduced(effects)));
        }
        let [bends, stretches] =
            [Effect::PressureToCurvature, Effect::PressureToStretch].map(|effect| effects.has(effect));
        let laws = self
            .segments
            .iter_mut()
            .map(|law| (&mut law.coupling, &mut law.strains));
        for (coupling, strains) in laws.chain([(&mut self.coupling, &mut self.strains)]) {
            *coupling = coupling.without(!bends, !stretches);
            *strains = strains.map(|strains| strains.without(!bends, !stretches));
        }
    }
}
