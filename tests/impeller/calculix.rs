//! Our impeller against CalculiX (`ccx`, Debian's `calculix-ccx`) on the same mesh: frequencies per nodal diameter at
//! rest, displacements and stresses of the centrifugal load.
//!
//! C3D20 is our 20-node element. C3D8I is not quite our 8-node one: it takes the bubbles' gradients as `J₀⁻ᵀ ∂P/∂ξ`
//! without the factor det J₀ / det J (its stiffness of a single crooked element equals ours without that factor to
//! 1e-14), which fails the patch test on crooked elements, and it gives the bubbles mass and load.
//! CalculiX prints seven digits.

use std::fmt::Write as _;
use std::process::Command;

use nalgebra::Vector3;
use rubmap::assembly::SectorMatrices;
use rubmap::impeller::mesh::{ElementOrder, Elements, SectorMesh};
use rubmap::impeller::{ImpellerParameters, Material, MeshDensities, Splitter, impeller_sector};

use crate::eigen::{harmonic, hertz, lowest};
use crate::packed::{cylindrical_frame, packed};

const MODES: usize = 4;

/// Results that CalculiX printed.
pub(crate) struct Answer {
    /// Frequencies (Hz) per nodal diameter.
    frequencies: Vec<Vec<f64>>,
    /// Nodal displacements in x, y, z.
    pub(crate) displacements: Vec<[f64; 3]>,
    /// Stresses per element and Gauss point: xx, yy, zz, xy, xz, yz.
    stresses: Vec<Vec<[f64; 6]>>,
    /// Stresses per node: xx, yy, zz, xy, yz, zx of the sector's own elements.
    pub(crate) nodal_stresses: Vec<[f64; 6]>,
}

fn set(deck: &mut String, name: &str, nodes: impl Iterator<Item = usize>) {
    writeln!(deck, "*NSET, NSET={name}").unwrap();
    for node in nodes {
        writeln!(deck, "{}", node + 1).unwrap();
    }
}

/// Deck of a cyclic frequency analysis without pre-stress (if there are cyclic faces), then a static step with the centrifugal load at `speed`.
fn deck(sector: &SectorMesh, material: &Material, speed: f64) -> String {
    let mut deck = String::from("*NODE, NSET=NALL\n");
    for (n, [x, y, z]) in sector.mesh.nodes.iter().enumerate() {
        writeln!(deck, "{}, {x:.14e}, {y:.14e}, {z:.14e}", n + 1).unwrap();
    }
    let kind = match sector.mesh.elements {
        Elements::Linear(_) => "C3D8I",
        Elements::Quadratic(_) => "C3D20",
    };
    writeln!(deck, "*ELEMENT, TYPE={kind}, ELSET=EALL").unwrap();
    for e in 0..sector.mesh.elements.len() {
        // A line has at most sixteen numbers.
        let numbers: Vec<String> = std::iter::once(e + 1)
            .chain(sector.mesh.elements.nodes_of(e).iter().map(|n| n + 1))
            .map(|number| number.to_string())
            .collect();
        let lines: Vec<String> = numbers.chunks(11).map(|line| line.join(", ")).collect();
        writeln!(deck, "{}", lines.join(",\n")).unwrap();
    }
    let free = |node: &usize| sector.clamped[*node] == [false; 3];
    set(&mut deck, "BORE", (0..sector.mesh.nodes.len()).filter(|node| !free(node)));
    let Material { youngs_modulus, poissons_ratio, density, .. } = material;
    write!(
        deck,
        "*MATERIAL, NAME=M
*ELASTIC
{youngs_modulus:e}, {poissons_ratio:e}
*DENSITY
{density:e}
*SOLID SECTION, ELSET=EALL, MATERIAL=M
*BOUNDARY
BORE, 1, 3
"
    )
    .unwrap();
    if !sector.cyclic.is_empty() {
        set(&mut deck, "LOW", sector.cyclic.iter().map(|&(low, _)| low).filter(free));
        set(&mut deck, "HIGH", sector.cyclic.iter().map(|&(_, high)| high).filter(free));
        // Modes come in pairs, also of nodal diameter 0, and the last ones are not converged.
        write!(
            deck,
            "*SURFACE, NAME=SHIGH, TYPE=NODE
HIGH
*SURFACE, NAME=SLOW, TYPE=NODE
LOW
*TIE, NAME=CYC, CYCLIC SYMMETRY, POSITION TOLERANCE=1.E-6
SHIGH, SLOW
*CYCLIC SYMMETRY MODEL, N={sectors}, TIE=CYC, NGRAPH=1
0., 0., 0., 0., 0., 1.
*STEP
*FREQUENCY
{count}
*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX={last}
*END STEP
",
            sectors = sector.sectors,
            count = 2 * MODES + 6,
            last = sector.sectors / 2,
        )
        .unwrap();
    }
    write!(
        deck,
        "*STEP
*STATIC
*DLOAD
EALL, CENTRIF, {square:e}, 0., 0., 0., 0., 0., 1.
*NODE PRINT, NSET=NALL
U
*EL PRINT, ELSET=EALL
S
*EL FILE
S
*END STEP
",
        square = speed * speed,
    )
    .unwrap();
    deck
}

