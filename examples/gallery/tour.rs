//! The gallery on a desktop: each example has its own process.

use std::env;
use std::io;
use std::process::{Command, ExitCode};

use clap::ValueEnum;

use crate::exhibit::Exhibit;
use crate::exit;

/// Runs each example without a window. Fails if one of them does.
pub fn run_all() -> io::Result<ExitCode> {
    let mut code = ExitCode::SUCCESS;
    for exhibit in Exhibit::value_variants() {
        println!("{exhibit:?}");
        if run(*exhibit)? != Some(0) {
            code = ExitCode::FAILURE;
        }
    }
    Ok(code)
}

/// Shows examples in windows, until one is closed.
pub fn show() -> io::Result<ExitCode> {
    let exhibits = Exhibit::value_variants();
    let mut shown = 0;
    loop {
        let code = run(exhibits[shown])?.and_then(|code| u8::try_from(code).ok());
        match code.and_then(|code| exit::after(shown, code, exhibits.len())) {
            Some(asked) => shown = asked,
            None if code == Some(0) => return Ok(ExitCode::SUCCESS),
            None => return Ok(ExitCode::FAILURE),
        }
    }
}

/// Runs an example in a process of its own with this process's options. Returns its exit code.
fn run(exhibit: Exhibit) -> io::Result<Option<i32>> {
    let mut command = Command::new(env::current_exe()?);
    command.args(env::args_os().skip(1)).args(["--only", &exhibit.name()]);
    command.status().map(|status| status.code())
}
