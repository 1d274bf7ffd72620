//! Looks at meshes: patches and chains that can be counted by hand, roles as the import finds them, and patches chosen by nodes.

use std::f64::consts::TAU;
use std::fmt::Write;

use nalgebra::Vector3;
use rubmap::from_mesh::{
    self, ClampSource, LookStep, MeshLook, MeshPatch, MeshRole, MeshSettings, TipSource, look,
};
use rubmap::impeller::generate;

use crate::from_mesh::{deck, impeller, is_that, read_mesh, sector_mesh, settings};

const SECTORS: usize = 6;
const INNER: f64 = 10.0;
const OUTER: f64 = 20.0;
const HEIGHT: f64 = 4.0;

/// Sector of a ring as a deck of hexahedra, without a material; numbers of elements around, along the radius and along the axis.
fn ring([around, radial, axial]: [usize; 3]) -> String {
    let mut deck = "*NODE\n".to_owned();
    let number = |i: usize, j: usize, k: usize| 1 + i + (around + 1) * (j + (radial + 1) * k);
    for k in 0..=axial {
        for j in 0..=radial {
            for i in 0..=around {
                let theta = TAU / SECTORS as f64 * i as f64 / around as f64;
                let r = INNER + (OUTER - INNER) * j as f64 / radial as f64;
                let [x, y, z] = [r * theta.cos(), r * theta.sin(), HEIGHT * k as f64 / axial as f64];
                writeln!(deck, "{}, {x:?}, {y:?}, {z:?}", number(i, j, k)).unwrap();
            }
        }
    }
    deck += "*ELEMENT, TYPE=C3D8I, ELSET=RING\n";
    let mut id = 0;
    for k in 0..axial {
        for j in 0..radial {
            for i in 0..around {
                id += 1;
                let of = |k| [[i, j + 1], [i, j], [i + 1, j], [i + 1, j + 1]].map(|[i, j]| number(i, j, k));
                let nodes: Vec<String> =
                    [of(k + 1), of(k)].concat().iter().rev().map(usize::to_string).collect();
                writeln!(deck, "{id}, {}", nodes.join(", ")).unwrap();
            }
        }
    }
    deck
}

fn without_material() -> MeshSettings {
    MeshSettings::of_look(b"{}").unwrap()
}

fn seen(deck: &str, settings: &MeshSettings) -> MeshLook {
    look(&read_mesh(deck), settings).unwrap()
}

fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within * expected.abs(), "{found} is not {expected}");
}

fn with_role(look: &MeshLook, role: MeshRole) -> Vec<&MeshPatch> {
    look.patches.iter().filter(|patch| patch.role == Some(role)).collect()
}

/// Volume inside of the triangles by the divergence theorem: that of the body only if they are closed and look outward.
fn volume(look: &MeshLook) -> f64 {
    let at = |node: u32| Vector3::from_fn(|d, _| f64::from(look.positions[3 * node as usize + d]));
    let of = |corners: &[u32]| at(corners[0]).dot(&at(corners[1]).cross(&at(corners[2]))) / 6.0;
    look.triangles.chunks(3).map(of).sum()
}

