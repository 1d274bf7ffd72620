//! Models from meshes: what is found where the file does not say it, the same from every format, and refusals.

use std::collections::BTreeMap;
use std::fmt::Write;

use nalgebra::Vector3;
use rubmap::from_mesh::{
    self, ClampSource, FileMatrices, FromMeshError, MeshSettings, Sector, TipSource, package_with_matrices,
};
use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{ImpellerParameters, Material, MeshDensities, Splitter, generate, impeller_sector};
use rubmap::mesh::matrices::{self, FileMatrix};
use rubmap::mesh::{self, MeshFile};
use rubmap::package::raw::{Axis, Frame, RawDof, RawMatrix, RawPackage};
use rubmap::package::to_sector;
use rubmap::solid::element::ElementKind;
use rubmap::solid::frame::AxisFrame;
use rubmap::solid::mesh::SectorMesh;
use rubmap::solid::natural::EDGES;

use crate::findings::turned;

const TOP_SPEED: f64 = 3000.0;

/// Coarse impeller of 20-node elements with splitter blades.
pub(crate) fn impeller(sectors: usize) -> ImpellerParameters {
    ImpellerParameters {
        sectors,
        contact_nodes: 5,
        element_order: ElementOrder::Quadratic,
        splitter: Some(Splitter::default()),
        top_speed_rad_s: TOP_SPEED,
        gyroscopic: true,
        mesh: MeshDensities {
            between_contact_nodes: 1,
            blade_height: 2,
            blade_thickness: 1,
            half_passage: 1,
            disk: 2,
        },
        ..ImpellerParameters::default()
    }
}

pub(crate) fn sector_mesh(parameters: &ImpellerParameters) -> SectorMesh {
    impeller_sector(parameters).unwrap().made_of(&parameters.material).mesh
}

/// Deck of a mesh with its material and nothing else.
pub(crate) fn deck(mesh: &SectorMesh) -> String {
    let mut deck = "*NODE\n".to_owned();
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.nodes) {
        writeln!(deck, "{id}, {x:?}, {y:?}, {z:?}").unwrap();
    }
    for element in &mesh.elements {
        let numbers: Vec<String> = element.nodes.iter().map(|node| (node + 1).to_string()).collect();
        let lines: Vec<String> = numbers.chunks(10).map(|line| line.join(", ")).collect();
        writeln!(deck, "*ELEMENT, TYPE={}, ELSET=WHEEL", element.kind.name()).unwrap();
        writeln!(deck, "{}, {}", element.id, lines.join(",\n")).unwrap();
    }
    let material = &mesh.sets[0].material;
    let (e, nu, rho) = (material.youngs_modulus, material.poissons_ratio, material.density);
    write!(deck, "*MATERIAL, NAME=M\n*ELASTIC\n{e:?}, {nu:?}\n*DENSITY\n{rho:?}\n*SOLID SECTION, ELSET=WHEEL, MATERIAL=M\n").unwrap();
    deck
}

pub(crate) fn read_mesh(text: &str) -> MeshFile {
    mesh::read(text.as_bytes(), &|_| Err("there is none".to_owned())).unwrap()
}

/// Settings with a top speed, five contact nodes, and titanium where the file has no material.
pub(crate) fn settings() -> MeshSettings {
    let titanium = Material::default().to_solid();
    MeshSettings {
        contact_nodes: 5,
        materials: BTreeMap::from([("*".to_owned(), titanium)]),
        ..MeshSettings::new(TOP_SPEED)
    }
}

pub(crate) fn made(text: &str) -> Result<Sector, FromMeshError> {
    from_mesh::sector(&read_mesh(text), &settings())
}

/// Largest difference of two matrices in parts of the largest entry.
fn difference(a: &RawMatrix, b: &RawMatrix) -> f64 {
    let mut off: BTreeMap<(u32, u32), f64> = a.entries.iter().map(|&(r, c, v)| ((r, c), v)).collect();
    b.entries.iter().for_each(|&(r, c, v)| *off.entry((r, c)).or_default() -= v);
    let largest = b.entries.iter().map(|entry| entry.2.abs()).fold(0.0, f64::max);
    off.values().map(|x| x.abs()).fold(0.0, f64::max) / largest
}

