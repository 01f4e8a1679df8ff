//! A small scanner of Rust sources: tokens without comments and literals, and the modules that paths lead to.

/// A word or a mark of a source, with its line counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token<'a> {
    pub(crate) text: &'a str,
    pub(crate) line: usize,
}

/// The identifiers and marks of a source; comments, strings, characters and lifetimes are left out.
pub(crate) fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(first) = source[at..].chars().next() {
        let rest = &source[at..];
        let (length, is_token) = if first.is_alphabetic() || first == '_' {
            match raw_string_length(rest) {
                Some(length) => (length, false),
                None => (rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len()), true),
            }
        } else if rest.starts_with("//") {
            (rest.find('\n').unwrap_or(rest.len()), false)
        } else if rest.starts_with("/*") {
            (block_comment_length(rest), false)
        } else if first == '"' {
            (string_length(rest), false)
        } else if first == '\'' {
            (quote_length(rest), false)
        } else if rest.starts_with("::") {
            (2, true)
        } else {
            (first.len_utf8(), !first.is_whitespace())
        };
        if is_token {
            found.push(Token { text: &rest[..length], line });
        }
        line += rest[..length].matches('\n').count();
        at += length;
    }
    found
}

/// Length of a raw string `r"..."`, `br#"..."#` or `cr"..."` that opens `rest`, if one does.
fn raw_string_length(rest: &str) -> Option<usize> {
    let after_prefix = ["r", "br", "cr"].iter().find_map(|prefix| {
        rest.strip_prefix(prefix).filter(|after| after.starts_with('"') || after.starts_with('#'))
    })?;
    let hashes = after_prefix.len() - after_prefix.trim_start_matches('#').len();
    let body = after_prefix[hashes..].strip_prefix('"')?;
    let close = format!("\"{}", "#".repeat(hashes));
    let end = body.find(&close).map_or(body.len(), |end| end + close.len());
    Some(rest.len() - body.len() + end)
}

