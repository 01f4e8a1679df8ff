//! Which settings are worth having: those that no other beats in success, work and size of the map at once (Pareto).

/// What a setting gives and what it costs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Merit {
    /// Success rate, a fraction: the more the better.
    pub success: f64,
    /// Work of a localisation: the less the better.
    pub work: f64,
    /// Size of the map in bytes: the less the better.
    pub map_bytes: f64,
}

impl Merit {
    /// Whether nothing of `other` is better and something is worse.
    #[must_use]
    pub fn dominates(&self, other: &Self) -> bool {
        self.success >= other.success
            && self.is_no_costlier_than(other)
            && (self.success > other.success || self.work < other.work || self.map_bytes < other.map_bytes)
    }

    /// Whether neither work nor map are larger than those of `other`.
    #[must_use]
    pub fn is_no_costlier_than(&self, other: &Self) -> bool {
        self.work <= other.work && self.map_bytes <= other.map_bytes
    }
}

/// The front of each setting: 0 for those that none dominates, 1 for those that only the former dominate, and so on.
#[must_use]
pub fn front_ranks(merits: &[Merit]) -> Vec<usize> {
    let mut ranks: Vec<Option<usize>> = vec![None; merits.len()];
    for rank in 0..merits.len() {
        let open: Vec<usize> = (0..merits.len()).filter(|&index| ranks[index].is_none()).collect();
        let is_free = |&index: &usize| !open.iter().any(|&other| merits[other].dominates(&merits[index]));
        for index in open.iter().copied().filter(is_free).collect::<Vec<_>>() {
            ranks[index] = Some(rank);
        }
    }
    // Domination has no cycles, so that every round ranks at least one.
    ranks.into_iter().map(|rank| rank.unwrap_or(merits.len())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merit(success: f64, work: f64, map_bytes: f64) -> Merit {
        Merit { success, work, map_bytes }
    }

    #[test]
    fn fronts_peel_off_one_by_one() {
        let merits = [
            merit(0.9, 10.0, 5.0), // best success
            merit(0.8, 4.0, 5.0),  // least work
            merit(0.8, 10.0, 5.0), // worse than both
            merit(0.7, 10.0, 6.0), // worse than all
            merit(0.5, 20.0, 1.0), // the smallest map
        ];
        assert_eq!(front_ranks(&merits), [0, 0, 1, 2, 0]);
    }

    #[test]
    fn equals_share_a_front() {
        assert_eq!(front_ranks(&[merit(0.9, 1.0, 1.0); 3]), [0, 0, 0]);
        assert!(front_ranks(&[]).is_empty());
    }
}
