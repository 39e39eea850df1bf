//! `slcbeam verify --paper`: the coefficients of the published cell beside the printed ones.

use std::process::ExitCode;

use serde_json::json;
use slcbeam_section::paper::{PRINTED, PaperTable, Variant, paper_table};

use crate::error::{Error, Result};
use crate::output::columns::table as table_of;
use crate::output::numbers::significant;

/// Values that the paper leaves open: Poisson's ratio, fillets of the square of 7.8 mm [m], height of its center [m]; its walls allow 3.9
/// to 6.9 mm.
const RATIOS: [f64; 3] = [0.45, 0.47, 0.49];
const FILLETS_M: [f64; 4] = [0.0, 0.001, 0.0025, 0.0039];
const CENTERS_M: [f64; 3] = [0.0044, 0.0049, 0.0054];

const HEADINGS: &str = "nu | fillet [mm] | centre [mm] | f_e | f_i | a_p [m^2/Pa] | a_M [m^2/(N m)] | a_N [m^2/N] | psi' [rad] | zeta' [m] | q1 [m^4] | misfit";

/// Computes and prints the coefficients.
pub fn paper(in_json: bool) -> Result<ExitCode> {
    let table = paper_table(&RATIOS, &FILLETS_M, &CENTERS_M).map_err(|error| Error::Usage(error.to_string()))?;
    let value = || json!({"printed": PRINTED, "computed": table});
    super::answer(in_json, value, || in_words(&table))
}

fn in_words(table: &PaperTable) -> String {
    let number = |x: f64| significant(x, 3);
    let mut lines = vec![];
    let mut row = |head: [String; 3], values: Vec<String>, misfit: String| {
        lines.push(head.into_iter().chain(values).chain([misfit]).collect::<Vec<_>>());
    };
    let printed = PRINTED.map(|p| match p.low == p.high {
        true => number(p.low),
        false => format!("{} to {}", number(p.low), number(p.high)),
    });
    row(
        ["printed".into(), String::new(), String::new()],
        printed.into(),
        String::new(),
    );
    let shape = |v: &Variant| [v.poisson_ratio, 1e3 * v.fillet_m, 1e3 * v.center_m].map(number);
    for variant in &table.variants {
        row(
            shape(variant),
            variant.computed.map(number).into(),
            number(variant.misfit),
        );
    }
    let best = table.variants.get(table.best);
    if let Some(best) = best {
        let values = table.spatial.map(number).into_iter().chain([String::new()]);
        row(shape(best), values.collect(), "in 3-D".into());
    }
    let every = |k: usize| {
        let ratios = table.variants.iter().map(move |v| v.computed[k] / PRINTED[k].high);
        let (least, most) = (ratios.clone().fold(f64::INFINITY, f64::min), ratios.fold(0.0, f64::max));
        format!("{} to {}", number(least), number(most))
    };
    let [nu, fillet, center] = best.map(shape).unwrap_or_default();
    format!(
        "{}\nmisfit: root mean square of ln(computed/printed) of the first five, of a range its geometric mean\n\n\
         best: nu {nu}, fillets of {fillet} mm, centres {center} mm off the mid-plane; its values in three dimensions stand last\n\
         f_e: {} times the printed one, which is a secant of a large pull\n\
         psi': {} times the printed one whatever the shape\n\
         q1: {} times the printed one, which is that of a square of {} mm; the printed one of tubes is that of a radius of {} mm\n",
        table_of(HEADINGS, lines),
        every(0),
        every(5),
        every(7),
        number(1e3 * table.square_side_m),
        significant(1e3 * table.tube_radius_m, 4),
    )
}
