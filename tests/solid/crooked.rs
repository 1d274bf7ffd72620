//! Crooked places of small meshes.

/// Number in (−1, 1) that looks random, of a place and a seed.
pub(crate) fn noise(at: [f64; 3], seed: f64) -> f64 {
    let wave = (at[0] * 12.9898 + at[1] * 78.233 + at[2] * 37.719 + seed * 4.581).sin() * 43758.5453;
    2.0 * (wave - wave.floor()) - 1.0
}

/// Place in a crooked mesh: every corner is a little out of place; the middles of edges stay in the middle.
pub(crate) fn crooked(at: [f64; 3], amount: f64) -> [f64; 3] {
    let corner = |at: [f64; 3]| -> [f64; 3] { std::array::from_fn(|d| at[d] + amount * noise(at, d as f64)) };
    // The point is in the middle of an edge with these ends; for a corner of the grid both are the corner.
    let [low, high] = [f64::floor, f64::ceil].map(|round| corner(at.map(round)));
    std::array::from_fn(|d| 0.5 * (low[d] + high[d]))
}
