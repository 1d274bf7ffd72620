//! Motion of contact nodes towards the casing by the coordinates of blades that bend far, at the instant of a step.

use super::super::bending::MOST_COORDINATES;
use super::super::oscillators::lanes::LANES;
use rubmap_numerics::aligned::Aligned;

/// Derivatives of the displacement Σ_a c_a q_a(p) of contact nodes by the coordinates p of their sector. Few of them are asked for in a step,
/// so that each is summed where it is needed.
#[derive(Debug, Clone)]
pub(crate) struct Slopes {
    /// Number of contact nodes.
    nodes: usize,
    /// Coefficients c, `[product][node]`, nodes padded by zeros.
    curvature: Aligned,
    stride: usize,
    /// Coordinates of each product.
    products: Vec<(usize, usize)>,
    /// Second derivatives of every node, `[node][coordinate]`, symmetric.
    second: Vec<[f64; MOST_COORDINATES]>,
    /// Largest Σ_j |∂²u/∂p_j∂p_k| of any node, by coordinate k.
    largest: [f64; MOST_COORDINATES],
    coordinates: usize,
    /// Coordinates of every sector.
    p: Vec<[f64; MOST_COORDINATES]>,
}

impl Slopes {
    /// Slopes of the first `nodes` of `stride` rows at p = 0.
    pub(crate) fn new(
        sectors: usize,
        nodes: usize,
        coordinates: usize,
        curvature: Aligned,
        stride: usize,
        products: Vec<(usize, usize)>,
    ) -> Self {
        let mut second = vec![[0.0; MOST_COORDINATES]; nodes * coordinates];
        for (c, &(j, k)) in curvature.chunks_exact(stride).zip(&products) {
            for (node, c) in c[..nodes].iter().enumerate() {
                second[node * coordinates + j][k] += c;
                second[node * coordinates + k][j] += c;
            }
        }
        let mut largest = [0.0f64; MOST_COORDINATES];
        for (row, of) in second.iter().enumerate() {
            let most = &mut largest[row % coordinates];
            *most = most.max(of.iter().map(|of| of.abs()).sum());
        }
        let p = vec![[0.0; MOST_COORDINATES]; sectors];
        Self { nodes, curvature, stride, products, second, largest, coordinates, p }
    }

    /// Number of coordinates of a sector.
    pub(crate) fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Takes the coordinates of all sectors from behind the nodes in `linear`, `[sector][row]`. Returns an upper bound of Σ |slope| of any node.
    #[inline(always)]
    pub(crate) fn move_to(&mut self, linear: &[f64]) -> f64 {
        let mut steepest = 0.0f64;
        for (p, linear) in self.p.iter_mut().zip(linear.chunks_exact(self.stride)) {
            let mut bound = 0.0;
            for k in 0..self.coordinates {
                p[k] = linear[self.nodes + k];
                bound += self.largest[k] * p[k].abs();
            }
            steepest = if bound > steepest { bound } else { steepest };
        }
        steepest
    }

    /// Slopes of a node of a sector, zeros behind those by its coordinates.
    #[inline(always)]
    pub(crate) fn of(&self, sector: usize, node: usize) -> [f64; MOST_COORDINATES] {
        let mut slopes = [0.0; MOST_COORDINATES];
        let second = &self.second[node * self.coordinates..][..self.coordinates];
        for (second, p) in second.iter().zip(&self.p[sector]) {
            for (slope, second) in slopes.iter_mut().zip(second) {
                *slope += second * p;
            }
        }
        slopes
    }

    /// Adds the motion of the nodes of a sector when its coordinates move by `moved`.
    #[inline(always)]
    pub(crate) fn add(&self, sector: usize, moved: &[f64; MOST_COORDINATES], out: &mut [f64]) {
        let p = &self.p[sector];
        for (c, &(j, k)) in self.curvature.chunks_exact(self.stride).zip(&self.products) {
            add_column(c, p[j] * moved[k] + p[k] * moved[j], out);
        }
    }
}

/// Adds `by` times a column, both padded to whole vectors.
#[inline(always)]
pub(crate) fn add_column(column: &[f64], by: f64, out: &mut [f64]) {
    for (out, column) in out.as_chunks_mut::<LANES>().0.iter_mut().zip(column.as_chunks::<LANES>().0) {
        out.iter_mut().zip(column).for_each(|(out, c)| *out += c * by);
    }
}
