//! Sector whose cyclic faces are held: its elements, free displacements, stiffness and mass.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

use rubmap_numerics::sparse_cholesky::SymbolicFactor;
use rubmap_solid::element::ElementKind;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::green_lagrange::{BUBBLES, GreenLagrange};
use rubmap_solid::integrals::{mass, stiffness};
use rubmap_solid::mesh::{Element, SectorMesh};
use rubmap_solid::rule::MassRule;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// Sector with held cyclic faces and clamps.
#[derive(Debug)]
pub(crate) struct HeldSector {
    pub(super) elements: Vec<(Vec<u32>, GreenLagrange)>,
    /// Number of nodes.
    pub(super) nodes: usize,
    /// Node and direction in x, y, z of every free displacement; those of one node are neighbours.
    pub(super) rows: Vec<(u32, Vector3<f64>)>,
    /// Own DOF of every free displacement.
    pub(super) own: Vec<usize>,
    /// First row of every node and one past its last.
    of_node: Vec<(usize, usize)>,
    pub(super) stiffness: SparseColMat<usize, f64>,
    pub(super) mass: SparseColMat<usize, f64>,
    pub(super) symbolic: SymbolicFactor,
    /// Contact nodes, in their order.
    pub(super) contact: Vec<ContactPlace>,
}

/// Contact node in space.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContactPlace {
    pub(super) node: u32,
    /// Unit vectors r, θ, z.
    pub(super) directions: [Vector3<f64>; 3],
    pub(super) radius: f64,
}

