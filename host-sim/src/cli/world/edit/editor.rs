//! What the page shows and changes: viewpoints of a world, with undo, and the file they are saved to.

use edgeloc::geometry::{Angle, Heading, PinholeCamera, Point2, Point3, StereoRig};
use edgeloc_sim::camera::CameraPose;
use edgeloc_sim::world::viewpoints::file;
use edgeloc_sim::world::{ReferenceViewpoints, WireframeWorld};
use serde::Serialize;
use std::path::PathBuf;

/// Size of the drawing, in pixels of its own; a right angle wide.
const SIZE_PX: (u16, u16) = (1280, 800);

/// An editing session.
#[derive(Debug)]
pub(super) struct Editor {
    world: WireframeWorld,
    path: PathBuf,
    viewpoints: ReferenceViewpoints,
    camera: PinholeCamera,
    done: Vec<Change>,
    undone: Vec<Change>,
    /// How many changes were done when the file was as the viewpoints; none when no undo leads back there.
    saved_after: Option<usize>,
    /// Checksum of the file as it was last read or written.
    saved_checksum: u64,
}

/// Edges that became visible or hidden from a viewpoint.
#[derive(Debug)]
struct Change {
    viewpoint: usize,
    edges: Vec<u32>,
    is_visible: bool,
}

/// Why the editor does not do what it is asked.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    #[error("{0}")]
    NotThere(&'static str),
    #[error("{0} was changed by someone else since it was read")]
    ChangedOnDisk(String),
    #[error("not saved: {0}")]
    NotSaved(String),
}

/// What stays the same through a session.
#[derive(Debug, Serialize)]
pub(super) struct WorldAnswer {
    name: String,
    file: String,
    size_px: (u16, u16),
    edge_count: usize,
    /// Number, x and y of each viewpoint [m].
    viewpoints: Vec<(u32, f32, f32)>,
    /// The edges seen from above [m]: x and y of both ends.
    plan: Vec<[f32; 4]>,
}

/// What is seen from a viewpoint.
#[derive(Debug, Serialize)]
pub(super) struct ViewAnswer {
    /// Number of the edge, x and y of both ends [px], 1 if visible, distance of its nearest end [m].
    segments: Vec<(u32, f32, f32, f32, f32, u8, f32)>,
    #[serde(flatten)]
    state: StateAnswer,
}

/// Where the session stands.
#[derive(Debug, Serialize)]
pub(super) struct StateAnswer {
    /// The viewpoint in question, by its place in the list.
    viewpoint: usize,
    visible_count: usize,
    can_undo: bool,
    can_redo: bool,
    is_saved: bool,
}

impl Editor {
    /// Edits `viewpoints`, just read from `path`, of `world`.
    pub(super) fn new(world: WireframeWorld, path: PathBuf, viewpoints: ReferenceViewpoints) -> Self {
        let (width, height) = (f32::from(SIZE_PX.0), f32::from(SIZE_PX.1));
        let camera = PinholeCamera::new(SIZE_PX, 0.5 * width, Point2::new(0.5 * width, 0.5 * height));
        let camera = camera.expect("the numbers of the drawing make a camera");
        let saved_checksum = viewpoints.checksum();
        let (done, undone) = (Vec::new(), Vec::new());
        Self { world, path, viewpoints, camera, done, undone, saved_after: Some(0), saved_checksum }
    }

    pub(super) fn world(&self) -> WorldAnswer {
        let viewpoints = self.viewpoints.viewpoints().iter();
        WorldAnswer {
            name: self.world.name.clone(),
            file: self.path.display().to_string(),
            size_px: SIZE_PX,
            edge_count: self.world.edges.len(),
            viewpoints: viewpoints.map(|at| (at.id, at.position.x, at.position.y)).collect(),
            plan: self.world.edges.iter().map(|edge| [edge.start.x, edge.start.y, edge.end.x, edge.end.y]).collect(),
        }
    }

