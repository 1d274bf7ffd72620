//! Drawings of surfaces read back.

use std::f64::consts::TAU;

use roxmltree::Document;
use rubmap_analysis::result::{FieldSurface, SurfaceColour};

use super::impeller::{SECTORS, impeller};
use crate::{SurfaceView, surface};

const VIEWS: [SurfaceView; 3] = [SurfaceView::Front, SurfaceView::Rear, SurfaceView::Meridional];

/// Width and palette indices of the only image.
fn image(drawing: &str) -> (usize, Vec<u8>) {
    let drawing = Document::parse(drawing).unwrap();
    let image = drawing.descendants().find(|node| node.has_tag_name("image")).unwrap();
    super::decode(image.attribute("href").unwrap())
}

fn turned(surface: &FieldSurface, angle: f64) -> FieldSurface {
    let turn =
        |[x, y, z]: [f64; 3]| [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos(), z];
    let all = |vectors: &[[f64; 3]]| vectors.iter().copied().map(turn).collect();
    FieldSurface { nodes: all(&surface.nodes), displacement: all(&surface.displacement), ..surface.clone() }
}

/// Wheels in nodal diameter 0 look the same after a turn by a sector; after half of one they do not.
#[test]
fn a_turn_by_a_sector_is_not_seen() {
    let wheel = impeller(0..SECTORS, 6, 0.0);
    let (_, first) = image(&surface(&wheel, SurfaceView::Front));
    let differing = |sectors: f64| {
        let (_, other) = image(&surface(&turned(&wheel, sectors * TAU / SECTORS as f64), SurfaceView::Front));
        first.iter().zip(&other).filter(|(a, b)| a != b).count() as f64 / first.len() as f64
    };
    let (whole, half) = (differing(1.0), differing(0.5));
    assert!(whole < 0.002 && half > 0.05, "{whole} {half}");
}

/// Silhouettes from both sides of the axis are mirror images.
#[test]
fn front_and_rear_have_one_silhouette() {
    let mut wheel = impeller(0..SECTORS, 6, 0.0);
    wheel.displacement.clear();
    let covered = |view| {
        let (width, pixels) = image(&surface(&wheel, view));
        (width, pixels.iter().map(|pixel| *pixel != 255).collect::<Vec<_>>())
    };
    let ((width, front), (_, rear)) = (covered(SurfaceView::Front), covered(SurfaceView::Rear));
    let mirrored = front.chunks(width).flat_map(|line| line.iter().rev());
    let differing = mirrored.zip(&rear).filter(|(a, b)| a != b).count() as f64;
    assert!(differing < 0.003 * front.len() as f64, "{differing} of {}", front.len());
}

#[test]
fn a_drawing_says_what_it_shows() {
    for view in VIEWS {
        for which in [0..SECTORS, 0..1] {
            let drawing = surface(&impeller(which.clone(), 5, 2.0), view);
            let read = Document::parse(&drawing).unwrap();
            let words: String =
                read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join("|");
            for expected in [
                "von Mises stress, MPa",
                "outline at rest",
                "times as large",
                "standing wave",
                "as 5 % of the wheel's radius",
                "0",
                "300",
            ] {
                assert!(words.contains(expected), "{view:?} {which:?} {expected}: {words}");
            }
            assert!(!words.contains("inside of an open surface"), "{view:?} {which:?}: closed");
            // From behind the disks of a whole wheel hide the contact nodes.
            let hidden = view == SurfaceView::Rear && which.len() > 1;
            let told = words.contains("nothing claimed: near contact nodes");
            assert!(told != hidden || view == SurfaceView::Meridional, "{view:?} {which:?}: {words}");
        }
    }
}

/// Sectors with open cyclic faces show their inside, where there is one.
#[test]
fn open_surfaces_show_their_inside() {
    let mut sector = impeller(0..1, 5, 2.0);
    // The faces between hub and core at both ends of the angle.
    let cyclic = |face: &[u32]| {
        let angle = |corner: &u32| {
            let [x, y, _] = sector.nodes[*corner as usize];
            y.atan2(x)
        };
        let half = 0.5 * TAU / SECTORS as f64;
        face.iter().all(|corner| (angle(corner) - half).abs() < 1e-9)
    };
    sector.faces = sector.faces.iter().filter(|face| !cyclic(face)).cloned().collect();
    assert!(surface(&sector, SurfaceView::Meridional).contains("inside of an open surface"));
}

