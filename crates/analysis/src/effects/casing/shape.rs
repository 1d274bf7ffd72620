//! Shape of a casing: what stands inward of its surface of revolution.

use std::f64::consts::TAU;

use num_integer::gcd;

use super::request::{self, Lobes, Measured, SingleLobe, Tilt, Wave};
use rubmap_wheel::dynamics::casing::{self, Part, Profile, Restriction};

/// Shape of a casing: parts whose heights add up.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shape {
    pub(crate) lobes: Option<Lobes>,
    pub(crate) single_lobes: Vec<SingleLobe>,
    pub(crate) waves: Vec<Wave>,
    pub(crate) measured: Option<Measured>,
    pub(crate) tilt: Option<Tilt>,
}

impl Shape {
    /// Reads the shape of a casing that is asked for.
    pub fn of(casing: &request::Casing) -> Self {
        let request::Casing { clearance: _, lobes, single_lobes, waves, measured, tilt } = casing.clone();
        Self { lobes, single_lobes, waves, measured, tilt }
    }

    /// Whether the casing is one of revolution.
    pub(crate) fn is_circular(&self) -> bool {
        *self == Self::default()
    }

    /// Number of times that the shape repeats around the circumference; none for a circular casing.
    pub fn repeats(&self) -> Option<u32> {
        let measured = self.measured.as_ref().map_or(0, Measured::repeats);
        let tilted = u32::from(self.leans().is_some());
        let repeats = [measured, tilted].into_iter().fold(self.lobes_and_waves().repeats(), gcd);
        (repeats > 0).then_some(repeats)
    }

    /// Width that steps have to resolve, rad; none for a circular casing.
    pub(crate) fn narrowest_rad(&self) -> Option<f64> {
        let measured = self.measured.as_ref().map(Measured::narrowest_rad);
        let narrowest = measured.into_iter().fold(self.lobes_and_waves().narrowest_rad(), f64::min);
        narrowest.is_finite().then_some(narrowest)
    }

    /// Upper bound of the height, wherever along the chord; infinite where a tilt makes it depend on the nodes.
    pub(crate) fn highest(&self) -> f64 {
        if self.leans().is_some() {
            return f64::INFINITY;
        }
        let (alike, shared): (Vec<Part>, Vec<Part>) =
            self.lobes_and_waves().parts.into_iter().partition(|part| part.along_chord.is_none());
        let alike = if alike.is_empty() { 0.0 } else { Restriction { parts: alike }.highest(1) };
        // A part with shares counts with its largest height at any of them, inward or outward.
        let shared = shared.into_iter().map(|Part { profile, along_chord }| {
            let part = Part { profile, along_chord: None };
            let (low, high) = Restriction { parts: vec![part] }.extremes(1);
            let of = |most: f64, share: f64| most.max(share * low).max(share * high);
            along_chord.into_iter().flatten().fold(f64::NEG_INFINITY, of)
        });
        let measured = self.measured.iter().map(|measured| {
            measured.extremes().iter().map(|[highest, _]| highest.1).fold(f64::NEG_INFINITY, f64::max)
        });
        alike + shared.sum::<f64>() + measured.sum::<f64>()
    }

    /// Length in which the shape does what a lobe does between two valleys, rad: for equal lobes alone their distance, otherwise eight times the
    /// width that steps have to resolve, as for a wave; none for a circular casing.
    pub(crate) fn period_rad(&self) -> Option<f64> {
        match &self.lobes {
            Some(lobes) if *self == (Self { lobes: self.lobes.clone(), ..Self::default() }) => {
                Some(TAU / f64::from(lobes.count))
            }
            _ => self.narrowest_rad().map(|narrowest| 8.0 * narrowest),
        }
    }

    /// Tilt of the casing, if its angle is not 0.
    fn leans(&self) -> Option<&Tilt> {
        self.tilt.as_ref().filter(|tilt| tilt.angle_rad != 0.0)
    }

    /// Restriction for contact nodes at `positions`, `[r, θ, z]` in the order of the chord, with `normals`; none for a circular casing.
    pub(crate) fn restriction(&self, positions: &[[f64; 3]], normals: &[[f64; 3]]) -> Option<Restriction> {
        let Restriction { mut parts } = self.lobes_and_waves();
        if let Some(measured) = &self.measured {
            parts.push(Part { profile: Profile::Measured(measured.at(positions)), along_chord: None });
        }
        parts.extend(self.leans().map(|tilt| tilt.part(positions, normals)));
        (!parts.is_empty()).then_some(Restriction { parts })
    }