    /// All edges in the picture from a viewpoint, hidden ones too.
    pub(super) fn view(&self, index: usize, heading_deg: f32) -> Result<ViewAnswer, Failure> {
        let viewpoint =
            self.viewpoints.viewpoints().get(index).ok_or(Failure::NotThere("there is no such viewpoint"))?;
        let heading = Heading::new(Angle::from_degrees(heading_deg)).ok_or(Failure::NotThere("this is no heading"))?;
        let eye = Point3::new(viewpoint.position.x, viewpoint.position.y, self.viewpoints.camera_height_m());
        let pose = CameraPose::new(eye, heading);
        let segments = (0_u32..).zip(&self.world.edges).filter_map(|(edge, segment)| {
            let from_eye = pose.segment_from_world(segment);
            let image = self.camera.project_segment(&from_eye, StereoRig::reference().near_limit_m)?;
            let distance = segment.start.distance(eye).min(segment.end.distance(eye));
            let (start, end) = (image.start(), image.end());
            Some((edge, start.x, start.y, end.x, end.y, u8::from(viewpoint.visible.contains(edge)), distance))
        });
        Ok(ViewAnswer { segments: segments.collect(), state: self.state(index) })
    }

    /// Shows or hides edges from a viewpoint.
    pub(super) fn set_visible(
        &mut self,
        viewpoint: usize,
        edges: &[u32],
        is_visible: bool,
    ) -> Result<StateAnswer, Failure> {
        if viewpoint >= self.viewpoints.viewpoints().len() {
            return Err(Failure::NotThere("there is no such viewpoint"));
        }
        if edges.iter().any(|&edge| edge as usize >= self.world.edges.len()) {
            return Err(Failure::NotThere("the world has no such edge"));
        }
        let edges = self.viewpoints.set_visible(viewpoint, edges.iter().copied(), is_visible);
        if !edges.is_empty() {
            if self.saved_after.is_some_and(|count| count > self.done.len()) {
                self.saved_after = None;
            }
            self.undone.clear();
            self.done.push(Change { viewpoint, edges, is_visible });
        }
        Ok(self.state(viewpoint))
    }

    pub(super) fn undo(&mut self) -> Result<StateAnswer, Failure> {
        let change = self.done.pop().ok_or(Failure::NotThere("there is nothing to undo"))?;
        Ok(self.apply(change, false))
    }

    pub(super) fn redo(&mut self) -> Result<StateAnswer, Failure> {
        let change = self.undone.pop().ok_or(Failure::NotThere("there is nothing to redo"))?;
        Ok(self.apply(change, true))
    }

    /// Makes a change again, or takes it back.
    fn apply(&mut self, change: Change, is_again: bool) -> StateAnswer {
        let viewpoint = change.viewpoint;
        self.viewpoints.set_visible(viewpoint, change.edges.iter().copied(), change.is_visible == is_again);
        if is_again { &mut self.done } else { &mut self.undone }.push(change);
        self.state(viewpoint)
    }

    /// Writes the file; one that someone else has changed only if `overwrite`.
    pub(super) fn save(&mut self, overwrite: bool) -> Result<StateAnswer, Failure> {
        let on_disk = file::load(&self.path).map(|viewpoints| viewpoints.checksum());
        let is_gone = !self.path.exists();
        if !overwrite && !is_gone && on_disk.ok() != Some(self.saved_checksum) {
            return Err(Failure::ChangedOnDisk(self.path.display().to_string()));
        }
        file::save(&self.viewpoints, &self.path).map_err(|error| Failure::NotSaved(error.to_string()))?;
        (self.saved_after, self.saved_checksum) = (Some(self.done.len()), self.viewpoints.checksum());
        Ok(self.state(self.done.last().map_or(0, |change| change.viewpoint)))
    }

    fn state(&self, viewpoint: usize) -> StateAnswer {
        StateAnswer {
            viewpoint,
            visible_count: self.viewpoints.viewpoints()[viewpoint].visible.len(),
            can_undo: !self.done.is_empty(),
            can_redo: !self.undone.is_empty(),
            is_saved: self.saved_after == Some(self.done.len()),
        }
    }
}

