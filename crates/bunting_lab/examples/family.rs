//! One family of contacts or hard cases, without the others.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example family -- itself quick|full
//! ```

use anyhow::{Context, Result, bail};
use bunting_lab::{contacts, stability};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, size] = &arguments[..] else { bail!("FAMILY quick|full") };
    let is_quick = size == "quick";
    if let Some((_, cases)) = stability::ALL.iter().find(|(known, _)| known == name) {
        for case in cases(is_quick) {
            let worst = case.worst.unwrap_or(f64::NAN);
            println!("{}: {worst} of {}, {}", case.name, case.limit, case.figure);
        }
        return Ok(());
    }
    let family = contacts::ALL.iter().find(|(known, _)| known == name);
    let (_, rows) = family.context("no such family")?;
    for row in rows(is_quick) {
        let figure = row.figure.unwrap_or(f64::NAN);
        println!("{}: {figure} of {}, {:.0} µs a tick", row.name, row.limit, row.us);
    }
    Ok(())
}
