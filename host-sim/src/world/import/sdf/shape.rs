//! Poses, simple shapes and colours of SDF elements.

use super::Source;
use crate::world::import::placement::Placement;
use crate::world::import::xml::{child, numbers, text};
use crate::world::import::{luminance, primitives};
use crate::world::mesh::TriangleMesh;
use nalgebra::Vector3;
use roxmltree::Node;

/// The `<pose>` of an element, none meaning no displacement.
pub(super) fn pose_of(source: &mut Source<'_>, element: Node<'_, '_>) -> Placement {
    let Some(pose) = child(element, "pose") else { return Placement::identity() };
    let relative = pose.attribute("relative_to").or_else(|| pose.attribute("frame")).unwrap_or("");
    if !["", "world", "__model__"].contains(&relative) {
        let what = format!("a pose relative to '{relative}' is read as relative to its parent");
        source.problems.add(pose, what, "state the pose relative to the parent");
    }
    if text(pose).is_empty() {
        return Placement::identity();
    }
    let placement = if pose.attribute("rotation_format") == Some("quat_xyzw") {
        numbers(pose).map(|[x, y, z, qx, qy, qz, qw]| {
            Placement::translation(Vector3::new(x, y, z)).after(&Placement::quaternion([qx, qy, qz, qw]))
        })
    } else {
        let unit = if pose.attribute("degrees") == Some("true") { 1.0_f64.to_radians() } else { 1.0 };
        numbers(pose).map(|[x, y, z, roll, pitch, yaw]| {
            let turn = Placement::roll_pitch_yaw(roll * unit, pitch * unit, yaw * unit);
            Placement::translation(Vector3::new(x, y, z)).after(&turn)
        })
    };
    placement.unwrap_or_else(|| {
        source.problems.add(pose, "the pose is not six finite numbers; no displacement is taken", "correct it");
        Placement::identity()
    })
}

/// A simple shape as a mesh; `None` if it shows nothing or can't be read.
pub(super) fn primitive(source: &mut Source<'_>, shape: Node<'_, '_>) -> Option<TriangleMesh> {
    let length =
        |name: &str| child(shape, name).and_then(numbers::<1>).map(|[value]| value).filter(|&value| value > 0.0);
    let name = shape.tag_name().name();
    let mesh = match name {
        "empty" => return None,
        "box" => child(shape, "size").and_then(numbers).map(|size| primitives::cuboid(Vector3::from(size))),
        "sphere" => length("radius").map(primitives::sphere),
        "cylinder" => {
            length("radius").zip(length("length")).map(|(radius_m, length_m)| primitives::cylinder(radius_m, length_m))
        }
        "plane" => {
            let normal = child(shape, "normal").and_then(numbers).unwrap_or([0.0, 0.0, 1.0]);
            let size = child(shape, "size").and_then(numbers).unwrap_or([1.0, 1.0]);
            Some(primitives::plane(Vector3::from(normal), size))
        }
        _ => {
            source.problems.add(shape, format!("the shape <{name}> is not read"), "replace it by a mesh");
            return None;
        }
    };
    if mesh.is_none() {
        source.problems.add(shape, format!("the <{name}> lacks its measures"), "give them as positive numbers");
    }
    mesh
}

/// How much light the visual's own material returns, if it states a colour.
pub(super) fn diffuse(source: &mut Source<'_>, visual: Node<'_, '_>) -> Option<f32> {
    let diffuse = child(child(visual, "material")?, "diffuse")?;
    let words = text(diffuse).split_ascii_whitespace().map(str::parse::<f64>);
    let color: Option<Vec<f64>> = words.map(|word| word.ok().filter(|value| value.is_finite())).collect();
    match color.as_deref() {
        Some([red, green, blue, ..]) => Some(luminance([*red, *green, *blue])),
        _ => {
            source.problems.add(diffuse, "the diffuse colour is not three numbers; mid grey is taken", "correct it");
            None
        }
    }
}
