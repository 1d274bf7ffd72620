//! Forces of one place: their distance from the projections, and their solution while all other places stay.

/// Forces at a place: along the normal, and in two directions of the contact plane.
pub type Forces = [f64; 3];

/// Block of W: displacements at one place by unit forces at another, `[of][by]`.
pub type Block = [[f64; 3]; 3];

/// State of contact of a place: the piece of its projections that it is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum State {
    Open,
    Sticks,
    /// Sliding, against τ along `direction`; the projection shortens τ + ρs by the factor `share`.
    Slides {
        direction: [f64; 2],
        share: f64,
        scale: f64,
    },
}

/// State of a place with forces `x`, gap and sliding `y`, and its distance from its projections, as a length.
pub(super) fn meet(w: &Block, x: &Forces, y: &Forces, coefficient: f64) -> (State, f64) {
    let (rigidity, scale) = (1.0 / w[0][0], 1.0 / (w[1][1] + w[2][2]));
    let lambda = x[0] - rigidity * y[0];
    if lambda <= 0.0 {
        return (State::Open, (x[0] * w[0][0]).abs() + x[1].hypot(x[2]) / scale);
    }
    let aim = [x[1] - scale * y[1], x[2] - scale * y[2]];
    let (size, radius) = (aim[0].hypot(aim[1]), coefficient * lambda);
    if size < radius {
        return (State::Sticks, y[0].abs().max(y[1].hypot(y[2])));
    }
    let direction = if size > 0.0 { [aim[0] / size, aim[1] / size] } else { [1.0, 0.0] };
    let share = if size > 0.0 { radius / size } else { 0.0 };
    let away = [x[1] - radius * direction[0], x[2] - radius * direction[1]];
    (State::Slides { direction, share, scale }, y[0].abs().max(away[0].hypot(away[1]) / scale))
}

/// Directions in which the sliding of one place is searched.
const DIRECTIONS: u32 = 36;

/// Forces of one place whose gap is y_n and sliding −y_t without them; none if it slides in no direction.
pub(super) fn alone(w: &Block, y: &Forces, coefficient: f64) -> Option<Forces> {
    if y[0] >= 0.0 {
        return Some([0.0; 3]);
    }
    let stuck = solve(w, y.map(|y| -y));
    if stuck[0] > 0.0 && stuck[1].hypot(stuck[2]) <= coefficient * stuck[0] {
        return Some(stuck);
    }
    // Forces if it slides along an angle; how far it then slides across and along.
    let towards = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let direction = [1.0, coefficient * cos, coefficient * sin];
        let lambda = -y[0] / dot(w[0], direction);
        let forces = direction.map(|d| d * lambda);
        let s = [-y[1] - dot(w[1], forces), -y[2] - dot(w[2], forces)];
        (forces, s[1] * cos - s[0] * sin, s[0] * cos + s[1] * sin)
    };
    let angle = |part: u32| std::f64::consts::TAU * f64::from(part) / f64::from(DIRECTIONS);
    for part in 0..DIRECTIONS {
        let (mut low, mut high) = (angle(part), angle(part + 1));
        if !(towards(low).1 > 0.0 && towards(high).1 <= 0.0) {
            continue;
        }
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if towards(middle).1 > 0.0 { low = middle } else { high = middle }
        }
        let (forces, _, along) = towards(high);
        if along >= 0.0 && forces[0] > 0.0 {
            return Some(forces);
        }
    }
    None
}

/// W⁻¹ b by Cramer's rule.
fn solve(w: &Block, b: Forces) -> Forces {
    let determinant = |w: &Block| {
        w[0][0] * (w[1][1] * w[2][2] - w[1][2] * w[2][1]) - w[0][1] * (w[1][0] * w[2][2] - w[1][2] * w[2][0])
            + w[0][2] * (w[1][0] * w[2][1] - w[1][1] * w[2][0])
    };
    let whole = determinant(w);
    [0, 1, 2].map(|column| {
        let mut changed = *w;
        for (row, value) in changed.iter_mut().zip(b) {
            row[column] = value;
        }
        determinant(&changed) / whole
    })
}

pub(super) fn dot(a: Forces, b: Forces) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