/// Asserts that a package has the rows, pairs, contact nodes and matrices of another.
pub(crate) fn is_that(found: &RawPackage, expected: &RawPackage, within: f64) {
    let sorted = |package: &RawPackage| {
        let mut pairs = package.manifest.cyclic.clone();
        pairs.sort_unstable();
        pairs
    };
    assert_eq!(sorted(found), sorted(expected));
    let contact = |package: &RawPackage| package.manifest.contact.iter().map(|c| c.node).collect::<Vec<_>>();
    assert_eq!(contact(found), contact(expected));
    // Rows of the high face follow the order of the pairs: compare own ones by place, all by the matrices of sorted rows.
    let order = |package: &RawPackage| {
        let mut order: Vec<u32> = (0..package.dofs.len() as u32).collect();
        order.sort_by_key(|&row| (package.dofs[row as usize].node, package.dofs[row as usize].component));
        let mut place = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&row, at)| place[row as usize] = at);
        place
    };
    let sorted = |package: &RawPackage, matrix: &RawMatrix, skew: bool| {
        let place = order(package);
        let mut entries: Vec<(u32, u32, f64)> = (matrix.entries.iter())
            .map(|&(r, c, v)| {
                let (r, c) = (place[r as usize], place[c as usize]);
                if r >= c { (r, c, v) } else { (c, r, if skew { -v } else { v }) }
            })
            .collect();
        entries.retain(|entry| entry.2 != 0.0);
        entries.sort_by_key(|&(r, c, _)| (c, r));
        RawMatrix { size: matrix.size, entries }
    };
    let matrices = |package: &RawPackage| -> Vec<RawMatrix> {
        let symmetric = std::iter::once(&package.mass).chain(&package.stiffness);
        let mut all: Vec<RawMatrix> = symmetric.map(|matrix| sorted(package, matrix, false)).collect();
        all.extend(package.gyroscopic.iter().map(|matrix| sorted(package, matrix, true)));
        all
    };
    for (k, (found, expected)) in matrices(found).iter().zip(&matrices(expected)).enumerate() {
        let off = difference(found, expected);
        assert!(off <= within, "matrix {k}: {off:e}");
    }
}

/// The generator knows axis, number of sectors, faces, clamp and contact nodes; from its bare elements all of them are found again.
#[test]
fn a_bare_mesh_becomes_the_model_that_its_generator_makes() {
    for sectors in [2, 3, 7, 10, 23] {
        let parameters = impeller(sectors);
        if impeller_sector(&parameters).is_err() {
            continue;
        }
        let sector = made(&deck(&sector_mesh(&parameters))).unwrap();
        let found = &sector.found;
        assert_eq!((found.sectors, found.sectors_found), (sectors, true));
        assert_eq!(found.axis, [[0.0; 3], [0.0, 0.0, 1.0]]);
        assert!(
            matches!(found.clamp, (ClampSource::Bore(radius), _) if (radius - parameters.bore_radius).abs() < 1e-9)
        );
        assert!(matches!(found.tip, (TipSource::Found(_), _)));
        let package = sector.package().unwrap();
        is_that(&package, &generate(&parameters).unwrap(), 1e-15);
        to_sector(package).unwrap();
    }
}

/// Axis along x, or anywhere, found or given: frequencies do not know of it, nor do matrices in r, θ, z at nodes whose θ is the same.
#[test]
fn the_axis_may_be_another() {
    let parameters = impeller(7);
    let plain = sector_mesh(&parameters);
    let swapped = |[x, y, z]: [f64; 3]| [z, x, y];
    let along_x = SectorMesh { nodes: plain.nodes.iter().map(|&at| swapped(at)).collect(), ..plain.clone() };
    let sector = made(&deck(&along_x)).unwrap();
    assert_eq!((sector.found.sectors, sector.found.axis), (7, [[0.0; 3], [1.0, 0.0, 0.0]]));
    is_that(&sector.package().unwrap(), &generate(&parameters).unwrap(), 1e-12);

    // A frame whose zero of θ is that of the wheel.
    let frame = AxisFrame::new([5.0, -3.0, 8.0], [0.3, 0.4, 1.2]).unwrap();
    let unit = frame.cylindrical(0.0);
    let moved = |at: [f64; 3]| -> [f64; 3] {
        (unit.tr_mul(&Vector3::from(at)) + Vector3::new(5.0, -3.0, 8.0)).into()
    };
    let anywhere = SectorMesh { nodes: plain.nodes.iter().map(|&at| moved(at)).collect(), ..plain };
    let text = deck(&anywhere);
    let unknown = made(&text).unwrap();
    assert_eq!(unknown.found.sectors, 7);
    is_that(&unknown.package().unwrap(), &generate(&parameters).unwrap(), 1e-10);
    let axis = Some(Axis { origin: [5.0, -3.0, 8.0], direction: [0.3, 0.4, 1.2] });
    let sector = from_mesh::sector(&read_mesh(&text), &MeshSettings { axis, ..settings() }).unwrap();
    is_that(&sector.package().unwrap(), &generate(&parameters).unwrap(), 1e-11);
}

