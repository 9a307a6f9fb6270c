//! The committed file of physical figures, one a line: its name and its value, separated by a tab. The file says which figures are
//! watched; a new line needs only a name.

use std::collections::BTreeMap;

use anyhow::{Context, Result};

use crate::{figure::Figure, output::table::figure as rounded};

/// The committed file.
pub const EXPECTED: &str = include_str!("../../expected/figures.tsv");

/// The file with measured values. Families of cases that have not been run keep theirs.
///
/// # Errors
///
/// When a figure of the file was not measured.
pub fn list(file: &str, measured: &[Figure]) -> Result<String> {
    let values = by_name(measured);
    let line = |name: &str| {
        let figure = values.get(name).with_context(|| format!("no figure is named \"{name}\""))?;
        Ok(format!("{name}\t{}\n", rounded(figure.value)))
    };
    file.lines().map(|it| line(name_and_value(it).0)).collect()
}

/// What differs from the file: names of figures, and how.
#[must_use]
pub fn differences(file: &str, measured: &[Figure]) -> Vec<[String; 2]> {
    let values = by_name(measured);
    let difference = |line: &str| {
        let (name, before) = name_and_value(line);
        let how = match values.get(name) {
            None => "is a figure of the file, and does not exist".to_owned(),
            Some(now) if now.has_changed_from(before) => {
                format!("was {}, and is {}", rounded(before), rounded(now.value))
            }
            Some(_) => return None,
        };
        Some([name.to_owned(), how])
    };
    file.lines().filter_map(difference).collect()
}

fn by_name(figures: &[Figure]) -> BTreeMap<&str, &Figure> {
    figures.iter().map(|figure| (figure.name.as_str(), figure)).collect()
}

/// Name and value of a line; NaN where the line has no number.
fn name_and_value(line: &str) -> (&str, f64) {
    let (name, value) = line.split_once('\t').unwrap_or((line, ""));
    (name, value.parse().unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures() -> [Figure; 3] {
        [("a", 1.0), ("b", 20.0), ("c", f64::INFINITY)]
            .map(|(name, value)| Figure::new(name, value, 1e-3))
    }

    #[test]
    fn what_is_written_is_no_difference() {
        let file = list("b\t7\nc\na", &figures()).expect("all are measured");
        assert_eq!(file, "b\t20.00\nc\tinf\na\t1.000\n");
        assert!(differences(&file, &figures()).is_empty());
    }

    #[test]
    fn changed_and_vanished_figures_are_differences() {
        let names = |file| differences(file, &figures()).into_iter().map(|[name, _]| name);
        let found: Vec<String> = names("a\t1.03\nb\t20.1\nc\t3\nd\t1\n").collect();
        assert_eq!(found, ["a", "c", "d"]);
        assert!(list("d\t1\n", &figures()).is_err());
    }
}