/// Sector of a ring: six patches and twelve chains, whose areas and lengths are those of the polygon that the elements make of it.
#[test]
fn a_ring_has_the_patches_and_chains_of_a_block() {
    let around = 4;
    let look = seen(&ring([around, 3, 2]), &without_material());
    let angle = TAU / (SECTORS * around) as f64;
    let strip = |r: f64| around as f64 * 2.0 * r * (0.5 * angle).sin();
    let side = 0.5 * around as f64 * angle.sin() * (OUTER * OUTER - INNER * INNER);
    let areas: Vec<f64> = look.patches.iter().map(|patch| patch.area).collect();
    let cut = (OUTER - INNER) * HEIGHT;
    let expected = [side, side, strip(OUTER) * HEIGHT, strip(INNER) * HEIGHT, cut, cut];
    assert_eq!(areas.len(), expected.len());
    areas.iter().zip(expected).for_each(|(&found, expected)| near(found, expected, 1e-12));
    let roles: Vec<_> = look.patches.iter().map(|patch| patch.role).collect();
    let bore = Some(MeshRole::Clamp);
    assert_eq!(roles, [None, None, None, bore, Some(MeshRole::Low), Some(MeshRole::High)]);
    // Mean of the chords' centres, and the middle of the height.
    near(look.patches[3].radius.unwrap(), INNER * (0.5 * angle).cos(), 1e-12);
    near(look.patches[3].axial.unwrap(), 0.5 * HEIGHT, 1e-12);
    assert_eq!(look.patches[3].nodes, (around + 1) * 3);
    near(volume(&look), side * HEIGHT, 1e-6);

    let lengths: Vec<f64> = look.chains.iter().map(|chain| chain.length).collect();
    assert_eq!(
        look.chains.iter().map(|chain| chain.cyclic).collect::<Vec<_>>(),
        [[false; 4].as_slice(), &[true; 8]].concat()
    );
    let (outer, inner, radial) = (strip(OUTER), strip(INNER), OUTER - INNER);
    let expected =
        [outer, outer, inner, inner, radial, radial, radial, radial, HEIGHT, HEIGHT, HEIGHT, HEIGHT];
    lengths.iter().zip(expected).for_each(|(&found, expected)| near(found, expected, 1e-12));

    // Neither the material nor a tip is there: both are told, and neither ends the look.
    assert_eq!((look.sectors, look.axis), (Some(SECTORS), Some([[0.0; 3], [0.0, 0.0, 1.0]])));
    let steps: Vec<LookStep> = look.refusals.iter().map(|refusal| refusal.step).collect();
    assert_eq!(steps, [LookStep::Materials, LookStep::Contact]);
    assert!(look.refusals[1].detail.starts_with("no blade tip was found"), "{:?}", look.refusals);
    // All nodes but those of the bore and the high face.
    assert_eq!(look.price.unknowns, 3 * around * 3 * 3);
}

/// Patches whose nodes all lie on their edges are named by the corners of a face; a node of an edge alone names none.
#[test]
fn patches_are_named_by_nodes() {
    let deck = ring([1, 1, 1]);
    let first = seen(&deck, &without_material());
    let bore = with_role(&first, MeshRole::Clamp)[0];
    assert_eq!(bore.at.len(), 4);
    // Edges from one cyclic face to the other lie on neither.
    assert_eq!(first.chains.iter().filter(|chain| chain.cyclic).count(), 8);
    let at = |clamp_at: &[u64]| MeshSettings { clamp_at: clamp_at.to_vec(), ..without_material() };
    let outer = &first.patches[2];
    near(outer.radius.unwrap(), OUTER * (TAU / 12.0).cos(), 1e-12);
    for patch in [bore, outer] {
        let look = seen(&deck, &at(&patch.at));
        let mut held: Vec<u64> = look.clamped.iter().map(|&node| look.node_ids[node as usize]).collect();
        held.sort_unstable();
        assert_eq!(held, patch.at);
        assert_eq!(
            with_role(&look, MeshRole::Clamp),
            [&MeshPatch { role: Some(MeshRole::Clamp), ..patch.clone() }]
        );
    }
    let refusal = |settings: &MeshSettings, step: LookStep| {
        let look = seen(&deck, settings);
        look.refusals.into_iter().find(|refusal| refusal.step == step).unwrap().detail
    };
    let edge = refusal(&at(&bore.at[..1]), LookStep::Clamp);
    assert!(
        edge.contains("of `clamp_at` lies on an edge of 2 patches of the skin; name a node inside of one"),
        "{edge}"
    );
    let nowhere = refusal(&at(&[99]), LookStep::Clamp);
    assert!(nowhere.starts_with("node 99 of `clamp_at` lies on no free face of the skin"), "{nowhere}");
    let both = [bore.at.clone(), outer.at.clone()].concat();
    let two = refusal(&MeshSettings { contact_at: both, ..without_material() }, LookStep::Contact);
    // Corners of both are those of the faces between, too.
    assert!(
        two.starts_with("the nodes of `contact_at` name 4 patches of the skin; a tip is one patch"),
        "{two}"
    );
}