/// One sector through every format: the same model to the last digit that the format has.
#[test]
fn every_format_gives_the_same_model() {
    let parameters = impeller(7);
    let mesh = sector_mesh(&parameters);
    let expected = generate(&parameters).unwrap();
    let files = [
        (deck(&mesh), 1e-15),
        (gmsh(&mesh), 1e-15),
        (vtu(&mesh), 1e-15),
        (ansys(&mesh), 1e-11),
        (nastran(&mesh), 1e-8),
    ];
    for (text, within) in files {
        let sector = made(&text).unwrap();
        is_that(&sector.package().unwrap(), &expected, within);
        println!("{}", sector.found);
    }
}

/// One edge of the main blade's tip, from corner to corner.
#[test]
fn the_contact_line_may_run_along_an_edge() {
    let parameters = impeller(7);
    let mesh = sector_mesh(&parameters);
    let text = deck(&mesh);
    let middle = made(&text).unwrap().found.contact.clone();
    let tip = |node: u64| mesh.nodes[node as usize - 1];
    let beside = |node: u64| {
        let away = |at: &[f64; 3]| rubmap::solid::frame::distance(*at, tip(node));
        let others = mesh.nodes.iter().zip(&mesh.node_ids).filter(|(_, id)| **id != node);
        *others.min_by(|a, b| away(a.0).total_cmp(&away(b.0))).unwrap().1
    };
    let ends = [beside(middle[0].node), beside(middle[4].node)];
    let with = |ends| {
        from_mesh::sector(&read_mesh(&text), &MeshSettings { contact_between: Some(ends), ..settings() })
    };
    let edge = with(ends).unwrap().found;
    assert_eq!(edge.tip.0, TipSource::Edge(ends));
    assert_eq!((edge.contact.len(), edge.contact[0].node), (5, ends[0]));
    for (edge, middle) in edge.contact.iter().zip(&middle) {
        let off = rubmap::solid::frame::distance(tip(edge.node), tip(middle.node));
        assert!(off < 0.75 * parameters.tip_thickness, "{off}");
    }
    let refused = with([ends[0], 1_000_000]).map(|_| ()).unwrap_err().to_string();
    assert!(refused.starts_with("node 1000000 lies on no sharp edge of the skin"), "{refused}");
}

/// One to four elements across the tip: one row of nodes along the middle where the mesh has it, with the generator's normals.
#[test]
fn contact_nodes_stay_in_one_row() {
    for blade_thickness in 1..=4 {
        let mut parameters = impeller(7);
        parameters.mesh.blade_thickness = blade_thickness;
        let mesh = sector_mesh(&parameters);
        let sector = made(&deck(&mesh)).unwrap();
        let expected = generate(&parameters).unwrap();
        let contact: Vec<u64> = sector.found.contact.iter().map(|point| point.node).collect();
        let generated: Vec<u64> = expected.manifest.contact.iter().map(|contact| contact.node).collect();
        assert_eq!(contact, generated, "{blade_thickness} across");
        to_sector(sector.package().unwrap()).unwrap();
    }
}

