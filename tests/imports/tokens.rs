//! Source as words and signs.

/// Words and signs of a source, without comments, literals and code for tests alone. `::` and `..` are one sign each.
pub fn tokens(source: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let word = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let hashes = rest.len() - rest.trim_start_matches('#').len();
        let (length, kept) = if rest.starts_with("//") {
            (after(rest, "\n"), false)
        } else if rest.starts_with("/*") {
            (after(rest, "*/"), false)
        } else if matches!(tokens.last(), Some(&("r" | "br" | "cr")))
            && rest[hashes..].starts_with('"')
        {
            let opened = hashes + 1;
            (opened + after(&rest[opened..], &format!("\"{}", &rest[..hashes])), false)
        } else if first == '"'
            || first == '\'' && (rest[1..].starts_with('\\') || rest.chars().nth(2) == Some(first))
        {
            (quoted(rest, first), false)
        } else if word > 0 {
            (word, !first.is_ascii_digit())
        } else if rest.starts_with("::") || rest.starts_with("..") {
            (2, true)
        } else {
            (first.len_utf8(), !first.is_whitespace())
        };
        if kept {
            tokens.push(&rest[..length]);
        }
        rest = &rest[length..];
    }
    without_tests(&tokens)
}

/// The bytes up to the first `end`, with it.
fn after(source: &str, end: &str) -> usize {
    source.find(end).map_or(source.len(), |at| at + end.len())
}

/// The bytes of a literal that begins with `quote`.
fn quoted(source: &str, quote: char) -> usize {
    let mut escaped = false;
    let ends = |&(_, c): &(usize, char)| {
        let ends = c == quote && !escaped;
        escaped = c == '\\' && !escaped;
        ends
    };
    source.char_indices().skip(1).find(ends).map_or(source.len(), |(at, _)| at + 1)
}

/// Leaves out the items with the attribute `#[cfg(test)]`.
fn without_tests<'a>(tokens: &[&'a str]) -> Vec<&'a str> {
    let of_test = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if !tokens[at..].starts_with(&of_test) {
            kept.push(tokens[at]);
            at += 1;
            continue;
        }
        let mut depth = 0;
        let mut is_use = false;
        at += of_test.len();
        while at < tokens.len() {
            let token = tokens[at];
            at += 1;
            is_use |= token == "use";
            depth += i32::from(["(", "[", "{"].contains(&token))
                - i32::from([")", "]", "}"].contains(&token));
            if depth == 0 && ([";", ","].contains(&token) || token == "}" && !is_use) {
                break;
            }
        }
    }
    kept
}
