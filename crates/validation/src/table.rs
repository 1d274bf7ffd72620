//! Table of all claims.

use crate::claim::Claim;
use crate::rows::{
    bending, by_tests, contact, effects, frequencies, importers, run_up, sensitivities, steady, stress,
    turning,
};

/// All claims, in the order of the document.
pub fn claims() -> impl Iterator<Item = &'static Claim> {
    [
        frequencies::ROWS,
        turning::ROWS,
        contact::ROWS,
        effects::ROWS,
        run_up::ROWS,
        steady::ROWS,
        bending::ROWS,
        stress::ROWS,
        sensitivities::ROWS,
        importers::ROWS,
        by_tests::ROWS,
    ]
    .into_iter()
    .flatten()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rubmap_analysis::kinds::list::KINDS;
    use rubmap_mesh::MeshFormat;
    use rubmap_mesh::matrices::MatrixFormat;

    use crate::claim::{Check, NO_REFERENCE, Subject};
    use crate::report::{Row, Verdict};

    /// Problems given to the program wrong by two in a hundred must fail: else a limit would let an error of that size pass.
    #[test]
    fn computed_rows_hold_and_fail_where_the_problem_is_another() {
        for claim in super::claims() {
            let Check::Computed(computed) = claim.check else { continue };
            let row = Row::of(claim);
            let wrong = (computed.error)(1.02).unwrap();
            println!(
                "{}: {:?} of {:e}, wrong {wrong:.2e}, {:.2} s",
                row.name, row.error, computed.limit, row.seconds
            );
            assert_eq!(row.verdict, Verdict::Passed, "{row:?}");
            assert!(
                wrong > computed.limit,
                "{}: {} off by 2 % goes unnoticed: {wrong:e}",
                row.name,
                computed.wrong
            );
        }
    }

    #[test]
    fn every_effect_kind_and_importer_has_a_row() {
        let covered: Vec<Subject> = super::claims().flat_map(|claim| claim.covers).copied().collect();
        let effects = rubmap_analysis::effects::names().map(Subject::Effect);
        // The service adds the generation of models to these, and asserts as much of it.
        let kinds = KINDS.iter().map(|kind| Subject::Kind(kind.name));
        let meshes = MeshFormat::ALL.map(Subject::Mesh).into_iter();
        let matrices = MatrixFormat::ALL.map(Subject::Matrices).into_iter();
        let wanted: Vec<Subject> = effects.chain(kinds).chain(meshes).chain(matrices).collect();
        let without: Vec<_> = wanted.iter().filter(|subject| !covered.contains(subject)).collect();
        assert!(without.is_empty(), "{without:?} without a row");
        let generated = Subject::Kind("model_generation");
        let unknown: Vec<_> =
            covered.iter().filter(|subject| !wanted.contains(subject) && **subject != generated).collect();
        assert!(unknown.is_empty(), "{unknown:?} is nothing");
    }

    #[test]
    fn names_are_unique_and_tests_exist() {
        let mut names = BTreeSet::new();
        for claim in super::claims() {
            assert!(names.insert(claim.name), "{} twice", claim.name);
            assert_eq!(claim.reference == NO_REFERENCE, matches!(claim.check, Check::None), "{}", claim.name);
            if let Check::Test { file, name, .. } | Check::Consistency { file, name, .. } = claim.check {
                let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../");
                let source = std::fs::read_to_string(format!("{root}{file}")).unwrap();
                let (before, _) = source.split_once(&format!("fn {name}()")).expect(name);
                assert!(before.trim_end().ends_with("#[test]"), "{name} is no test");
            }
        }
    }
}
