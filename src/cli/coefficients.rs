//! `slcbeam coefficients`: the coefficients of a section from its geometry, with errors.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde_json::{Map, Value, json};
use slcbeam_section::coefficients::{Coefficients, Numbers};
use slcbeam_section::finite::StrainEnergy;
use slcbeam_section::input::Section;
use slcbeam_section::three::Spatial;

use super::arguments::CaseArguments;
use super::inflation;
use super::interrupt::WallArguments;
use crate::case::{self, inherited, section};
use crate::error::{Result, usage};
use crate::output::columns::table;
use crate::output::folder::replace;
use crate::output::numbers::significant;
use crate::study::bands::by_sealing;

/// `coefficients`.
#[derive(Debug, Args)]
pub struct CoefficientsArguments {
    /// A section, or a case that has one under `section` or in a span
    #[command(flatten)]
    pub case: CaseArguments,
    /// Compute the section of this span of the case; the first span is 0
    #[arg(long, value_name = "N")]
    pub span: Option<usize>,
    /// Solve the cell in three dimensions too, and say how far the plane one is off
    #[arg(long)]
    pub three_d: bool,
    /// Follow the section at finite strain to these pressures of the upper row [Pa], rising: free curvature, area, blocked
    /// moment, and the pressure at which chambers balloon
    #[arg(long, value_name = "PASCALS", value_delimiter = ',', value_parser = super::inflation::pressure, conflicts_with = "case_file")]
    pub inflate: Vec<f64>,
    /// Limit of wall time.
    #[command(flatten)]
    pub wall: WallArguments,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write a case of the section with these coefficients
    #[arg(long = "case", value_name = "FILE", value_parser = super::progress_line::output_path(), conflicts_with = "three_d")]
    pub case_file: Option<PathBuf>,
    /// Write over a file that is there
    #[arg(long)]
    pub force: bool,
}

/// A number of the table with its error. `entry` is the place of its compliance, and the power, which is negative for a stiffness.
struct Row {
    key: &'static str,
    unit: &'static str,
    value: f64,
    error: f64,
    entry: Option<(usize, usize, f64)>,
}

/// Computes and prints the coefficients.
pub fn coefficients(asked: &CoefficientsArguments) -> Result<ExitCode> {
    let text = case::text(&asked.case.case)?;
    // while standard input is read, Ctrl-C still ends the program
    asked.wall.flag();
    let mut written = section::parse(&text, &asked.case.case, &asked.case.sets, asked.span)?;
    // beside the cell in three dimensions, the table shows the plane cell
    written.section.three_d &= !asked.three_d;
    if let Some(path) = &asked.case_file {
        return write_case(&written, path, asked);
    }
    let found = written.coefficients()?;
    // the polynomial of the energy costs more than the path
    let energy = if asked.inflate.is_empty() {
        written.strain_energy()?
    } else {
        None
    };
    let inflation = inflation::follow(&written, asked)?;
    let spatial = asked.three_d.then(|| written.three_dimensional()).transpose()?;
    // growths at finite strain multiply the compliance in three dimensions where it is computed
    let linear = spatial
        .as_ref()
        .map_or(found.numbers.compliance, |spatial| spatial.compliance);
    let value = || {
        let mut all = in_json(&found, spatial.as_ref(), energy.as_ref());
        if let Some(inflation) = &inflation {
            all["inflation"] = inflation::in_json(inflation, &linear);
        }
        all
    };
    let text = || {
        let grown = inflation
            .as_ref()
            .map(|inflation| inflation::in_words(inflation, &linear));
        let energy = energy.as_ref().map(of_energy);
        in_words(&written.section, &found, spatial.as_ref()) + &energy.or(grown).unwrap_or_default()
    };
    super::answer(asked.json, value, text)
}

/// Number of cells of the beam in a written case.
const CELLS: u32 = 10;

