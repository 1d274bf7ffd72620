//! Units: their names, their sizes, and whether four of them are consistent.

use rubmap_wheel::dynamics::sector::{SectorParts, Units};

use super::error::ManifestProblem;

/// Largest relative difference of two factors of the same unit system: pounds and slugs are quoted with few digits.
const TOLERANCE: f64 = 1e-3;

/// Largest number of characters of a unit's name.
const LONGEST_NAME: usize = 40;

const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;
const POUND: f64 = 0.453_592_37;
const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// Known names by quantity, with their sizes in SI units.
const LENGTH: Names = &[
    (&["m", "meter", "metre"], 1.0),
    (&["dm"], 1e-1),
    (&["cm"], 1e-2),
    (&["mm", "millimeter", "millimetre"], 1e-3),
    (&["um", "µm", "μm"], 1e-6),
    (&["in", "inch"], INCH),
    (&["ft", "foot"], FOOT),
];
const FORCE: Names = &[
    (&["N", "newton"], 1.0),
    (&["mN"], 1e-3),
    (&["uN", "µN", "μN"], 1e-6),
    (&["daN"], 1e1),
    (&["kN"], 1e3),
    (&["MN"], 1e6),
    (&["dyn", "dyne"], 1e-5),
    (&["kgf", "kp"], 9.806_65),
    (&["lbf"], POUND_FORCE),
    (&["kip"], 1e3 * POUND_FORCE),
];
const TIME: Names = &[
    (&["s", "sec", "second"], 1.0),
    (&["ms"], 1e-3),
    (&["us", "µs", "μs"], 1e-6),
    (&["min"], 60.0),
    (&["h"], 3600.0),
];
const MASS: Names = &[
    (&["kg", "kilogram"], 1.0),
    (&["g", "gram"], 1e-3),
    (&["mg"], 1e-6),
    (&["t", "tonne", "Mg", "N·s²/mm", "N*s^2/mm", "N s2/mm", "Ns2/mm"], 1e3),
    (&["kt"], 1e6),
    (&["lb", "lbm"], POUND),
    (&["slug", "lbf·s²/ft", "lbf*s^2/ft", "lbf s2/ft", "lbf-s2/ft", "lbf.s2/ft"], POUND_FORCE / FOOT),
    (
        &[
            "slinch",
            "blob",
            "snail",
            "lbf·s²/in",
            "lbf*s^2/in",
            "lbf s^2/in",
            "lbf s2/in",
            "lbf-s2/in",
            "lbf.s2/in",
        ],
        POUND_FORCE / INCH,
    ),
];

