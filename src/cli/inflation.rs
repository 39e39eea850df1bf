//! `slcbeam coefficients --inflate`: a section under pressure at finite strain.

use serde_json::{Value, json};
use slcbeam_section::finite::inflation::{Growth, Inflation};

use super::coefficients::CoefficientsArguments;
use crate::case::section::SectionFile;
use crate::error::{Result, usage};
use crate::output::columns::table;
use crate::output::numbers::significant;

/// Reads a pressure above zero.
pub fn pressure(text: &str) -> std::result::Result<f64, String> {
    let value: f64 = text
        .trim()
        .parse()
        .map_err(|_| format!("{text} is not a number, such as 5000"))?;
    let good = value.is_finite() && value > 0.0;
    good.then_some(value)
        .ok_or_else(|| format!("{text} is not a pressure above 0 Pa"))
}

/// Growths at the requested pressures; None without any.
pub fn follow(written: &SectionFile, asked: &CoefficientsArguments) -> Result<Option<Inflation>> {
    let pressures = &asked.inflate;
    if pressures.windows(2).any(|pair| pair[0] >= pair[1]) {
        return usage("--inflate: pressures do not rise. The section is followed from rest. Give them in rising order");
    }
    (!pressures.is_empty())
        .then(|| written.inflation(pressures))
        .transpose()
}

/// Curvature [1/m], blocked moment [N m] and change of a bladder's area over pitch times length [m^2] by linear law and growth.
fn values(growth: &Growth, c: &[[f64; 4]; 4]) -> [Option<f64>; 3] {
    let p = growth.pressure_pa;
    [
        growth.curvature.map(|g| g * c[1][2] * p),
        growth.moment.map(|g| g * c[1][2] / c[1][1] * p),
        growth.area.map(|g| g * c[2][2] * p),
    ]
}

/// JSON of growths and values.
pub fn in_json(found: &Inflation, compliance: &[[f64; 4]; 4]) -> Value {
    let row = |growth: &Growth| {
        let [curvature, moment, area] = values(growth, compliance);
        json!({
            "pressure_pa": growth.pressure_pa,
            "curvature_1_m": curvature, "curvature_growth": growth.curvature,
            "blocked_moment_n_m": moment, "blocked_moment_growth": growth.moment,
            "volume_per_length_m2": area, "volume_growth": growth.area,
        })
    };
    json!({
        "states": found.growths.iter().map(row).collect::<Vec<_>>(),
        "limit_pressure_pa": found.limit_pa,
        "blocked_limit_pressure_pa": found.blocked_limit_pa,
    })
}

/// Table of growths and values.
pub fn in_words(found: &Inflation, compliance: &[[f64; 4]; 4]) -> String {
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| significant(value, 4));
    let row = |growth: &Growth| {
        let [curvature, moment, area] = values(growth, compliance);
        let own = [curvature, growth.curvature, moment, growth.moment, area, growth.area];
        let cells = own.into_iter().map(shown);
        std::iter::once(significant(growth.pressure_pa, 6))
            .chain(cells)
            .collect::<Vec<_>>()
    };
    let rows = table(
        "pressure [Pa] | curvature [1/m] | over linear | blocked moment [N m] | over linear | volume per length [m^2] | over linear",
        found.growths.iter().map(row),
    );
    let limit = |what: &str, at: Option<f64>| {
        at.map_or_else(String::new, |at| {
            let at = significant(at, 4);
            format!("{what}: no stable state from {at} Pa on. Chambers balloon; the model has no prediction there\n")
        })
    };
    format!(
        "\nupper row pumped up at finite strain\n\n{rows}{}{}",
        limit("free", found.limit_pa),
        limit("blocked", found.blocked_limit_pa)
    )
}
