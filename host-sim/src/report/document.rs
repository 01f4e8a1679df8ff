//! The frame of every page: one self-contained file with its style sheets, without scripts and without addresses.

use super::drawing;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use svg::node::element::SVG;

const STYLE: &str = include_str!("page.css");

/// A page with a title, a line below it and a body of sections.
pub(super) fn document(title: &str, subtitle: &str, body: &Markup) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(drawing::STYLE)) }
            }
            body { main {
                header {
                    h1 { (title) }
                    p { (subtitle) }
                }
                (body)
            } }
        }
    };
    markup.into_string()
}

/// A drawing within the page.
pub(super) fn inline(drawing: &SVG) -> PreEscaped<String> {
    PreEscaped(drawing.to_string())
}