/// Elements that share corners but no middle nodes, and faces of which one side is finer, are slits: both are refused.
#[test]
fn hanging_nodes_are_refused() {
    let message = refused(|mesh| {
        mesh.elements[10].kind = ElementKind::C3D8I;
        mesh.elements[10].nodes.truncate(8);
    });
    assert!(message.contains("share the corners of a face but not the nodes on its edges"), "{message}");
    let message = refused(|mesh| {
        // One element has nodes of its own, a hair away from those of its neighbours.
        let first = mesh.nodes.len() as u32;
        for node in mesh.elements[20].nodes.clone() {
            let at = mesh.nodes[node as usize].map(|x| x + 3e-4);
            mesh.nodes.push(at);
            mesh.node_ids.push(mesh.nodes.len() as u64);
        }
        let other = mesh.elements[19].nodes.clone();
        let own = mesh.elements[20].nodes.clone();
        // It stays with one neighbour, so that there is one body.
        let node = |(k, node): (u32, &u32)| if other.contains(node) { *node } else { first + k };
        mesh.elements[20].nodes = (0..).zip(&own).map(node).collect();
    });
    assert!(message.contains("without sharing its nodes"), "{message}");
}

/// Nodes of an element in another order: corners, then the middles of these edges.
fn ordered(nodes: &[u32], edges: &[[usize; 2]; 12]) -> Vec<u32> {
    let middle = |edge: &[usize; 2]| {
        let own = EDGES.iter().position(|own| own == edge || [own[1], own[0]] == *edge).unwrap();
        nodes[8 + own]
    };
    nodes[..8].iter().copied().chain(edges.iter().map(middle)).map(|node| node + 1).collect()
}

fn joined(numbers: &[u32], by: &str) -> String {
    numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(by)
}

pub(crate) fn gmsh(mesh: &SectorMesh) -> String {
    const EDGES: [[usize; 2]; 12] =
        [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]];
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.nodes.len());
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.nodes) {
        writeln!(text, "{id} {x:?} {y:?} {z:?}").unwrap();
    }
    writeln!(text, "$EndNodes\n$Elements\n{}", mesh.elements.len()).unwrap();
    for element in &mesh.elements {
        writeln!(text, "{} 17 2 1 1 {}", element.id, joined(&ordered(&element.nodes, &EDGES), " ")).unwrap();
    }
    text + "$EndElements\n"
}

pub(crate) fn vtu(mesh: &SectorMesh) -> String {
    let points: String = mesh.nodes.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}\n")).collect();
    let (mut connectivity, mut offsets, mut types) = (String::new(), String::new(), String::new());
    for (k, element) in mesh.elements.iter().enumerate() {
        writeln!(connectivity, "{}", joined(&element.nodes, " ")).unwrap();
        write!(offsets, "{} ", 20 * (k + 1)).unwrap();
        types += "25 ";
    }
    let array = |kind: &str, name: &str, data: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{data}</DataArray>")
    };
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\
         {points}</DataArray></Points><Cells>{}{}{}</Cells></Piece></UnstructuredGrid></VTKFile>\n",
        mesh.nodes.len(),
        mesh.elements.len(),
        array("Int64", "connectivity", &connectivity),
        array("Int64", "offsets", &offsets),
        array("UInt8", "types", &types),
    )
}

pub(crate) fn ansys(mesh: &SectorMesh) -> String {
    let mut text =
        "/COM,ANSYS RELEASE 20.2\n/PREP7\nET,1,186\nKEYOP,1,2,1\nNBLOCK,6,SOLID\n(3i9,6e22.14e3)\n"
            .to_owned();
    for (id, at) in mesh.node_ids.iter().zip(&mesh.nodes) {
        let fortran = |x: f64| {
            let text = format!("{x:.14e}");
            let (mantissa, exponent) = text.split_once('e').unwrap();
            format!("{mantissa}E{:+04}", exponent.parse::<i32>().unwrap())
        };
        let numbers: String = at.iter().map(|&x| format!("{:>22}", fortran(x))).collect();
        writeln!(text, "{id:>9}{:>9}{:>9}{numbers}", 0, 0).unwrap();
    }
    text += "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID\n(19i9)\n";
    for element in &mesh.elements {
        let mut numbers: Vec<u64> = vec![1, 1, 1, 1, 0, 0, 0, 0, 20, 0, element.id];
        numbers.extend(element.nodes.iter().map(|&node| u64::from(node) + 1));
        for line in [&numbers[..19], &numbers[19..]] {
            writeln!(text, "{}", line.iter().map(|x| format!("{x:>9}")).collect::<String>()).unwrap();
        }
    }
    text + "       -1\n"
}

