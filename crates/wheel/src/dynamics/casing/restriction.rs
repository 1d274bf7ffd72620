//! Restriction: the casing's height over its surface of revolution, which narrows the gap, in the fixed frame.

use std::f64::consts::{PI, TAU};

use num_integer::gcd;

use super::spline::{ALIKE, PeriodicSpline, narrowest_rad};

/// Height p(φ) at every contact node, a sum of parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Restriction {
    /// Parts of the sum.
    pub parts: Vec<Part>,
}

/// Part of a [`Restriction`].
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Shape of the part around the circumference.
    pub profile: Profile,
    /// Factor of the profile at every contact node; absent: the same all along the chord.
    pub along_chord: Option<Vec<f64>>,
}

/// Shape around the circumference; heights are lengths, angles rad from the package's x axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// Equal Gaussian lobes, evenly spaced: A Σ_l exp(−(wrap(φ − φ_l)/w)²), φ_l = 2πl/count + phase.
    Lobes(Lobes),
    /// Gaussian lobes of their own, each A exp(−(wrap(φ − angle)/w)²).
    Each(Vec<Lobe>),
    /// Wave A cos(order (φ − phase)); of order 0 it is A all around.
    Wave {
        /// Number of waves around the circumference.
        order: u32,
        /// Amplitude A, length.
        amplitude: f64,
        /// Angle of a crest, rad.
        phase_rad: f64,
    },
    /// Measured curves.
    Measured(Measured),
}

/// Curves along lines around the circumference, and contact nodes on and between them: the curve of a node between two lines is linear in theirs.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Curve of every line.
    pub curves: Vec<PeriodicSpline>,
    /// Two lines of every contact node, and the share of the second.
    pub nodes: Vec<(usize, usize, f64)>,
}

/// Equal Gaussian lobes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobes {
    /// Number of lobes.
    pub count: u32,
    /// Height A, length.
    pub amplitude: f64,
    /// Half-width w, rad.
    pub width_rad: f64,
    /// Angle of the first lobe, rad.
    pub phase_rad: f64,
}

/// Gaussian lobe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Height A, length; negative of a hollow.
    pub amplitude: f64,
    /// Half-width w, rad.
    pub width_rad: f64,
    /// Angle of the lobe's crest, rad.
    pub angle_rad: f64,
}

impl From<Lobes> for Restriction {
    fn from(lobes: Lobes) -> Self {
        Self { parts: vec![Part { profile: Profile::Lobes(lobes), along_chord: None }] }
    }
}

impl Restriction {
    /// Height p at an angle and contact node.
    pub fn height(&self, angle_rad: f64, node: usize) -> f64 {
        self.parts.iter().map(|part| part.height(angle_rad, node)).sum()
    }

    /// Largest p of any of `nodes` contact nodes, to about a thousandth.
    pub fn highest(&self, nodes: usize) -> f64 {
        self.extremes(nodes).1
    }

    /// Largest |p| of any of `nodes` contact nodes, to about a thousandth.
    pub fn largest(&self, nodes: usize) -> f64 {
        let (lowest, highest) = self.extremes(nodes);
        highest.max(-lowest)
    }

    /// Smallest and largest p of any of `nodes` contact nodes, to about a thousandth.
    pub fn extremes(&self, nodes: usize) -> (f64, f64) {
        self.extremes_of(nodes, |p, _| p)
    }

    /// Smallest and largest value that `of` makes of p and the contact node, to about a thousandth of p.
    pub(super) fn extremes_of(&self, nodes: usize, of: impl Fn(f64, usize) -> f64) -> (f64, f64) {
        // A thousand angles over what repeats, and twenty over the narrowest shape: of the narrowest ones about their crests alone.
        const MOST: f64 = 20_000.0;
        let (turn, narrowest) = (TAU / self.repeats().max(1) as f64, self.narrowest_rad());
        let count = (20.0 * turn / narrowest).clamp(1000.0, MOST).ceil() as usize;
        let angles = (0..=count).map(|i| turn * i as f64 / count as f64);
        let aside = if count as f64 == MOST { 60 } else { 0 };
        let crests = self.parts.iter().flat_map(|part| part.profile.crests());
        let crests = crests.flat_map(|crest| {
            (-aside..=aside)
                .map(move |i| if i == 0 { crest } else { crest + 0.05 * narrowest * f64::from(i) })
        });
        let of = &of;
        let values = angles.chain(crests);
        let values = values.flat_map(|angle| (0..nodes).map(move |node| of(self.height(angle, node), node)));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// Number of times that p repeats around the circumference.
    pub fn repeats(&self) -> u32 {
        self.parts.iter().map(|part| part.profile.repeats()).fold(0, gcd)
    }

    /// Width that steps have to resolve: the narrowest half-width of a lobe, an eighth of a wave, and that of measured curves as
    /// [`narrowest_rad`] finds it.
    pub fn narrowest_rad(&self) -> f64 {
        self.parts.iter().map(|part| part.profile.narrowest_rad()).fold(f64::INFINITY, f64::min)
    }
}

impl Part {
    fn height(&self, angle_rad: f64, node: usize) -> f64 {
        let factor = self.along_chord.as_ref().map_or(1.0, |along| along[node]);
        factor * self.profile.height(angle_rad, node)
    }
}

impl Profile {
    fn height(&self, angle_rad: f64, node: usize) -> f64 {
        match self {
            Self::Lobes(lobes) => lobes.height(angle_rad),
            Self::Each(lobes) => lobes.iter().map(|lobe| lobe.height(angle_rad)).sum(),
            Self::Wave { order, amplitude, phase_rad } => {
                amplitude * (f64::from(*order) * (angle_rad - phase_rad)).cos()
            }
            Self::Measured(measured) => measured.height(angle_rad, node),
        }
    }

