//! Codes of all errors and warnings, with their titles and explanations from `docs/messages.md`.

/// Page that explains the codes, one section each.
const PAGE: &str = include_str!("../../docs/messages.md");

macro_rules! codes {
    ($($name:ident = $id:literal, $what:literal;)*) => {
        /// Code of an error or warning. Codes are permanent: readers look them up in pages and threads.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Code {
            $(#[doc = $what] $name,)*
        }

        impl Code {
            /// All codes, in the order of the page.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// Number with its letter: `E` for an error that ends a command, `W` for a warning about a result.
            pub fn id(self) -> &'static str {
                match self {
                    $(Self::$name => $id,)*
                }
            }
        }
    };
}

codes! {
    Text = "E001", "The file is not valid JSON.";
    Kind = "E002", "Wrong type of value.";
    Name = "E003", "Unknown name.";
    Key = "E004", "Unknown key.";
    Missing = "E005", "Missing key.";
    Range = "E006", "Number out of range.";
    Count = "E007", "Wrong number of entries.";
    Table = "E008", "Unusable table.";
    Function = "E009", "Unusable function of time or position.";
    Implausible = "E010", "Implausible size.";
    Together = "E011", "Incompatible parts.";
    Geometry = "E012", "Bladders do not fit.";
    Slopes = "E013", "Contradictory data of a bladder.";
    Wiring = "E014", "Invalid network.";
    Times = "E019", "Contradictory times.";
    CaseName = "E020", "Invalid name.";
    Effect = "E021", "Effect that the case needs or excludes.";
    Usage = "E030", "Invalid command line.";
    NoStart = "E040", "No consistent state.";
    Integrator = "E041", "The integrator fails.";
    Singular = "E042", "No unique solution.";
    Steps = "E043", "Too many steps.";
    NoEquilibrium = "E045", "No equilibrium found.";
    NoCycle = "E046", "No motion over a period.";
    NoModes = "E047", "No modes found.";
    OutOfRange = "E048", "State outside the range of the model.";
    Interrupted = "E049", "The command was interrupted.";
    File = "E050", "A file cannot be read or written.";
    Reciprocity = "W001", "Pressure and deformation do not share one potential.";
    CouplingLaw = "W002", "Coupling not passive or not unique.";
    FastFlow = "W003", "Inertia or losses of the flow left out.";
    Strain = "W004", "Strains are not small.";
    Stocky = "W005", "Beam too short for a rod model.";
    Mathieu = "W006", "Shaking inside a Mathieu tongue.";
    Growth = "W007", "The deflection grows.";
    EnergyOpen = "W008", "A balance does not close.";
    LostConvexity = "W009", "The potential lost convexity.";
    Buckling = "W010", "A straight beam beyond its buckling load.";
    OrderHeld = "W011", "Steps limited by stability.";
    Accuracy = "W012", "Accuracy not reached or not known.";
    NotAtRest = "W013", "State is not an equilibrium.";
    FewOutputs = "W015", "Output times miss the motion.";
    Unresolved = "W016", "The mesh does not resolve a load or the start.";
    Inherited = "W017", "Coefficients of another beam.";
    PortFlow = "W019", "Port flows do not follow their law.";
    EnergyFigure = "W020", "Uncertain energy or efficiency.";
    ErrorEstimate = "W021", "Large or unknown numerical error.";
    PlaneCell = "W022", "Incomplete coefficients of a section.";
    BeyondRange = "W023", "States outside the range of the model.";
    FastGas = "W024", "Gas flow near the speed of sound.";
    LostModes = "W025", "Modes missing from the list.";
    PartOfStream = "W026", "Incomplete model of a stream.";
    Overshoot = "W028", "Spline overshoots its points.";
    Fit = "W029", "Doubtful fit.";
    Trapped = "W030", "Fluid behind a closed valve.";
    Seldom = "W031", "Unusual value.";
    UnexplainedPressures = "W032", "Pressures that the loads do not explain.";
    StateAside = "W033", "Another state under the same loads.";
    ModesExchanged = "W034", "Modes that change places.";
    Optimum = "W035", "Doubtful optimum.";
    FastLoad = "W036", "Load unresolved between knots.";
    LateRest = "W037", "Fluid not at rest within the run.";
    WaterHammer = "W038", "Unresolved water hammer.";
    Boiling = "W040", "A liquid below its vapor pressure.";
    OtherCells = "W041", "Cells differ from those in the middle.";
    Controller = "W044", "A controller that does not act.";
}

impl Code {
    /// Prefixes a warning with its number.
    pub fn warning(self, text: impl std::fmt::Display) -> String {
        format!("{} {text}", self.id())
    }

    /// Finds the code of a number. Case and leading zeros do not matter; a retired number yields its replacement.
    pub fn find(id: &str) -> Option<Self> {
        let number = |id: &str| Some((id.get(..1)?.to_ascii_uppercase(), id.get(1..)?.parse::<u32>().ok()?));
        let wanted = number(id)?;
        let row = |line: &'static str| line.strip_prefix("| ")?.strip_suffix(" |")?.split_once(" | ");
        let mut retired = PAGE.lines().filter_map(row);
        let wanted = match retired.find(|(old, _)| number(old).as_ref() == Some(&wanted)) {
            Some((_, new)) => number(new)?,
            None => wanted,
        };
        Self::ALL
            .iter()
            .copied()
            .find(|code| number(code.id()).as_ref() == Some(&wanted))
    }

    /// Title: the heading of the section.
    pub fn title(self) -> &'static str {
        let heading = self.section().lines().next().unwrap_or_default();
        heading.split_once(' ').map_or(heading, |(_, title)| title)
    }

    /// Explanation with meaning, cause and remedy: the section without its heading.
    pub fn text(self) -> &'static str {
        self.section().split_once('\n').map_or("", |(_, text)| text.trim())
    }

    fn section(self) -> &'static str {
        let sections = PAGE.split("\n### ").skip(1);
        let mine = sections.map(|s| s.split("\n## ").next().unwrap_or(s));
        mine.into_iter().find(|s| s.starts_with(self.id())).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: every code has exactly one section, with a heading and a remedy; every section has a code.
    #[test]
    fn the_page_explains_each_number_once() {
        for code in Code::ALL {
            assert!(code.title().len() > 5, "{code:?} has no heading");
            assert!(code.text().contains("**Remedy.**"), "{code:?} has no remedy");
        }
        let headings: Vec<&str> = PAGE.lines().filter_map(|l| l.strip_prefix("### ")).collect();
        let ids: Vec<&str> = Code::ALL.iter().map(|c| c.id()).collect();
        let documented: Vec<&str> = headings.iter().filter_map(|h| h.split(' ').next()).collect();
        assert_eq!(documented, ids);
        assert_eq!(Code::find("e16"), Some(Code::Wiring));
    }
}