pub(crate) fn nastran(mesh: &SectorMesh) -> String {
    const EDGES: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 5], [2, 6], [3, 7], [4, 5], [5, 6], [6, 7], [7, 4]];
    let mut text = "BEGIN BULK\n".to_owned();
    for (id, at) in mesh.node_ids.iter().zip(&mesh.nodes) {
        let [x, y, z] = at.map(|x| format!("{:>16}", format!("{x:.9e}").replace('e', "E")));
        writeln!(text, "{:<8}{id:>16}{:>16}{x}{y}*\n{:<8}{z}", "GRID*", "", "*").unwrap();
    }
    for element in &mesh.elements {
        let nodes = ordered(&element.nodes, &EDGES);
        let (id, first, second, third) = (element.id, &nodes[..6], &nodes[6..14], &nodes[14..]);
        writeln!(
            text,
            "CHEXA,{id},1,{},+\n+,{},+\n+,{}",
            joined(first, ","),
            joined(second, ","),
            joined(third, ",")
        )
        .unwrap();
    }
    text + "ENDDATA\n"
}

/// Sixth of a disk without a bore: wedges around the axis, hexahedra outside of them, three levels of nodes; held nodes follow.
fn solid_disk(held: &str) -> String {
    let mut nodes: Vec<[f64; 3]> = Vec::new();
    let mut deck = String::new();
    for z in [0.0, 2.0, 4.0] {
        nodes.push([0.0, 0.0, z]);
        for r in [10.0, 20.0] {
            nodes.extend([-0.5, 0.0, 0.5].map(|part| {
                let theta = part * std::f64::consts::TAU / 6.0;
                [f64::cos(theta) * r, f64::sin(theta) * r, z]
            }));
        }
    }
    deck += "*NODE\n";
    nodes.iter().zip(1..).for_each(|([x, y, z], id)| writeln!(deck, "{id}, {x:?}, {y:?}, {z:?}").unwrap());
    // Nodes of a level: the axis, then three at each radius.
    for (level, id) in [0, 7].into_iter().zip([1, 3]) {
        for column in 0..2 {
            let at = |k: usize| level + k + 1;
            let (a, b) = (
                [at(0), at(1 + column), at(2 + column)],
                [at(1 + column), at(4 + column), at(5 + column), at(2 + column)],
            );
            let listed = |nodes: &[usize]| {
                let above: Vec<usize> = nodes.iter().map(|node| node + 7).collect();
                [nodes, &above].concat().iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
            };
            writeln!(deck, "*ELEMENT, TYPE=C3D6\n{}, {}", id + column, listed(&a)).unwrap();
            writeln!(deck, "*ELEMENT, TYPE=C3D8I\n{}, {}", 10 + id + column, listed(&b)).unwrap();
        }
    }
    deck + "*NSET, NSET=TIP\n6, 13, 20\n*BOUNDARY\n" + held
}

/// Nodes on the axis are in no pair, clamped or free, and never contact nodes.
#[test]
fn nodes_on_the_axis_are_in_no_pair() {
    let settings = |set: &str| MeshSettings { contact_set: Some(set.into()), ..settings() };
    let made = |held: &str, set: &str| from_mesh::sector(&read_mesh(&solid_disk(held)), &settings(set));
    for (held, on_axis) in [("1, 1, 3\n8, 1, 3\n15, 1, 3\n", 0), ("2, 1, 3\n4, 1, 3\n", 3)] {
        let sector = made(held, "TIP").unwrap();
        assert_eq!((sector.found.sectors, sector.found.on_axis), (6, on_axis));
        let model = to_sector(sector.package().unwrap()).unwrap();
        assert_eq!(model.axis.len(), on_axis);
    }
    let axis = "2, 1, 3\n4, 1, 3\n*NSET, NSET=AXIS\n1, 8, 15\n";
    let refused = made(axis, "AXIS").map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains("the contact line has 0 free nodes"), "{refused}");
}

