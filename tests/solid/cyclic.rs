//! Sector with its nodal diameter's phase against the whole wheel of the same elements.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use rubmap::solid::element::ElementKind;
use rubmap::solid::frame::{AxisFrame, distance};
use rubmap::solid::load::centrifugal;
use rubmap::solid::mesh::{Element, SectorMesh};
use rubmap::solid::skin::{Cut, skin};
use rubmap::solid::stress::NodalStress;

use crate::crooked::noise;
use crate::meshes::block;

const SECTORS: usize = 5;
const CELLS: [usize; 3] = [2, 2, 1];

/// Sector whose cuts are skewed, its cells along r, θ and z.
fn sector(kind: ElementKind) -> SectorMesh {
    let turn = TAU / SECTORS as f64;
    let place = |[r, j, z]: [f64; 3]| {
        let theta = turn * j / CELLS[1] as f64 + 0.1 * r + 0.05 * z;
        [(3.0 + r) * theta.cos(), (3.0 + r) * theta.sin(), z + 0.1 * r]
    };
    let mut mesh = block(kind, CELLS, place);
    mesh.sectors = SECTORS;
    let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1).unwrap();
    let close = |a, b| distance(a, b) < 1e-9;
    for low in 0..mesh.nodes.len() {
        let turned = frame.turn_point(mesh.nodes[low], turn);
        if let Some(high) = mesh.nodes.iter().position(|&node| close(node, turned)) {
            mesh.cyclic.push((low as u32, high as u32));
        }
    }
    // Every third element has another material, so that averages go over materials too.
    let mut other = mesh.sets[0].clone();
    other.material.youngs_modulus *= 0.5;
    mesh.sets.push(other);
    mesh.elements.iter_mut().for_each(|element| element.set = u32::from(element.id % 3 == 0));
    mesh
}

/// Mesh of all sectors, and the place in the wheel of each sector's nodes.
fn wheel(sector: &SectorMesh) -> (SectorMesh, Vec<Vec<u32>>) {
    let frame = AxisFrame::new(sector.axis.0, sector.axis.1).unwrap();
    let low_of = |node: u32| sector.cyclic.iter().find(|&&(_, high)| high == node).map(|&(low, _)| low);
    let mut nodes = Vec::new();
    let mut places = vec![vec![u32::MAX; sector.nodes.len()]; SECTORS];
    for (s, places) in places.iter_mut().enumerate() {
        for (node, &at) in sector.nodes.iter().enumerate().filter(|&(node, _)| low_of(node as u32).is_none())
        {
            places[node] = nodes.len() as u32;
            nodes.push(frame.turn_point(at, TAU * s as f64 / SECTORS as f64));
        }
    }
    for &(low, high) in &sector.cyclic {
        for s in 0..SECTORS {
            places[s][high as usize] = places[(s + 1) % SECTORS][low as usize];
        }
    }
    let copies = places.iter().flat_map(|places| {
        let place = |&node: &u32| places[node as usize];
        sector
            .elements
            .iter()
            .map(move |e| Element { nodes: e.nodes.iter().map(place).collect(), ..e.clone() })
    });
    let elements = copies.collect();
    let node_ids = (0..nodes.len() as u64).collect();
    (SectorMesh { sectors: 1, node_ids, nodes, cyclic: Vec::new(), elements, ..sector.clone() }, places)
}

