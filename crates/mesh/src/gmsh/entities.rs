//! `$PhysicalNames` and `$Entities`: names of physical groups, and the groups of each entity of the geometry.

use std::collections::BTreeMap;

use crate::error::{MeshFileError, MeshProblem};

use super::groups::{Group, Groups};
use super::source::Source;

/// Physical groups by dimension and number of an entity.
pub(super) type Entities = BTreeMap<(u64, i64), Vec<Group>>;

/// Most physical groups of an entity: all its elements are added to each.
const MOST_GROUPS: u64 = 1000;

/// Reads the names of physical groups.
pub(super) fn names(source: &mut Source<'_>, groups: &mut Groups) -> Result<(), MeshFileError> {
    source.text_row("the number of names")?;
    let count = source.text_size("the number of names")?;
    for _ in 0..count {
        source.text_row("a name of a physical group")?;
        let dimension = source.text_size("the dimension of a physical group")?;
        let number = source.text_size("the number of a physical group")?;
        let name = source.rest_of_row();
        let name = name.strip_prefix('"').and_then(|name| name.strip_suffix('"')).unwrap_or(&name);
        if !name.is_empty() {
            groups.name(Group { dimension, number }, name);
        }
    }
    source.end()
}

/// Reads the entities of version 4.1.
pub(super) fn read(source: &mut Source<'_>) -> Result<Entities, MeshFileError> {
    source.row("the numbers of points, curves, surfaces and volumes")?;
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = source.size("a number of entities")?;
    }
    source.end_row()?;
    let mut entities = Entities::new();
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            source.row("an entity")?;
            let tag = source.integer("the number of an entity")?;
            // Points have their position here, others the two corners of their box.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                source.real("a coordinate of an entity")?;
            }
            let groups = integers(source, "the number of a physical group", MOST_GROUPS)?;
            if dimension > 0 {
                integers(source, "the number of a bounding entity", u64::MAX)?;
            }
            source.end_row()?;
            // A negative number stands for elements that are turned over.
            let group = |number: i64| Group { dimension, number: number.unsigned_abs() };
            entities.insert((dimension, tag), groups.into_iter().map(group).collect());
        }
    }
    source.end()?;
    Ok(entities)
}

/// Reads a count up to `most` and as many integers.
fn integers(source: &mut Source<'_>, expected: &'static str, most: u64) -> Result<Vec<i64>, MeshFileError> {
    let count = source.size("a number of integers")?;
    if count > most {
        let what = format!("an entity in more than {most} physical groups");
        let advice = "keep the groups that the model needs only";
        return Err(source.error(MeshProblem::NotCarried { what, advice }));
    }
    let mut found = Vec::new();
    for _ in 0..count {
        found.push(source.integer(expected)?);
    }
    Ok(found)
}
