//! Checks of spans whose section is given by its geometry, against bladders and finite strain of the case.

use slcbeam_section::input::Section;

use crate::case::faults::Violations;
use crate::case::schema::{Case, ROUNDING, SpanRows};
use crate::case::{section, spans};
use crate::error::{Code, Violation};

/// Checks the section of span `k`.
pub(super) fn check(case: &Case, k: usize, own: &Section, faults: &mut Violations) {
    let rows = section::rows(own);
    if rows == SpanRows::None {
        return;
    }
    let at = format!("/spans/{k}/section");
    let Some(bladders) = &case.bladders else {
        let what = "the section has bladders, but the case has no bladders";
        let fault = Violation::new(Code::Together, format!("{at}/bladders"), what);
        faults.push(
            fault.hint("add \"bladders\" or \"section\" to the case, or give both rows of this section as \"none\""),
        );
        return;
    };
    let possible = spans::rows(case);
    let missing = [0, 1].into_iter().find(|row| rows.has()[*row] && !possible[*row]);
    if let Some(row) = missing {
        let name = ["upper", "lower"][row];
        let what = format!("the section has bladders in the {name} row, but the case has no {name} row");
        let fault = Violation::new(Code::Together, format!("{at}/bladders/{name}"), what);
        let fault = fault.allowed("\"none\", as for /bladders/lower");
        faults.push_beside(&["/bladders/lower"], fault.hint("or give the case both rows"));
    }
    let length = own.bladders.length_m;
    if (length - bladders.length_m).abs() > ROUNDING * bladders.length_m {
        let what = format!("{length} m, but bladders of the case are {} m long", bladders.length_m);
        let fault = Violation::new(Code::Together, format!("{at}/bladders/length_m"), what);
        let fault = fault.allowed(bladders.length_m.to_string());
        let hint =
            "all bladders of a beam have one length across its width, /bladders/length_m or /section/bladders/length_m";
        faults.push_beside(&["/bladders/length_m", "/section"], fault.hint(hint));
    }
    let of_case = bladders.strain_energy.is_some();
    let law = own.material.law.is_some();
    if of_case && case.section.as_ref() != Some(own) {
        let what = "a section of its own with bladders, in a beam at finite strain";
        let fault = Violation::new(Code::Together, at, what);
        let fault = fault.allowed("the section of the case, /section, or one without bladders");
        faults.push(fault.hint(
            "or remove /bladders/strain_energy, and give \"law\": \"linear\" in all sections: all are then linear",
        ));
    } else if law && !of_case {
        let what = "a law at finite strain in a span with bladders, in a beam whose section is linear";
        let fault = Violation::new(Code::Together, format!("{at}/material"), what);
        faults.push(fault.hint("give \"law\": \"linear\" beside the material: the section of the span is then linear"));
    }
}
