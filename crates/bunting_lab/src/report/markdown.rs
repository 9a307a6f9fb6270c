//! The report as Markdown, with its plots in files of their own.

use std::{fmt::Write, fs, path::Path};

use anyhow::{Context, Result};

use super::{limits::limits, machine::Machine, section::Section};
use crate::output::table::Table;

/// Name of the document, and of the folder of its plots, without their endings.
const NAME: &str = "measurements";
/// Number of rows from which a table is folded.
const LONG: usize = 20;

/// Writes `measurements.md` into a folder, and its plots into `measurements/`.
///
/// # Errors
///
/// When a plot cannot be drawn, or a file cannot be written.
pub fn write(folder: &Path, sections: &[Section], machine: &Machine, quick: bool) -> Result<()> {
    let plots = folder.join(NAME);
    fs::create_dir_all(&plots).with_context(|| format!("cannot create {}", plots.display()))?;
    for plot in sections.iter().flat_map(|it| &it.outcome).flat_map(|outcome| &outcome.plots) {
        plot.write_svg(&plots)?;
    }
    let path = folder.join(format!("{NAME}.md"));
    fs::write(&path, render(sections, machine, quick))
        .with_context(|| format!("cannot write {}", path.display()))
}

/// The document.
#[must_use]
pub fn render(sections: &[Section], machine: &Machine, quick: bool) -> String {
    let mut text = String::from(
        "# Measurements\n\n\
         Written by `cargo run --release -p bunting_lab -- report`; not to be edited by hand.\n\n",
    );
    push(&mut text, &format!("Measured on {machine}."));
    if let Some(load) = machine.foreign_load() {
        let warning = "**Other programs used the machine (load average";
        push(&mut text, &format!("{warning} {load:.1} at the start): times are too long.**"));
    }
    if quick {
        push(&mut text, "**A quick run: few sizes and repetitions, figures are rough.**");
    }
    for section in sections {
        push_section(&mut text, section);
    }
    text.push_str("## What the project cannot do yet\n\n");
    for limit in limits() {
        writeln!(text, "- {limit}").expect("a string takes all");
    }
    text
}

fn push(text: &mut String, paragraph: &str) {
    text.push_str(paragraph);
    text.push_str("\n\n");
}

fn push_section(text: &mut String, section: &Section) {
    push(text, &format!("## {}: {}", section.command, section.measures));
    let seconds = section.took.as_secs_f64();
    let command = &section.command_line;
    push(text, &format!("`{command}`, {seconds:.0} s; `--out DIR` writes its tables and plots."));
    for finding in section.findings() {
        let sign = if finding.good { "✓" } else { "✗" };
        writeln!(text, "- {sign} {}", finding.text).expect("a string takes all");
    }
    text.push('\n');
    let Ok(outcome) = &section.outcome else { return };
    for plot in &outcome.plots {
        push(text, &format!("![{}]({NAME}/{}.svg)", plot.title, plot.name));
    }
    for table in &outcome.tables {
        if table.rows.len() < LONG {
            push(text, &format!("**{}**", table.title));
            push(text, &lines(table));
        } else {
            push(text, &format!("<details><summary>{}</summary>", escaped(&table.title)));
            push(text, &lines(table));
            push(text, "</details>");
        }
    }
}

fn lines(table: &Table) -> String {
    let line = |cells: &mut dyn Iterator<Item = String>| {
        format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
    };
    let mut lines = vec![
        line(&mut table.headers.iter().map(|header| escaped(header))),
        line(&mut table.headers.iter().map(|_| "---".to_owned())),
    ];
    lines.extend(table.rows.iter().map(|row| line(&mut row.iter().map(|cell| escaped(cell)))));
    lines.join("\n")
}

/// Text with escaped ends of cells and beginnings of tags.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use serde_json::json;

    use super::*;
    use crate::output::{
        Outcome,
        plot::{Axes, Mark, Plot, Series},
    };

    fn section(outcome: Result<Outcome, String>) -> Section {
        Section {
            command: "oracles",
            command_line: "oracles --some".into(),
            measures: "closed forms",
            outcome,
            took: Duration::from_secs(2),
        }
    }

    fn outcome() -> Outcome {
        let plot = Plot {
            name: "dots".into(),
            title: "Dots".into(),
            labels: ["x".into(), "y".into()],
            axes: Axes::Logarithmic,
            series: vec![Series {
                name: "dots".into(),
                points: vec![(1.0, 1.0)],
                mark: Mark::Dots,
            }],
        };
        let table = Table {
            name: "cases".into(),
            title: "Cases".into(),
            headers: vec!["name"],
            rows: vec![vec!["|a| < b".into()]],
        };
        Outcome { json: json!({}), tables: vec![table], plots: vec![plot] }
    }

    #[test]
    fn a_document_is_written_beside_its_plots() {
        let folder = std::env::temp_dir().join(format!("bunting-lab-md-{}", std::process::id()));
        write(&folder, &[section(Ok(outcome()))], &Machine::here(), true).expect("a document");
        let text = fs::read_to_string(folder.join("measurements.md")).expect("the document");
        for part in [
            "`oracles --some`",
            "![Dots](measurements/dots.svg)",
            "| \\|a\\| &lt; b |",
            "A quick run",
            &limits()[0],
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert!(folder.join("measurements/dots.svg").exists());
        fs::remove_dir_all(folder).expect("the folder is ours");
    }

    #[test]
    fn a_section_that_failed_says_why() {
        let text = render(&[section(Err("no such scene".into()))], &Machine::here(), false);
        assert!(text.contains("✗ not measured: no such scene"), "{text}");
        assert!(!text.contains("A quick run"));
    }
}
