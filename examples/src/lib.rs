//! Code shared by the examples of `bevy_bunting`, which live beside this folder, one folder each.
//!
//! An [`Example`] is simulated by [`headless`] and, with the feature `render`, drawn by `render`.

pub mod durations;
mod example;
pub mod headless;
pub mod limits;
#[cfg(feature = "render")]
pub mod render;
pub mod strain;
pub mod table;

pub use example::{Example, Options, Record};

/// Folder of scenes and models.
pub const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets");

/// The README, whose first example is tested here.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

#[cfg(test)]
mod tests {
    #[test]
    fn the_readme_shows_the_example_that_is_compiled() {
        let example = include_str!("../hello_flag/main.rs");
        let (_, code) = example.split_once("\n\n").expect("a header");
        let readme = include_str!("../../README.md");
        assert!(
            readme.contains(code),
            "README.md shows another hello_flag than examples/hello_flag"
        );
    }
}
