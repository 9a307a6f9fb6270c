//! The gallery in a browser: a page shows the example that its address names, and has a link to each.

use std::process::ExitCode;

use bunting_examples::Options;
use clap::ValueEnum;
use web_sys::{Document, window};

use crate::address;
use crate::exhibit::Exhibit;

/// Id of the page's element that gets the links.
const LINKS: &str = "examples";

/// Shows the example that the address names.
pub fn show(options: &Options) -> ExitCode {
    if let Some(document) = window().and_then(|window| window.document()) {
        Exhibit::value_variants().iter().for_each(|exhibit| add_link(&document, *exhibit));
    }
    address::exhibit().run(options)
}

fn add_link(document: &Document, exhibit: Exhibit) {
    let name = exhibit.name();
    let parts = document.get_element_by_id(LINKS).zip(document.create_element("a").ok());
    if let Some((links, link)) = parts {
        link.set_text_content(Some(&name));
        // A new element takes any attribute, and any place.
        let _ = link.set_attribute("href", &format!("?{name}"));
        let _ = links.append_child(&link);
    }
}