/// Runs CalculiX; `None`, with a printed reason, without it.
pub(crate) fn calculix(sector: &SectorMesh, material: &Material, speed: f64) -> Option<Answer> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("sector.inp"), deck(sector, material, speed)).unwrap();
    let run = Command::new("ccx").args(["-i", "sector"]).current_dir(folder.path()).output();
    let output = match run {
        Ok(output) => output,
        Err(error) => {
            eprintln!("skipped: CalculiX (`ccx`, package calculix-ccx) cannot be run: {error}");
            return None;
        }
    };
    let text = std::fs::read_to_string(folder.path().join("sector.dat")).unwrap_or_default();
    assert!(output.status.success() && !text.is_empty(), "{}", String::from_utf8_lossy(&output.stdout));
    let frd = std::fs::read_to_string(folder.path().join("sector.frd")).unwrap();
    Some(Answer { nodal_stresses: nodal_stresses(&frd, sector.mesh.nodes.len()), ..parse(&text, sector) })
}

fn parse(text: &str, sector: &SectorMesh) -> Answer {
    let mut answer = Answer {
        frequencies: Vec::new(),
        displacements: vec![[f64::NAN; 3]; sector.mesh.nodes.len()],
        stresses: vec![Vec::new(); sector.mesh.elements.len()],
        nodal_stresses: Vec::new(),
    };
    let mut block = "";
    for line in text.lines() {
        if line.contains("E I G E N V A L U E") {
            block = "frequencies";
        } else if line.contains("P A R T I C I P A T I O N") || line.contains("E F F E C T I V E") {
            block = "";
        } else if line.contains("displacements (vx,vy,vz)") {
            block = "displacements";
        } else if line.contains("stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz)") {
            block = "stresses";
        }
        let values: Option<Vec<f64>> = line.split_whitespace().map(|field| field.parse().ok()).collect();
        let Some(v) = values.filter(|v| !v.is_empty()) else { continue };
        match block {
            // The columns are nodal diameter, mode, eigenvalue, rad/time, cycles/time, imaginary part.
            "frequencies" => {
                let diameter = v[0] as usize;
                answer.frequencies.resize(answer.frequencies.len().max(diameter + 1), Vec::new());
                answer.frequencies[diameter].push(v[4]);
            }
            "displacements" => answer.displacements[v[0] as usize - 1] = [v[1], v[2], v[3]],
            "stresses" => answer.stresses[v[0] as usize - 1].push(std::array::from_fn(|c| v[2 + c])),
            _ => {}
        }
    }
    answer
}

/// Last stresses of a file of results at nodes, which has six digits.
fn nodal_stresses(frd: &str, nodes: usize) -> Vec<[f64; 6]> {
    let mut found = vec![[f64::NAN; 6]; nodes];
    let mut in_stress = false;
    for line in frd.lines() {
        if line.starts_with(" -4") {
            in_stress = line.contains("STRESS");
        } else if line.starts_with(" -3") {
            in_stress = false;
        } else if in_stress && line.starts_with(" -1") {
            let node: usize = line[3..13].trim().parse().unwrap();
            let value = |k: usize| line[13 + 12 * k..25 + 12 * k].trim().parse::<f64>().unwrap();
            if let Some(found) = found.get_mut(node - 1) {
                *found = std::array::from_fn(value);
            }
        }
    }
    found
}

