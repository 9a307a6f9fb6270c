//! Tables, for reading and as CSV.

use std::path::Path;

use anyhow::{Context, Result};

/// Rows of text under headers.
#[derive(Clone, Debug)]
pub struct Table {
    /// File name without its ending.
    pub name: String,
    /// Heading.
    pub title: String,
    /// Names of the columns.
    pub headers: Vec<&'static str>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The table as aligned text.
    #[must_use]
    pub fn render(&self) -> String {
        let mut table = comfy_table::Table::new();
        table.load_style(comfy_table::presets::UTF8_FULL_CONDENSED);
        table.set_header(&self.headers).add_rows(&self.rows);
        table.to_string()
    }

    /// Writes `name.csv` into the folder.
    ///
    /// # Errors
    ///
    /// When the file cannot be written.
    pub fn write_csv(&self, folder: &Path) -> Result<()> {
        let path = folder.join(format!("{}.csv", self.name));
        let mut writer = csv::Writer::from_path(&path)
            .with_context(|| format!("cannot write {}", path.display()))?;
        writer.write_record(&self.headers)?;
        for row in &self.rows {
            writer.write_record(row)?;
        }
        Ok(writer.flush()?)
    }
}

/// A number with four significant digits, in scientific notation if that is shorter; a dash for NaN.
#[must_use]
pub fn figure(value: f64) -> String {
    if value.is_nan() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    match value.abs() {
        size if (1e-2..1e5).contains(&size) => {
            let decimals = (3 - size.log10().floor() as i32).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.3e}"),
    }
}

/// A number formatted by [`figure`], or a dash.
#[must_use]
pub fn figure_or_dash(value: Option<f64>) -> String {
    value.map_or_else(|| "–".into(), figure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_four_digits() {
        assert_eq!(figure(2.34567), "2.346");
        assert_eq!(figure(f64::NAN), "–");
        assert_eq!(figure(0.05), "0.05000");
        assert_eq!(figure(12_345.6), "12346");
        assert_eq!(figure(-1.23456e-5), "-1.235e-5");
    }
}
