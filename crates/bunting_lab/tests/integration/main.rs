//! Tests of the bench through its library and its binary, in one program but for the one that counts memory.

mod baselines;
mod command_line;
mod costs;
mod files;
mod reference;
mod trials;
