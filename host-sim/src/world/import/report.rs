//! What an import read, and what it could not read.

use serde::Serialize;

/// What [`import`](super::import) made of the files; lengths are in metres, the world frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ImportReport {
    /// One entry per model placed in the world, in file order.
    pub models: Vec<ModelReport>,
    /// What was not read, or read differently from what the file asks.
    pub problems: Vec<ImportProblem>,
    /// Problems beyond the first [`ImportReport::MAX_PROBLEMS`], not listed.
    pub unlisted_problem_count: usize,
    /// Least length of an edge that enters the world, in metres.
    pub min_edge_m: f64,
    /// Segments shorter than `min_edge_m`, left out of the world.
    pub short_segment_count: usize,
    /// Materials that are pictures; their surfaces count as mid grey.
    pub textured_material_count: usize,
}

impl ImportReport {
    /// How many problems are listed; a broken file would name millions.
    pub const MAX_PROBLEMS: usize = 100;

    /// Triangles read, over all models.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.models.iter().map(|model| model.triangle_count).sum()
    }

    /// Segments of any length, over all models.
    #[must_use]
    pub fn segment_count(&self) -> usize {
        self.models.iter().map(|model| model.segment_count).sum()
    }

    /// Segments of 10 cm or more, over all models.
    #[must_use]
    pub fn segments_10cm(&self) -> usize {
        self.models.iter().map(|model| model.segments_10cm).sum()
    }

    /// The box around all models.
    #[must_use]
    pub fn bounding_box(&self) -> Option<BoundingBox> {
        self.models.iter().filter_map(|model| model.bounding_box).reduce(BoundingBox::joined)
    }

    pub(super) fn add(&mut self, problem: ImportProblem) {
        if self.problems.contains(&problem) {
            return;
        }
        if self.is_full() {
            self.unlisted_problem_count += 1;
        } else {
            self.problems.push(problem);
        }
    }

    /// Whether further problems are only counted, so that nobody need work out their places.
    pub(super) fn is_full(&self) -> bool {
        self.problems.len() >= Self::MAX_PROBLEMS
    }
}

/// One placed model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelReport {
    /// Its name in the world file, or the file's own name.
    pub name: String,
    /// The mesh files it was read from, relative to the folder that was searched.
    pub sources: Vec<String>,
    /// Triangles read.
    pub triangle_count: usize,
    /// Segments of any length.
    pub segment_count: usize,
    /// Segments of 5 cm or more.
    pub segments_5cm: usize,
    /// Segments of 10 cm or more.
    pub segments_10cm: usize,
    /// Total length of its segments, in metres.
    pub edge_length_m: f64,
    /// The box around it; none if nothing was read.
    pub bounding_box: Option<BoundingBox>,
}

/// A box along the axes of the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BoundingBox {
    /// Least x, y and z, in metres.
    pub min_m: [f32; 3],
    /// Greatest x, y and z, in metres.
    pub max_m: [f32; 3],
}

impl BoundingBox {
    /// The box around points; none without points.
    pub(super) fn around(points: impl IntoIterator<Item = [f32; 3]>) -> Option<Self> {
        points.into_iter().map(|point| Self { min_m: point, max_m: point }).reduce(Self::joined)
    }

    /// The box around both.
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        let each = |a: [f32; 3], b: [f32; 3], pick: fn(f32, f32) -> f32| [0, 1, 2].map(|i| pick(a[i], b[i]));
        Self { min_m: each(self.min_m, other.min_m, f32::min), max_m: each(self.max_m, other.max_m, f32::max) }
    }

    /// Its extent along x, y and z, in metres.
    #[must_use]
    pub fn size_m(&self) -> [f32; 3] {
        [0, 1, 2].map(|i| self.max_m[i] - self.min_m[i])
    }
}

/// Something an import could not read or do as the file asks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, thiserror::Error)]
#[error("{place}: {what} ({remedy})")]
pub struct ImportProblem {
    /// The file, and the line or the element.
    pub place: String,
    /// What is wrong.
    pub what: String,
    /// What to do about it.
    pub remedy: String,
}

impl ImportProblem {
    pub(super) fn new(place: impl Into<String>, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { place: place.into(), what: what.into(), remedy: remedy.into() }
    }
}
