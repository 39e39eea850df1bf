//! Cache of values computed from sections, because cases are read repeatedly.

use std::sync::{Mutex, PoisonError};

use serde_json::{Value, json};
use slcbeam_section::coefficients::{Coefficients, Options};
use slcbeam_section::error::Error;
use slcbeam_section::finite::StrainEnergy;
use slcbeam_section::input::Section;

use super::schema::StrainEnergy as Written;

/// Largest number of cached sections: those of a case with the most spans, before and after a change.
const KEPT: usize = 2048;

/// Cached values, each with its section.
type CachedValue<T> = Mutex<Vec<(Section, T)>>;

static COEFFICIENTS: CachedValue<Coefficients> = Mutex::new(vec![]);
static ENERGIES: CachedValue<Option<StrainEnergy>> = Mutex::new(vec![]);

/// Returns the cached value of a section, or computes and caches it.
fn once<T: Clone>(kept: &CachedValue<T>, section: &Section, compute: impl FnOnce() -> Computed<T>) -> Computed<T> {
    let known = || kept.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, found)) = known().iter().find(|(of, _)| of == section) {
        return Ok(found.clone());
    }
    let found = compute()?;
    let mut known = known();
    known.truncate(KEPT - 1);
    known.insert(0, (section.clone(), found.clone()));
    Ok(found)
}

type Computed<T> = std::result::Result<T, Error>;

/// Coefficients of a section, computed once. [`slcbeam_section`] documents the method and the errors.
pub fn coefficients(section: &Section) -> Computed<Coefficients> {
    once(&COEFFICIENTS, section, || section.coefficients(&Options::default()))
}

/// Energy of a section at finite strain, computed once.
pub fn strain_energy(section: &Section) -> Computed<Option<StrainEnergy>> {
    once(&ENERGIES, section, || section.strain_energy())
}

/// Energy in the form of a case file.
pub fn written(energy: &StrainEnergy) -> Value {
    let [stretch, curvature_1_m, upper_pressure_pa, lower_pressure_pa] = energy.limits;
    json!(Written {
        stretch,
        curvature_1_m,
        upper_pressure_pa,
        lower_pressure_pa,
        degree: energy.degree,
        mirrored: energy.mirrored,
        coefficients_n: energy.coefficients_n.clone(),
        error: energy.error,
    })
}