/// Largest difference of the frequencies, relative, over all nodal diameters.
fn frequency_difference(sector: &SectorMesh, p: &ImpellerParameters, theirs: &Answer) -> f64 {
    let package = packed("impeller", sector, &p.material, &p.units, p.top_speed_rad_s);
    assert_eq!(theirs.frequencies.len(), p.sectors / 2 + 1);
    let mut worst = 0.0_f64;
    for (i, theirs) in theirs.frequencies.iter().enumerate() {
        let k = harmonic(&package, &package.stiffness[0], i);
        let ours = hertz(&lowest(&k, &harmonic(&package, &package.mass, i), MODES).unwrap());
        println!("nodal diameter {i}: {ours:.3?}, CalculiX {theirs:.3?}");
        for (j, ours) in ours.iter().enumerate() {
            worst = worst.max((ours / theirs[2 * j] - 1.0).abs());
        }
    }
    worst
}

/// Largest differences of displacement and of stress under the centrifugal load, in parts of the largest of each.
fn static_differences(sector: &SectorMesh, material: &Material, speed: f64, theirs: &Answer) -> [f64; 2] {
    let prestress = SectorMatrices::assemble(&sector.made_of(material)).unwrap().prestress;
    let square = speed * speed;
    let largest = theirs.displacements.iter().map(|u| Vector3::from(*u).norm()).fold(0.0, f64::max);
    let mut displacement = 0.0_f64;
    for (node, theirs) in theirs.displacements.iter().enumerate() {
        let ours = Vector3::from(prestress.displacements[node]) * square;
        let ours = cylindrical_frame(sector.mesh.angle(node)).transpose() * ours;
        displacement = displacement.max((ours - Vector3::from(*theirs)).norm() / largest);
    }
    let largest = theirs.stresses.iter().flatten().flatten().fold(0.0_f64, |m, s| m.max(s.abs()));
    let mut stress = 0.0_f64;
    for (ours, theirs) in prestress.stresses.iter().zip(&theirs.stresses) {
        assert_eq!(ours.len(), theirs.len());
        for (ours, theirs) in ours.iter().zip(theirs) {
            for (component, theirs) in [0, 1, 2, 3, 5, 4].into_iter().zip(theirs) {
                stress = stress.max((ours[component] * square - theirs).abs() / largest);
            }
        }
    }
    [displacement, stress]
}

/// Parameters of a coarse impeller of 20-node elements with splitter blades.
pub(crate) fn twenty_node_impeller() -> ImpellerParameters {
    ImpellerParameters {
        sectors: 7,
        contact_nodes: 5,
        element_order: ElementOrder::Quadratic,
        splitter: Some(Splitter::default()),
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

/// Impeller of 20-node elements, the same as CalculiX's, so only the printed digits differ. Measured: frequencies
/// 1.5e-7, displacements 3.9e-7, stresses 9e-8.
#[test]
fn a_twenty_node_impeller_agrees_with_calculix() {
    let p = twenty_node_impeller();
    let sector = impeller_sector(&p).unwrap();
    let Some(theirs) = calculix(&sector, &p.material, p.top_speed_rad_s) else { return };
    let frequency = frequency_difference(&sector, &p, &theirs);
    let [displacement, stress] = static_differences(&sector, &p.material, p.top_speed_rad_s, &theirs);
    println!("frequency {frequency:.1e}, displacement {displacement:.1e}, stress {stress:.1e}");
    assert!(frequency < 1e-6 && displacement < 1e-6 && stress < 1e-6);
}

/// Impeller of 8-node elements, one idea in two formulations (C3D8I, see above), on the default mesh, eight elements over
/// a blade's length and four over its height at most: frequencies within 2 %, displacements within 2 % of the largest. At
/// single Gauss points in the most crooked elements a stress is 15 % of the largest one apart.
#[test]
fn eight_node_impeller_is_close_to_calculix() {
    let p = ImpellerParameters::default();
    let sector = impeller_sector(&p).unwrap();
    let Some(theirs) = calculix(&sector, &p.material, p.top_speed_rad_s) else { return };
    let frequency = frequency_difference(&sector, &p, &theirs);
    let [displacement, stress] = static_differences(&sector, &p.material, p.top_speed_rad_s, &theirs);
    println!("frequency {frequency:.1e}, displacement {displacement:.1e}, stress {stress:.1e}");
    assert!(frequency < 0.02 && displacement < 0.02 && stress < 0.2);
}
