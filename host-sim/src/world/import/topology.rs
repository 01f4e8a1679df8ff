//! How a flat list of corners makes triangles or lines: the topologies that Collada and glTF share.

/// The kinds of list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Topology {
    Triangles,
    TriangleStrip,
    TriangleFan,
    Lines,
    LineStrip,
    LineLoop,
}

impl Topology {
    /// The triangles of `corners`, all wound alike; none for a list of lines.
    pub(super) fn triangles<T: Copy>(self, corners: &[T]) -> Vec<[T; 3]> {
        match self {
            Self::Triangles => corners.chunks_exact(3).map(|face| [face[0], face[1], face[2]]).collect(),
            Self::TriangleStrip => corners
                .windows(3)
                .enumerate()
                .map(
                    |(index, face)| {
                        if index % 2 == 0 { [face[0], face[1], face[2]] } else { [face[1], face[0], face[2]] }
                    },
                )
                .collect(),
            Self::TriangleFan => corners.split_first().map_or_else(Vec::new, |(&center, rim)| {
                rim.windows(2).map(|pair| [center, pair[0], pair[1]]).collect()
            }),
            Self::Lines | Self::LineStrip | Self::LineLoop => Vec::new(),
        }
    }

    /// The lines of `corners`; none for a list of triangles.
    pub(super) fn lines<T: Copy>(self, corners: &[T]) -> Vec<[T; 2]> {
        let strip = || corners.windows(2).map(|pair| [pair[0], pair[1]]);
        match self {
            Self::Lines => corners.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect(),
            Self::LineStrip => strip().collect(),
            Self::LineLoop => match corners {
                [first, .., last] => strip().chain([[*last, *first]]).collect(),
                _ => Vec::new(),
            },
            Self::Triangles | Self::TriangleStrip | Self::TriangleFan => Vec::new(),
        }
    }

    /// How many corners at the end of a list of `count` make no whole triangle or line.
    pub(super) fn left_over(self, count: usize) -> usize {
        match self {
            Self::Triangles => count % 3,
            Self::Lines => count % 2,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_and_a_fan_wind_all_triangles_alike() {
        assert_eq!(Topology::TriangleStrip.triangles(&[0, 1, 2, 3]), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(Topology::TriangleFan.triangles(&[0, 1, 2, 3]), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(Topology::Triangles.triangles(&[0, 1, 2, 3]), [[0, 1, 2]]);
        assert_eq!(Topology::Triangles.left_over(4), 1);
    }

    #[test]
    fn a_loop_closes_and_a_strip_does_not() {
        assert_eq!(Topology::LineLoop.lines(&[0, 1, 2]), [[0, 1], [1, 2], [2, 0]]);
        assert_eq!(Topology::LineStrip.lines(&[0, 1, 2]), [[0, 1], [1, 2]]);
        assert_eq!(Topology::Lines.lines(&[0, 1, 2, 3]), [[0, 1], [2, 3]]);
        assert!(Topology::LineLoop.lines(&[0]).is_empty());
    }
}
