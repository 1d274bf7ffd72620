//! Structure of the factor: the rows that each front eliminates, and the fronts to which it passes its update.

use std::ops::Range;

use faer::Side;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};

/// The elimination tree of fronts for one sparsity pattern and order.
#[derive(Debug, Default)]
pub struct Analysis {
    /// Number of rows of the matrix.
    pub(super) size: usize,
    /// Number of rows that are eliminated; the boundary follows.
    pub(super) eliminated: usize,
    /// Fronts in elimination order: children before parents.
    pub(super) fronts: Vec<Front>,
    /// Fronts whose updates reach the boundary.
    pub(super) roots: Vec<usize>,
    /// Disjoint subtrees, each a run of consecutive fronts ending with its root.
    pub(super) subtrees: Vec<Vec<usize>>,
    /// Fronts above the subtrees.
    pub(super) top: Vec<usize>,
}

/// Consecutive rows eliminated together.
#[derive(Debug)]
pub(super) struct Front {
    /// First row eliminated.
    pub(super) start: usize,
    /// Number of rows eliminated.
    pub(super) pivots: usize,
    /// Rows below the pivots that the pivots reach, ascending.
    pub(super) rows: Vec<usize>,
    /// Fronts whose updates are added to this one.
    pub(super) children: Vec<usize>,
}

impl Front {
    /// Row of the matrix at position `i` of the front.
    pub(super) fn row(&self, i: usize) -> usize {
        if i < self.pivots { self.start + i } else { self.rows[i - self.pivots] }
    }

    /// Number of entries of L and L_F in this front.
    fn entries(&self) -> usize {
        self.pivots * (self.pivots + self.rows.len())
    }

    /// Cost of a solve, in numbers of L, including every row that is read and written.
    fn solve_cost(&self) -> usize {
        self.entries() - self.pivots * self.pivots / 2 + ROW_COST * (self.pivots + self.rows.len())
    }

    /// Multiplications to eliminate the front.
    fn work(&self) -> f64 {
        let (p, r) = (self.pivots as f64, self.rows.len() as f64);
        p * p * p / 3.0 + p * p * r + p * r * r
    }
}

/// Cost of reading and writing a row in a solve, in numbers of L.
const ROW_COST: usize = 16;

/// Share of the whole work below which subtrees are not split further: enough pieces for a few threads, and never so many that their
/// updates fill the memory.
const SUBTREE_SHARE: f64 = 1.0 / 24.0;

impl Analysis {
    /// Analyses `pattern` (square, both triangles, rows in elimination order): the first `eliminated` rows are to go,
    /// the rest is the boundary. The order should be postordered ([`postorder`]), or fronts stay small.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, usize>, eliminated: usize) -> Self {
        let size = pattern.ncols();
        let mut fronts = Vec::new();
        let identity: Vec<usize> = (0..size).collect();
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        // SymbolicOrdering::Identity takes the wrong triangle in faer 0.24.
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&identity, &identity, size));
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, order, params)
            .unwrap_or_else(|_| panic!("out of memory in the symbolic factorisation of {size} rows"));
        let SymbolicCholeskyRaw::Supernodal(supernodes) = symbolic.raw() else {
            unreachable!("the supernodal form was demanded")
        };
        let mut front_of = vec![usize::MAX; eliminated];
        for s in 0..supernodes.n_supernodes() {
            let (start, end) = (supernodes.supernode_begin()[s], supernodes.supernode_end()[s]);
            if start >= eliminated {
                break;
            }
            // A supernode across the border is cut there.
            let pivots = end.min(eliminated) - start;
            let rows =
                (start + pivots..end).chain(supernodes.supernode(s).pattern().iter().copied()).collect();
            front_of[start..start + pivots].fill(fronts.len());
            fronts.push(Front { start, pivots, rows, children: Vec::new() });
        }
        for child in 0..fronts.len() {
            if let Some(&row) = fronts[child].rows.first().filter(|&&row| row < eliminated) {
                fronts[front_of[row]].children.push(child);
            }
        }
        let fronts = merged(fronts);
        let reaches = |&front: &usize| fronts[front].rows.first().is_some_and(|&row| row >= eliminated);
        let roots = (0..fronts.len()).filter(reaches).collect();
        let (subtrees, top) = split(&fronts);
        Self { size, eliminated, fronts, roots, subtrees, top }
    }

    /// Multiplications of the elimination.
    pub fn work(&self) -> f64 {
        self.fronts.iter().map(Front::work).sum()
    }

    /// Number of entries in L and L_F.
    pub fn factor_entries(&self) -> usize {
        self.fronts.iter().map(Front::entries).sum()
    }

    /// Numbers held at once beside the factor while it is made, at most: updates on their way up, and the boundary.
    pub fn working_entries(&self) -> usize {
        let square = |front: usize| self.fronts[front].rows.len().pow(2);
        // Subtrees are done before anything above them; then children are the last updates made.
        let mut held: usize =
            self.subtrees.iter().filter_map(|subtree| subtree.last()).map(|&root| square(root)).sum();
        let mut most = held;
        for &front in &self.top {
            held += square(front);
            most = most.max(held);
            held -= self.fronts[front].children.iter().map(|&child| square(child)).sum::<usize>();
        }
        most + (self.size - self.eliminated).pow(2)
    }
}