/// Half a turn about a line in a flat face lays the face onto itself: no wheel of two sectors about an axis that nobody stated.
#[test]
fn half_turns_beside_another_symmetry_are_refused() {
    let file = read_mesh(&solid_disk("2, 1, 3\n4, 1, 3\n"));
    let of_two =
        |axis| MeshSettings { contact_set: Some("TIP".into()), sectors: Some(2), axis, ..settings() };
    let refused = from_mesh::sector(&file, &of_two(None)).map(|_| ()).unwrap_err().to_string();
    assert!(refused.starts_with("half a turn about"), "{refused}");
    assert!(refused.ends_with("the turn by 2π/6 about [0.0, 0.0, 1.0]: state the `axis`"), "{refused}");
    let about_z = Axis { origin: [0.0; 3], direction: [0.0, 0.0, 1.0] };
    let refused = from_mesh::sector(&file, &of_two(Some(about_z))).map(|_| ()).unwrap_err().to_string();
    assert!(refused.starts_with("no face of the skin turned by 2π/2"), "{refused}");
}

/// Refusal of a mesh that is changed.
pub(crate) fn refused(change: impl FnOnce(&mut SectorMesh)) -> String {
    let mut mesh = sector_mesh(&impeller(7));
    change(&mut mesh);
    made(&deck(&mesh)).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn bad_meshes_are_refused_with_their_element_or_node() {
    let high = |mesh: &SectorMesh| mesh.cyclic[5].1 as usize;
    let message = refused(|mesh| mesh.elements[3].nodes.swap(0, 1));
    assert!(message.starts_with("element 4 (C3D20, line "), "{message}");
    let message = refused(|mesh| {
        let other = mesh.elements[1].nodes.clone();
        let shared = mesh.elements[0].nodes.iter_mut().find(|node| other.contains(node)).unwrap();
        mesh.nodes.push(mesh.nodes[*shared as usize]);
        mesh.node_ids.push(mesh.nodes.len() as u64);
        *shared = mesh.nodes.len() as u32 - 1;
    });
    assert!(message.contains("the mesh is slit there; merge nodes at the same place"), "{message}");
    let message = refused(|mesh| {
        let first = mesh.nodes.len() as u32;
        let element = mesh.elements[0].clone();
        for &node in &element.nodes {
            let [x, y, z] = mesh.nodes[node as usize];
            mesh.nodes.push([x, y, z + 500.0]);
            mesh.node_ids.push(mesh.nodes.len() as u64);
        }
        let nodes = (0..element.nodes.len() as u32).map(|k| first + k).collect();
        mesh.elements.push(rubmap::solid::mesh::Element { id: 100_000, nodes, ..element });
    });
    assert!(message.contains("2 bodies") && message.contains("element 100000"), "{message}");
    // One corner of the high face is off by far more than digits, by less than an element.
    let message = refused(|mesh| {
        let node = high(mesh);
        mesh.nodes[node][2] += 0.01;
    });
    assert!(message.contains("turned by 2π/7 meets no node of the high face"), "{message}");
    assert!(message.contains("1.000e-2 away"), "{message}");
    // A part of the high face has its nodes at other places of the same surface: it fits nowhere, and is no free surface.
    let message = refused(|mesh| {
        let outer = |mesh: &SectorMesh, node: usize| mesh.nodes[node][0].hypot(mesh.nodes[node][1]);
        let highs: Vec<usize> = mesh.cyclic.iter().map(|&(_, high)| high as usize).collect();
        let farthest = highs.iter().map(|&node| outer(mesh, node)).fold(0.0, f64::max);
        let far: Vec<usize> = highs.into_iter().filter(|&node| outer(mesh, node) > 0.8 * farthest).collect();
        for node in far {
            let scale = 1.0 - 0.005 * outer(mesh, node) / farthest;
            (0..2).for_each(|k| mesh.nodes[node][k] *= scale);
        }
    });
    assert!(message.contains("turned by 2π/7 meets no node of the high face"), "{message}");
}

#[test]
fn settings_that_do_not_fit_are_refused() {
    let text = deck(&sector_mesh(&impeller(7)));
    let with = |change: fn(&mut MeshSettings)| {
        let mut settings = settings();
        change(&mut settings);
        from_mesh::sector(&read_mesh(&text), &settings).map(|_| ()).unwrap_err().to_string()
    };
    for (message, begins) in [
        (with(|s| s.top_speed_rad_s = -1.0), "the top speed -1 rad/s must be positive"),
        (with(|s| s.sectors = Some(9)), "no face of the skin turned by 2π/9 meets another"),
        (with(|s| s.sectors = Some(0)), "a wheel has at least one sector"),
        (with(|s| s.clamp_set = Some("BORE".into())), "the file has no nodes in a set \"BORE\""),
        (with(|s| s.contact_set = Some("TIP".into())), "the file has no nodes in a set \"TIP\""),
        (
            with(|s| s.materials.get_mut("*").unwrap().poissons_ratio = 0.5),
            "Poisson's ratio 0.5 of the material \"*\"",
        ),
        (
            with(|s| drop(s.materials.insert("BLADE".into(), Material::default().to_solid()))),
            "the file has no element set and no material \"BLADE\" (it has WHEEL, M)",
        ),
    ] {
        assert!(message.starts_with(begins), "{message}");
    }
}

/// Package in Cartesian components: the generator's are cylindrical.
pub(crate) fn cartesian(mut package: RawPackage) -> RawPackage {
    let axis = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
    let at: BTreeMap<u64, [f64; 3]> = package.nodes.iter().map(|node| (node.id, node.position)).collect();
    turned(&mut package, |node| axis.cylindrical(axis.coordinates(at[&node])[1]).transpose());
    package
}

/// Matrix as Abaqus generates it with node labels, one triangle.
fn labelled(package: &RawPackage, matrix: &RawMatrix) -> String {
    let dof = |row: u32| package.dofs[row as usize];
    let line = |&(r, c, v): &(u32, u32, f64)| {
        format!("{},{},{},{},{v:e}\n", dof(r).node, dof(r).component, dof(c).node, dof(c).component)
    };
    matrix.entries.iter().map(line).collect()
}

/// Matrix as Ansys exports it in Matrix Market form, and its mapping.
pub(crate) fn market(package: &RawPackage, matrix: &RawMatrix) -> (String, String) {
    let mut text = format!(
        "%%MatrixMarket matrix coordinate real symmetric\n{} {} {}\n",
        matrix.size,
        matrix.size,
        matrix.entries.len()
    );
    matrix.entries.iter().for_each(|(r, c, v)| writeln!(text, "{} {} {v:e}", r + 1, c + 1).unwrap());
    let row = |(k, dof): (usize, &RawDof)| {
        format!("{} {} {}\n", k + 1, dof.node, ["UX", "UY", "UZ"][usize::from(dof.component) - 1])
    };
    (
        text,
        "Matrix Eqn    Node    DOF\n".to_owned()
            + &package.dofs.iter().enumerate().map(row).collect::<String>(),
    )
}

/// Matrices of other programs with the mesh for the rest: the package that the generator makes, with a gyroscopic matrix from the mass.
#[test]
fn matrices_of_other_programs_become_the_package_they_say() {
    let parameters = impeller(7);
    let expected = cartesian(generate(&parameters).unwrap());
    let mesh = deck(&sector_mesh(&parameters));
    let speeds = expected.manifest.speeds_rad_s.clone();
    let abaqus = |matrix: &RawMatrix| matrices::read(labelled(&expected, matrix).as_bytes(), None).unwrap();
    let ansys = |matrix: &RawMatrix| {
        let (text, mapping) = market(&expected, matrix);
        matrices::read(text.as_bytes(), Some(mapping.as_bytes())).unwrap()
    };
    let read: [&dyn Fn(&RawMatrix) -> FileMatrix; 2] = [&abaqus, &ansys];
    for read in read {
        let stiffness = speeds.iter().copied().zip(expected.stiffness.iter().map(read)).collect();
        let files = FileMatrices { mass: read(&expected.mass), stiffness };
        let (package, found) = package_with_matrices(read_mesh(&mesh), &settings(), &files).unwrap();
        assert_eq!((found.sectors, package.manifest.frame), (7, Frame::Cartesian));
        assert_eq!(package.manifest.speeds_rad_s, speeds);
        is_that(&package, &expected, 1e-13);
        to_sector(package).unwrap();
    }
    let mut short = abaqus(&expected.mass);
    short.rows.pop();
    let files = FileMatrices { mass: short, stiffness: vec![(0.0, abaqus(&expected.stiffness[0]))] };
    let refused = package_with_matrices(read_mesh(&mesh), &settings(), &files).unwrap_err();
    assert!(refused.to_string().contains("has a row in one matrix and none in another"), "{refused}");
}
