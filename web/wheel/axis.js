// The axis of rotation of a surface, found from what repeats in every sector.

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const size = (a) => Math.hypot(...a);
const scaled = (a, factor) => a.map((value) => factor * value);

/**
 * Coordinates in which the axis is z. Of fewer than three sectors nothing tells, and they stay as they are.
 * @param {{points: Float64Array, arrays: any}} surface
 * @returns {{point: (p: number[]) => number[], vector: (v: number[]) => number[]}}
 */
export function axisFrame({ points, arrays }) {
  const same = { point: (p) => p, vector: (v) => v };
  if (!arrays.has('sector')) return same;
  const [ids, sectors] = [arrays.get('node'), arrays.get('sector')];
  const bySector = new Map();
  // A node that is far from the axis: the plane of its places is then well known.
  const farthest = widest(points, ids, sectors);
  for (let k = 0; k < ids.length; k += 1) {
    if (ids[k] === farthest) bySector.set(sectors[k], [...points.subarray(3 * k, 3 * k + 3)]);
  }
  const places = [...bySector].sort(([a], [b]) => a - b).map(([, place]) => place);
  if (places.length < 3) return same;
  const middle = scaled(places.reduce((sum, place) => sum.map((value, k) => value + place[k])), 1 / places.length);
  let normal = [0, 0, 0];
  for (let k = 0; k < places.length; k += 1) {
    const next = places[(k + 1) % places.length];
    normal = cross(minus(places[k], middle), minus(next, middle)).map((value, axis) => value + normal[axis]);
  }
  const length = size(normal);
  if (!(length > 0)) return same;
  const z = scaled(normal, 1 / length);
  const helper = Math.abs(z[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
  const x = scaled(cross(helper, z), 1 / size(cross(helper, z)));
  const y = cross(z, x);
  const vector = (v) => [dot(v, x), dot(v, y), dot(v, z)];
  return { vector, point: (p) => vector(minus(p, middle)) };
}

/** The node of the first sector that is farthest from the others of its kind. */
function widest(points, ids, sectors) {
  const first = new Map();
  let found = ids[0];
  let most = -1;
  for (let k = 0; k < ids.length; k += 1) {
    if (sectors[k] === 0) first.set(ids[k], k);
    else if (sectors[k] === 1 && first.has(ids[k])) {
      const at = first.get(ids[k]);
      const apart = Math.hypot(points[3 * k] - points[3 * at], points[3 * k + 1] - points[3 * at + 1], points[3 * k + 2] - points[3 * at + 2]);
      if (apart > most) [most, found] = [apart, ids[k]];
    }
  }
  return found;
}
