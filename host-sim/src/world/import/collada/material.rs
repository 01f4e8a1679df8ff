//! Materials of a Collada file: the diffuse luminance, or mid grey where a picture stands for it.

use super::ById;
use crate::world::import::luminance;
use crate::world::import::xml::{child, children, text};
use crate::world::mesh::MID_GREY;
use roxmltree::Node;
use std::collections::{BTreeMap, HashMap};

/// How much light a material returns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reflectance {
    /// It states a colour of this luminance.
    Stated(f32),
    /// A picture gives its colour.
    Textured,
    /// It says nothing.
    Unknown,
}

impl Reflectance {
    pub(super) fn value(self) -> f32 {
        match self {
            Self::Stated(value) => value,
            Self::Textured | Self::Unknown => MID_GREY,
        }
    }
}

/// Which material an `<instance_geometry>` binds to each symbol of its primitives.
pub(super) fn bindings<'a>(instance: Node<'a, 'a>) -> HashMap<&'a str, &'a str> {
    child(instance, "bind_material")
        .and_then(|bind| child(bind, "technique_common"))
        .into_iter()
        .flat_map(children)
        .filter_map(|material| material.attribute("symbol").zip(material.attribute("target")))
        .collect()
}

/// Materials by the id of their element, looked up once.
pub(super) struct Materials<'d, 'a> {
    by_id: &'d ById<'a>,
    known: BTreeMap<String, Reflectance>,
}

impl<'d, 'a> Materials<'d, 'a> {
    pub(super) fn new(by_id: &'d ById<'a>) -> Self {
        Self { by_id, known: BTreeMap::new() }
    }

    /// The material that `bindings` give a symbol; without one, the material of that id.
    pub(super) fn bound(&mut self, bindings: &HashMap<&str, &str>, symbol: &str) -> Reflectance {
        let id = bindings.get(symbol).map_or(symbol, |target| target.trim_start_matches('#'));
        if let Some(&known) = self.known.get(id) {
            return known;
        }
        let reflectance = self.read(id).unwrap_or(Reflectance::Unknown);
        self.known.insert(id.to_owned(), reflectance);
        reflectance
    }

    /// How many of the materials met are pictures.
    pub(super) fn textured_count(&self) -> usize {
        self.known.values().filter(|&&reflectance| reflectance == Reflectance::Textured).count()
    }

    fn read(&self, id: &str) -> Option<Reflectance> {
        let effect_url = child(self.by_id.get("material", id)?, "instance_effect")?.attribute("url")?;
        let effect = self.by_id.get("effect", effect_url)?;
        let technique = child(child(effect, "profile_COMMON")?, "technique")?;
        let diffuse = children(technique).find_map(|shader| child(shader, "diffuse"))?;
        if child(diffuse, "texture").is_some() {
            return Some(Reflectance::Textured);
        }
        let words = text(child(diffuse, "color")?).split_ascii_whitespace().take(3);
        let color: Vec<f64> =
            words.filter_map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect();
        color.try_into().ok().map(|color| Reflectance::Stated(luminance(color)))
    }
}
