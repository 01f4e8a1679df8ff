//! What robots learn by themselves, as text: the rigs that they estimate from corners and the ways that they explore.
//!
//! A line for each batch of corners and for each decision of an explorer, in debug form, whose shortest round-trip floats
//! tell any two bit patterns of a number apart.

use std::fmt::{Debug, Write};

use edgeloc::explore::{Action, Cell, ExploreConfig, Explorer, Motion, Odometry, RangeScan};
use edgeloc::geometry::{Heading, Point2, StereoRig};
use edgeloc::math;
use edgeloc::stereo::{
    Calibration, CalibrationError, CornerPair, CorrelatedErrors, PARAMETER_COUNT, ParameterVector, Rectification,
    StereoParameters,
};
use edgeloc_sim::random::Stream;

use crate::corner_pairs::{NOISE_PX, corner};

/// Decides every rig and every corner.
const SEED: u64 = 20;

/// Standard deviations of the priors.
const PRIOR: [f64; PARAMETER_COUNT] =
    [3.0, 1e-3, 2.0, 2.0, 0.01, 3.0, 1e-3, 2.0, 2.0, 0.01, 5e-3, 5e-3, 5e-3, 5e-4, 5e-4, 5e-4];

/// Corner pairs of each view: from none to many.
const VIEWS: [usize; 4] = [12, 40, 0, 90];

/// Rooms of a quarter of a metre a character; `S` is where the robot starts.
const ROOMS: [(&str, &[&str]); 2] = [
    (
        "column",
        &[
            "################",
            "#..............#",
            "#..............#",
            "#..............#",
            "#......##......#",
            "#......##......#",
            "#..............#",
            "#..............#",
            "#..S...........#",
            "################",
        ],
    ),
    (
        "three rooms",
        &[
            "#########################",
            "#...............#.......#",
            "#...............#.......#",
            "#...............#.......#",
            "#.......#.......#.......#",
            "#..S....#.......#.......#",
            "#.......#.......#.......#",
            "#.......#...............#",
            "#.......#...............#",
            "#.......#...............#",
            "#########################",
        ],
    ),
];
const SQUARE_M: f32 = 0.25;
const RAY_COUNT: u8 = 180;

/// All lines, as made today.
#[must_use]
pub fn learned() -> String {
    let mut text = String::new();
    for robot in 0..4 {
        calibrate(robot, &mut text);
    }
    refuse(&mut text);
    for (name, room) in ROOMS {
        explore(name, room, ExploreConfig { side_cells: 256, ..ExploreConfig::reference() }, &mut text);
    }
    explore(
        "seven steps",
        ROOMS[0].1,
        ExploreConfig { side_cells: 256, max_steps: 7, ..ExploreConfig::reference() },
        &mut text,
    );
    text
}

fn note(text: &mut String, name: &str, what: &dyn Debug) {
    writeln!(text, "{name}: {what:?}").expect("a string grows");
}

/// One robot's calibration, view by view, and what it does with it.
fn calibrate(robot: u64, text: &mut String) {
    let meant =
        StereoParameters { rotation_rad: [0.01, -0.05, 0.02], ..StereoParameters::ideal(&StereoRig::reference()) };
    let deviation = ParameterVector::from_column_slice(&PRIOR);
    let mut stream = Stream::new(SEED, "learned", robot, 0);
    let error = ParameterVector::from_fn(|index, _| PRIOR[index] * stream.circular_gaussian()[0]);
    let built = StereoParameters::from_vector(&(meant.to_vector() + error));

    let mut calibration = Calibration::from_prior(&meant, &deviation).expect("a prior");
    calibration.know_far_disparity(0.3).expect("a standard deviation");
    for (view, count) in VIEWS.into_iter().enumerate() {
        let pairs: Vec<CornerPair> = (0..count).map(|_| corner(&built, &mut stream)).collect();
        let update = calibration.update(&pairs, NOISE_PX);
        let found = (update, calibration.estimate(), calibration.standard_errors().map(|errors| errors.data.0));
        note(text, &format!("rig {robot}.{view}"), &found);
    }
    let gaussians = core::array::from_fn(|_| stream.circular_gaussian()[0]);
    let errors = CorrelatedErrors::of(&calibration).map(|errors| errors.error(&gaussians, 1.0).data.0);
    note(text, &format!("rig {robot} error"), &errors);
    let rectification =
        Rectification::new(calibration.estimate(), &StereoRig::reference().camera).expect("cameras side by side");
    let point = Point2::new(17.25, 450.5);
    note(text, &format!("rig {robot} rectified"), &(rectification.left(point), rectification.right(point)));
}

