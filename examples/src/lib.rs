//! Scenes and shared code of the examples of `bevy_bunting`. The programs that run them are beside this folder.
//!
//! An [`Example`], such as those of [`scenes`], is simulated by [`headless`] and, with the feature `render`, drawn by
//! `render`.

pub mod durations;
mod example;
mod figure;
pub mod headless;
pub mod limits;
mod options;
mod orbit_example;
#[cfg(feature = "render")]
pub mod render;
mod run;
pub mod scenes;
pub mod strain;
pub mod table;
mod view;

pub use example::{Example, Record};
pub use options::Options;
pub use orbit_example::OrbitExample;
pub use run::run;
pub use view::View;

/// Folder of scenes and models; in browsers it is beside the page.
pub const ASSETS: &str = if cfg!(target_arch = "wasm32") {
    "assets"
} else {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../assets")
};

/// The README, whose first example is tested here.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

#[cfg(test)]
mod tests {
    #[test]
    fn the_readme_shows_the_example_that_is_compiled() {
        let example = include_str!("../hello_flag.rs");
        let (_, code) = example.split_once("\n\n").expect("a header");
        let readme = include_str!("../../README.md");
        assert!(
            readme.contains(code),
            "README.md shows another hello_flag than examples/hello_flag.rs"
        );
    }
}