#[test]
fn a_sector_has_the_stress_of_the_wheel() {
    for kind in ElementKind::ALL {
        let sector = sector(kind);
        let (wheel, places) = wheel(&sector);
        let [of_sector, of_wheel] = [&sector, &wheel].map(NodalStress::new);
        assert_eq!(of_sector.places().len() * SECTORS, of_wheel.places().len());
        for diameter in 0..=2 {
            let phase = c64::cis(TAU * f64::from(diameter) / SECTORS as f64);
            // There are more columns than are done at once.
            let columns = 11;
            let u = Mat::from_fn(3 * sector.nodes.len(), columns, |row, column| {
                let value = |part: f64| noise([row as f64, column as f64, part], 0.3);
                c64::new(value(1.0), value(2.0))
            });
            let mut full = Mat::zeros(3 * wheel.nodes.len(), columns);
            for (s, places) in places.iter().enumerate() {
                for (node, &place) in places.iter().enumerate() {
                    if sector.cyclic.iter().all(|&(_, high)| high != node as u32) {
                        for column in 0..columns {
                            for k in 0..3 {
                                let turned = u[(3 * node + k, column)] * phase.powi(s as i32);
                                full[(3 * place as usize + k, column)] = turned;
                            }
                        }
                    }
                }
            }
            let found = of_sector.apply(phase, u.as_ref());
            let expected = of_wheel.apply(c64::new(1.0, 0.0), full.as_ref());
            let largest = expected.norm_max();
            for (s, places) in places.iter().enumerate() {
                for (k, &node) in of_sector.places().iter().enumerate() {
                    let place = of_wheel.places().iter().position(|&p| p == places[node as usize]).unwrap();
                    for component in 0..6 {
                        for column in 0..columns {
                            let turned = found[(6 * k + component, column)] * phase.powi(s as i32);
                            let off = turned - expected[(6 * place + component, column)];
                            assert!(off.norm() < 1e-11 * largest, "{kind:?} {diameter} {s} {node}");
                        }
                    }
                }
            }
        }
        // The load of a low node is that of the wheel's node.
        let [own, full] = [&sector, &wheel].map(centrifugal);
        for &node in of_sector.places() {
            let whole = full[places[1][node as usize] as usize];
            let off = own[node as usize].iter().zip(whole).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-20, "{kind:?} {node}");
        }
        // The free skin repeats; together with nothing at the cuts it closes the wheel.
        let skin_of_sector = skin(&sector);
        let at = |cut| skin_of_sector.faces.iter().filter(|face| face.cut == Some(cut)).count();
        assert_eq!(at(Cut::Low), at(Cut::High));
        assert_eq!(skin_of_sector.free().count() * SECTORS, skin(&wheel).faces.len());
        // The skin points outwards: the divergence theorem gives the volume of straight-sided elements from it.
        if kind.nodes() == kind.corners() {
            let flux: f64 = skin(&wheel).faces.iter().map(|face| flux(&wheel, &face.nodes)).sum();
            let volume: f64 = rubmap::solid::load::volumes(&wheel).iter().sum();
            assert!((flux / volume - 1.0).abs() < 1e-12, "{kind:?}: {flux} {volume}");
        }
    }
}

/// Share ⅓ ∮ x·n dA of a bilinear face in the volume.
fn flux(mesh: &SectorMesh, nodes: &[u32]) -> f64 {
    use nalgebra::Vector3;
    let x: Vec<Vector3<f64>> = nodes.iter().map(|&node| mesh.nodes[node as usize].into()).collect();
    if let [a, b, c] = x[..] {
        return a.dot(&b.cross(&c)) / 6.0;
    }
    let g = 1.0 / 3.0_f64.sqrt();
    let mut sum = 0.0;
    for s in [-g, g] {
        for t in [-g, g] {
            let shape = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let at: Vector3<f64> =
                shape.iter().zip(&x).map(|(&(a, b), x)| x * ((1.0 + a * s) * (1.0 + b * t) / 4.0)).sum();
            let along: Vector3<f64> =
                shape.iter().zip(&x).map(|(&(a, b), x)| x * (a * (1.0 + b * t) / 4.0)).sum();
            let up: Vector3<f64> =
                shape.iter().zip(&x).map(|(&(a, b), x)| x * (b * (1.0 + a * s) / 4.0)).sum();
            sum += at.dot(&along.cross(&up)) / 3.0;
        }
    }
    sum
}