/// Writes a case of a section: a cantilever of ten cells whose upper row is pumped to a hundredth of Young's modulus.
fn write_case(written: &section::SectionFile, path: &Path, asked: &CoefficientsArguments) -> Result<ExitCode> {
    if path.exists() && !asked.force {
        let what = format!(
            "{} exists and is not overwritten; name another file, or use --force",
            path.display()
        );
        return usage(what);
    }
    let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("section");
    let name: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    let own = &written.section;
    let length = f64::from(CELLS) * own.pitch_m;
    let mut case = json!({
        "name": name,
        "about": "Coefficients of a section. Change length, fluid, tubes, network, ends and times to those of your structure.",
        "beam": {"length_m": length},
        "ends": {"root": "clamped", "tip": "free"},
        "time": {"end_s": 2.0, "output_interval_s": 0.01},
    });
    for (part, values) in written.values(length)?.as_object().into_iter().flatten() {
        match (case.get_mut(part).and_then(Value::as_object_mut), values.as_object()) {
            (Some(own), Some(values)) => own.extend(values.clone()),
            _ => case[part] = values.clone(),
        }
    }
    if case.get("bladders").is_some() {
        let row = |sign: i64| (1..=i64::from(CELLS)).map(|k| sign * k).collect::<Vec<_>>();
        let to = 0.01 * own.material.young_modulus_pa;
        let mut chains = vec![
            json!({"bladders": row(1), "ends": [{"pressure_pa": {"ramp": {"to": to, "duration_s": 1.0}}}, "sealed"]}),
        ];
        if case["bladders"].get("lower") != Some(&"none".into()) {
            chains.push(json!({"bladders": row(-1), "ends": [{"pressure_pa": 0.0}, "sealed"]}));
        }
        case["fluid"] = json!({"preset": "water"});
        case["tubes"] = json!({"length_m": 0.3 * own.pitch_m, "radius_m": 0.001});
        case["network"] = json!({"chains": chains});
    }
    replace(path, format!("{case:#}\n"))?;
    super::print(&match asked.json {
        true => format!("{:#}\n", json!({"case": path})),
        false => {
            let next = format!("wrote {}\nnext: slcbeam check {0}; slcbeam run {0}\n", path.display());
            next + &open_ends(own, &written.coefficients()?.numbers)
        }
    })?;
    Ok(ExitCode::SUCCESS)
}

fn rows(found: &Coefficients) -> Vec<Row> {
    macro_rules! rows {
        ($($key:ident $unit:literal $entry:expr;)*) => {
            vec![$(Row {
                key: stringify!($key),
                unit: $unit,
                value: found.numbers.$key,
                error: found.errors.$key,
                entry: $entry,
            },)*]
        };
    }
    rows! {
        axial_stiffness_factor "1" Some((0, 0, -1.0));
        bending_stiffness_factor "1" Some((1, 1, -1.0));
        area_per_pressure_m2_per_pa "m^2/Pa" Some((2, 2, 1.0));
        area_per_other_pressure_m2_per_pa "m^2/Pa" Some((2, 3, 1.0));
        area_per_moment_m2_per_n_m "m^2/(N m)" Some((1, 2, 1.0));
        area_per_force_m2_per_n "m^2/N" Some((0, 2, 1.0));
        slope_per_pressure_rad "rad" Some((1, 2, 1.0));
        length_per_pressure_m "m" Some((0, 2, 1.0));
        shear_stiffness_n "N" None;
        permeability_m4 "m^4" None;
        solid_mass_kg_per_m "kg/m" None;
        solid_rotary_inertia_kg_m "kg m" None;
        fluid_volume_per_length_m2 "m^2" None;
        fluid_second_moment_m4 "m^4" None;
    }
}

/// Relative error of the plane cell, and the value in three dimensions, of a number that the plane cell has.
fn in_space(row: &Row, plane: &Numbers, spatial: &Spatial) -> Option<(f64, f64)> {
    let (i, j, sense) = row.entry?;
    let ratio = (spatial.compliance[i][j] / plane.compliance[i][j]).powf(sense);
    Some((ratio.recip() - 1.0, row.value * ratio)).filter(|_| ratio.is_finite() && ratio != 0.0)
}

/// Text about the ends of bladders, which a plane cell omits.
fn open_ends(section: &Section, numbers: &Numbers) -> String {
    let rows = numbers.upper.iter().chain(&numbers.lower);
    let along = section.bladders.along();
    let size = rows.map(|row| along.max(row.area_m2 / along)).fold(0.0, f64::max);
    let open = !section.three_d && section.bladders.length_m < section.width_m;
    let excess = inherited::plane_cell_excess(size, section.bladders.length_m).filter(|_| open);
    excess.map_or_else(String::new, |excess| {
        format!(
            "\nW022: the plane cell omits the ends of bladders. Areas per moment and force are about {:.0} % too large. Set \"three_d\": true\n",
            100.0 * excess
        )
    })
}

/// Text about a neutral axis beside mid-height.
fn beside_mid_height(section: &Section, numbers: &Numbers) -> String {
    let axis = neutral_axis(numbers);
    if axis.abs() < 1e-3 * section.height_m {
        return String::new();
    }
    format!(
        "\nneutral axis {} mm from mid-height: a normal force at mid-height bends this section. The stiffness and areas above are those of \
         a force at mid-height. --case FILE writes a case with those about the neutral axis\n",
        significant(1e3 * axis, 4)
    )
}