    /// Number of times that the shape repeats; 0 if it is the same all around.
    fn repeats(&self) -> u32 {
        match self {
            Self::Lobes(lobes) => lobes.count,
            Self::Each(lobes) => repeats(lobes),
            Self::Wave { order, .. } => *order,
            Self::Measured(measured) => {
                measured.curves.iter().map(|curve| curve.repeats() as u32).fold(0, gcd)
            }
        }
    }

    fn narrowest_rad(&self) -> f64 {
        let least = |widths: &mut dyn Iterator<Item = f64>| widths.fold(f64::INFINITY, f64::min);
        match self {
            Self::Lobes(lobes) => lobes.width_rad,
            Self::Each(lobes) => least(&mut lobes.iter().map(|lobe| lobe.width_rad)),
            Self::Wave { order: 0, .. } => f64::INFINITY,
            Self::Wave { order, .. } => TAU / (8.0 * f64::from(*order)),
            Self::Measured(measured) => narrowest_rad(&measured.curves),
        }
    }

    /// Angles at which the shape is highest or lowest.
    fn crests(&self) -> Vec<f64> {
        match self {
            Self::Lobes(lobes) => vec![lobes.phase_rad],
            Self::Each(lobes) => lobes.iter().map(|lobe| lobe.angle_rad).collect(),
            Self::Wave { order, phase_rad, .. } => {
                vec![*phase_rad, phase_rad + PI / f64::from((*order).max(1))]
            }
            Self::Measured(Measured { curves, .. }) => {
                curves.iter().flat_map(|curve| [curve.highest().0, curve.lowest().0]).collect()
            }
        }
    }
}

impl Measured {
    /// Curves with one for every contact node.
    pub fn at_each(curves: Vec<PeriodicSpline>) -> Self {
        Self { nodes: (0..curves.len()).map(|node| (node, node, 0.0)).collect(), curves }
    }

