//! Camera tilt: the optical axis is not quite horizontal, the image not quite upright.
//!
//! One draw a look: a roll and a pitch, Gaussian and independent, of the standard deviation given, about the left
//! camera's optical centre. A pure rotation moves image points by a homography, whatever their depth, so that no world
//! is needed; the right image takes the same one, exact for pitch and within baseline x sin(roll) of where the right
//! eye really goes. What the tilt turns out of the image is cut off; what it would turn in, a strip of 9 px a degree,
//! stays unseen.
//!
//! In looks alone: a map is made standing level. A source of ours.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::camera::{StereoObservation, move_pieces};
use crate::random::Stream;
use edgeloc::geometry::{PinholeCamera, Point2, Point3, Segment2};
use edgeloc::math;

const FACTS: SourceFacts = SourceFacts {
    key: "camera_tilt",
    name: "camera tilt",
    symbol: "",
    unit: "degrees",
    stream_id: 13,
    is_enabled_by_default: false,
    default_magnitude: 1.0,
    legal_range: (0.0, 10.0),
    acts_in: ActsIn::Looks,
    cause: "an uneven floor rolls and pitches the camera, each by a Gaussian of that standard deviation",
    citation: "ours",
};

source! {
    /// Rolls and pitches the camera; the magnitude is the standard deviation of either, in degrees.
    pub struct CameraTilt: FACTS {}
}

impl UncertaintySource for CameraTilt {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        if self.magnitude <= 0.0 {
            return;
        }
        let [roll, pitch] = stream.circular_gaussian().map(|error| (error * self.magnitude).to_radians() as f32);
        let tilt = Tilt { camera: observation.rig.camera, roll: math::sin_cos(roll), pitch: math::sin_cos(pitch) };
        for feature in &mut observation.features {
            tilt.apply(&mut feature.left);
            tilt.apply(&mut feature.right);
        }
    }
}

/// The rotation of one look, as the sines and cosines of its angles.
struct Tilt {
    camera: PinholeCamera,
    roll: (f32, f32),
    pitch: (f32, f32),
}

impl Tilt {
    /// Moves the pieces of one image and cuts off what leaves it.
    fn apply(&self, pieces: &mut Vec<Segment2>) {
        // What lies behind the tilted camera or wholly beside its image shrinks to a point, which makes no segment.
        let gone = (Point2::default(), Point2::default());
        move_pieces(pieces, |piece| {
            let ends = self.moved(piece.start()).zip(self.moved(piece.end()));
            ends.and_then(|(start, end)| self.camera.clip_to_image(start, end)).unwrap_or(gone)
        });
    }

    /// Where an image point goes; none when it is no longer in front of the camera.
    fn moved(&self, point: Point2) -> Option<Point2> {
        let (focal_px, center) = (self.camera.focal_length_px(), self.camera.principal_point_px());
        let ((sin_roll, cos_roll), (sin_pitch, cos_pitch)) = (self.roll, self.pitch);
        let (x, y) = ((point.x - center.x) / focal_px, (point.y - center.y) / focal_px);
        let (y, z) = (y * cos_pitch - sin_pitch, y * sin_pitch + cos_pitch);
        let tilted = Point3::new(x * cos_roll - y * sin_roll, x * sin_roll + y * cos_roll, z);
        (z > 1e-3).then(|| self.camera.project(tilted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed};

    fn after_tilt(draw: u64, point: Point2) -> Point2 {
        let end = Point2::new(point.x + 50.0, point.y);
        let piece = Segment2::new(point, end, edgeloc::geometry::Polarity::LeftBrighter).expect("a segment");
        let mut look = observation(1);
        look.features[0].left = vec![piece];
        let source = CameraTilt { enabled: true, magnitude: 1.0 };
        source.apply(&mut look, &mut Stream::new(draw, "test", 0, 0));
        look.features[0].left[0].start()
    }

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = CameraTilt { magnitude: 0.0, ..CameraTilt::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn pitch_moves_the_middle_and_roll_turns_about_it_by_a_degree_each() {
        let (mut pitch, mut roll, mut both) = (0.0_f64, 0.0_f64, 0.0_f64);
        for draw in 0..4000 {
            let (middle, right) =
                (after_tilt(draw, Point2::new(320.0, 240.0)), after_tilt(draw, Point2::new(420.0, 240.0)));
            // Small angles: the middle moves by f x pitch, a point 100 px beside it by another 100 px x roll.
            let pitch_deg = (f64::from(middle.y - 240.0) / 502.3).to_degrees();
            let roll_deg = (f64::from(right.y - middle.y) / 100.0).to_degrees();
            (pitch, roll, both) =
                (pitch + pitch_deg * pitch_deg, roll + roll_deg * roll_deg, both + pitch_deg * roll_deg);
        }
        assert!((pitch / 4000.0 - 1.0).abs() < 0.08 && (roll / 4000.0 - 1.0).abs() < 0.08, "{pitch} {roll}");
        assert!((both / 4000.0).abs() < 0.06, "{both}");
    }

    #[test]
    fn a_whole_look_tilts_as_one_and_straight_stays_straight() {
        // Midpoints are not kept by a homography, but they stay on their line.
        let source = CameraTilt { enabled: true, magnitude: 5.0 };
        let mut stream = Stream::new(3, "test", 0, 0);
        let [roll, pitch] = stream.circular_gaussian().map(|error| (error * 5.0).to_radians() as f32);
        let camera = PinholeCamera::reference();
        let tilt = Tilt { camera, roll: math::sin_cos(roll), pitch: math::sin_cos(pitch) };
        let (before, mut after) = (observation(300), observation(300));
        source.apply(&mut after, &mut Stream::new(3, "test", 0, 0));
        for (before, after) in before.features.iter().zip(&after.features) {
            let (Some(piece), [whole]) = (after.left.first(), &before.left[..]) else { continue };
            let middle = tilt.moved(whole.start().lerp(whole.end(), 0.5)).expect("before the camera");
            let (dx, dy) = (piece.end().x - piece.start().x, piece.end().y - piece.start().y);
            let off_px = (dx * (middle.y - piece.start().y) - dy * (middle.x - piece.start().x)) / piece.length_px();
            assert!(off_px.abs() < 0.05, "{off_px}");
        }
    }

    #[test]
    fn nothing_is_seen_outside_the_image() {
        let mut look = observation(2000);
        CameraTilt { enabled: true, magnitude: 10.0 }.apply(&mut look, &mut Stream::new(4, "test", 0, 0));
        for piece in look.features.iter().flat_map(|feature| &feature.left) {
            for end in [piece.start(), piece.end()] {
                assert!((0.0..=640.0).contains(&end.x) && (0.0..=480.0).contains(&end.y), "{end:?}");
            }
        }
    }
}
