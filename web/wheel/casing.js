// The casing at rest around the contact line, its distance and its lobes drawn larger than they are.

/** Sections around the axis. */
const AROUND = 180;

/**
 * A surface of revolution, translucent, with a line at each edge.
 * @param {{position: number[], normal: number[], clearance: number}[]} line contact nodes in (r, θ, z), unit normals in the same components
 * @param {{count: number, amplitude: number, width_rad: number, phase_rad?: number} | null} lobes
 * @param {{z: number, theta: number}} shift from the package's coordinates to those that are drawn
 * @param {number} factor by which distances are exaggerated
 */
export function casing(line, lobes, shift, factor) {
  const points = new Float32Array(3 * AROUND * line.length);
  const triangles = [];
  const edges = [];
  for (let around = 0; around < AROUND; around += 1) {
    const angle = 2 * Math.PI * around / AROUND;
    const height = lobes ? restriction(lobes, angle) : 0;
    line.forEach(({ position: [r, , z], normal, clearance }, k) => {
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

/** Height of the lobes at an angle of the fixed frame: equal Gaussian bumps. */
function restriction({ count, amplitude, width_rad: width, phase_rad: phase = 0 }, angle) {
  let height = 0;
  for (let lobe = 0; lobe < count; lobe += 1) {
    const apart = angle - phase - 2 * Math.PI * lobe / count;
    const wrapped = Math.atan2(Math.sin(apart), Math.cos(apart));
    height += amplitude * Math.exp(-((wrapped / width) ** 2));
  }
  return height;
}