    /// Restriction by lobes and waves alone.
    fn lobes_and_waves(&self) -> Restriction {
        let lobes = self.lobes.iter().map(|lobes| Part {
            profile: Profile::Lobes(casing::Lobes {
                count: lobes.count,
                amplitude: lobes.amplitude,
                width_rad: lobes.width_rad,
                phase_rad: lobes.phase_rad,
            }),
            along_chord: lobes.along_chord.clone(),
        });
        // Lobes are put together as far as they share their part of the chord: only so it is seen where they repeat.
        let mut single: Vec<Part> = Vec::new();
        for lobe in self.single_lobes.iter().filter(|lobe| is_there(lobe.amplitude, &lobe.along_chord)) {
            let one = casing::Lobe {
                amplitude: lobe.amplitude,
                width_rad: lobe.width_rad,
                angle_rad: lobe.angle_rad,
            };
            let alike = single.iter_mut().find(|part| part.along_chord == lobe.along_chord);
            match alike {
                Some(Part { profile: Profile::Each(lobes), .. }) => lobes.push(one),
                _ => single
                    .push(Part { profile: Profile::Each(vec![one]), along_chord: lobe.along_chord.clone() }),
            }
        }
        let waves = self.waves.iter().filter(|wave| is_there(wave.amplitude, &wave.along_chord));
        let waves = waves.map(|wave| Part {
            profile: Profile::Wave {
                order: wave.order,
                amplitude: wave.amplitude,
                phase_rad: wave.phase_rad,
            },
            along_chord: wave.along_chord.clone(),
        });
        Restriction { parts: lobes.chain(single).chain(waves).collect() }
    }
}

/// Whether a part has a height anywhere: a part without one would count with its symmetry all the same.
fn is_there(amplitude: f64, along_chord: &Option<Vec<f64>>) -> bool {
    amplitude != 0.0 && along_chord.as_ref().is_none_or(|along| along.iter().any(|share| *share != 0.0))
}