/// Text about the energy at finite strain.
fn of_energy(energy: &StrainEnergy) -> String {
    let names = [
        "stretch [1]",
        "curvature [1/m]",
        "pressure, upper [Pa]",
        "pressure, lower [Pa]",
    ];
    let rows = names.into_iter().zip(energy.limits);
    let rows = rows.map(|(name, [low, high])| [name.to_owned(), significant(low, 4), significant(high, 4)]);
    format!(
        "\nenergy at finite strain beyond the quadratic part: degree {}, error of its slopes {:.0e}, valid within the \
         ellipsoid of\n\n{}",
        energy.degree,
        energy.error,
        table("< | from | to", rows)
    )
}

fn in_json(found: &Coefficients, spatial: Option<&Spatial>, energy: Option<&StrainEnergy>) -> Value {
    let mut all = json!(found.numbers);
    all["errors"] = json!(found.errors);
    all["asymmetry"] = json!(found.asymmetry);
    all["unknowns"] = json!(found.unknowns);
    all["neutral_axis_m"] = json!(neutral_axis(&found.numbers));
    all["coupling_number"] = json!(coupling_number(&found.numbers));
    if let Some(energy) = energy {
        all["strain_energy"] = json!(energy);
    }
    if let Some(spatial) = spatial {
        let in_three_d = rows(found).into_iter().filter_map(|row| {
            let (off, value) = in_space(&row, &found.numbers, spatial)?;
            Some((row.key.to_owned(), json!({"value": value, "plane_off": off})))
        });
        all["three_d"] = in_three_d.collect::<Map<_, _>>().into();
        all["three_d"]["compliance"] = json!(spatial.compliance);
        all["three_d"]["errors"] = json!(spatial.errors);
        all["three_d"]["unknowns"] = json!(spatial.unknowns);
    }
    all
}

/// Height of the neutral axis above mid-height [m].
fn neutral_axis(numbers: &Numbers) -> f64 {
    -numbers.compliance[0][1] / numbers.compliance[1][1]
}

/// Share of the bending stiffness that the fluid of sealed bladders adds, `aᵀ P⁻¹ a/c_MM`, as `bands` has it for a beam; none without
/// bladders.
fn coupling_number(numbers: &Numbers) -> Option<f64> {
    let c = &numbers.compliance;
    let mut rows = vec![(c[1][2], c[2][2]), (c[1][3], c[3][3])];
    rows.retain(|(_, by_pressure)| *by_pressure > 0.0);
    Some(by_sealing(&rows, c[2][3])? / c[1][1])
}

/// Text about the coupling of bending and fluid.
fn of_coupling(numbers: &Numbers) -> String {
    coupling_number(numbers).map_or_else(String::new, |coupling| {
        let raised = (1.0 - coupling).sqrt().recip();
        format!(
            "\ncoupling number {}: sealed bladders raise bending frequencies by {:.0} %. If fluid in tubes between the rows resonates at w, \
             a band gap reaches from w to {} w (slcbeam bands)\n",
            significant(coupling, 4),
            100.0 * (raised - 1.0),
            significant(raised, 3)
        )
    })
}

fn in_words(section: &Section, found: &Coefficients, spatial: Option<&Spatial>) -> String {
    let mut headings = "<coefficient | value | <unit | error".to_owned();
    if spatial.is_some() {
        headings += " | in 3-D | plane off";
    }
    let mut lines = vec![];
    for row in rows(found).iter().filter(|row| row.value != 0.0) {
        let mut line = vec![
            row.key.into(),
            significant(row.value, 5),
            row.unit.into(),
            format!("{:.0e}", row.error),
        ];
        if let Some(spatial) = spatial {
            let pair = in_space(row, &found.numbers, spatial);
            let cells = pair.map_or(["-".into(), "-".into()], |(off, value)| {
                [significant(value, 4), format!("{:+.1} %", 100.0 * off)]
            });
            line.extend(cells);
        }
        lines.push(line);
    }
    let names = ["stretch", "curvature", "area, upper", "area, lower"];
    let matrix = names.into_iter().zip(found.numbers.compliance).map(|(name, row)| {
        let numbers = row.iter().map(|c| format!("{c:.4e}"));
        std::iter::once(name.to_owned()).chain(numbers).collect::<Vec<_>>()
    });
    format!(
        "section {} m high, {} m wide, a bladder every {} m; E {} Pa, nu {}\n\n{}\ncompliance (areas times l_b/pitch), symmetric to {:.0e}\n\n{}",
        section.height_m,
        section.width_m,
        section.pitch_m,
        section.material.young_modulus_pa,
        section.material.poisson_ratio,
        table(&headings, lines),
        found.asymmetry,
        table("< | N | M | p upper | p lower", matrix)
    ) + &of_coupling(&found.numbers)
        + &beside_mid_height(section, &found.numbers)
        + &open_ends(section, &found.numbers)
}
