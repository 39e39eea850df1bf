//! Names of figures and of numbers of a case as people read them.

use super::units::suffixed;

/// The name of a figure as people read it, without units: `harvested energy, final` for `harvested_energy_j.final`.
pub fn figure_name(figure: &str) -> String {
    let part = |part: &str| suffixed(part).map_or(part, |(name, _)| name).replace('_', " ");
    figure.split('.').map(part).collect::<Vec<_>>().join(", ")
}

/// The name of a number of a case as people read it, without units: `fluid: viscosity` for `/fluid/viscosity_pa_s`.
pub fn pointer_name(pointer: &str) -> String {
    let keys: Vec<&str> = pointer.split('/').skip(1).collect();
    let Some((last, before)) = keys.split_last() else {
        return pointer.into();
    };
    let index = |key: &str| !key.is_empty() && key.bytes().all(|b| b.is_ascii_digit());
    let from = before.iter().rposition(|key| !index(key)).unwrap_or(0);
    let parent = before[from..].join(" ").replace('_', " ");
    match parent.is_empty() {
        true => figure_name(last),
        false => format!("{parent}: {}", figure_name(last)),
    }
}

#[cfg(test)]
mod tests {
    use super::{figure_name, pointer_name};

    /// Goal: axes and titles show names, not pointers and keys.
    #[test]
    fn names_are_read_without_units() {
        assert_eq!(figure_name("harvested_energy_j.final"), "harvested energy, final");
        assert_eq!(
            figure_name("max_pressure_pa.window_max_abs"),
            "max pressure, window max abs"
        );
        assert_eq!(pointer_name("/fluid/viscosity_pa_s"), "fluid: viscosity");
        assert_eq!(pointer_name("/loads/0/force_n"), "loads 0: force");
        assert_eq!(
            pointer_name("/network/permeability_factor"),
            "network: permeability factor"
        );
    }
}