impl HeldSector {
    /// Sector of a mesh and its nodes, in the same order; none if the axis has no direction or nothing is free.
    pub(crate) fn new(mesh: &SectorMesh, nodes: &[SectorNode]) -> Option<Self> {
        let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1)?;
        let directions = |node: &SectorNode| {
            let unit = frame.cylindrical(node.coordinates[1]);
            [0, 1, 2].map(|k| unit.row(k).transpose())
        };
        let mut held = mesh.on_axis();
        for &(low, high) in &mesh.cyclic {
            (held[low as usize], held[high as usize]) = (true, true);
        }
        let (mut rows, mut own, mut of_node) = (Vec::new(), Vec::new(), Vec::with_capacity(nodes.len()));
        for (index, node) in nodes.iter().enumerate() {
            let first = rows.len();
            if !held[index] {
                let unit = directions(node);
                for dof in node.dofs.iter().flatten() {
                    let along = (0..3).map(|k| unit[k] * dof.components[k]).sum::<Vector3<f64>>();
                    rows.push((index as u32, along));
                    own.push(dof.dof);
                }
            }
            of_node.push((first, rows.len()));
        }
        if rows.is_empty() {
            return None;
        }
        let constants = |element: &Element| mesh.sets[element.set as usize].material.lame_constants();
        let bending = |element: &Element| {
            let bent = GreenLagrange::of(element.kind, &mesh.positions(element), constants(element));
            (element.nodes.clone(), bent)
        };
        let pattern = Pattern::new(mesh, &of_node, rows.len());
        let stiffness = pattern.assemble(mesh, &rows, &of_node, |element| {
            let k = stiffness(element.kind, &mesh.positions(element), constants(element));
            Box::new(move |a, b, x: &Vector3<f64>, y: &Vector3<f64>| x.dot(&(k[(a, b)] * y)))
        });
        let mass = pattern.assemble(mesh, &rows, &of_node, |element| {
            let density = mesh.sets[element.set as usize].material.density;
            let m: DMatrix<f64> = mass(element.kind, &mesh.positions(element), density, MassRule::Consistent);
            Box::new(move |a, b, x: &Vector3<f64>, y: &Vector3<f64>| m[(a, b)] * x.dot(y))
        });
        let groups: Vec<usize> = rows.iter().map(|&(node, _)| node as usize).collect();
        let symbolic = SymbolicFactor::new(stiffness.symbolic(), &groups);
        let mut contact: Vec<(u32, ContactPlace)> = (nodes.iter().enumerate())
            .filter_map(|(index, node)| {
                let place = ContactPlace {
                    node: index as u32,
                    directions: directions(node),
                    radius: node.coordinates[0],
                };
                Some((node.contact?, place))
            })
            .collect();
        contact.sort_by_key(|&(order, _)| order);
        Some(Self {
            elements: mesh.elements.par_iter().map(bending).collect(),
            nodes: nodes.len(),
            rows,
            own,
            of_node,
            stiffness,
            mass,
            symbolic,
            contact: contact.into_iter().map(|(_, place)| place).collect(),
        })
    }

    /// Bytes that a sector and its factor take at most, for a mesh of these elements: gradients, two matrices, and a factor that grows as
    /// under nested dissection.
    pub(crate) fn bytes(mesh: &SectorMesh) -> u64 {
        let elements: usize = mesh.elements.iter().map(|element| GreenLagrange::bytes(element.kind)).sum();
        elements as u64 + Self::matrix_bytes(3 * mesh.nodes.len())
    }

    /// Bytes as of [`Self::bytes`] for so many elements, of the largest kind, and so many DOF.
    pub(super) fn expected_bytes(elements: usize, dofs: usize) -> u64 {
        (elements * GreenLagrange::bytes(ElementKind::C3D20)) as u64 + Self::matrix_bytes(dofs)
    }

    fn matrix_bytes(rows: usize) -> u64 {
        let rows = rows as f64;
        (rows * (4e3 + 60.0 * rows.sqrt())) as u64
    }

    /// Displacements in x, y, z of all nodes by the free ones.
    pub(super) fn spread(&self, free: &[f64]) -> Vec<Vector3<f64>> {
        let mut spread = vec![Vector3::zeros(); self.nodes];
        for (&value, &(node, direction)) in free.iter().zip(&self.rows) {
            spread[node as usize] += direction * value;
        }
        spread
    }

    /// Components of the field of all nodes on the free displacements.
    pub(super) fn gathered(&self, field: &[Vector3<f64>]) -> Vec<f64> {
        self.rows.iter().map(|&(node, along)| along.dot(&field[node as usize])).collect()
    }

    /// Displacements of an element's nodes.
    pub(super) fn at(nodes: &[u32], field: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        nodes.iter().map(|&node| field[node as usize]).collect()
    }

    /// Gradient of the energy at displacements with the β of incompatible modes: by the free displacements, and by β of every element.
    /// Elements are computed in parallel and summed in their order.
    pub(super) fn force(
        &self,
        field: &[Vector3<f64>],
        beta: &[[Vector3<f64>; BUBBLES]],
    ) -> (Vec<f64>, Vec<[Vector3<f64>; BUBBLES]>) {
        let forces = self.of_elements(|index, nodes, element| {
            element.force(&element.values(&Self::at(nodes, field), &beta[index]))
        });
        self.spread_forces(&forces)
    }

    /// Forces of elements on the free displacements, and on β of every element.
    fn spread_forces(&self, forces: &[Vec<Vector3<f64>>]) -> (Vec<f64>, Vec<[Vector3<f64>; BUBBLES]>) {
        let on_beta = |(force, (nodes, _)): (&Vec<Vector3<f64>>, &(Vec<u32>, GreenLagrange))| {
            let own = &force[nodes.len()..];
            std::array::from_fn(|b| own.get(b).copied().unwrap_or_default())
        };
        (self.on_rows(forces), forces.iter().zip(&self.elements).map(on_beta).collect())
    }

    /// Linear part K u of the force at displacements of all nodes, on the free ones.
    pub(super) fn linear_force(&self, field: &[Vector3<f64>]) -> Vec<f64> {
        let still = [Vector3::zeros(); BUBBLES];
        let forces = self.of_elements(|_, nodes, element| {
            element.linear_force(&element.values(&Self::at(nodes, field), &still))
        });
        self.on_rows(&forces)
    }

    /// Part of second order G(a, b) of the force at two fields, as [`Self::force`] has it.
    pub(super) fn second_order_force(
        &self,
        a: &[Vector3<f64>],
        b: &[Vector3<f64>],
    ) -> (Vec<f64>, Vec<[Vector3<f64>; BUBBLES]>) {
        let still = [Vector3::zeros(); BUBBLES];
        let forces = self.of_elements(|_, nodes, element| {
            let values = |field| element.values(&Self::at(nodes, field), &still);
            element.second_order_force(&values(a), &values(b))
        });
        self.spread_forces(&forces)
    }

    /// Sum of the forces of elements on the free displacements.
    fn on_rows(&self, forces: &[Vec<Vector3<f64>>]) -> Vec<f64> {
        let mut free = vec![0.0; self.rows.len()];
        for ((nodes, _), force) in self.elements.iter().zip(forces) {
            for (&node, force) in nodes.iter().zip(force) {
                let (first, end) = self.of_node[node as usize];
                let along = self.rows[first..end].iter();
                free[first..end].iter_mut().zip(along).for_each(|(sum, (_, along))| *sum += along.dot(force));
            }
        }
        free
    }

    /// Results of all elements, computed in parallel, in their order.
    pub(super) fn of_elements<T: Send>(
        &self,
        of: impl Fn(usize, &[u32], &GreenLagrange) -> T + Sync,
    ) -> Vec<T> {
        let elements = self.elements.par_iter().enumerate();
        elements.map(|(index, (nodes, element))| of(index, nodes, element)).collect()
    }

    /// Sums of `K` numbers of every element, in the order of the elements.
    pub(super) fn sum<const K: usize>(
        &self,
        of: impl Fn(usize, &[u32], &GreenLagrange) -> [f64; K] + Sync,
    ) -> [f64; K] {
        let mut sums = [0.0; K];
        for part in self.of_elements(of) {
            sums.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        sums
    }
}