fn block_comment_length(rest: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < rest.len() {
        if rest[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if rest[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                break;
            }
        } else {
            at += rest[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    at
}

fn string_length(rest: &str) -> usize {
    let mut is_escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Length of a character literal with its quotes, or of the quote alone that opens a lifetime.
fn quote_length(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    match (chars.next(), chars.next()) {
        (Some((_, '\\')), Some((after, escaped))) => {
            let from = after + escaped.len_utf8();
            rest[from..].find('\'').map_or(rest.len(), |end| from + end + 1)
        }
        (Some(_), Some((at, '\''))) => at + 1,
        _ => 1,
    }
}

/// A path that leads to an item at the root of its crate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reference {
    /// The first name after the crate's root; `*` for all of it.
    pub(crate) target: String,
    /// Where it is written, counted from 1.
    pub(crate) line: usize,
}

/// The items at the root of its own crate that the source of module `path` names through `crate::` or `super::`.
pub(crate) fn root_references(source: &str, path: &[&str]) -> Vec<Reference> {
    let tokens = tokens(source);
    let mut found = Vec::new();
    // Inline modules around the current token, by the brace depth they opened at.
    let (mut inline_modules, mut depth) = (Vec::new(), 0_usize);
    for (index, token) in tokens.iter().enumerate() {
        let is_continued = index > 0 && tokens[index - 1].text == "::";
        match token.text {
            "{" => {
                depth += 1;
                if index >= 2 && tokens[index - 2].text == "mod" {
                    inline_modules.push(depth);
                }
            }
            "}" => {
                if inline_modules.last() == Some(&depth) {
                    inline_modules.pop();
                }
                depth = depth.saturating_sub(1);
            }
            "crate" | "super" | "self" if !is_continued => {
                let module_depth = path.len() + inline_modules.len();
                follow(&tokens, index, module_depth, &mut found);
            }
            _ => {}
        }
    }
    found
}

/// Follows a path that opens with `crate`, `super` or `self` at `index`, written `module_depth` below the root.
fn follow(tokens: &[Token<'_>], mut index: usize, module_depth: usize, found: &mut Vec<Reference>) {
    let mut depth = match tokens[index].text {
        "crate" => 0,
        "super" => module_depth.saturating_sub(1),
        _ => module_depth,
    };
    index += 1;
    while text(tokens, index) == "::" && text(tokens, index + 1) == "super" {
        depth = depth.saturating_sub(1);
        index += 2;
    }
    if text(tokens, index) == "::" {
        follow_tree(tokens, index + 1, depth, found);
    }
}

/// Reads one path or group of paths, `depth` below the root, and returns the index after it.
fn follow_tree(tokens: &[Token<'_>], mut index: usize, depth: usize, found: &mut Vec<Reference>) -> usize {
    match text(tokens, index) {
        "{" => {
            index += 1;
            while !matches!(text(tokens, index), "}" | "") {
                index = if text(tokens, index) == "," { index + 1 } else { follow_tree(tokens, index, depth, found) };
            }
            index + 1
        }
        "super" if text(tokens, index + 1) == "::" => follow_tree(tokens, index + 2, depth.saturating_sub(1), found),
        "self" => index + 1,
        "" => index,
        name => {
            if depth == 0 {
                found.push(Reference { target: name.to_owned(), line: tokens[index].line });
            }
            skip_tree(tokens, index)
        }
    }
}

/// The index of the `,`, `}` or end that closes the path at `index` inside its group.
fn skip_tree(tokens: &[Token<'_>], mut index: usize) -> usize {
    let mut depth = 0_usize;
    loop {
        match text(tokens, index) {
            "" => return index,
            "," | "}" | ";" if depth == 0 => return index,
            "{" => depth += 1,
            "}" => depth -= 1,
            _ => {}
        }
        index += 1;
    }
}

fn text<'a>(tokens: &[Token<'a>], index: usize) -> &'a str {
    tokens.get(index).map_or("", |token| token.text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn targets(source: &str, path: &[&str]) -> Vec<String> {
        root_references(source, path).into_iter().map(|reference| reference.target).collect()
    }

    #[test]
    fn comments_and_literals_hold_no_tokens() {
        let source = r###"
            // crate::a
            /// [`crate::b`]
            /* crate::c /* nested crate::d */ crate::e */
            fn f<'x>(y: &'x str) -> char { let _ = ("crate::f \" crate::g", r#"crate::h " crate::i"#, b'\''); 'c' }
            use crate::kept;
        "###;
        assert_eq!(targets(source, &["m"]), ["kept"]);
    }

    #[test]
    fn groups_and_expressions_are_followed() {
        let source = "use crate::{a::{b, c::d}, e, f as g};\nfn h() -> crate::i::J { super::super::k::l() }";
        assert_eq!(targets(source, &["m", "n"]), ["a", "e", "f", "i", "k"]);
        assert_eq!(root_references(source, &["m", "n"])[3].line, 2);
    }

    #[test]
    fn super_counts_from_the_module_it_is_written_in() {
        let inline = "use super::own; mod tests { use super::own; use super::super::other; } use super::super::root;";
        assert_eq!(targets(inline, &["m"]), ["own", "other", "root"]);
        assert_eq!(targets(inline, &["m", "n"]), ["root"]);
        assert!(targets("use self::a; use super::{b, self};", &["m", "n"]).is_empty());
    }

    #[test]
    fn a_restricted_visibility_is_no_path() {
        assert!(targets("pub(crate) fn f() {} pub(super) struct S; impl S { fn g(&self) {} }", &["m"]).is_empty());
    }

    #[test]
    fn lines_are_counted_through_comments_and_strings() {
        let source = "/* 1\n2 */ \"3\n\"\nhere";
        assert_eq!(tokens(source), [Token { text: "here", line: 4 }]);
    }
}
