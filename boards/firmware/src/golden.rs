//! The golden vectors, as every board carries them.

/// The map; a board may place a copy of it in a memory of its choice.
pub static MAP: [u8; include_bytes!("../../../tests/fixtures/golden/office.map").len()] =
    *include_bytes!("../../../tests/fixtures/golden/office.map");

/// The same nodes as the verifying localizer's maps have them: the pieces of an edge joined, the models within a budget.
pub static JOINED_MAP: &[u8] = include_bytes!("../../../tests/fixtures/golden/joined.map");

/// What robots saw.
pub static LOOKS: &[u8] = include_bytes!("../../../tests/fixtures/golden/looks.bin");

/// What the localizer of the host answered.
pub static ANSWERS: &str = include_str!("../../../tests/fixtures/golden/expected.txt");

/// What the kernels of the host made of drawn inputs.
pub static KERNELS: &str = include_str!("../../../tests/fixtures/golden/kernels.txt");
