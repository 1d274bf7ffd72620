// The casing at rest around the contact line, its distance and its shape drawn larger than they are.

/** Sections around the axis. */
const AROUND = 360;

/**
 * A surface of revolution, translucent, with a line at each edge.
 * @param {{position: number[], normal: number[], clearance: number, heights?: number[]}[]} line contact nodes in (r, θ, z), unit normals
 *   in the same components, heights of the casing at equal angles
 * @param {{z: number, theta: number}} shift from the package's coordinates to those that are drawn
 * @param {number} factor by which distances are exaggerated
 */
export function casing(line, shift, factor) {
  const points = new Float32Array(3 * AROUND * line.length);
  const triangles = [];
  const edges = [];
  for (let around = 0; around < AROUND; around += 1) {
    const angle = 2 * Math.PI * around / AROUND;
    line.forEach(({ position: [r, , z], normal, clearance, heights }, k) => {
      const height = heights ? heights[Math.floor(heights.length * around / AROUND)] : 0;
      const distance = factor * (clearance - height);
      const radius = r + distance * normal[0];
      const at = 3 * (around * line.length + k);
      points.set([radius * Math.cos(angle + shift.theta), radius * Math.sin(angle + shift.theta), z + distance * normal[2] + shift.z], at);
      const next = ((around + 1) % AROUND) * line.length + k;
      const here = around * line.length + k;
      if (k + 1 < line.length) triangles.push(here, next, here + 1, next, next + 1, here + 1);
      if (k === 0 || k + 1 === line.length) edges.push(here, next);
    });
  }
  return { points, triangles: new Uint32Array(triangles), edges: new Uint32Array(edges) };
}
