//! Shell, style, scripts and data as one text.

use super::Page;

const SHELL: &str = include_str!("page/shell.html");

const STYLES: [&str; 4] = [
    include_str!("vendor/uPlot.min.css"),
    include_str!("page/base.css"),
    include_str!("page/figures.css"),
    include_str!("page/print.css"),
];

/// Scripts in the order of execution: each uses those before it.
const SCRIPTS: [&str; 20] = [
    include_str!("page/base.js"),
    include_str!("page/colour.js"),
    include_str!("page/clock.js"),
    include_str!("page/plot.js"),
    include_str!("page/downloads.js"),
    include_str!("page/wires.js"),
    include_str!("page/scene.js"),
    include_str!("page/beam.js"),
    include_str!("page/structure.js"),
    include_str!("page/animation.js"),
    include_str!("page/profiles.js"),
    include_str!("page/maps.js"),
    include_str!("page/histories.js"),
    include_str!("page/ledger.js"),
    include_str!("page/tables.js"),
    include_str!("page/charts.js"),
    include_str!("page/facts.js"),
    include_str!("page/kinds.js"),
    include_str!("page/states.js"),
    include_str!("page/main.js"),
];

const VENDOR: &str = include_str!("vendor/uPlot.iife.min.js");
const LICENCE: &str = include_str!("vendor/LICENSE");

/// Assembles the page that shows the data.
pub fn assemble(page: &Page) -> String {
    let json = serde_json::to_string(&page.data).unwrap_or_default();
    let scripts: Vec<&str> = SCRIPTS.iter().map(|s| s.trim()).collect();
    // One pass from left to right: inserted text is never searched for marks.
    let parts = [
        ("{{title}}", escaped(&page.name)),
        ("{{licence}}", LICENCE.trim().replace("--", "- -")),
        ("{{style}}", STYLES.map(str::trim).join("\n")),
        // In a script element only `<` could end it, or begin a comment.
        ("{{data}}", json.replace('<', "\\u003c")),
        ("{{vendor}}", VENDOR.trim().to_string()),
        ("{{script}}", scripts.join("\n")),
    ];
    let mut out = String::new();
    let mut rest = SHELL;
    for (mark, text) in parts {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        out.push_str(before);
        out.push_str(&text);
        rest = after;
    }
    out.push_str(rest);
    out
}

/// Escapes text for markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_case_says_stays_text() {
        let mut page = Page {
            name: "</script><img src=x onerror=alert(1)> {{script}}".into(),
            ..Page::default()
        };
        page.put("name", page.name.clone());
        let page = assemble(&page);
        assert!(!page.contains("<img src=x"));
        assert!(page.contains("&lt;/script&gt;"));
        assert!(page.contains("\\u003c/script>"));
        assert_eq!(page.matches("</html>").count(), 1);
    }
}