/// Roles of the generator's impeller are those of the import, and a click on what was found by itself changes nothing.
#[test]
fn a_look_shows_what_the_import_finds_and_a_click_chooses_it() {
    let parameters = impeller(7);
    let text = deck(&sector_mesh(&parameters));
    let file = read_mesh(&text);
    let sector = from_mesh::sector(&file, &settings()).unwrap();
    let look = seen(&text, &settings());
    assert_eq!(look.refusals, []);
    assert_eq!(look.found, sector.found.to_string().lines().collect::<Vec<_>>());
    let ids = |places: &[u32]| places.iter().map(|&node| look.node_ids[node as usize]).collect::<Vec<_>>();
    let contact: Vec<u64> = sector.found.contact.iter().map(|point| point.node).collect();
    assert_eq!(ids(&look.contact), contact);
    assert_eq!(ids(&look.contact_line).len(), sector.found.tip.1);
    assert_eq!(look.clamped.len(), sector.found.clamp.1);
    let [clamp, tip, low, high] = [MeshRole::Clamp, MeshRole::Contact, MeshRole::Low, MeshRole::High]
        .map(|role| with_role(&look, role));
    assert_eq!([clamp.len(), tip.len(), low.len(), high.len()], [1; 4]);
    near(low[0].area, high[0].area, 1e-9);
    assert!(low[0].at.is_empty() && clamp[0].at.len() == 1 && tip[0].at.len() == 1);
    let package = generate(&parameters).unwrap();
    let high_rows =
        package.manifest.cyclic.iter().filter(|pair| package.dofs.iter().any(|dof| dof.node == pair[1]));
    assert_eq!(look.price.unknowns, package.dofs.len() - 3 * high_rows.count());
    assert_eq!(look.price.memory_bytes, sector.assembly_bytes());

    let clicked = MeshSettings { clamp_at: clamp[0].at.clone(), contact_at: tip[0].at.clone(), ..settings() };
    let chosen = from_mesh::sector(&file, &clicked).unwrap();
    assert_eq!(chosen.found.clamp, (ClampSource::Patches(clamp[0].at.clone()), sector.found.clamp.1));
    assert_eq!(chosen.found.tip, (TipSource::Patch(tip[0].at.clone()), sector.found.tip.1));
    is_that(&chosen.package().unwrap(), &package, 1e-15);

    // The splitter's tip is another patch between flanks at the same height.
    let other =
        look.patches.iter().filter(|patch| patch.role.is_none() && patch.at.len() == 1).find_map(|patch| {
            let with = MeshSettings { contact_at: patch.at.clone(), ..settings() };
            let made = from_mesh::sector(&file, &with).ok()?;
            (patch.area < tip[0].area).then_some(made.found.contact)
        });
    assert!(other.unwrap().iter().all(|point| !contact.contains(&point.node)));
}

#[test]
fn a_broken_mesh_is_seen_and_settings_that_contradict_are_refused() {
    let mut mesh = sector_mesh(&impeller(7));
    let whole = deck(&mesh);
    mesh.elements[3].nodes.swap(0, 1);
    let broken = seen(&deck(&mesh), &settings());
    assert_eq!(broken.refusals.iter().map(|refusal| refusal.step).collect::<Vec<_>>(), [LookStep::Mesh]);
    assert!(broken.refusals[0].detail.starts_with("element 4 (C3D20, line "), "{:?}", broken.refusals);
    assert!(broken.patches.len() > 6 && broken.sectors.is_none());
    let wrong = seen(&whole, &MeshSettings { sectors: Some(9), ..settings() });
    assert_eq!(wrong.refusals[0].step, LookStep::Sectors);
    assert!(wrong.patches.iter().all(|patch| patch.role.is_none() && patch.radius.is_none()));
    let file = read_mesh(&whole);
    let refused = |change: fn(&mut MeshSettings)| {
        let mut both = settings();
        change(&mut both);
        let message = look(&file, &both).unwrap_err().to_string();
        assert_eq!(message, from_mesh::sector(&file, &both).map(|_| ()).unwrap_err().to_string());
        message
    };
    let clamps = refused(|both| (both.clamp_set, both.clamp_at) = (Some("BORE".into()), vec![1]));
    assert_eq!(clamps, "`clamp_set` and `clamp_at` both say where the clamp is; leave one out");
    let lines = refused(|both| (both.contact_between, both.contact_at) = (Some([1, 2]), vec![1]));
    assert_eq!(lines, "`contact_between` and `contact_at` both say where the contact line is; leave one out");
}
