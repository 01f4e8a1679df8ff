//! Occlusion: somebody stands before the camera and hides a part of the view.
//!
//! A share of the view's bearings, in one span at a place uniform in the view, is blocked over the whole height of the
//! image: what was seen in those columns is gone, and what crosses their borders ends there. Both images lose the same
//! columns, though whoever stands near hides other things from the other camera: looks use the left one alone.
//!
//! In looks alone, and drawn anew in each: a learner waits until nobody stands in the way. A source of ours.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::camera::StereoObservation;
use crate::random::Stream;
use edgeloc::geometry::{PinholeCamera, Segment2};
use std::ops::Range;

const FACTS: SourceFacts = SourceFacts {
    key: "occlusion",
    name: "occlusion",
    symbol: "",
    unit: "share of bearings",
    stream_id: 14,
    is_enabled_by_default: false,
    default_magnitude: 0.25,
    legal_range: (0.0, 1.0),
    acts_in: ActsIn::Looks,
    cause: "people who stand near hide one span of that share of the view's bearings, at a random place in each look",
    citation: "ours",
};

source! {
    /// Blocks a span of image columns; the magnitude is its share of the view's bearings.
    pub struct Occlusion: FACTS {}
}

impl UncertaintySource for Occlusion {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        if self.magnitude <= 0.0 {
            return;
        }
        let blocked_px = self.blocked_columns_px(&observation.rig.camera, stream);
        for feature in &mut observation.features {
            hide(&mut feature.left, &blocked_px);
            hide(&mut feature.right, &blocked_px);
        }
    }
}

impl Occlusion {
    /// The image columns of one look that are blocked.
    fn blocked_columns_px(&self, camera: &PinholeCamera, stream: &mut Stream) -> Range<f32> {
        let (focal_px, center_px) = (f64::from(camera.focal_length_px()), f64::from(camera.principal_point_px().x));
        let bearing = |column_px: f64| libm::atan2(column_px - center_px, focal_px);
        let (first, last) = (bearing(0.0), bearing(f64::from(camera.width_px())));
        let blocked = self.magnitude * (last - first);
        let from = stream.uniform(first, last - blocked);
        let column_px = |bearing: f64| (center_px + focal_px * libm::tan(bearing)) as f32;
        column_px(from)..column_px(from + blocked)
    }
}

/// Cuts what lies in the blocked columns out of every piece.
fn hide(pieces: &mut Vec<Segment2>, blocked_px: &Range<f32>) {
    let whole_count = pieces.len();
    for index in 0..whole_count {
        let whole = pieces[index];
        let (from, to) = (whole.start().x, whole.end().x);
        if from.max(to) <= blocked_px.start || from.min(to) >= blocked_px.end {
            pieces.push(whole);
            continue;
        }
        // Walking along the piece it goes behind what blocks at `enter` and comes out at `leave`; an upright one inside has
        // neither.
        let fraction = |column_px: f32| (column_px - from) / (to - from);
        let (enter, leave) = if from < to {
            (fraction(blocked_px.start), fraction(blocked_px.end))
        } else {
            (fraction(blocked_px.end), fraction(blocked_px.start))
        };
        let border = |at: f32| whole.start().lerp(whole.end(), at);
        if enter > 0.0 {
            pieces.extend(Segment2::new(whole.start(), border(enter), whole.polarity()));
        }
        if leave < 1.0 {
            pieces.extend(Segment2::new(border(leave), whole.end(), whole.polarity()));
        }
    }
    pieces.drain(..whole_count);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed, unit_stream};
    use edgeloc::geometry::{Point2, Polarity, Segment2};

    const BLOCKED_PX: Range<f32> = 200.0..300.0;

    fn left_of(start: (f32, f32), end: (f32, f32)) -> Vec<[f32; 4]> {
        let point = |(x, y): (f32, f32)| Point2::new(x, y);
        let piece = Segment2::new(point(start), point(end), Polarity::RightBrighter).expect("a segment");
        let mut pieces = vec![piece];
        hide(&mut pieces, &BLOCKED_PX);
        assert!(pieces.iter().all(|piece| piece.polarity() == Polarity::RightBrighter));
        let ends = |piece: &Segment2| [piece.start().x, piece.start().y, piece.end().x, piece.end().y];
        pieces.iter().map(ends).collect()
    }

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = Occlusion { magnitude: 0.0, ..Occlusion::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn what_lies_in_the_blocked_columns_is_cut_out_whichever_way_it_runs() {
        assert_eq!(left_of((100.0, 0.0), (400.0, 300.0)), [[100.0, 0.0, 200.0, 100.0], [300.0, 200.0, 400.0, 300.0]]);
        assert_eq!(left_of((400.0, 300.0), (100.0, 0.0)), [[400.0, 300.0, 300.0, 200.0], [200.0, 100.0, 100.0, 0.0]]);
        assert_eq!(left_of((100.0, 0.0), (250.0, 150.0)), [[100.0, 0.0, 200.0, 100.0]]);
        assert_eq!(left_of((250.0, 10.0), (350.0, 10.0)), [[300.0, 10.0, 350.0, 10.0]]);
        assert_eq!(left_of((210.0, 10.0), (290.0, 50.0)), Vec::<[f32; 4]>::new());
        assert_eq!(left_of((250.0, 10.0), (250.0, 90.0)), Vec::<[f32; 4]>::new());
        assert_eq!(left_of((150.0, 10.0), (150.0, 90.0)), [[150.0, 10.0, 150.0, 90.0]]);
    }

    #[test]
    fn a_quarter_of_the_bearings_is_blocked_anywhere_in_the_view() {
        let camera = PinholeCamera::reference();
        let bearing = |column_px: f32| libm::atan2(f64::from(column_px) - 320.0, 502.3).to_degrees();
        let (mut sum, mut least, mut greatest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        let half_view = bearing(640.0);
        for draw in 0..4000 {
            let blocked = Occlusion::default().blocked_columns_px(&camera, &mut Stream::new(draw, "test", 0, 0));
            let (from, to) = (bearing(blocked.start), bearing(blocked.end));
            assert!(((to - from) / (2.0 * half_view) - 0.25).abs() < 1e-3, "{blocked:?}");
            sum += f64::midpoint(from, to);
            (least, greatest) = (least.min(from), greatest.max(to));
        }
        assert!((sum / 4000.0).abs() < 0.6, "{sum}");
        assert!((least + half_view).abs() < 0.2 && (greatest - half_view).abs() < 0.2, "{least} {greatest}");
    }

    #[test]
    fn nothing_is_left_when_all_is_blocked_and_nothing_is_seen_in_the_blocked_columns() {
        let camera = observation(1).rig.camera;
        let source = Occlusion { enabled: true, magnitude: 1.0 };
        let all = source.blocked_columns_px(&camera, &mut unit_stream());
        assert!(all.start <= 0.01 && all.end >= 639.99, "{all:?}");

        let blocked = Occlusion::default().blocked_columns_px(&camera, &mut unit_stream());
        let after = perturbed(&Occlusion::default(), 2000);
        for piece in after.features.iter().flat_map(|feature| feature.left.iter().chain(&feature.right)) {
            let (low, high) = (piece.start().x.min(piece.end().x), piece.start().x.max(piece.end().x));
            assert!(high <= blocked.start + 0.01 || low >= blocked.end - 0.01, "{piece:?} in {blocked:?}");
        }
    }
}
