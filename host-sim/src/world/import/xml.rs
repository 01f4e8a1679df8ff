//! Reading XML from strangers: bounded, and with the line of what is wrong.

use super::{ImportProblem, ImportReport};
use roxmltree::{Document, Node, ParsingOptions};

/// Most elements and texts in one file.
const MAX_NODES: u32 = 8_000_000;

/// Parses `bytes`; document types, and so entities, are refused.
pub(super) fn parse<'a>(bytes: &'a [u8], shown: &str) -> Result<Document<'a>, ImportProblem> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        ImportProblem::new(shown, format!("is not UTF-8 text: {error}"), "save the file as UTF-8, or fetch it again")
    })?;
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let remedy = match error {
            roxmltree::Error::DtdDetected => "remove the document type (<!DOCTYPE ...>) and what depends on it",
            _ => "fetch or export the file again; it may be cut short",
        };
        ImportProblem::new(shown, format!("is not readable XML: {error}"), remedy)
    })
}

/// Collects problems with the line of the element that has them.
#[derive(Debug)]
pub(super) struct Problems<'a> {
    shown: &'a str,
    /// The problems so far.
    pub(super) found: Vec<ImportProblem>,
}

impl<'a> Problems<'a> {
    /// No problems yet in the file shown as `shown`.
    pub(super) fn of(shown: &'a str) -> Self {
        Self { shown, found: Vec::new() }
    }

    /// The file and line of `node`.
    pub(super) fn place(&self, node: Node<'_, '_>) -> String {
        let line = node.document().text_pos_at(node.range().start).row;
        format!("{}:{line}", self.shown)
    }

    /// Names a problem of `node`, unless so many are named already that finding its line is not worth while.
    pub(super) fn add(&mut self, node: Node<'_, '_>, what: impl Into<String>, remedy: &str) {
        if self.found.len() <= ImportReport::MAX_PROBLEMS {
            self.found.push(ImportProblem::new(self.place(node), what, remedy));
        }
    }
}

/// The first child element of that name, in any namespace.
pub(super) fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    children(node).find(|child| child.tag_name().name() == name)
}

/// All child elements.
pub(super) fn children<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(Node::is_element)
}

/// The text directly inside `node`, trimmed.
pub(super) fn text<'a>(node: Node<'a, '_>) -> &'a str {
    // A comment in front of the text would make it the second text node.
    node.children()
        .filter_map(|child| child.is_text().then(|| child.text()).flatten())
        .map(str::trim)
        .find(|text| !text.is_empty())
        .unwrap_or("")
}

/// Exactly `N` finite numbers from the text of `node`.
pub(super) fn numbers<const N: usize>(node: Node<'_, '_>) -> Option<[f64; N]> {
    let mut values = [0.0; N];
    let mut words = text(node).split_ascii_whitespace();
    for value in &mut values {
        *value = words.next()?.parse().ok().filter(|parsed: &f64| parsed.is_finite())?;
    }
    words.next().is_none().then_some(values)
}