/// What can't be used.
fn refuse(text: &mut String) {
    let ideal = StereoParameters::ideal(&StereoRig::reference());
    let prior = |deviation: f64| Calibration::from_prior(&ideal, &ParameterVector::repeat(deviation));
    let nowhere = CornerPair { left: Point2::new(f32::NAN, 0.0), right: Point2::default() };
    let update = |pairs: &[CornerPair], noise_px: f64| prior(1.0).and_then(|mut prior| prior.update(pairs, noise_px));
    let one_behind = StereoParameters { translation_m: [0.0, 0.0, 0.1], ..ideal };
    let refused: [Result<(), CalibrationError>; 4] = [
        prior(0.0).map(drop),
        update(&[], 0.0).map(drop),
        update(&[nowhere], 0.1).map(drop),
        Rectification::new(&one_behind, &StereoRig::reference().camera).map(drop),
    ];
    note(text, "refused", &refused);
}

/// One robot's exploration, decision by decision.
fn explore(name: &str, room: &[&str], config: ExploreConfig, text: &mut String) {
    let row = room.iter().position(|row| row.contains('S')).expect("a start");
    let middle = |index: usize| (index as f32 + 0.5) * SQUARE_M;
    let start = Point2::new(middle(room[row].find('S').expect("a start")), middle(row));
    let mut cells = vec![Cell::EMPTY; Explorer::cell_count(&config)];
    let mut explorer = Explorer::new(&config, &mut cells).expect("memory for the grid");
    let mut odometry = Odometry::default();
    for step in 0.. {
        let place = Point2::new(start.x + odometry.position.x, start.y + odometry.position.y);
        let ranges: Vec<f32> = (0..RAY_COUNT).map(|ray| range_m(room, place, odometry.heading, ray)).collect();
        let action = explorer.step(&odometry, &RangeScan::new(&ranges, 8.0).expect("a scan"));
        note(text, &format!("{name} {step}"), &action);
        let Action::Move(Motion { turn, advance_m }) = action else { return };
        odometry.heading = odometry.heading.turned(turn).expect("a turn");
        let (sin, cos) = math::sin_cos(odometry.heading.angle().radians());
        odometry.position.x += cos * advance_m;
        odometry.position.y += sin * advance_m;
    }
}

/// How far a ray goes, in steps of a centimetre.
fn range_m(room: &[&str], from: Point2, heading: Heading, ray: u8) -> f32 {
    let beside = f32::from(ray) * (core::f32::consts::TAU / f32::from(RAY_COUNT));
    let (sin, cos) = math::sin_cos(heading.angle().radians() + beside);
    let square = |coordinate: f32| (coordinate / SQUARE_M) as usize;
    let is_wall = |range_m: f32| {
        let (x, y) = (square(from.x + cos * range_m), square(from.y + sin * range_m));
        room.get(y).and_then(|row| row.as_bytes().get(x)).is_none_or(|character| *character == b'#')
    };
    let ranges = (1..800_u16).map(|step| f32::from(step) * 0.01);
    ranges.into_iter().find(|&range_m| is_wall(range_m)).unwrap_or(f32::INFINITY)
}
