//! Cameras beside a node that are checked together: which parts of a segment each of them sees.

use super::frustum::Frustum;
use super::lanes::Lane;
use crate::math;

/// Cameras that are checked together at most.
pub(super) const BATCH: usize = 16;

/// Cameras in one frame, that of the turned model, which look along its axis.
#[derive(Debug)]
pub(super) struct Cameras {
    /// To the right and forward \[m\]; those beyond the count stand with the first.
    offsets: [[f32; BATCH]; 2],
    frustum: Frustum,
    /// How far each camera's place moves a point towards the inner side of each plane.
    shifts: [[f32; BATCH]; Frustum::PLANES],
    /// The least and the most of these.
    reaches: [[f32; 2]; Frustum::PLANES],
}

/// Planes that cut a segment for some of the cameras.
#[derive(Debug, Clone, Copy)]
pub(super) struct CutPlanes(u8);

impl Cameras {
    /// Those at `offsets_m` to the right and forward, [`BATCH`] of them at most.
    pub(super) fn new(offsets_m: impl Iterator<Item = [f32; 2]> + Clone, frustum: Frustum) -> Self {
        let [right, forward] = offsets_m.clone().next().unwrap_or_default();
        let mut offsets = [[right; BATCH], [forward; BATCH]];
        for (index, [right, forward]) in offsets_m.enumerate().take(BATCH) {
            (offsets[0][index], offsets[1][index]) = (right, forward);
        }
        let mut cameras =
            Self { offsets, frustum, shifts: [[0.0; BATCH]; Frustum::PLANES], reaches: [[0.0; 2]; Frustum::PLANES] };
        cameras.shift::<0>();
        cameras.shift::<1>();
        cameras.shift::<2>();
        cameras.shift::<3>();
        cameras.shift::<4>();
        cameras
    }

    fn shift<const PLANE: usize>(&mut self) {
        let still = self.frustum.inside::<PLANE>([0.0; 3]);
        let [right, forward] = &self.offsets;
        let [mut least, mut most] = [f32::INFINITY, f32::NEG_INFINITY];
        for (index, shift) in self.shifts[PLANE].iter_mut().enumerate() {
            *shift = self.frustum.inside::<PLANE>([-right[index], 0.0, -forward[index]]) - still;
            (least, most) = (math::min(least, *shift), math::max(most, *shift));
        }
        self.reaches[PLANE] = [least, most];
    }

    /// To the right and forward, of `N` cameras from the `first` on \[m\].
    #[inline(always)]
    pub(super) fn offsets<const N: usize>(&self, first: usize) -> [Lane<f32, N>; 2] {
        let [right, forward] = &self.offsets;
        [lanes(right, first), lanes(forward, first)]
    }

    /// At which planes a segment is to be cut; `None` if no camera sees any of it.
    #[inline(always)]
    pub(super) fn planes_across(&self, start: [f32; 3], end: [f32; 3]) -> Option<CutPlanes> {
        let planes = self.plane_across::<0>(start, end)?
            | self.plane_across::<1>(start, end)?
            | self.plane_across::<2>(start, end)?
            | self.plane_across::<3>(start, end)?
            | self.plane_across::<4>(start, end)?;
        Some(CutPlanes(planes))
    }

    #[inline(always)]
    fn plane_across<const PLANE: usize>(&self, start: [f32; 3], end: [f32; 3]) -> Option<u8> {
        let [least, most] = self.reaches[PLANE];
        let (from, to) = (self.frustum.inside::<PLANE>(start), self.frustum.inside::<PLANE>(end));
        let is_outside = (from + most < 0.0) & (to + most < 0.0);
        let is_inside = (from + least >= 0.0) & (to + least >= 0.0);
        (!is_outside).then_some(u8::from(!is_inside) << PLANE)
    }

    /// Which part of a segment `N` cameras from the `first` on see.
    #[inline(always)]
    pub(super) fn seen_part<const N: usize>(
        &self,
        (start, end): ([f32; 3], [f32; 3]),
        first: usize,
        planes: CutPlanes,
    ) -> SeenPart<N> {
        let mut part = SeenPart { enter: [0.0; N], leave: [1.0; N] };
        self.cut::<0, N>((start, end), first, planes, &mut part);
        self.cut::<1, N>((start, end), first, planes, &mut part);
        self.cut::<2, N>((start, end), first, planes, &mut part);
        self.cut::<3, N>((start, end), first, planes, &mut part);
        self.cut::<4, N>((start, end), first, planes, &mut part);
        part
    }

    #[inline(always)]
    fn cut<const PLANE: usize, const N: usize>(
        &self,
        (start, end): ([f32; 3], [f32; 3]),
        first: usize,
        CutPlanes(planes): CutPlanes,
        part: &mut SeenPart<N>,
    ) {
        if planes & (1 << PLANE) == 0 {
            return;
        }
        let (start, end) = (self.frustum.inside::<PLANE>(start), self.frustum.inside::<PLANE>(end));
        let shifts = lanes::<N>(&self.shifts[PLANE], first);
        for (lane, shift) in shifts.into_iter().enumerate() {
            let (from, to) = (start + shift, end + shift);
            // One lane is spared what changes nothing; several go together.
            if N == 1 && from >= 0.0 && to >= 0.0 {
                continue;
            }
            let at = from / (from - to);
            let (enter, leave) = (part.enter[lane], part.leave[lane]);
            let later = if (from < 0.0) & (at > enter) { at } else { enter };
            part.enter[lane] = if (from < 0.0) & (to < 0.0) { 2.0 } else { later };
            part.leave[lane] = if (to < 0.0) & (at < leave) { at } else { leave };
        }
    }
}

/// `N` of all, from the `first` on, or the last.
#[inline(always)]
fn lanes<const N: usize>(all: &[f32; BATCH], first: usize) -> Lane<f32, N> {
    let first = first.min(BATCH - N);
    let mut lanes = [0.0; N];
    lanes.copy_from_slice(&all[first..first + N]);
    lanes
}

/// Which part of a segment is seen, in shares of the way from its start to its end; none, where `enter` is not below
/// `leave`.
#[derive(Debug)]
pub(super) struct SeenPart<const N: usize> {
    pub(super) enter: Lane<f32, N>,
    pub(super) leave: Lane<f32, N>,
}

impl<const N: usize> SeenPart<N> {
    /// In which lanes anything is seen.
    #[inline(always)]
    pub(super) fn is_any(&self) -> Lane<bool, N> {
        let mut is_any = [false; N];
        for (lane, is_any) in is_any.iter_mut().enumerate() {
            *is_any = self.enter[lane] < self.leave[lane];
        }
        is_any
    }
}
