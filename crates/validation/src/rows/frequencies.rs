//! Natural frequencies: at rest, at speed, and of reduced against full models.

use std::f64::consts::{FRAC_PI_2, TAU};

use faer::sparse::{SparseColMat, Triplet};
use rubmap_model::impeller::mesh::ElementOrder;
use rubmap_model::impeller::{AnnulusParameters, CantileverParameters, Material, annulus, cantilever};
use rubmap_model::package::raw::RawPackage;
use rubmap_model::package::to_sector;
use rubmap_wheel::dynamics::modal_wheel::natural_frequencies;
use rubmap_wheel::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap_wheel::dynamics::sector::{ContactNode, CyclicMatrix, SectorModel, SectorParts, Units};

use super::blade::relative;
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[
    Claim {
        name: "wheel-of-hubs",
        covers: &[],
        claim: "A cyclic wheel at rest has the natural frequencies of every nodal diameter.",
        reference: "closed form: ten hubs on springs with a blade each, λ² − (h + b)λ + b(h − b) = 0 with h = g + b + 2c(1 − cos iα)",
        quantity: "largest relative error of both frequencies of all nodal diameters",
        check: Check::Computed(Computed {
            error: wheel_of_hubs,
            wrong: "stiffness between hubs",
            limit: 1e-12,
            reason: "the reduction keeps all modes: round-off",
        }),
    },
    Claim {
        name: "reduction-against-full",
        covers: &[],
        claim: "The reduction keeps the lowest natural frequencies of the full model.",
        reference: "closed form of the full model: chain of 60 masses, ω = 2√(k/m) sin((2j − 1)π/240)",
        quantity: "largest relative error of the three lowest frequencies with 12 fixed-interface modes in each direction",
        check: Check::Computed(Computed {
            error: reduced_chain,
            wrong: "stiffness of the chain",
            limit: 5e-4,
            reason: "modes above the twelfth are left out",
        }),
    },
    Claim {
        name: "rotating-beam",
        covers: &[Subject::Effect("centrifugal_stiffening"), Subject::Kind("model_generation")],
        claim: "Rotation stiffens a beam out of its plane of rotation.",
        reference: "Wright, Smith, Thresher and Wang, J. Appl. Mech. 49 (1982) 197–202, recomputed by Legendre–Ritz: rotating uniform cantilever at η = Ω/√(EI/mL⁴) of 0, 2, 4 and 8",
        quantity: "largest relative error of the first two flap frequencies",
        check: Check::Computed(Computed {
            error: rotating_beam,
            wrong: "Young's modulus",
            limit: 4e-4,
            reason: "80 elements of 8 nodes: second order in their length",
        }),
    },
    Claim {
        name: "annular-plate",
        covers: &[Subject::Kind("model_generation")],
        claim: "A disk clamped at its bore has the frequencies of a plate by nodal diameter.",
        reference: "Kirchhoff's plate: zeros of the determinant of Bessel functions, b/a = 0.3, ν = 0.3",
        quantity: "largest relative error of nodal diameters 0 to 3 without nodal circle",
        check: Check::Computed(Computed {
            error: annular_plate,
            wrong: "Young's modulus",
            limit: 7e-3,
            reason: "mesh of 24 elements across, shear and rotary inertia of a hundredth of the radius",
        }),
    },
];

/// Sector of hubs or blades of nodes that move alike in all directions, the tip last. Values are (row, column, value).
fn springs(
    sectors: usize,
    nodes: usize,
    mass: &[(usize, usize, f64)],
    stiffness: &[(usize, usize, f64)],
    next: &[(usize, usize, f64)],
) -> anyhow::Result<SectorModel> {
    let matrix = |entries: &[(usize, usize, f64)]| {
        let alike = |&(row, column, value): &(usize, usize, f64)| {
            (0..3).map(move |d| Triplet::new(3 * row + d, 3 * column + d, value))
        };
        let entries: Vec<_> = entries.iter().flat_map(alike).collect();
        SparseColMat::try_new_from_triplets(3 * nodes, 3 * nodes, &entries)
    };
    let tip = 3 * (nodes - 1);
    Ok(SectorModel::new(SectorParts {
        name: "springs".into(),
        sectors,
        units: Units { length: "m".into(), force: "N".into(), time: "s".into(), mass: "kg".into() },
        mass: CyclicMatrix { own: matrix(mass)?, next: matrix(&[])? },
        stiffness: vec![CyclicMatrix { own: matrix(stiffness)?, next: matrix(next)? }],
        gyroscopic: None,
        speeds_rad_s: vec![0.0],
        contact: vec![ContactNode {
            id: 1,
            position: [1.0, 0.0, 0.0],
            normal: [1.0, 0.0, 0.0],
            dofs: [tip, tip + 1, tip + 2],
        }],
        axis: Vec::new(),
        node_of_dof: (0..3 * nodes).map(|dof| dof / 3).collect(),
    })?)
}

fn reduced(sector: &SectorModel, modes: usize) -> anyhow::Result<ReducedWheel> {
    Ok(reduce(sector, &ReductionOptions::new(modes), &NoCheckpoints, &|_, _| true)?)
}

