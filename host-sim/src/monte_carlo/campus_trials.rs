//! Kidnapped robots on a campus: the same robots and the same looks in maps of any number of its buildings.

use super::looks::Looks;
use super::{Campus, SiteError, draw_start};
use crate::scenario::Start;
use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::geometry::{Angle, Point2, Scene, Segment2};
use edgeloc::gist::{Projection, add_similarities, edge_layout};
use edgeloc::localize::{
    Decision, HeadingPrior, Localizer, LocalizerConfig, Look, Motion, ObserveError, StartError, VerificationConfig,
};
use rayon::prelude::*;
use std::time::Duration;

/// A robot put down somewhere in a building, and what it will see.
#[derive(Debug, Clone)]
pub struct CampusStart {
    /// Where the robot is, in the world of the campus \[m\].
    pub position: Point2,
    /// The two nodes nearest to it, the nearest first.
    pub nearest: [u32; 2],
    looks: Vec<CampusLook>,
}

#[derive(Debug, Clone)]
struct CampusLook {
    compass: Option<HeadingPrior>,
    segments: Vec<Segment2>,
}

/// How an attempt ended.
#[derive(Debug, Clone, PartialEq)]
pub struct CampusRecord {
    /// Whether one of the two nearest nodes was answered.
    pub is_success: bool,
    /// Whether anything was answered.
    pub is_answered: bool,
    /// Distance of the position answered from the true one \[m\].
    pub position_error_m: Option<f32>,
    /// Whether one of the two nearest nodes was scored at the first look, and whether at the last.
    pub is_shortlisted: [bool; 2],
    /// Time of the localiser on the processor for each look.
    pub look_times: Vec<Duration>,
}

/// What scoring every node at the first look finds best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExactScan {
    /// Whether it is one of the two nearest nodes.
    pub is_right: bool,
    /// Whether it is on the shortlist.
    pub is_shortlisted: bool,
}

impl Campus {
    /// Robots anywhere in the free space of the first `buildings`, as many in each, `count` in all; tells `on_building` of
    /// each building that is done.
    ///
    /// # Errors
    /// When the nodes of a building can't be placed.
    pub fn starts(
        &self,
        buildings: u32,
        count: u32,
        on_building: &(dyn Fn() + Sync),
    ) -> Result<Vec<CampusStart>, SiteError> {
        let in_building = |building: u32| {
            let trials = (0..count).filter(|trial| trial % buildings == building).map(|trial| trial / buildings);
            let starts = self.starts_in(building, trials.collect());
            on_building();
            starts
        };
        let starts = (0..buildings).into_par_iter().map(in_building).collect::<Result<Vec<_>, _>>()?;
        Ok(starts.into_iter().flatten().collect())
    }

    fn starts_in(&self, building: u32, trials: Vec<u32>) -> Result<Vec<CampusStart>, SiteError> {
        if trials.is_empty() {
            return Ok(Vec::new());
        }
        let (site, scenario, origin) = (self.site(building)?, self.scenario(building), self.origin(building));
        let first_node = building * self.nodes_per_building();
        let sources = &scenario.uncertainty;
        let draw = |trial: u32| {
            let start = draw_start(&site, &scenario, Start::Anywhere, trial);
            let mut looks = Looks::new(&site, scenario.seed, trial, 0);
            let turn = Angle::from_degrees(scenario.localizer.turn_deg as f32);
            let mut pose = start;
            let mut taken = Vec::new();
            for look in 0..usize::from(scenario.localizer.max_looks) {
                let compass = looks.compass_reading(look, pose.heading, sources);
                taken.push(CampusLook { compass, segments: looks.scene(look, pose, sources).to_vec() });
                pose.heading = pose.heading.turned(turn).unwrap_or_default();
            }
            CampusStart {
                position: Point2::new(start.position.x + origin.x, start.position.y + origin.y),
                nearest: site.two_nearest_nodes(start.position).map(|node| first_node + node),
                looks: taken,
            }
        };
        Ok(trials.into_iter().map(draw).collect())
    }
}

