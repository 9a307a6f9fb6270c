//! Limitations of the project, listed beside its figures: those that its README names.

/// The README.
const README: &str = include_str!("../../../../README.md");

/// Heading of the list in the README, and the beginning of the next heading.
const HEADINGS: [&str; 2] = ["\n## Missing features\n", "\n## "];

/// Limitations that a reader of the figures should know, each in one line.
#[must_use]
pub fn limits() -> Vec<String> {
    let [own, next] = HEADINGS;
    let list = README.split_once(own).map_or("", |(_, after)| after);
    let list = list.split_once(next).map_or(list, |(list, _)| list);
    let items = list.split("\n- ").skip(1);
    items.map(|item| item.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_are_those_of_the_readme() {
        let limits = limits();
        assert!(limits.iter().any(|limit| limit.contains("GPU")), "{limits:?}");
        assert!(limits.iter().all(|limit| !limit.is_empty() && !limit.contains('#')));
    }
}
