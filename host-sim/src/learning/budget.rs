//! A budget of segments for the model of a node: of a furnished room's many, those are kept that tell most.
//!
//! A segment tells by the length that it shows about the node, but the tenth of a bookshelf tells less than the first of
//! a door: lengths are divided by the root of the rank among what stands in the same direction and depth, so that no
//! direction is emptied for another.

use edgeloc::geometry::{Point3, Segment3};
use edgeloc::math;
use nalgebra::Vector3;

/// Directions that share the budget.
const SECTORS: usize = 24;
/// Where one band of depth ends and the next begins \[m\].
const BAND_ENDS_M: [f32; 3] = [1.0, 2.0, 4.0];
/// How far the robot stands from the node, say \[m\]: what is nearer shows no more than what is so far away.
const AROUND_M: f32 = 0.5;

/// Leaves the `max_segments` of a model, in the node frame, that tell most, in their order.
pub fn keep_most_telling(segments: &mut Vec<Segment3>, max_segments: usize) {
    if segments.len() <= max_segments {
        return;
    }
    let lengths: Vec<f32> = segments.iter().map(shown_length).collect();
    let mut by_length: Vec<usize> = (0..segments.len()).collect();
    by_length.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
    let mut counts = [0.0_f32; SECTORS * (BAND_ENDS_M.len() + 1)];
    let valued = by_length.into_iter().map(|index| {
        let count = &mut counts[share_of(&segments[index])];
        *count += 1.0;
        (lengths[index] / math::sqrt(*count), index)
    });
    let mut valued: Vec<(f32, usize)> = valued.collect();
    valued.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let mut is_kept = vec![false; segments.len()];
    for (_, index) in valued.into_iter().take(max_segments) {
        is_kept[index] = true;
    }
    let mut is_kept = is_kept.into_iter();
    segments.retain(|_| is_kept.next() == Some(true));
}

/// The angle that a segment spans from about the node \[rad\].
fn shown_length(segment: &Segment3) -> f32 {
    let [start, end] = [segment.start, segment.end].map(|point| Vector3::new(point.x, point.y, point.z));
    let angle = math::atan2(start.cross(&end).norm(), start.dot(&end));
    let distance_m = middle(segment).distance(Point3::default());
    angle * distance_m / math::length(distance_m, AROUND_M)
}

/// The direction and band of depth that a segment belongs to, as an index.
fn share_of(segment: &Segment3) -> usize {
    let Point3 { x, y, .. } = middle(segment);
    let turns = math::atan2(y, x) / core::f32::consts::TAU + 0.5;
    let sector = ((turns * SECTORS as f32) as usize).min(SECTORS - 1);
    let depth_m = math::length(x, y);
    let band = BAND_ENDS_M.iter().filter(|&&end_m| depth_m >= end_m).count();
    sector * (BAND_ENDS_M.len() + 1) + band
}

fn middle(segment: &Segment3) -> Point3 {
    segment.start.lerp(segment.end, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Polarity;

    fn post(x: f32, y: f32, length_m: f32) -> Segment3 {
        let (start, end) = (Point3::new(x, y, 0.0), Point3::new(x, y, length_m));
        Segment3 { start, end, polarity: Polarity::LeftBrighter }
    }

    /// A crowded shelf ahead, 60 posts, and two small things behind the node.
    fn room() -> Vec<Segment3> {
        let shelf = (0_u8..60).map(|index| post(3.0, 0.02 * f32::from(index), 0.8 + 0.001 * f32::from(index)));
        shelf.chain([post(-3.0, 0.1, 0.5), post(-3.0, 0.4, 0.6)]).collect()
    }

    #[test]
    fn a_model_within_the_budget_stays_as_it_is() {
        let mut segments = room();
        keep_most_telling(&mut segments, 62);
        assert_eq!(segments, room());
    }

    #[test]
    fn the_budget_is_met_and_no_direction_is_emptied_for_a_crowded_one() {
        let mut segments = room();
        keep_most_telling(&mut segments, 20);
        assert_eq!(segments.len(), 20);
        assert_eq!(segments.iter().filter(|segment| segment.start.x < 0.0).count(), 2);
        let order = |kept: &Segment3| room().iter().position(|segment| segment == kept);
        assert!(segments.iter().map(order).is_sorted(), "kept in their order");
    }

    #[test]
    fn of_what_stands_alike_the_longer_is_kept() {
        let mut segments = vec![post(3.0, 0.1, 0.2), post(3.0, 0.2, 0.9), post(3.0, 0.3, 0.5)];
        keep_most_telling(&mut segments, 2);
        assert_eq!(segments, [post(3.0, 0.2, 0.9), post(3.0, 0.3, 0.5)]);
    }

    #[test]
    fn what_stands_close_to_the_node_shows_no_more_than_what_the_robot_may_see_of_it() {
        let (near, far) = (post(0.2, 0.0, 0.2), post(1.5, 0.0, 1.2));
        assert!(shown_length(&near) < shown_length(&far));
    }
}