impl Tilt {
    /// Heights of a casing whose axis leans by τ towards ψ about z₀, to first order: its surface at (r, φ, z) moves away from a tip
    /// with the normal n by τ ((z − z₀) n_r − r n_z) cos(φ − ψ), and a height is its move towards the tip.
    fn part(&self, positions: &[[f64; 3]], normals: &[[f64; 3]]) -> Part {
        let near =
            |([r, _, z], normal): (&[f64; 3], &[f64; 3])| r * normal[2] - (z - self.about_z) * normal[0];
        let along_chord = Some(positions.iter().zip(normals).map(near).collect());
        let wave = Profile::Wave { order: 1, amplitude: self.angle_rad, phase_rad: self.towards_rad };
        Part { profile: wave, along_chord }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::casing::curves::Curves;
    use nalgebra::{Rotation3, Unit, Vector3};
    use rubmap_wheel::dynamics::casing::arc_lengths;
    use rubmap_wheel::dynamics::sector::ContactNode;
    use std::f64::consts::PI;

    fn nodes() -> Vec<ContactNode> {
        let node = |k: usize| {
            let lean = 0.3 + 0.2 * k as f64;
            ContactNode {
                id: k as u64,
                position: [100.0 + 8.0 * k as f64, 0.05 * k as f64, -5.0 * k as f64],
                normal: [lean.cos(), 0.0, lean.sin()],
                dofs: [3 * k, 3 * k + 1, 3 * k + 2],
            }
        };
        (0..5).map(node).collect()
    }

    impl Shape {
        fn of_nodes(&self, nodes: &[ContactNode]) -> Option<Restriction> {
            let (positions, normals): (Vec<_>, Vec<_>) =
                nodes.iter().map(|node| (node.position, node.normal)).unzip();
            self.restriction(&positions, &normals)
        }
    }

    fn lobe(angle_rad: f64, amplitude: f64, along_chord: Option<Vec<f64>>) -> SingleLobe {
        SingleLobe { angle_rad, amplitude, width_rad: 0.3, along_chord }
    }

    /// Two lobes, as lobes, one by one, and measured, are the same: to the bit but for their sum, and to the error of the interpolation.
    #[test]
    fn lobes_are_the_same_however_they_are_said() {
        let lobes = Lobes { count: 2, amplitude: 0.4, width_rad: 0.3, phase_rad: 0.1, along_chord: None };
        let equal = Shape { lobes: Some(lobes), ..Shape::default() };
        let single = vec![lobe(0.1, 0.4, None), lobe(0.1 + PI, 0.4, None)];
        let single = Shape { single_lobes: single, ..Shape::default() };
        let nodes = nodes();
        let exact = equal.of_nodes(&nodes).unwrap();
        let angles_rad: Vec<f64> = (0..720).map(|i| TAU * f64::from(i) / 720.0).collect();
        let heights = vec![angles_rad.iter().map(|&angle| exact.height(angle, 0)).collect()];
        let measured = Measured { angles_rad, chord: Some(vec![0.5]), heights, curves: Curves::default() };
        assert!(std::ptr::eq(measured.clone().curves(), measured.curves()), "made once");
        let measured = Shape { measured: Some(measured), ..Shape::default() };
        for (shape, error) in [(&equal, 0.0), (&single, 1e-14), (&measured, 1e-8)] {
            assert_eq!(shape.repeats(), Some(2), "{shape:?}");
            let restriction = shape.of_nodes(&nodes).unwrap();
            for (node, i) in (0..5).flat_map(|node| (0..100).map(move |i| (node, i))) {
                let angle = 0.063 * f64::from(i);
                let off = (restriction.height(angle, node) - exact.height(angle, node)).abs();
                assert!(off <= error, "{node} {angle}: {off:e}");
            }
            assert!((shape.highest() - 0.4).abs() < 1e-3, "{}", shape.highest());
        }
        assert_eq!((equal.narrowest_rad(), single.narrowest_rad()), (Some(0.3), Some(0.3)));
    }

    #[test]
    fn a_circular_casing_repeats_nowhere_in_particular() {
        let circular = Shape::default();
        assert!(circular.is_circular() && circular.of_nodes(&nodes()).is_none());
        assert_eq!((circular.repeats(), circular.narrowest_rad(), circular.highest()), (None, None, 0.0));
    }

    /// A hollow that a negative share turns inward, and lobes whose shares meet: no height may be larger than is said.
    #[test]
    fn shares_of_either_sign_reach_no_higher_than_is_said() {
        let along = |shares: [f64; 5]| Some(shares.to_vec());
        let shapes = [
            (vec![lobe(0.0, -0.5, along([-1.0, 0.0, 0.0, 0.0, 0.0]))], 0.5),
            (
                vec![
                    lobe(0.0, 0.5, along([1.0, 0.0, 0.5, 0.0, 0.0])),
                    lobe(0.0, 0.3, along([0.0, 1.0, 0.0, 0.0, 0.0])),
                ],
                0.5,
            ),
            (vec![lobe(1.0, -0.5, None)], 0.0),
        ];
        for (single_lobes, most) in shapes {
            let shape = Shape { single_lobes, ..Shape::default() };
            let true_most = shape.of_nodes(&nodes()).unwrap().highest(5);
            let said = shape.highest();
            assert!(
                (true_most - most).abs() < 1e-6 && said >= true_most - 1e-9 && said < most + 0.31,
                "{said} {true_most}"
            );
        }
    }

    #[test]
    fn what_differs_along_the_chord_or_in_height_repeats_less() {
        let shape = |single_lobes| Shape { single_lobes, ..Shape::default() };
        let along = Some(vec![1.0, 0.8, 0.6, 0.4, 0.2]);
        let four = |along: [&Option<Vec<f64>>; 4]| {
            (0..4).map(|l| lobe(0.2 + PI / 2.0 * l as f64, 0.3, along[l].clone())).collect()
        };
        assert_eq!(shape(four([&None; 4])).repeats(), Some(4));
        assert_eq!(shape(four([&None, &along, &None, &along])).repeats(), Some(2));
        assert_eq!(shape(four([&None, &None, &along, &along])).repeats(), Some(1));
        let mut one_is_higher: Vec<SingleLobe> = four([&None; 4]);
        one_is_higher[2].amplitude = 0.31;
        assert_eq!(shape(one_is_higher).repeats(), Some(1));
        let tilt = Some(Tilt { angle_rad: 1e-4, towards_rad: 0.0, about_z: 0.0 });
        assert_eq!(Shape { tilt, ..shape(four([&None; 4])) }.repeats(), Some(1));
        // Parts without height break no symmetry.
        let wave = |amplitude: f64, along_chord| Wave { order: 3, amplitude, phase_rad: 0.0, along_chord };
        let flat = vec![wave(0.0, None), wave(0.1, Some(vec![0.0; 5]))];
        let upright = Some(Tilt { angle_rad: 0.0, towards_rad: 0.0, about_z: 0.0 });
        assert_eq!(Shape { tilt: upright, waves: flat, ..shape(four([&None; 4])) }.repeats(), Some(4));
    }

    #[test]
    fn measured_lines_are_joined_along_the_arc() {
        let angles_rad: Vec<f64> = (0..16).map(|i| TAU * f64::from(i) / 16.0).collect();
        let heights = [0.1, 0.5, 0.2].map(|height| vec![height; 16]).to_vec();
        let measured =
            Measured { angles_rad, chord: Some(vec![0.25, 0.5, 1.0]), heights, curves: Curves::default() };
        let nodes = nodes();
        let restriction =
            Shape { measured: Some(measured.clone()), ..Shape::default() }.of_nodes(&nodes).unwrap();
        let positions: Vec<_> = nodes.iter().map(|node| node.position).collect();
        let arc = arc_lengths(&positions);
        let share = |node: usize| arc[node] / arc[4];
        let expected = |node: usize| match share(node) {
            share if share <= 0.25 => 0.1,
            share if share <= 0.5 => 0.1 + 0.4 * (share - 0.25) / 0.25,
            share => 0.5 - 0.3 * (share - 0.5) / 0.5,
        };
        for node in 0..5 {
            let found = restriction.height(1.234, node);
            assert!((found - expected(node)).abs() < 1e-14, "{node}: {found} {}", expected(node));
        }
        let heights = (0..5).map(|k| vec![0.1 * f64::from(k); 16]).collect();
        let each = Measured { chord: None, heights, curves: Curves::default(), ..measured };
        let restriction = Shape { measured: Some(each), ..Shape::default() }.of_nodes(&nodes).unwrap();
        for node in 0..5 {
            assert_eq!(restriction.height(1.234, node), 0.1 * node as f64);
        }
    }

    /// A casing that touches the tips when it is upright, turned as a rigid body: how far its tangent plane at every tip has
    /// come inward along the tip's normal, without the small-angle formula.
    #[test]
    fn a_tilt_turns_the_casing() {
        let tilt = Tilt { angle_rad: 1e-5, towards_rad: 0.7, about_z: -3.0 };
        let nodes = nodes();
        let restriction = Shape { tilt: Some(tilt.clone()), ..Shape::default() }.of_nodes(&nodes).unwrap();
        let axis = Vector3::new(-tilt.towards_rad.sin(), tilt.towards_rad.cos(), 0.0);
        let lean = Rotation3::from_axis_angle(&Unit::new_normalize(axis), tilt.angle_rad);
        let (top, centre) = (lean * Vector3::z(), Vector3::new(0.0, 0.0, tilt.about_z));
        assert!(top.x > 0.0 && top.y > 0.0, "the end at larger z leans towards 0.7 rad");
        for (k, node) in nodes.iter().enumerate() {
            for i in 0..12 {
                let angle = f64::from(i) * TAU / 12.0;
                let [r, _, z] = node.position;
                let at = Vector3::new(r * angle.cos(), r * angle.sin(), z);
                let normal =
                    Vector3::new(node.normal[0] * angle.cos(), node.normal[0] * angle.sin(), node.normal[2]);
                let (moved, turned) = (lean * (at - centre) + centre, lean * normal);
                let inward = -(moved - at).dot(&turned) / normal.dot(&turned);
                let found = restriction.height(angle, k);
                // The formula leaves out the square of the angle.
                assert!((found - inward).abs() < 1e-10 * r, "{k} {angle}: {found:e} {inward:e}");
            }
        }
    }
}