/// Names of one quantity's units with their sizes.
type Names = &'static [(&'static [&'static str], f64)];

const QUANTITIES: [(&str, Names); 4] = [("length", LENGTH), ("force", FORCE), ("time", TIME), ("mass", MASS)];

/// Converts a sector whose matrices count time in another unit than seconds to seconds, in which speeds are given: mass and the gyroscopic
/// matrix, which is measured in mass, become force·s²/length; stiffness stays.
pub(super) fn count_time_in_seconds(sector: &mut SectorParts) {
    let seconds = seconds(&sector.units);
    if seconds == 1.0 {
        return;
    }
    for matrix in std::iter::once(&mut sector.mass).chain(&mut sector.gyroscopic) {
        for values in [matrix.own.val_mut(), matrix.next.val_mut()] {
            values.iter_mut().for_each(|value| *value *= seconds * seconds);
        }
    }
    let Units { length, force, .. } = &sector.units;
    sector.units.mass = format!("{force}·s²/{length}");
    sector.units.time = "s".to_owned();
}

/// Length of the unit of time, s.
pub(super) fn seconds(units: &Units) -> f64 {
    size(TIME, &units.time).unwrap_or(1.0)
}

/// Sizes of the units of length, force and mass in m, N and kg, the mass as it follows from force, time and length; none where a name is
/// not known.
pub(super) fn si_sizes(units: &Units) -> Option<[f64; 3]> {
    let (length, force) = (size(LENGTH, &units.length)?, size(FORCE, &units.force)?);
    let seconds = size(TIME, &units.time)?;
    Some([length, force, force * seconds * seconds / length])
}

/// Young's modulus, Pa, and density, kg/m³; none where a unit is not known.
pub(super) fn material_in_si(youngs_modulus: f64, density: f64, units: &Units) -> Option<[f64; 2]> {
    let [length, force, mass] = si_sizes(units)?;
    Some([youngs_modulus * (force / (length * length)), density * (mass / length.powi(3))])
}

/// Checks that force = mass·length/time² among the names this module knows.
///
/// A name it does not know is accepted: a package may use any consistent system, and only what is known to be wrong is refused, which
/// includes known names of another quantity. On failure: the field and the problem.
pub(crate) fn check(units: &Units) -> Result<(), (&'static str, ManifestProblem)> {
    let given = [&units.length, &units.force, &units.time, &units.mass];
    let fields = ["/units/length", "/units/force", "/units/time", "/units/mass"];
    let mut sizes = [None; 4];
    for (k, (quantity, names)) in QUANTITIES.iter().enumerate() {
        if given[k].trim().is_empty() {
            return Err((fields[k], ManifestProblem::UnitUnnamed));
        }
        if given[k].chars().nth(LONGEST_NAME).is_some() {
            return Err((fields[k], ManifestProblem::TextTooLong { limit: LONGEST_NAME }));
        }
        sizes[k] = size(names, given[k]);
        let other = QUANTITIES.iter().any(|(_, names)| size(names, given[k]).is_some());
        if sizes[k].is_none() && other {
            return Err((
                fields[k],
                ManifestProblem::UnitOfOtherQuantity { unit: given[k].clone(), quantity },
            ));
        }
    }
    if sizes[2].is_none() {
        return Err(("/units/time", ManifestProblem::TimeUnknown { unit: units.time.clone() }));
    }
    let [Some(length), Some(force), Some(time), Some(mass)] = sizes else { return Ok(()) };
    let factor = mass * length / (time * time) / force;
    if (factor - 1.0).abs() <= TOLERANCE {
        return Ok(());
    }
    let needed = force * time * time / length;
    let fitting = MASS.iter().find(|(_, size)| (size / needed - 1.0).abs() <= TOLERANCE);
    let problem = ManifestProblem::UnitsInconsistent {
        mass: units.mass.clone(),
        length: units.length.clone(),
        time: units.time.clone(),
        force: units.force.clone(),
        // Six digits: the rest is rounding of the factors.
        factor: format!("{factor:.5e}").parse().unwrap_or(factor),
        fitting: fitting.map(|(names, _)| names[0]),
    };
    Err(("/units", problem))
}

/// Factors from units `from` to units `to`, for length, force and mass.
///
/// # Errors
/// Field of `to` whose unit this module does not know, or that of `from`.
pub(crate) fn factors(from: &Units, to: &Units) -> Result<[f64; 3], &'static str> {
    let of = |field, names, from: &str, to: &str| {
        Ok(size(names, from).ok_or(field)? / size(names, to).ok_or(field)?)
    };
    Ok([
        of("units.length", LENGTH, &from.length, &to.length)?,
        of("units.force", FORCE, &from.force, &to.force)?,
        of("units.mass", MASS, &from.mass, &to.mass)?,
    ])
}

/// Size of a unit by its exact name, or by its name in other capitals if only one unit has it.
fn size(names: &[(&[&str], f64)], name: &str) -> Option<f64> {
    let name = name.trim();
    let matching = |same: &dyn Fn(&str) -> bool| -> Vec<f64> {
        names
            .iter()
            .filter(|(names, _)| names.iter().any(|known| same(known)))
            .map(|(_, size)| *size)
            .collect()
    };
    let exact = matching(&|known| known == name);
    let any_case = matching(&|known| known.eq_ignore_ascii_case(name));
    match (exact[..].first(), &any_case[..]) {
        (Some(size), _) => Some(*size),
        (None, [size]) => Some(*size),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(length: &str, force: &str, time: &str, mass: &str) -> Result<(), (&'static str, String)> {
        let [length, force, time, mass] = [length, force, time, mass].map(str::to_owned);
        check(&Units { length, force, time, mass }).map_err(|(field, problem)| (field, problem.to_string()))
    }

    #[test]
    fn consistent_systems_pass() {
        for [l, f, t, m] in [
            ["mm", "N", "s", "t"],
            ["m", "N", "s", "kg"],
            ["mm", "mN", "s", "kg"],
            ["mm", "kN", "ms", "kg"],
            ["cm", "dyn", "s", "g"],
            ["in", "lbf", "s", "lbf·s²/in"],
            ["ft", "lbf", "s", "slug"],
            ["M", "n", "S", "KG"],
            ["furlong", "N", "s", "kg"],
        ] {
            assert_eq!(verdict(l, f, t, m), Ok(()), "{l} {f} {t} {m}");
        }
    }

    #[test]
    fn inconsistent_systems_are_told_the_mass_unit() {
        let (field, text) = verdict("mm", "N", "s", "kg").expect_err("inconsistent");
        assert_eq!(field, "/units");
        assert_eq!(
            text,
            "the units are not consistent: force must be mass·length/time², but 1 kg·mm/s² is 0.001 N; with mm, N and s \
             the mass is in t"
        );
        assert_eq!(verdict("kg", "N", "s", "t").expect_err("not a length").0, "/units/length");
        assert_eq!(verdict("mm", "", "s", "t").expect_err("unnamed").0, "/units/force");
        assert_eq!(verdict("in", "lbf", "s", "lbm").expect_err("386 times off").0, "/units");
    }
}
