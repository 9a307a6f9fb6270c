//! The output of a command: printed, and written to files.

pub mod plot;
pub mod table;
pub mod verdicts;

use std::{fs, io::Write, path::Path};

use anyhow::{Context, Result};

use plot::Plot;
use table::Table;

/// Everything that a command measured.
#[derive(Debug)]
pub struct Outcome {
    /// The JSON object.
    pub json: serde_json::Value,
    /// Readable tables; each is also a CSV file.
    pub tables: Vec<Table>,
    /// Plots, each an SVG file.
    pub plots: Vec<Plot>,
}

impl Outcome {
    /// Prints JSON or tables on standard output, and writes CSV and SVG files into `folder`.
    ///
    /// # Errors
    ///
    /// When a file or standard output cannot be written.
    pub fn present(&self, json: bool, folder: Option<&Path>) -> Result<()> {
        if let Some(folder) = folder {
            fs::create_dir_all(folder)
                .with_context(|| format!("cannot create {}", folder.display()))?;
            for table in &self.tables {
                table.write_csv(folder)?;
            }
            for plot in &self.plots {
                plot.write_svg(folder)?;
            }
        }
        let mut stdout = std::io::stdout().lock();
        if json {
            serde_json::to_writer(&mut stdout, &self.json)?;
            writeln!(stdout)?;
        } else {
            for table in &self.tables {
                writeln!(stdout, "{}\n{}\n", table.title, table.render())?;
            }
        }
        Ok(())
    }
}