/// Two upright edges before one viewpoint; its file lies in `folder`.
#[cfg(test)]
pub(super) fn sample(folder: &std::path::Path) -> Editor {
    use edgeloc::geometry::{Polarity, Segment3};
    use edgeloc_sim::world::Occluders;
    let edge = |y: f32| Segment3 {
        start: Point3::new(2.0, y, 0.5),
        end: Point3::new(2.0, y, 1.5),
        polarity: Polarity::LeftBrighter,
    };
    let world = WireframeWorld { edges: vec![edge(0.0), edge(1.0)], ..WireframeWorld::default() };
    let occluders = Occluders::new(&world.surfaces);
    let viewpoints = ReferenceViewpoints::from_surfaces(&world, &occluders, &[Point2::default()], 1.0, &|| ());
    let path = folder.join("a.views");
    file::save(&viewpoints, &path).expect("a writable folder");
    Editor::new(world, path, viewpoints)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visible(editor: &Editor) -> Vec<u32> {
        editor.viewpoints.viewpoints()[0].visible.iter().collect()
    }

    #[test]
    fn the_projection_is_the_librarys_and_hidden_edges_are_drawn_too() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut editor = sample(folder.path());
        editor.set_visible(0, &[1], false).expect("there is an edge 1");
        let view = editor.view(0, 0.0).expect("there is a viewpoint");
        let [ahead, beside] = view.segments[..] else { panic!("two segments") };
        assert_eq!((ahead.0, ahead.5, beside.0, beside.5), (0, 1, 1, 0));
        // Two metres ahead, half a metre up: a quarter of 640 px above the middle; one metre to the left: half of them.
        assert!((ahead.1 - 640.0).abs() < 0.1 && (ahead.2 - 560.0).abs() < 0.1, "{ahead:?}");
        assert!((beside.1 - 320.0).abs() < 0.1, "{beside:?}");
        assert!(editor.view(0, 180.0).expect("a heading").segments.is_empty());
    }

    #[test]
    fn undo_and_redo_walk_through_the_changes_and_know_the_saved_one() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut editor = sample(folder.path());
        assert!(editor.set_visible(0, &[0, 0, 1], false).is_ok_and(|state| !state.is_saved && state.can_undo));
        assert!(editor.set_visible(0, &[0], false).is_ok(), "no change, nothing to undo");
        assert!(editor.undo().is_ok_and(|state| state.is_saved && state.can_redo && !state.can_undo));
        assert_eq!(visible(&editor), [0, 1]);
        assert!(editor.undo().is_err());
        assert!(editor.redo().is_ok_and(|state| !state.is_saved && state.visible_count == 0));
        assert!(editor.save(false).is_ok_and(|state| state.is_saved));
        assert!(editor.undo().is_ok_and(|state| !state.is_saved));
        assert!(editor.set_visible(0, &[0], false).is_ok_and(|state| !state.can_redo));
        assert!(editor.undo().is_ok_and(|state| !state.is_saved), "the saved state can't be reached any more");
    }

    #[test]
    fn what_was_saved_is_in_the_file_and_a_foreign_change_is_not_overwritten_unasked() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut editor = sample(folder.path());
        let (path, before) = (editor.path.clone(), editor.viewpoints.clone());
        editor.set_visible(0, &[1], false).expect("there is an edge 1");
        editor.save(false).expect("the folder is writable");
        assert_eq!(file::load(&path).expect("readable"), editor.viewpoints);
        file::save(&before, &path).expect("the folder is writable");
        assert!(matches!(editor.save(false), Err(Failure::ChangedOnDisk(_))));
        editor.save(true).expect("asked to");
        assert_eq!(file::load(&path).expect("readable"), editor.viewpoints);
        std::fs::remove_dir_all(folder.path()).expect("removed");
        assert!(matches!(editor.save(true), Err(Failure::NotSaved(_))));
    }

    #[test]
    fn edges_and_viewpoints_that_are_not_there_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut editor = sample(folder.path());
        assert!(editor.set_visible(0, &[2], false).is_err() && editor.set_visible(1, &[0], false).is_err());
        assert!(editor.view(1, 0.0).is_err() && editor.view(0, f32::NAN).is_err());
    }
}