    fn height(&self, angle_rad: f64, node: usize) -> f64 {
        let (line, next, share) = self.nodes[node];
        let height = self.curves[line].at(angle_rad);
        if share == 0.0 { height } else { height + share * (self.curves[next].at(angle_rad) - height) }
    }
}

impl Lobes {
    /// Height A Σ_l exp(−(wrap(φ − φ_l)/w)²).
    pub fn height(&self, angle_rad: f64) -> f64 {
        let lobe = |l: u32| {
            let centre = TAU * f64::from(l) / f64::from(self.count) + self.phase_rad;
            (-(wrap(angle_rad - centre) / self.width_rad).powi(2)).exp()
        };
        self.amplitude * (0..self.count).map(lobe).sum::<f64>()
    }
}

impl Lobe {
    fn height(&self, angle_rad: f64) -> f64 {
        self.amplitude * (-(wrap(angle_rad - self.angle_rad) / self.width_rad).powi(2)).exp()
    }
}

/// Largest m such that a turn by 1/m takes every lobe to an equal one; 0 of none.
fn repeats(lobes: &[Lobe]) -> u32 {
    let shown: Vec<&Lobe> = lobes.iter().filter(|lobe| lobe.amplitude != 0.0).collect();
    let is_there = |lobe: &Lobe, turn: f64| {
        shown.iter().any(|other| {
            (other.amplitude, other.width_rad) == (lobe.amplitude, lobe.width_rad)
                && wrap(lobe.angle_rad + turn - other.angle_rad).abs() <= ALIKE
        })
    };
    let count = shown.len() as u32;
    let same = |m: u32| shown.iter().all(|lobe| is_there(lobe, TAU / f64::from(m)));
    (1..=count).rev().find(|&m| count.is_multiple_of(m) && same(m)).unwrap_or(0)
}

/// Angle φ wrapped into (−π, π].
fn wrap(angle_rad: f64) -> f64 {
    let turns = angle_rad - TAU * (angle_rad / TAU).round();
    if turns <= -PI { turns + TAU } else { turns }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(profiles: Vec<Profile>) -> Restriction {
        Restriction {
            parts: profiles.into_iter().map(|profile| Part { profile, along_chord: None }).collect(),
        }
    }

    fn lobe(amplitude: f64, angle_rad: f64) -> Lobe {
        Lobe { amplitude, width_rad: 0.2, angle_rad }
    }

    #[test]
    fn lobes_are_even_and_wrap_around() {
        let lobes = Lobes { count: 3, amplitude: 2.0, width_rad: 0.2, phase_rad: 0.0 };
        assert!((lobes.height(0.0) - 2.0).abs() < 1e-12);
        assert!((lobes.height(TAU / 3.0 + 0.2) - 2.0 / std::f64::consts::E).abs() < 1e-12);
        assert!((lobes.height(10.0 * TAU - 0.1) - lobes.height(0.1)).abs() < 1e-12);
    }

    #[test]
    fn equal_lobes_are_those_of_a_list() {
        let equal = Restriction::from(Lobes { count: 3, amplitude: 0.4, width_rad: 0.2, phase_rad: 0.5 });
        let listed = (0..3).map(|l| lobe(0.4, 0.5 + TAU * f64::from(l) / 3.0)).collect();
        let each = of(vec![Profile::Each(listed)]);
        assert_eq!((equal.repeats(), each.repeats()), (3, 3));
        for i in 0..100 {
            let angle = 0.1 * f64::from(i);
            assert!((equal.height(angle, 0) - each.height(angle, 0)).abs() < 1e-13);
        }
    }

    /// Repetition of a sum is what all of its parts have in common; a turn by it changes nothing, by any more often it does.
    #[test]
    fn symmetry_is_what_all_parts_have_in_common() {
        let wave = |order| Profile::Wave { order, amplitude: 0.1, phase_rad: 0.3 };
        let lobes = |count| Profile::Lobes(Lobes { count, amplitude: 0.3, width_rad: 0.2, phase_rad: 0.1 });
        let pairs = Profile::Each(vec![lobe(0.3, 0.0), lobe(0.2, 1.0), lobe(0.3, PI), lobe(0.2, 1.0 + PI)]);
        let cases = [
            (vec![wave(4), wave(6)], 2),
            (vec![wave(3), lobes(2)], 1),
            (vec![wave(0), lobes(5)], 5),
            (vec![pairs.clone()], 2),
            (vec![pairs, wave(4)], 2),
            (vec![Profile::Each(vec![lobe(0.3, 0.0), lobe(0.2, PI)])], 1),
            (vec![wave(0)], 0),
        ];
        for (profiles, expected) in cases {
            let restriction = of(profiles);
            assert_eq!(restriction.repeats(), expected, "{restriction:?}");
            let moved = |m: f64| {
                let off = |i: u32| {
                    let angle = 0.05 * f64::from(i);
                    (restriction.height(angle + TAU / m, 0) - restriction.height(angle, 0)).abs()
                };
                (0..126).map(off).fold(0.0, f64::max)
            };
            assert!(moved(f64::from(expected.max(1))) < 1e-12);
            if expected > 0 {
                for more in 2..=6 {
                    assert!(moved(f64::from(expected * more)) > 1e-3, "{restriction:?} {more}");
                }
            }
        }
    }

    #[test]
    fn the_highest_point_is_found_where_parts_add_up() {
        let chord = Some(vec![0.5, 1.0]);
        let narrow = Profile::Each(vec![Lobe { amplitude: 0.4, width_rad: 1e-3, angle_rad: 2.0 }]);
        let wave = Profile::Wave { order: 1, amplitude: 0.1, phase_rad: 2.0 };
        let parts =
            vec![Part { profile: narrow, along_chord: chord }, Part { profile: wave, along_chord: None }];
        let restriction = Restriction { parts };
        assert!((restriction.highest(2) - 0.5).abs() < 1e-6);
        assert!((restriction.highest(1) - 0.3).abs() < 1e-6);
        assert!((restriction.narrowest_rad() - 1e-3).abs() < 1e-15);
    }

    /// Sampled lobes converge to the lobes as their points come nearer, in fourth order.
    #[test]
    fn measured_lobes_converge_to_the_lobes() {
        let lobes = Lobes { count: 2, amplitude: 0.4, width_rad: 0.35, phase_rad: 0.1 };
        let worst = |n: usize| {
            let angles: Vec<f64> = (0..n).map(|i| TAU * i as f64 / n as f64).collect();
            let heights: Vec<f64> = angles.iter().map(|&angle| lobes.height(angle)).collect();
            let measured =
                of(vec![Profile::Measured(Measured::at_each(vec![PeriodicSpline::new(&angles, &heights)]))]);
            assert_eq!(measured.repeats(), 2);
            let off = |i: u32| {
                let angle = 0.0017 * f64::from(i);
                (measured.height(angle, 0) - lobes.height(angle)).abs()
            };
            (0..4000).map(off).fold(0.0, f64::max)
        };
        let [coarse, fine] = [180, 360].map(worst);
        assert!(coarse < 1e-5 && (12.0..20.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}
