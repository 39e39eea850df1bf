//! Coefficients of the model (model.md sections 1 to 4) from a section's geometry.
//!
//! ```text
//! EA = 1/C_00 = E h w f_e,   EI = 1/C_11 = E (w h^3/12) f_i                                  [K1]
//! a_p = C_22/(phi_b l_b)     am = C_12/(phi_b l_b)     an = C_02/(phi_b l_b)                 [K2]
//! psi' = l_b am E            zeta' = l_b an E                                                [K3]
//! ```
//!
//! [K3] follows from Maxwell and Betti: curvature per pressure equals area per moment. The sign of am is reversed for
//! the lower row, so mirrored rows have equal coefficients.

use crate::cell::{self, Cell};
use crate::error::Error;
use crate::estimate;
use crate::finite::{FiniteCell, Law};
use crate::geometry::check::check;
use crate::geometry::outline::Outline;
use crate::input::Section;
use crate::level::Level;
use crate::mesh::{Fineness, Mesh};
use crate::three::Spatial;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options for the solution of the cell.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Fineness of the coarsest mesh.
    pub fineness: Fineness,
    /// Number of meshes, each with four times as many triangles as the previous one; 3 determine an order.
    pub meshes: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fineness: Fineness::default(),
            meshes: 3,
        }
    }
}

/// Coefficients of one row of bladders, in the model's signs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RowCoefficients {
    /// Cross-section of the bladder [m^2].
    pub area_m2: f64,
    /// Height of its centroid [m].
    pub centroid_m: f64,
    /// a_p: area per its own pressure [m^2/Pa].
    pub area_per_pressure_m2_per_pa: f64,
    /// Area per the other row's pressure [m^2/Pa].
    pub area_per_other_pressure_m2_per_pa: f64,
    /// am: area per moment [m^2/(N m)], positive if a moment that stretches this row's side opens it.
    pub area_per_moment_m2_per_n_m: f64,
    /// an: area per axial force [m^2/N].
    pub area_per_force_m2_per_n: f64,
    /// psi' = l_b am E [rad].
    pub slope_per_pressure_rad: f64,
    /// zeta' = l_b an E [m].
    pub length_per_pressure_m: f64,
    /// q1 of the bladder [m^4].
    pub permeability_m4: f64,
}

/// All numbers of a section. Numbers of rows are means over the existing rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Numbers {
    /// Compliance over (N, M, p_upper, p_lower) against (stretch, curvature, phi_b l_b area of upper, of lower).
    pub compliance: [[f64; 4]; 4],
    /// f_e.
    pub axial_stiffness_factor: f64,
    /// f_i.
    pub bending_stiffness_factor: f64,
    /// EA at fixed pressures [N].
    pub axial_stiffness_n: f64,
    /// EI at fixed pressures [N m^2].
    pub bending_stiffness_n_m2: f64,
    /// Curvature per axial force over the geometric mean of stretch per force and curvature per moment: 0 for symmetric
    /// sections, below 1.
    pub force_curvature_coupling: f64,
    /// a_p [m^2/Pa].
    pub area_per_pressure_m2_per_pa: f64,
    /// Area of a bladder per pressure of the other row [m^2/Pa].
    pub area_per_other_pressure_m2_per_pa: f64,
    /// am [m^2/(N m)].
    pub area_per_moment_m2_per_n_m: f64,
    /// an [m^2/N].
    pub area_per_force_m2_per_n: f64,
    /// psi' [rad].
    pub slope_per_pressure_rad: f64,
    /// zeta' [m].
    pub length_per_pressure_m: f64,
    /// kGA [N].
    pub shear_stiffness_n: f64,
    /// q1 of a bladder [m^4].
    pub permeability_m4: f64,
    /// Mass of the solid per unit length [kg/m].
    pub solid_mass_kg_per_m: f64,
    /// Second moment of the solid's mass about the mid-plane per unit length [kg m].
    pub solid_rotary_inertia_kg_m: f64,
    /// Fluid volume per unit length [m^2]; the fluid's mass is this times its density.
    pub fluid_volume_per_length_m2: f64,
    /// Second moment of that volume about the mid-plane [m^4].
    pub fluid_second_moment_m4: f64,
    /// The upper row.
    pub upper: Option<RowCoefficients>,
    /// The lower row.
    pub lower: Option<RowCoefficients>,
}

/// Numbers with their errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Coefficients {
    /// Values on the finest mesh.
    pub numbers: Numbers,
    /// Relative error of each number; that of compliance is relative to the geometric mean of its diagonal entries.
    pub errors: Errors,
    /// Largest relative difference of transposed entries before symmetrization: the reciprocity error.
    pub asymmetry: f64,
    /// Number of displacement unknowns of the finest mesh.
    pub unknowns: usize,
}