/// Entry of an element's matrix between two of its nodes, along two directions.
type Entry = Box<dyn Fn(usize, usize, &Vector3<f64>, &Vector3<f64>) -> f64>;

/// Sparsity pattern of the matrices: rows that share an element with a column, ascending, column by column.
struct Pattern {
    starts: Vec<usize>,
    rows: Vec<usize>,
}

impl Pattern {
    fn new(mesh: &SectorMesh, of_node: &[(usize, usize)], size: usize) -> Self {
        let mut beside: Vec<Vec<u32>> = vec![Vec::new(); mesh.nodes.len()];
        for element in &mesh.elements {
            element.nodes.iter().for_each(|&node| beside[node as usize].extend(&element.nodes));
        }
        let (mut starts, mut rows) = (Vec::with_capacity(size + 1), Vec::new());
        starts.push(0);
        for (node, neighbours) in beside.iter_mut().enumerate() {
            neighbours.sort_unstable();
            neighbours.dedup();
            for _ in of_node[node].0..of_node[node].1 {
                for &neighbour in &*neighbours {
                    rows.extend(of_node[neighbour as usize].0..of_node[neighbour as usize].1);
                }
                starts.push(rows.len());
            }
        }
        Self { starts, rows }
    }

    fn assemble(
        &self,
        mesh: &SectorMesh,
        along: &[(u32, Vector3<f64>)],
        of_node: &[(usize, usize)],
        entry: impl Fn(&Element) -> Entry,
    ) -> SparseColMat<usize, f64> {
        let mut values = vec![0.0; self.rows.len()];
        for element in &mesh.elements {
            let entry = entry(element);
            for (b, &column_node) in element.nodes.iter().enumerate() {
                for column in of_node[column_node as usize].0..of_node[column_node as usize].1 {
                    let (first, end) = (self.starts[column], self.starts[column + 1]);
                    for (a, &row_node) in element.nodes.iter().enumerate() {
                        let (from, to) = of_node[row_node as usize];
                        let at = first + self.rows[first..end].partition_point(|&row| row < from);
                        for row in from..to {
                            values[at + row - from] += entry(a, b, &along[row].1, &along[column].1);
                        }
                    }
                }
            }
        }
        let size = along.len();
        let (starts, rows) = (self.starts.clone(), self.rows.clone());
        SparseColMat::new(SymbolicSparseColMat::new_checked(size, size, starts, None, rows), values)
    }
}