/// Displacements take their share of the drawing: two plates, one of which moves by a tenth of a millimetre.
#[test]
fn displacement_is_as_large_as_is_said() {
    let plate = |x: f64| [[x, 0.0, 0.0], [x + 10.0, 0.0, 0.0], [x + 10.0, 10.0, 0.0], [x, 10.0, 0.0]];
    let mut nodes = plate(0.0).to_vec();
    nodes.extend(plate(-100.0));
    let mut displacement = vec![[0.0; 3]; 8];
    displacement[2] = [0.0, 0.1, 0.0];
    let radius = (100.0f64 * 100.0 + 10.0 * 10.0).sqrt();
    let drawing = surface(
        &FieldSurface {
            title: "plates".to_owned(),
            subtitles: Vec::new(),
            nodes,
            displacement,
            faces: vec![vec![0, 1, 2, 3], vec![4, 5, 6, 7]],
            colour: SurfaceColour {
                quantity: "displacement".to_owned(),
                unit: "mm".to_owned(),
                values: vec![Some(1.0); 8],
            },
            length_unit: "mm".to_owned(),
        },
        SurfaceView::Front,
    );
    // 5 % of the radius over 0.1 mm.
    assert_eq!(format!("{:.1}", 0.05 * radius / 0.1), "50.2");
    assert!(drawing.contains("drawn 50 times as large"), "{drawing}");
}

#[test]
fn what_is_odd_is_still_a_drawing() {
    let odd = |nodes: Vec<[f64; 3]>, faces: Vec<Vec<u32>>, values: Vec<Option<f64>>| FieldSurface {
        title: "a <b> & \"c\"".to_owned(),
        subtitles: vec!["</svg>".to_owned()],
        displacement: nodes.iter().map(|node| node.map(|value| 0.1 * value)).collect(),
        nodes,
        faces,
        colour: SurfaceColour { quantity: "q".to_owned(), unit: String::new(), values },
        length_unit: "mm".to_owned(),
    };
    let triangle = |scale: f64| vec![[0.0, 0.0, 0.0], [scale, 0.0, 0.0], [0.0, scale, 0.0]];
    for case in [
        odd(Vec::new(), Vec::new(), Vec::new()),
        odd(triangle(1.0), Vec::new(), vec![Some(1.0); 3]),
        odd(triangle(1.0), vec![vec![0, 1, 2]], vec![Some(2.0); 3]),
        odd(triangle(1e300), vec![vec![0, 1, 2]], vec![Some(1e300), Some(-1e300), None]),
        odd(triangle(1e-300), vec![vec![0, 1, 2]], vec![Some(1e-300), Some(0.0), None]),
        odd(triangle(0.0), vec![vec![0, 1, 2]], vec![None; 3]),
        odd(triangle(1.0), vec![vec![0, 1], vec![0, 1, 7], vec![], vec![2, 2, 2]], Vec::new()),
        odd(
            vec![[f64::NAN; 3], [1.0, 0.0, f64::INFINITY], [0.0; 3]],
            vec![vec![0, 1, 2]],
            vec![Some(f64::NAN); 3],
        ),
    ] {
        for view in VIEWS {
            let drawing = surface(&case, view);
            assert!(Document::parse(&drawing).is_ok(), "{drawing}");
            let bad = drawing.lines().find(|line| line.contains("NaN") || line.contains("inf\""));
            assert_eq!(bad, None, "{view:?}");
        }
    }
}

/// Meshes of forty thousand nodes make drawings of a few hundred kilobytes at most.
#[test]
fn a_fine_mesh_makes_no_larger_drawing() {
    let fine = impeller(0..SECTORS, 28, 2.0);
    assert!(fine.nodes.len() > 40_000 && fine.faces.len() > 40_000, "{}", fine.nodes.len());
    for view in VIEWS {
        let drawing = surface(&fine, view);
        assert!(drawing.len() < 400_000, "{view:?}: {}", drawing.len());
    }
}