/// Relative errors, named as the numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[allow(missing_docs)]
pub struct Errors {
    pub compliance: [[f64; 4]; 4],
    pub axial_stiffness_factor: f64,
    pub bending_stiffness_factor: f64,
    pub area_per_pressure_m2_per_pa: f64,
    /// Relative to a_p, since this number may vanish.
    pub area_per_other_pressure_m2_per_pa: f64,
    pub area_per_moment_m2_per_n_m: f64,
    pub area_per_force_m2_per_n: f64,
    pub slope_per_pressure_rad: f64,
    pub length_per_pressure_m: f64,
    pub shear_stiffness_n: f64,
    pub permeability_m4: f64,
    pub solid_mass_kg_per_m: f64,
    pub solid_rotary_inertia_kg_m: f64,
    pub fluid_volume_per_length_m2: f64,
    pub fluid_second_moment_m4: f64,
}

impl Section {
    /// Returns all violated rules of the section.
    pub fn faults(&self) -> Vec<crate::error::Fault> {
        check(self)
    }

    /// Coefficients with errors estimated from the meshes.
    pub fn coefficients(&self, options: &Options) -> Result<Coefficients, Error> {
        let levels = self.levels(options)?;
        let all: Vec<Numbers> = levels.iter().map(|level| Numbers::new(self, level)).collect();
        let finest = levels.len() - 1;
        let plane = Coefficients {
            errors: Errors::new(&all, self.order()),
            asymmetry: levels[finest].asymmetry,
            unknowns: levels[finest].unknowns,
            numbers: all[finest].clone(),
        };
        match self.three_d {
            false => Ok(plane),
            true => Ok(plane.in_space(self, &levels[finest], &self.beside(&levels[finest])?)),
        }
    }

    /// Highest order of convergence for error estimates.
    fn order(&self) -> f64 {
        let regions = self.regions.iter().map(|r| Outline::region(&r.shape, self.pitch_m));
        let smooth = cell::bladders(self)
            .into_iter()
            .flatten()
            .chain(regions)
            .all(|o| o.corners().is_empty());
        if smooth { estimate::SMOOTH } else { estimate::SHARP }
    }

    /// Results on successive meshes, coarsest first.
    pub fn levels(&self, options: &Options) -> Result<Vec<Level>, Error> {
        self.meshes(options)?
            .iter()
            .map(|mesh| Level::new(self, &Cell::new(self, mesh)))
            .collect()
    }

    /// Finite-strain cell on the finest mesh.
    pub fn finite(&self, law: Law, options: &Options) -> Result<FiniteCell, Error> {
        let mesh = self
            .meshes(options)?
            .pop()
            .ok_or_else(|| Error::Mesh("no mesh was asked for".to_owned()))?;
        FiniteCell::new(self, Cell::new(self, &mesh), law)
    }

    /// Successive meshes of the cell, coarsest first.
    pub fn meshes(&self, options: &Options) -> Result<Vec<Mesh<cell::Part>>, Error> {
        let faults = self.faults();
        if !faults.is_empty() {
            return Err(Error::Section(faults));
        }
        let mut meshes = vec![cell::mesh(self, &options.fineness)?];
        while meshes.len() < options.meshes {
            meshes.extend(meshes.last().map(Mesh::refined));
        }
        Ok(meshes)
    }
}

impl Coefficients {
    /// Replaces the results by those of the three-dimensional compliance.
    fn in_space(self, section: &Section, plane: &Level, spatial: &Spatial) -> Self {
        let level = Level {
            compliance: spatial.compliance,
            ..plane.clone()
        };
        let c = &spatial.compliance;
        // relative error of an entry
        let error = |i: usize, j: usize| match c[i][j].abs() {
            0.0 => 0.0,
            size => spatial.errors[i][j] * (c[i][i] * c[j][j]).sqrt() / size,
        };
        let rows = [2, 3].into_iter().filter(|&k| c[k][k] > 0.0);
        let worst = |of: &dyn Fn(usize) -> f64| rows.clone().map(of).fold(0.0, f64::max);
        let (of_moment, of_force) = (worst(&|k| error(1, k)), worst(&|k| error(0, k)));
        Self {
            numbers: Numbers::new(section, &level),
            errors: Errors {
                compliance: spatial.errors,
                axial_stiffness_factor: error(0, 0),
                bending_stiffness_factor: error(1, 1),
                area_per_pressure_m2_per_pa: worst(&|k| error(k, k)),
                area_per_other_pressure_m2_per_pa: spatial.errors[2][3],
                area_per_moment_m2_per_n_m: of_moment,
                area_per_force_m2_per_n: of_force,
                slope_per_pressure_rad: of_moment,
                length_per_pressure_m: of_force,
                ..self.errors
            },
            asymmetry: self.asymmetry,
            unknowns: spatial.unknowns,
        }
    }
}