impl CampusStart {
    /// Lets the robot look around until the localiser decides, on the spot: its looks are taken already, a turn apart.
    ///
    /// # Errors
    /// When the localiser refuses to start.
    pub fn run(
        &self,
        map: TopologicalDatabase<'_>,
        config: &LocalizerConfig,
        memory: &mut [u64],
    ) -> Result<CampusRecord, StartError> {
        let on_the_spot = config.verification.map(|verification| VerificationConfig { moves: 0, ..verification });
        let config = &LocalizerConfig { verification: on_the_spot, ..*config };
        let mut localizer = Localizer::new(map, config, memory)?;
        let mut record = CampusRecord {
            is_success: false,
            is_answered: false,
            position_error_m: None,
            is_shortlisted: [false; 2],
            look_times: Vec::new(),
        };
        let (mut motion, mut at) = (None, 0);
        for index in 0..self.looks.len() {
            let look = &self.looks[at];
            let started = processor_time();
            let decision = localizer.observe(&look.as_seen(motion));
            record.look_times.push(processor_time().saturating_sub(started));
            let scores = localizer.candidates().scores();
            let is_shortlisted = self.nearest.iter().any(|node| scores[*node as usize].is_candidate());
            record.is_shortlisted =
                [if index == 0 { is_shortlisted } else { record.is_shortlisted[0] }, is_shortlisted];
            match decision {
                Ok(Decision::LookAgain { turn, .. }) => {
                    let turns = (turn.radians() / config.turn.radians()).round() as i32;
                    at = (at as i32 + turns).rem_euclid(self.looks.len() as i32) as usize;
                    motion = Some(Motion::exact_turn(turn));
                }
                Ok(Decision::Localized(answer)) => {
                    record.is_answered = true;
                    record.is_success = self.nearest.contains(&answer.node.0);
                    record.position_error_m = answer.pose.map(|pose| pose.position.distance(self.position));
                    break;
                }
                Ok(Decision::Unknown { .. }) | Err(_) => break,
            }
        }
        Ok(record)
    }

    /// Time of the first stage for the first look, without the choice; `None` in a map without an index.
    #[must_use]
    pub fn first_stage_time(&self, map: &TopologicalDatabase<'_>) -> Option<Duration> {
        let (index, look) = map.index().zip(self.looks.first())?;
        let mut sums = vec![0; map.node_count() * usize::from(index.shape().poses)];
        let sectors = f32::from(index.shape().sectors);
        let turns = look.compass.map_or(0.0, |compass| compass.mean.angle().radians() / core::f32::consts::TAU);
        let sector = index.sector((turns.rem_euclid(1.0) * sectors + 0.5) as u16 % index.shape().sectors);
        let started = processor_time();
        let projection = Projection { mean: index.mean(), axes: index.axes() };
        let code = projection.code(&edge_layout(&map.rig().camera, look.segments.iter().copied()));
        add_similarities(&code, &[sector], &mut sums);
        let taken = processor_time().saturating_sub(started);
        std::hint::black_box(&sums);
        Some(taken)
    }

    /// Scores every node at the first look and compares the best with the shortlist; `None` when no node scores.
    ///
    /// # Errors
    /// When a localiser refuses.
    pub fn scan_exactly(
        &self,
        map: TopologicalDatabase<'_>,
        config: &LocalizerConfig,
    ) -> Result<Option<ExactScan>, StartError> {
        let first_look = |map: TopologicalDatabase<'_>, memory: &mut Vec<u64>| -> Result<_, StartError> {
            memory.resize(Localizer::memory_len_in(config, &map), 0);
            let mut localizer = Localizer::new(map, config, memory)?;
            let done: Result<Decision, ObserveError> = self
                .looks
                .first()
                .map_or(Err(ObserveError::HeadingMissing), |look| localizer.observe(&look.as_seen(None)));
            let leader = localizer.candidates().leading_node().filter(|(_, score)| score.sum_q30 > 0);
            let scored = localizer.candidates().candidates().map(|(node, _)| node).collect::<Vec<_>>();
            Ok(done.ok().and(leader).map(|(node, _)| (node, scored)))
        };
        let mut memory = Vec::new();
        let Some((best, _)) = first_look(map.without_index(), &mut memory)? else { return Ok(None) };
        let is_right = self.nearest.contains(&best.0);
        let scan = |scored: Vec<NodeId>| ExactScan { is_right, is_shortlisted: scored.contains(&best) };
        Ok(first_look(map, &mut memory)?.map(|(_, scored)| scan(scored)))
    }
}

impl CampusLook {
    fn as_seen(&self, motion: Option<Motion>) -> Look<'_> {
        Look { heading: self.compass, motion_since_last: motion, scene: Scene::new(&self.segments) }
    }
}

/// Time that this thread has spent on the processor: what others do on a busy machine hardly matters.
#[cfg(unix)]
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.max(0) as u64, time.tv_nsec as u32)
}

/// Time since the first call, where nothing better is to be had.
#[cfg(not(unix))]
fn processor_time() -> Duration {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed()
}
