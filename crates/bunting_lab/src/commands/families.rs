//! Families of cases: they are independent of one another, so they run on all cores.

use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;
use serde_json::{Value, json};

use super::progress;
use crate::{
    output::table::{Table, figure},
    parallel,
};

/// The families that run: all of them unless some are named.
#[derive(Clone, Debug, Default, Args)]
pub struct Selection {
    /// Run this family of cases alone; may be given several times.
    #[arg(long = "family", value_name = "NAME")]
    names: Vec<String>,
}

impl Selection {
    /// The selected entries of `all`, in their order.
    ///
    /// # Errors
    ///
    /// No family has a given name; the error lists the names that there are.
    pub fn of<Entry: Copy>(
        &self,
        all: &[(&'static str, Entry)],
    ) -> Result<Vec<(&'static str, Entry)>> {
        if let Some(unknown) = self.names.iter().find(|name| all.iter().all(|(it, _)| it != name)) {
            let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
            bail!("no family is called {unknown:?}; there are {}", names.join(", "));
        }
        let is_selected =
            |name: &str| self.names.is_empty() || self.names.iter().any(|it| it == name);
        Ok(all.iter().copied().filter(|(name, _)| is_selected(name)).collect())
    }
}

/// The cases of one family.
#[derive(Debug)]
pub struct Family<Case> {
    /// Name of the family.
    pub name: &'static str,
    /// Cases of the family, in their order.
    pub cases: Vec<Case>,
    /// Wall-clock time of the family, s.
    pub seconds: f64,
}

/// Runs every family; `run` receives the entry beside the family's name.
pub fn run<Entry: Copy + Sync, Case: Send>(
    all: &[(&'static str, Entry)],
    run: impl Fn(Entry) -> Vec<Case> + Sync,
) -> Vec<Family<Case>> {
    let bar = progress(all.len());
    let families = parallel::map(all, |&(name, entry)| {
        let start = Instant::now();
        let cases = run(entry);
        bar.inc(1);
        Family { name, cases, seconds: start.elapsed().as_secs_f64() }
    });
    bar.finish_and_clear();
    families
}

/// Table of the families' times, the longest first.
#[must_use]
pub fn times<Case>(command: &str, families: &[Family<Case>]) -> Table {
    let mut longest_first: Vec<_> = families.iter().collect();
    longest_first.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let sum: f64 = families.iter().map(|family| family.seconds).sum();
    Table {
        name: format!("{command}_times"),
        title: format!("Time of the families of {command}, {} s on their threads", figure(sum)),
        headers: vec!["family", "cases", "s"],
        rows: longest_first
            .into_iter()
            .map(|it| vec![it.name.into(), it.cases.len().to_string(), figure(it.seconds)])
            .collect(),
    }
}

/// Name, number of cases and time of each family, as JSON.
#[must_use]
pub fn json<Case>(families: &[Family<Case>]) -> Value {
    let family = |it: &Family<Case>| json!({ "name": it.name, "cases": it.cases.len(), "seconds": it.seconds });
    families.iter().map(family).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [(&str, u8); 3] = [("fall", 1), ("drag", 2), ("spin", 3)];

    fn selected(names: &[&str]) -> Result<Vec<u8>> {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        let entries = Selection { names }.of(&ALL)?;
        Ok(entries.into_iter().map(|(_, entry)| entry).collect())
    }

    #[test]
    fn named_families_run_in_their_order_and_all_without_names() {
        assert_eq!(selected(&[]).unwrap(), [1, 2, 3]);
        assert_eq!(selected(&["spin", "fall"]).unwrap(), [1, 3]);
        let error = selected(&["fall", "swim"]).unwrap_err().to_string();
        assert!(error.contains("swim") && error.contains("drag"), "{error}");
    }
}
