//! Axes that nobody states: sectors moved and turned rigidly are found where they were moved to, with the pairs that they had.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nalgebra::{Rotation3, Vector3};
use rubmap::from_mesh::{self, FromMeshError, MeshSettings, Sector};
use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{ImpellerParameters, MeshDensities, generate, impeller_sector};
use rubmap::mesh;
use rubmap::solid::element::ElementKind;
use rubmap::solid::mesh::SectorMesh;

use crate::meshes::block;

const SPEED: f64 = 3000.0;

/// Motion of a wheel about the z axis to another place.
struct Motion {
    rotation: Rotation3<f64>,
    shift: Vector3<f64>,
}

impl Motion {
    /// Motion of a fixed sequence, with a shift of the order of `size`.
    fn new(number: usize, size: f64) -> Self {
        let part = |k: usize| 2.0 * ((number * 6 + k + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0;
        let vector = |from: usize| Vector3::new(part(from), part(from + 1), part(from + 2));
        Self { rotation: Rotation3::new(vector(0) * 3.0), shift: vector(3) * size }
    }

    fn moved(&self, mesh: &SectorMesh) -> SectorMesh {
        let at = |at: &[f64; 3]| (self.rotation * Vector3::from(*at) + self.shift).into();
        SectorMesh { nodes: mesh.nodes.iter().map(at).collect(), ..mesh.clone() }
    }

    /// Asserts that a sector's axis is the moved one in the told sense, and that its pairs are these.
    fn is_found(&self, sector: &Sector, sectors: usize, pairs: &[[u64; 2]], within: f64, of: &str) {
        let found = &sector.found;
        assert_eq!(found.sectors, sectors, "{of}");
        let axis = self.rotation * Vector3::z();
        let [origin, direction] = found.axis.map(Vector3::from);
        let largest = direction[direction.icamax()];
        assert!(largest > 0.0, "{of}: {direction}");
        let forward = direction.dot(&axis) > 0.0;
        let tilt = direction.cross(&axis).norm();
        let off = (self.shift - origin).cross(&direction).norm() / self.shift.norm();
        assert!(tilt < within && off < within, "{of}: {tilt:e} {off:e}");
        assert!(found.to_string().contains("note: the axis was found from the cyclic faces"), "{found}");
        let mut expected: Vec<[u64; 2]> =
            pairs.iter().map(|&[low, high]| if forward { [low, high] } else { [high, low] }).collect();
        expected.sort_unstable();
        let package = sector.package().unwrap();
        let mut found = package.manifest.cyclic;
        found.sort_unstable();
        // By half a turn either face may be the low one.
        assert!(found == expected || sectors == 2 && found.len() == expected.len(), "{of}");
    }
}

fn deck(mesh: &SectorMesh) -> String {
    crate::deck::deck(mesh)
}

fn made(deck: &str, settings: &MeshSettings) -> Result<Sector, FromMeshError> {
    from_mesh::sector(&mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap(), settings)
}

#[test]
fn moved_impellers_are_found() {
    for (k, sectors) in [2, 3, 5, 7, 10, 16, 23].into_iter().enumerate() {
        for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
            let parameters = ImpellerParameters {
                sectors,
                element_order: order,
                top_speed_rad_s: SPEED,
                mesh: MeshDensities {
                    between_contact_nodes: 1,
                    blade_height: 2,
                    blade_thickness: 2,
                    half_passage: 2,
                    disk: 2,
                },
                ..ImpellerParameters::default()
            };
            let Ok(plain) = impeller_sector(&parameters) else { continue };
            let mut plain = plain.made_of(&parameters.material).mesh;
            // No deck has the generator's linear element.
            let linear = plain.elements.iter_mut().filter(|element| element.kind == ElementKind::QM6);
            linear.for_each(|element| element.kind = ElementKind::C3D8I);
            let mut pairs = generate(&parameters).unwrap().manifest.cyclic;
            pairs.sort_unstable();
            let motion = Motion::new(2 * k, 100.0);
            let of = format!("{sectors} {order:?}");
            let sector = made(&deck(&motion.moved(&plain)), &MeshSettings::new(SPEED))
                .unwrap_or_else(|error| panic!("{of}: {error}"));
            motion.is_found(&sector, sectors, &pairs, 1e-8, &of);
        }
    }
}

/// Sector of a ring with skewed cuts, its free nodes on the low cut, and those of a set in the middle.
fn ring(kind: ElementKind, sectors: usize) -> (SectorMesh, [Vec<usize>; 2]) {
    let cells = [2, 4, 2];
    let place = |[r, j, z]: [f64; 3]| {
        let theta = TAU / sectors as f64 * j / 4.0 + 0.1 * r + 0.05 * z;
        let r = 30.0 + 10.0 * r;
        [r * theta.cos(), r * theta.sin(), 2.0 * z + 0.5 * (r / 40.0)]
    };
    let grid = block(kind, cells, |at| at);
    let of = |is: &dyn Fn([f64; 3]) -> bool| (0..grid.nodes.len()).filter(|&k| is(grid.nodes[k])).collect();
    let sets = [of(&|at| at[1] == 0.0 && at[0] > 0.0), of(&|at| at[0] == 1.0 && at[1] == 2.0)];
    (block(kind, cells, place), sets)
}

#[test]
fn moved_rings_of_every_kind_are_found() {
    let kinds = [
        ElementKind::C3D4,
        ElementKind::C3D6,
        ElementKind::C3D8I,
        ElementKind::C3D10,
        ElementKind::C3D20,
        ElementKind::C3D13,
    ];
    for (k, kind) in kinds.into_iter().enumerate() {
        for sectors in [2, 3, 4, 5, 9, 12, 23] {
            let (plain, [low, tip]) = ring(kind, sectors);
            let motion = Motion::new(17 * k + sectors, 60.0);
            let mut deck = deck(&motion.moved(&plain));
            deck += "*NSET, NSET=TIP\n";
            tip.iter().for_each(|node| writeln!(deck, "{}", node + 1).unwrap());
            let settings = MeshSettings { contact_set: Some("TIP".into()), ..MeshSettings::new(SPEED) };
            let of = format!("{kind:?} {sectors}");
            let sector = made(&deck, &settings).unwrap_or_else(|error| panic!("{of}: {error}"));
            let (sin, cos) = (TAU / sectors as f64).sin_cos();
            let partner = |&node: &usize| {
                let [x, y, z] = plain.nodes[node];
                let to = [cos * x - sin * y, sin * x + cos * y, z];
                let away = |at: &[f64; 3]| rubmap::solid::frame::distance(*at, to);
                let near = plain.nodes.iter().zip(1..).min_by(|a, b| away(a.0).total_cmp(&away(b.0)));
                [node as u64 + 1, near.unwrap().1]
            };
            let mut pairs: Vec<[u64; 2]> = low.iter().map(partner).collect();
            pairs.sort_unstable();
            motion.is_found(&sector, sectors, &pairs, 1e-8, &of);
        }
    }
}

/// Deck of a moved impeller of seven sectors, coordinates with so many digits behind the first, changed by `change` after the motion.
fn seven(digits: usize, change: impl FnOnce(&SectorMesh, &mut SectorMesh)) -> (String, Motion) {
    let parameters = ImpellerParameters {
        sectors: 7,
        top_speed_rad_s: SPEED,
        element_order: ElementOrder::Quadratic,
        ..ImpellerParameters::default()
    };
    let plain = impeller_sector(&parameters).unwrap().made_of(&parameters.material).mesh;
    let motion = Motion::new(5, 100.0);
    let mut moved = motion.moved(&plain);
    change(&plain, &mut moved);
    for at in &mut moved.nodes {
        *at = at.map(|x| format!("{x:.digits$e}").parse().unwrap());
    }
    (deck(&moved), motion)
}

/// Six digits, as some programs write them, are enough for the axis and for the pairs.
#[test]
fn few_digits_are_enough() {
    let (deck, motion) = seven(5, |_, _| {});
    let found = made(&deck, &MeshSettings::new(SPEED)).unwrap().found;
    assert_eq!(found.sectors, 7);
    let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let look = from_mesh::look(&file, &MeshSettings::new(SPEED)).unwrap();
    assert!(look.found.iter().any(|line| line.starts_with("note: the axis was found")), "{:?}", look.found);
    let direction = Vector3::from(found.axis[1]);
    assert!(direction.cross(&(motion.rotation * Vector3::z())).norm() < 1e-5, "{direction}");
}

/// Faces that miss each other, a wrong number of sectors and other shapes are refused with what was tried.
#[test]
fn what_fits_about_no_axis_is_refused() {
    let refused =
        |deck: &str, settings: MeshSettings| made(deck, &settings).map(|_| ()).unwrap_err().to_string();
    let (deck, _) = seven(14, |plain, moved| {
        let (_, high) = plain.cyclic[5];
        moved.nodes[high as usize][2] += 0.01;
    });
    let message = refused(&deck, MeshSettings::new(SPEED));
    assert!(message.contains("turned by 2π/7 meets no node of the high face"), "{message}");
    assert!(
        message.contains("1.000e-2 away") && message.contains("with 7 sectors about the axis through"),
        "{message}"
    );
    let (deck, _) = seven(14, |_, _| {});
    let message = refused(&deck, MeshSettings { sectors: Some(9), ..MeshSettings::new(SPEED) });
    assert!(
        message.contains("nor about any axis that congruent faces suggest; give `axis` and `sectors`"),
        "{message}"
    );
    // A box fits about the middle of each of its sides, by half a turn.
    let cube = block(ElementKind::C3D20, [3; 3], |[x, y, z]| [x + 20.0, y + 30.0, z + 40.0]);
    let message = refused(&self::deck(&cube), MeshSettings::new(SPEED));
    assert!(message.starts_with("the faces of the skin fit about several axes: through"), "{message}");
}