impl Numbers {
    /// Numbers from the results on one mesh, [K1] to [K3].
    pub fn new(section: &Section, level: &Level) -> Self {
        let c = &level.compliance;
        let (h, w, lb) = (section.height_m, section.width_m, section.bladders.length_m);
        let e = section.material.young_modulus_pa;
        let per_cell = lb / section.pitch_m;
        let row = |k: usize, sign: f64| {
            let [area, first, _] = level.cavities[k];
            (area > 0.0).then(|| RowCoefficients {
                area_m2: area,
                centroid_m: first / area,
                area_per_pressure_m2_per_pa: c[2 + k][2 + k] / per_cell,
                area_per_other_pressure_m2_per_pa: c[2][3] / per_cell,
                area_per_moment_m2_per_n_m: sign * c[1][2 + k] / per_cell,
                area_per_force_m2_per_n: c[0][2 + k] / per_cell,
                slope_per_pressure_rad: lb * e * sign * c[1][2 + k] / per_cell,
                length_per_pressure_m: lb * e * c[0][2 + k] / per_cell,
                permeability_m4: level.permeability[k],
            })
        };
        let (upper, lower) = (row(0, 1.0), row(1, -1.0));
        let mean = |of: fn(&RowCoefficients) -> f64| {
            let rows = upper.iter().chain(&lower);
            let count = rows.clone().count().max(1);
            rows.map(of).sum::<f64>() / count as f64
        };
        Self {
            compliance: *c,
            axial_stiffness_factor: 1.0 / (c[0][0] * e * h * w),
            bending_stiffness_factor: 12.0 / (c[1][1] * e * w * h.powi(3)),
            axial_stiffness_n: 1.0 / c[0][0],
            bending_stiffness_n_m2: 1.0 / c[1][1],
            force_curvature_coupling: c[0][1] / (c[0][0] * c[1][1]).sqrt(),
            area_per_pressure_m2_per_pa: mean(|r| r.area_per_pressure_m2_per_pa),
            area_per_other_pressure_m2_per_pa: mean(|r| r.area_per_other_pressure_m2_per_pa),
            area_per_moment_m2_per_n_m: mean(|r| r.area_per_moment_m2_per_n_m),
            area_per_force_m2_per_n: mean(|r| r.area_per_force_m2_per_n),
            slope_per_pressure_rad: mean(|r| r.slope_per_pressure_rad),
            length_per_pressure_m: mean(|r| r.length_per_pressure_m),
            shear_stiffness_n: level.shear_stiffness,
            permeability_m4: mean(|r| r.permeability_m4),
            solid_mass_kg_per_m: level.solid[0],
            solid_rotary_inertia_kg_m: level.solid[1],
            fluid_volume_per_length_m2: per_cell * (level.cavities[0][0] + level.cavities[1][0]),
            fluid_second_moment_m4: per_cell * (level.cavities[0][2] + level.cavities[1][2]),
            upper,
            lower,
        }
    }
}

impl Errors {
    fn new(all: &[Numbers], most: f64) -> Self {
        let of = |value: &dyn Fn(&Numbers) -> f64| {
            estimate::estimate(&all.iter().map(value).collect::<Vec<_>>(), most).relative_error
        };
        let c = &all[all.len() - 1].compliance;
        let entry = |i: usize, j: usize| {
            let scale = (c[i][i] * c[j][j]).sqrt();
            let error = estimate::error(&all.iter().map(|n| n.compliance[i][j]).collect::<Vec<_>>(), most);
            if scale > 0.0 { error / scale } else { 0.0 }
        };
        let other = all
            .iter()
            .map(|n| n.area_per_other_pressure_m2_per_pa)
            .collect::<Vec<_>>();
        let own = all[all.len() - 1].area_per_pressure_m2_per_pa;
        Self {
            compliance: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
            axial_stiffness_factor: of(&|n| n.axial_stiffness_factor),
            bending_stiffness_factor: of(&|n| n.bending_stiffness_factor),
            area_per_pressure_m2_per_pa: of(&|n| n.area_per_pressure_m2_per_pa),
            area_per_other_pressure_m2_per_pa: if own > 0.0 {
                estimate::error(&other, most) / own
            } else {
                0.0
            },
            area_per_moment_m2_per_n_m: of(&|n| n.area_per_moment_m2_per_n_m),
            area_per_force_m2_per_n: of(&|n| n.area_per_force_m2_per_n),
            slope_per_pressure_rad: of(&|n| n.slope_per_pressure_rad),
            length_per_pressure_m: of(&|n| n.length_per_pressure_m),
            shear_stiffness_n: of(&|n| n.shear_stiffness_n),
            permeability_m4: of(&|n| n.permeability_m4),
            solid_mass_kg_per_m: of(&|n| n.solid_mass_kg_per_m),
            solid_rotary_inertia_kg_m: of(&|n| n.solid_rotary_inertia_kg_m),
            fluid_volume_per_length_m2: of(&|n| n.fluid_volume_per_length_m2),
            fluid_second_moment_m4: of(&|n| n.fluid_second_moment_m4),
        }
    }
}