fn wheel_of_hubs(wrong: f64) -> anyhow::Result<f64> {
    let (sectors, ground, blade, between) = (10, 1.0, 1.0, 0.2);
    let given = wrong * between;
    let hub = ground + blade + 2.0 * given;
    let stiffness = [(0, 0, hub), (0, 1, -blade), (1, 0, -blade), (1, 1, blade)];
    let sector = springs(sectors, 2, &[(0, 0, 1.0), (1, 1, 1.0)], &stiffness, &[(0, 0, -given)])?;
    let wheel = reduced(&sector, 3)?;
    let mut most = 0.0f64;
    for (i, harmonic) in wheel.harmonics.iter().enumerate() {
        let h = ground + blade + 2.0 * between * (1.0 - (TAU * i as f64 / sectors as f64).cos());
        let (mean, spread) = (0.5 * (h + blade), (0.25 * (h - blade).powi(2) + blade * blade).sqrt());
        let found = natural_frequencies(harmonic, 0.0, false)?;
        // Each three times, in r, θ and z.
        let exact = |mode: usize| if mode < 3 { (mean - spread).sqrt() } else { (mean + spread).sqrt() };
        most = most.max(relative(found.iter().enumerate().map(|(mode, &omega)| (omega, exact(mode)))));
    }
    Ok(most)
}

fn reduced_chain(wrong: f64) -> anyhow::Result<f64> {
    let masses = 60;
    // Half a mass at the end makes it the half of a chain without ends.
    let mass: Vec<_> = (0..masses).map(|i| (i, i, if i + 1 == masses { 0.5 } else { 1.0 })).collect();
    let spring = |i: usize| {
        let below = (i > 0).then(|| [(i, i - 1, -wrong), (i - 1, i, -wrong), (i - 1, i - 1, wrong)]);
        below.into_iter().flatten().chain([(i, i, wrong)])
    };
    let stiffness: Vec<_> = (0..masses).flat_map(spring).collect();
    let wheel = reduced(&springs(1, masses, &mass, &stiffness, &[])?, 36)?;
    let found = natural_frequencies(&wheel.harmonics[0], 0.0, false)?;
    let exact = |j: usize| 2.0 * ((2 * j + 1) as f64 * FRAC_PI_2 / (2 * masses) as f64).sin();
    Ok(relative((0..9).map(|mode| (found[mode], exact(mode / 3)))))
}

/// Flap frequencies over √(EI/mL⁴) at η, as tabulated.
const FLAP: [(f64, [f64; 2]); 4] = [
    (0.0, [3.51602, 22.03449]),
    (2.0, [4.13732, 22.61492]),
    (4.0, [5.58500, 24.27335]),
    (8.0, [9.25684, 29.99538]),
];

fn rotating_beam(wrong: f64) -> anyhow::Result<f64> {
    let slenderness = 200.0f64;
    // Square section of side 1.
    let (modulus, density) = (2e5f64, 8e-9);
    let unit = (modulus / density / 12.0).sqrt() / slenderness.powi(2);
    let material =
        Material { youngs_modulus: wrong * modulus, poissons_ratio: 0.0, density, ..Material::default() };
    let package = cantilever(&CantileverParameters {
        length: slenderness,
        width: 1.0,
        depth: 1.0,
        elements: [80, 1, 2],
        element_order: ElementOrder::Linear,
        material,
        top_speed_rad_s: 8.0 * unit,
        ..CantileverParameters::default()
    })?;
    let wheel = of_package(package, 12)?;
    let mut most = 0.0f64;
    for (eta, exact) in FLAP {
        // Lag and flap of the first family, then of the second.
        let found = natural_frequencies(&wheel.harmonics[0], eta * unit, true)?;
        most = most.max(relative([1, 3].map(|mode| found[mode] / unit).into_iter().zip(exact)));
    }
    Ok(most)
}

/// Zeros λ² = ωa²√(ρh/D) of nodal diameters 0 to 3 without nodal circle.
const PLATE: [f64; 4] = [6.6604, 6.5523, 7.9565, 13.2757];

fn annular_plate(wrong: f64) -> anyhow::Result<f64> {
    let (modulus, density, thickness, nu) = (2e5f64, 8e-9, 0.01, 0.3);
    let material =
        Material { youngs_modulus: wrong * modulus, poissons_ratio: nu, density, ..Material::default() };
    let package = annulus(&AnnulusParameters {
        sectors: 24,
        inner_radius: 0.3,
        outer_radius: 1.0,
        thickness,
        elements: [24, 4, 1],
        element_order: ElementOrder::Quadratic,
        material,
        top_speed_rad_s: 1e-3,
        ..AnnulusParameters::default()
    })?;
    let wheel = of_package(package, 4)?;
    let unit = thickness * (modulus / density / (12.0 * (1.0 - nu * nu))).sqrt();
    let mut most = 0.0f64;
    for (harmonic, exact) in wheel.harmonics.iter().zip(PLATE) {
        let found = natural_frequencies(harmonic, 0.0, false)?;
        most = most.max((found[0] / unit / exact - 1.0).abs());
    }
    Ok(most)
}

fn of_package(package: RawPackage, modes: usize) -> anyhow::Result<ReducedWheel> {
    reduced(&to_sector(package)?, modes)
}
