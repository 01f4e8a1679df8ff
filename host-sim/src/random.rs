//! Random draws as an argument: counter-based streams, keyed by what they are for.
//!
//! A stream depends on the run's seed, its purpose and two indices (a trial and a source, say), never on a thread, a
//! worker or what was drawn before. So any trial replays alone, and switching one source off leaves the others' draws
//! unchanged.

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// One stream of random numbers.
#[derive(Debug, Clone)]
pub struct Stream {
    generator: ChaCha8Rng,
}

impl Stream {
    /// The stream of `seed` for a `purpose` (a fixed word, at most eight bytes) and two indices.
    ///
    /// The four parts fill the 32-byte key of ChaCha8, so that no two streams share a key.
    #[must_use]
    pub fn new(seed: u64, purpose: &str, first: u64, second: u64) -> Self {
        assert!(purpose.len() <= 8, "the purpose {purpose:?} does not fit eight bytes of the key");
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..8 + purpose.len()].copy_from_slice(purpose.as_bytes());
        key[16..24].copy_from_slice(&first.to_le_bytes());
        key[24..].copy_from_slice(&second.to_le_bytes());
        Self { generator: ChaCha8Rng::from_seed(key) }
    }

    /// Goes on at the `place`-th of many places in the stream, each with room for 32,768 draws: what is drawn there
    /// does not depend on how much was drawn before.
    pub fn seek(&mut self, place: usize) {
        self.generator.set_word_pos((place as u128) << 16);
    }

    /// A number uniform in `[0, 1)`, a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// A number uniform in `[low, high)`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// An index uniform in `0..count`; `count` must be positive.
    pub fn index(&mut self, count: usize) -> usize {
        assert!(count > 0, "an index needs something to point at");
        // Lemire's multiply-shift; the bias is below count / 2^64.
        ((u128::from(self.generator.next_u64()) * count as u128) >> 64) as usize
    }

    /// `true` with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Two independent standard Gaussian numbers (the polar method, Marsaglia and Bray 1964).
    ///
    /// Refused draws are a matter of chance, 21 % of them, never of the machine: only `sqrt` and `libm` are used.
    pub fn circular_gaussian(&mut self) -> [f64; 2] {
        loop {
            let (x, y) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                let scale = (-2.0 * libm::log(square) / square).sqrt();
                return [x * scale, y * scale];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_with_any_part_different_differ() {
        let first = |mut stream: Stream| stream.unit().to_bits();
        let base = first(Stream::new(1, "trial", 2, 3));
        assert_eq!(base, first(Stream::new(1, "trial", 2, 3)));
        for other in [
            Stream::new(2, "trial", 2, 3),
            Stream::new(1, "map", 2, 3),
            Stream::new(1, "trial", 3, 3),
            Stream::new(1, "trial", 2, 4),
        ] {
            assert_ne!(base, first(other));
        }
    }

    #[test]
    fn a_place_in_a_stream_is_the_same_however_it_is_reached() {
        let mut stream = Stream::new(1, "trial", 2, 3);
        let from_start = stream.unit();
        stream.seek(7);
        let at_place = stream.unit();
        (0..100).for_each(|_| _ = stream.unit());
        stream.seek(7);
        assert_eq!(stream.unit().to_bits(), at_place.to_bits());
        stream.seek(0);
        assert_eq!(stream.unit().to_bits(), from_start.to_bits());
        assert_ne!(at_place.to_bits(), from_start.to_bits());
    }

    #[test]
    fn uniform_and_gaussian_have_their_moments() {
        let mut stream = Stream::new(7, "test", 0, 0);
        let draws = 40_000;
        let (mut sum, mut square) = (0.0, 0.0);
        for _ in 0..draws {
            let [x, _] = stream.circular_gaussian();
            sum += x;
            square += x * x;
        }
        let count = f64::from(draws);
        assert!((sum / count).abs() < 0.02 && (square / count - 1.0).abs() < 0.03);
        assert!((0..1000).all(|_| (3.0..5.0).contains(&stream.uniform(3.0, 5.0))));
        assert!((0..1000).all(|_| stream.index(7) < 7));
    }
}
