//! `$Elements`: solid elements, what is left out, and the groups of both.

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;
use crate::solids;

use super::entities::Entities;
use super::groups::{Group, Groups};
use super::header::Version;
use super::shapes::{Shape, reordered};
use super::source::Source;

/// Groups and entities of a file while its elements are read.
#[derive(Default)]
pub(super) struct Elements {
    /// Physical groups.
    pub(super) groups: Groups,
    /// Entities of version 4.1.
    pub(super) entities: Entities,
    /// Numbers that were added to groups besides the first of each element.
    repeated: u64,
}

/// Most numbers of nodes and elements that are added to groups besides the first of each element: a short file could name a mesh in a
/// thousand groups.
const MOST_REPEATED: u64 = 100_000_000;

/// Type of elements, with its number.
#[derive(Clone, Copy)]
struct Type {
    number: i64,
    shape: Shape,
}

impl Type {
    fn read(source: &mut Source<'_>) -> Result<Self, MeshFileError> {
        let number = source.integer("the type of an element")?;
        let shape = Shape::of(number).map_err(|problem| source.error(problem))?;
        Ok(Self { number, shape })
    }
}

impl Elements {
    /// Reads the section.
    pub(super) fn read(
        &mut self,
        source: &mut Source<'_>,
        version: Version,
        mesh: &mut MeshFile,
    ) -> Result<(), MeshFileError> {
        if mesh.nodes.is_empty() {
            let expected = "$Nodes before $Elements".to_owned();
            return Err(source.error(MeshProblem::Expected { expected }));
        }
        match version {
            Version::Two if source.is_binary() => self.version_2_binary(source, mesh)?,
            Version::Two => self.version_2(source, mesh)?,
            Version::Four => self.version_4(source, mesh)?,
        }
        source.end()
    }

    fn version_2(&mut self, source: &mut Source<'_>, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        source.text_row("the number of elements")?;
        let count = source.text_size("the number of elements")?;
        source.claim(count, 1, "elements")?;
        for _ in 0..count {
            source.row("an element")?;
            let id = source.small("an element number")?;
            let of = Type::read(source)?;
            let tags = source.small("the number of tags")?;
            self.tagged(source, mesh, id, of, tags)?;
        }
        Ok(())
    }

    /// Elements in blocks of one type and number of tags.
    fn version_2_binary(
        &mut self,
        source: &mut Source<'_>,
        mesh: &mut MeshFile,
    ) -> Result<(), MeshFileError> {
        source.text_row("the number of elements")?;
        let mut left = source.text_size("the number of elements")?;
        while left > 0 {
            let of = Type::read(source)?;
            let count = source.small("the number of elements of a block")?;
            let tags = source.small("the number of tags")?;
            source.claim(count, 4 * (1 + tags + of.shape.nodes as u64), "elements")?;
            for _ in 0..count {
                let id = source.small("an element number")?;
                self.tagged(source, mesh, id, of, tags)?;
            }
            left = left.saturating_sub(count);
        }
        Ok(())
    }

    /// Reads tags, of which the first is the physical group, and nodes of an element.
    fn tagged(
        &mut self,
        source: &mut Source<'_>,
        mesh: &mut MeshFile,
        id: u64,
        of: Type,
        tags: u64,
    ) -> Result<(), MeshFileError> {
        let mut group = None;
        for place in 0..tags {
            let tag = source.integer("a tag")?.unsigned_abs();
            // 0 is no group.
            if place == 0 && tag != 0 {
                group = Some(Group { dimension: of.shape.dimension, number: tag });
            }
        }
        let mut nodes = Vec::new();
        for _ in 0..of.shape.nodes {
            nodes.push(source.small("a node number")?);
        }
        source.end_row()?;
        self.add(source, mesh, id, of, &nodes, group.as_slice())
    }

    fn version_4(&mut self, source: &mut Source<'_>, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        source.row("the number of blocks of elements")?;
        let blocks = source.size("the number of blocks of elements")?;
        for expected in
            ["the number of elements", "the smallest element number", "the largest element number"]
        {
            source.size(expected)?;
        }
        source.end_row()?;
        for _ in 0..blocks {
            source.row("a block of elements")?;
            let dimension = source.small("the dimension of an entity")?;
            let entity = source.integer("the number of an entity")?;
            let of = Type::read(source)?;
            let count = source.size("the number of elements of a block")?;
            source.end_row()?;
            source.claim(count, 8 * (1 + of.shape.nodes as u64), "elements")?;
            let groups = self.entities.get(&(dimension, entity)).cloned().unwrap_or_default();
            let each = groups.len().saturating_sub(1) * (1 + of.shape.nodes);
            self.repeat(count, each).map_err(|problem| source.error(problem))?;
            for _ in 0..count {
                source.row("an element")?;
                let id = source.size("an element number")?;
                let mut nodes = Vec::new();
                for _ in 0..of.shape.nodes {
                    nodes.push(source.size("a node number")?);
                }
                source.end_row()?;
                self.add(source, mesh, id, of, &nodes, &groups)?;
            }
        }
        Ok(())
    }

    /// Counts the numbers that `count` elements add to groups besides their first, `each` of them.
    fn repeat(&mut self, count: u64, each: usize) -> Result<(), MeshProblem> {
        self.repeated = self.repeated.saturating_add(count.saturating_mul(each as u64));
        if self.repeated <= MOST_REPEATED {
            return Ok(());
        }
        Err(MeshProblem::NotCarried {
            what: format!("a file whose physical groups share more than {MOST_REPEATED} numbers"),
            advice: "keep the groups that the model needs only",
        })
    }

    /// Adds an element to the mesh and to its groups.
    fn add(
        &mut self,
        source: &Source<'_>,
        mesh: &mut MeshFile,
        id: u64,
        of: Type,
        nodes: &[u64],
        groups: &[Group],
    ) -> Result<(), MeshFileError> {
        let failed = |problem| source.error(problem);
        if let Some(kind) = of.shape.solid {
            let nodes = reordered(kind, nodes);
            let element = solids::element(id, kind, &nodes, source.line()).map_err(failed)?;
            let twice = || failed(MeshProblem::Twice { what: "element", id });
            match mesh.elements.get(&id) {
                None => solids::add(mesh, id, element).map_err(failed)?,
                // Some writers of version 2.2 list an element by the same number in each of its groups.
                Some(known) if known.nodes == element.nodes && !groups.is_empty() => {}
                Some(_) => return Err(twice()),
            }
            if !groups.iter().all(|&group| self.groups.add_solid(group, id)) {
                return Err(twice());
            }
        } else {
            if let Some(&node) = nodes.iter().find(|node| !mesh.nodes.contains_key(node)) {
                return Err(failed(MeshProblem::NoSuchNode { element: id, node }));
            }
            mesh.leave_out(&of.shape.name(of.number));
        }
        groups.iter().for_each(|&group| self.groups.add_nodes(group, nodes));
        Ok(())
    }
}
