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
    Text = "E001", "The file is not JSON text.";
    Kind = "E002", "A value of another kind than wanted.";
    Name = "E003", "A name that is none of those allowed.";
    Key = "E004", "A key that is not known.";
    Missing = "E005", "A key that is missing.";
    Range = "E006", "A number out of its range.";
    Count = "E007", "An array with too few or too many entries.";
    Table = "E008", "A table that cannot be used.";
    Function = "E009", "A function of time or place that cannot be used.";
    Implausible = "E010", "A size that no such beam has.";
    Together = "E011", "Parts that only make sense together, or contradict each other.";
    Geometry = "E012", "Bladders that do not fit into the beam.";
    Slopes = "E013", "Data of a bladder that contradict each other.";
    Wiring = "E014", "A network that cannot be wired so.";
    Times = "E019", "Times that contradict each other.";
    CaseName = "E020", "A name that cannot be used.";
    Effect = "E021", "An effect that cannot be left out.";
    Usage = "E030", "A command line that makes no sense.";
    NoStart = "E040", "No consistent state to start or go on from.";
    Integrator = "E041", "The integrator cannot go on.";
    Singular = "E042", "The equations lose their unique solution.";
    Steps = "E043", "The steps allowed are used up.";
    NoEquilibrium = "E045", "No equilibrium is found.";
    NoCycle = "E046", "No motion over a period.";
    NoModes = "E047", "No modes are found.";
    OutOfRange = "E048", "The result leaves what the model describes.";
    Interrupted = "E049", "A command that was interrupted.";
    File = "E050", "A file that cannot be read or written.";
    Reciprocity = "W001", "A coupling that is not reciprocal.";
    CouplingLaw = "W002", "A coupling that is not passive, solvable or convex.";
    FastFlow = "W003", "Flow that is not creeping.";
    Strain = "W004", "Strains that are not small.";
    Stocky = "W005", "A beam that is not slender.";
    Mathieu = "W006", "Shaking inside a Mathieu tongue.";
    Growth = "W007", "A deflection that grows.";
    EnergyOpen = "W008", "A balance that stays open.";
    LostConvexity = "W009", "A potential that lost convexity during the run.";
    Buckling = "W010", "A straight beam beyond its buckling load.";
    OrderHeld = "W011", "An order held down for stability.";
    Accuracy = "W012", "An accuracy that is not reached, or not known.";
    NotAtRest = "W013", "Modes about a state that is no equilibrium.";
    FewOutputs = "W015", "Output times that miss the motion.";
    Unresolved = "W016", "A shape along the beam that the mesh does not resolve.";
    Inherited = "W017", "Coefficients of another beam.";
    PortFlow = "W019", "Flow through ports that does not follow its law.";
    EnergyFigure = "W020", "A figure of energy that its balance does not carry.";
    ErrorEstimate = "W021", "An error that may be larger than it seems.";
    PlaneCell = "W022", "Coefficients that leave out a part of the section.";
    BeyondRange = "W023", "States beyond what the model describes.";
    FastGas = "W024", "Gas that flows nearly as fast as sound.";
    LostModes = "W025", "Modes that were not found again.";
    PartOfStream = "W026", "A stream of which the model has a part.";
    Overshoot = "W028", "A curve that swings beyond its points.";
    Fit = "W029", "A fit that tells less than it seems.";
    Trapped = "W030", "Fluid behind a valve that has shut.";
    Seldom = "W031", "Something that is seldom meant.";
    UnexplainedPressures = "W032", "Pressures that the loads do not explain.";
    StateAside = "W033", "Loads whose path leads to another state.";
    ModesExchanged = "W034", "Modes that change places from one design to the next.";
    Optimum = "W035", "A best that may be none.";
    FastLoad = "W036", "A load that may change faster than it is followed.";
    LateRest = "W037", "Fluid that comes to rest later than the run lasts.";
    WaterHammer = "W038", "A valve that shuts faster than a pressure wave returns.";
    Boiling = "W040", "A liquid below its vapor pressure.";
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
            assert!(code.text().contains("**Do.**"), "{code:?} does not say what to do");
        }
        let headings: Vec<&str> = PAGE.lines().filter_map(|l| l.strip_prefix("### ")).collect();
        let ids: Vec<&str> = Code::ALL.iter().map(|c| c.id()).collect();
        let told: Vec<&str> = headings.iter().filter_map(|h| h.split(' ').next()).collect();
        assert_eq!(told, ids);
        assert_eq!(Code::find("e16"), Some(Code::Wiring));
    }
}