/// Merges a front with all below it wherever a solve is then cheaper: zeros are multiplied, but fewer rows are moved.
fn merged(fronts: Vec<Front>) -> Vec<Front> {
    let mut kept: Vec<Front> = Vec::with_capacity(fronts.len());
    // Where each front has gone.
    let mut place = Vec::with_capacity(fronts.len());
    for mut front in fronts {
        front.children.iter_mut().for_each(|child| *child = place[*child]);
        let first = kept.len() - front.children.len();
        // Their rows then lie just before its own.
        let last_and_leaves = front.children.iter().copied().eq(first..kept.len())
            && kept[first..].iter().all(|child| child.children.is_empty());
        if let Some(child) = kept.get(first).filter(|_| last_and_leaves) {
            let (start, pivots) = (child.start, front.start + front.pivots - child.start);
            let separate: usize = kept[first..].iter().chain([&front]).map(Front::solve_cost).sum();
            let whole = Front { start, pivots, rows: front.rows, children: Vec::new() };
            if whole.solve_cost() <= separate {
                kept.truncate(first);
                front = whole;
            } else {
                front.rows = whole.rows;
            }
        }
        place.push(kept.len());
        kept.push(front);
    }
    kept
}

/// Disjoint subtrees of small work, as runs of consecutive fronts, and the fronts above them.
fn split(fronts: &[Front]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let mut work: Vec<f64> = fronts.iter().map(Front::work).collect();
    // The first front of the subtree below each.
    let mut first: Vec<usize> = (0..fronts.len()).collect();
    let mut consecutive = vec![true; fronts.len()];
    for (index, front) in fronts.iter().enumerate() {
        let mut next = index;
        for &child in front.children.iter().rev() {
            work[index] += work[child];
            consecutive[index] &= consecutive[child] && child + 1 == next;
            next = first[child];
        }
        first[index] = next;
    }
    let whole: f64 = fronts.iter().map(Front::work).sum();
    let small = |index: usize| consecutive[index] && work[index] <= SUBTREE_SHARE * whole;
    let mut below = vec![false; fronts.len()];
    let mut subtrees = Vec::new();
    let mut top = Vec::new();
    for index in (0..fronts.len()).rev() {
        if below[index] {
            continue;
        }
        if small(index) {
            below[first[index]..=index].fill(true);
            subtrees.push((first[index]..=index).collect());
        } else {
            top.push(index);
        }
    }
    subtrees.reverse();
    top.reverse();
    (subtrees, top)
}

/// Postorder of the elimination tree of the rows in `range` of `pattern` (both triangles, in elimination order):
/// `order[new] = old`, the same fill, with every subtree in consecutive rows. Rows outside `range` keep their place.
pub fn postorder(pattern: SymbolicSparseColMatRef<'_, usize>, range: Range<usize>) -> Vec<usize> {
    const NONE: usize = usize::MAX;
    // Liu's algorithm with path compression.
    let mut parent = vec![NONE; range.end];
    let mut ancestor = vec![NONE; range.end];
    for column in range.clone() {
        for row in pattern.row_idx_of_col(column).filter(|&row| row < column && range.contains(&row)) {
            let mut node = row;
            while node != column {
                let next = std::mem::replace(&mut ancestor[node], column);
                if next == NONE {
                    parent[node] = column;
                    break;
                }
                node = next;
            }
        }
    }
    let mut first_child = vec![NONE; range.end];
    let mut sibling = vec![NONE; range.end];
    let mut roots = Vec::new();
    for node in range.clone().rev() {
        if parent[node] == NONE {
            roots.push(node);
        } else {
            sibling[node] = std::mem::replace(&mut first_child[parent[node]], node);
        }
    }
    let mut order: Vec<usize> = (0..range.start).collect();
    let mut stack = roots;
    let mut entered = vec![false; range.end];
    while let Some(&node) = stack.last() {
        if std::mem::replace(&mut entered[node], true) || first_child[node] == NONE {
            order.push(node);
            stack.pop();
            continue;
        }
        let from = stack.len();
        let mut child = first_child[node];
        while child != NONE {
            stack.push(child);
            child = sibling[child];
        }
        stack[from..].reverse();
    }
    order.extend(range.end..pattern.ncols());
    order
}
