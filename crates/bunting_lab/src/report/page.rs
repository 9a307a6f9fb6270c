//! The page: self-contained, from the summary down to the tables.

use anyhow::Result;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{findings::Finding, machine::Machine, section::Section};
use crate::output::table::Table;

/// Number of rows from which a table is folded.
const LONG: usize = 12;
/// Style sheet of the page.
const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; font-size: 0.85rem; margin: 0.5rem 0; }
th, td { padding: 0.1rem 0.6rem; text-align: left; border-bottom: 1px solid #ddd; }
svg { max-width: 100%; height: auto; }
.good li::marker { content: '✓ '; color: #080; } .bad li::marker { content: '✗ '; color: #b00; }
.scroll { overflow-x: auto; } summary { cursor: pointer; }
";

/// The whole page.
///
/// # Errors
///
/// When a plot cannot be drawn.
pub fn render(sections: &[Section], machine: &Machine, quick: bool) -> Result<String> {
    let bodies = sections.iter().map(section).collect::<Result<Vec<Markup>>>()?;
    let found: Vec<(&str, Finding)> = sections
        .iter()
        .flat_map(|section| section.findings().into_iter().map(|it| (section.command, it)))
        .collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "bevy_bunting: measurements" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "bevy_bunting: measurements" }
                @if quick {
                    p { strong { "A quick run: few sizes and repetitions, figures are rough." } }
                }
                h2 { "What was measured" }
                ul {
                    @for section in sections {
                        li {
                            a href={ "#" (section.command) } { (section.command) }
                            ": " (section.measures)
                            " (" (format!("{:.0} s", section.took.as_secs_f64())) ")"
                        }
                    }
                }
                h2 { "On what" }
                p { (machine) }
                @if let Some(load) = machine.foreign_load() {
                    p {
                        strong {
                            "Other programs used the machine (load average "
                            (format!("{load:.1}")) " at the start): times are too long."
                        }
                    }
                }
                h2 { "What is good" }
                (list(&found, true))
                h2 { "What is not" }
                (list(&found, false))
                @for body in &bodies { (body) }
            }
        }
    };
    Ok(page.into_string())
}

fn list(found: &[(&str, Finding)], good: bool) -> Markup {
    html! {
        ul class=(if good { "good" } else { "bad" }) {
            @for (command, finding) in found.iter().filter(|(_, finding)| finding.good == good) {
                li { b { (command) } ": " (finding.text) }
            }
        }
    }
}

fn section(section: &Section) -> Result<Markup> {
    let Ok(outcome) = &section.outcome else { return Ok(html! {}) };
    let plots = outcome.plots.iter().map(|plot| Ok(PreEscaped(plot.svg()?)));
    let plots = plots.collect::<Result<Vec<_>>>()?;
    Ok(html! {
        h2 id=(section.command) { (section.command) }
        p { (section.measures) }
        @for plot in &plots { figure { (plot) } }
        @for measured in &outcome.tables {
            @if measured.rows.len() < LONG {
                h3 { (measured.title) }
                (table(measured))
            } @else {
                details { summary { (measured.title) } (table(measured)) }
            }
        }
    })
}

fn table(measured: &Table) -> Markup {
    html! {
        div class="scroll" {
            table {
                tr { @for header in &measured.headers { th { (header) } } }
                @for row in &measured.rows {
                    tr { @for cell in row { td { (cell) } } }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use serde_json::json;

    use super::*;
    use crate::output::Outcome;

    #[test]
    fn a_page_shows_findings_and_tables() {
        let case = json!({ "name": "fall", "pass": true, "relative_error": 0.0, "tolerance": 1.0 });
        let table = Table {
            name: "cases".into(),
            title: "Cases".into(),
            headers: vec!["name"],
            rows: vec![vec!["a < b".into()]],
        };
        let outcome =
            Outcome { json: json!({ "cases": [case] }), tables: vec![table], plots: Vec::new() };
        let section = Section {
            command: "oracles",
            command_line: "oracles".into(),
            measures: "closed forms",
            outcome: Ok(outcome),
            took: Duration::from_secs(2),
        };
        let page = render(&[section], &Machine::here(), true).expect("a page");
        assert!(page.contains("1 of 1 closed forms are met") && page.contains("a &lt; b"));
        assert!(!page.contains("src=") && !page.contains("<link"));
    }
}
