//! `modelDescription.xml` of an FMU.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::FmuContents;
use super::units::{BASE, exponents};

/// Attributes of an element, without those that are absent.
fn element(name: &str, attributes: &[(&str, Option<String>)]) -> String {
    let given = attributes
        .iter()
        .filter_map(|(key, value)| Some((key, value.as_ref()?)));
    let all: String = given
        .map(|(key, value)| format!(" {key}=\"{}\"", escaped(value)))
        .collect();
    format!("<{name}{all}/>")
}

/// Text as the value of an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace(['\n', '\r', '\t'], " ")
}

/// True for names of the structured naming convention: identifiers with indices, joined by dots.
fn is_structured(name: &str) -> bool {
    name.split('.').all(|part| {
        let (word, indices) = part.split_once('[').unwrap_or((part, "0]"));
        let index = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        let sound = indices.strip_suffix(']').is_some_and(|all| all.split("][").all(index));
        sound
            && word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && word.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
    })
}

/// Definition of a unit; none if it has no base units.
fn unit(name: &str) -> Option<String> {
    let all = exponents(name)?;
    let base: String = BASE
        .iter()
        .zip(all)
        .filter(|(_, exponent)| *exponent != 0)
        .map(|(base, exponent)| format!(" {base}=\"{exponent}\""))
        .collect();
    let offset = if name == "°C" { " offset=\"273.15\"" } else { "" };
    Some(format!(
        "    <Unit name=\"{}\"><BaseUnit{base}{offset}/></Unit>\n",
        escaped(name)
    ))
}

/// The text of the file.
pub fn text(of: &FmuContents) -> String {
    let setup = of.setup();
    let some = |text: &str| Some(text.to_owned());
    let number = |x: f64| Some(format!("{x:?}"));
    let variable = |place: usize, causality: &str, [name, about, unit]: [&str; 3], numbers: [Option<f64>; 3]| {
        let [low, high, start] = numbers.map(|number| number.map(|x| format!("{x:?}")));
        element(
            "Float64",
            &[
                ("name", some(name)),
                ("valueReference", Some(place.to_string())),
                ("causality", some(causality)),
                ("variability", some("continuous")),
                ("description", some(about)),
                ("unit", some(unit)),
                ("min", low),
                ("max", high),
                ("start", start),
            ],
        )
    };
    let mut variables = vec![variable(0, "independent", ["time", "time", "s"], [None; 3])];
    let mut units = BTreeSet::from(["s"]);
    let mut names = vec![];
    for input in &of.inputs {
        units.insert(input.unit());
        names.push(input.name());
        let [low, high] = input.range.map_or([None; 2], |range| range.map(Some));
        let words = [&input.name(), &input.about(), input.unit()];
        variables.push(variable(
            variables.len(),
            "input",
            words,
            [low, high, Some(input.start)],
        ));
    }
    let first = variables.len();
    for output in &of.outputs {
        units.insert(output.unit);
        names.push(output.name.clone());
        let words = [&*output.name, &output.about, output.unit];
        variables.push(variable(variables.len(), "output", words, [None; 3]));
    }
    let known = |unit: &&str| exponents(unit).is_some();
    let definitions: String = units.into_iter().filter(known).filter_map(unit).collect();
    let convention = if names.iter().all(|name| is_structured(name)) {
        "structured"
    } else {
        "flat"
    };
    let about = match &of.linear {
        Some(model) => format!(
            "Small motions of the case {}: linear model with {} states",
            of.case.name,
            model.b.len()
        ),
        None => of.case.about.clone(),
    };
    let root = element(
        "fmiModelDescription",
        &[
            ("fmiVersion", some("3.0")),
            ("modelName", some(&of.case.name)),
            ("instantiationToken", Some(setup.token)),
            ("description", Some(about).filter(|text| !text.is_empty())),
            ("generationTool", some(concat!("slcbeam ", env!("CARGO_PKG_VERSION")))),
            ("variableNamingConvention", some(convention)),
        ],
    );
    let nonlinear = of.linear.is_none().then(|| "true".to_owned());
    let interface = element(
        "CoSimulation",
        &[
            ("modelIdentifier", Some(of.identifier())),
            ("canGetAndSetFMUState", some("true")),
            ("canSerializeFMUState", some("true")),
            ("canHandleVariableCommunicationStepSize", some("true")),
            ("mightReturnEarlyFromDoStep", nonlinear.clone()),
            ("hasEventMode", nonlinear),
        ],
    );
    let experiment = element(
        "DefaultExperiment",
        &[
            ("startTime", number(0.0)),
            ("stopTime", number(of.case.time.end_s)),
            ("stepSize", number(of.case.time.output_interval())),
        ],
    );
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}>\n  {interface}\n  <UnitDefinitions>\n{definitions}  </UnitDefinitions>\n  \
         <LogCategories>\n    <Category name=\"logStatusWarning\" description=\"Warnings\"/>\n    \
         <Category name=\"logStatusError\" description=\"Errors\"/>\n  </LogCategories>\n  {experiment}\n  <ModelVariables>\n",
        root.trim_end_matches("/>")
    );
    let mut line = |line: String| {
        let _ = writeln!(text, "{line}");
    };
    variables.iter().for_each(|variable| line(format!("    {variable}")));
    line("  </ModelVariables>\n  <ModelStructure>".into());
    // values at a communication point do not depend on inputs that are set there
    for kind in ["Output", "InitialUnknown"] {
        for place in first..variables.len() {
            line(format!("    <{kind} valueReference=\"{place}\" dependencies=\"\"/>"));
        }
    }
    line("  </ModelStructure>\n</fmiModelDescription>".into());
    text
}

#[cfg(test)]
mod tests {
    use super::{escaped, is_structured};

    #[test]
    fn names_and_texts_are_valid_in_xml() {
        assert!(is_structured("network.chains[0].ends[1].pressure_pa") && is_structured("tip_u1"));
        assert!(!is_structured("1a") && !is_structured("a b") && !is_structured("a[b]") && !is_structured("a."));
        assert_eq!(escaped("a<b> & \"c\"\n"), "a&lt;b&gt; &amp; &quot;c&quot; ");
    }
}
