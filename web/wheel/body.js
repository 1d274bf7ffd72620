// A surface as bodies that are drawn: about its axis, in single precision, with its contact line.

import { axisFrame } from './axis.js';

/** Extent of a surface about its axis. */
export function extent(points) {
  let [low, high, radius] = [Infinity, -Infinity, 0];
  for (let k = 0; k < points.length; k += 3) {
    low = Math.min(low, points[k + 2]);
    high = Math.max(high, points[k + 2]);
    radius = Math.max(radius, Math.hypot(points[k], points[k + 1]));
  }
  const middle = (low + high) / 2;
  return { middle, wheel: radius, radius: Math.hypot(radius, (high - low) / 2) };
}

function turned(values, turn) {
  const out = new Float32Array(values.length);
  for (let k = 0; k < values.length; k += 3) out.set(turn([values[k], values[k + 1], values[k + 2]]), k);
  return out;
}

/**
 * A surface about its axis: points, displacement (that of another field on it as well), and pairs of points along the contact line.
 * @param {ReturnType<import('./vtp.js').readSurface>} surface
 */
export function aboutAxis(surface) {
  const frame = axisFrame(surface);
  const vectors = (name, { arrays } = surface) => (arrays.has(name) ? turned(arrays.get(name), frame.vector) : null);
  const points = turned(surface.points, frame.point);
  const line = contactLine(surface);
  const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(frame.vector);
  const displacement = (other) => vectors('displacement', other);
  return { points, axes, displacement, real: displacement(surface), imaginary: vectors('displacement_imaginary'), line, front: opensUp(points, line), triangles: surface.triangles, edges: surface.edges };
}

/** Points of the contact lines in their order: pairs to join, and all of them. */
function contactLine({ arrays }) {
  if (!arrays.has('contact')) return { pairs: new Uint32Array(0), all: new Uint32Array(0), places: [] };
  const [contact, sectors] = [arrays.get('contact'), arrays.get('sector')];
  const lines = new Map();
  for (let k = 0; k < contact.length; k += 1) {
    if (contact[k] === 0) continue;
    if (!lines.has(sectors[k])) lines.set(sectors[k], []);
    lines.get(sectors[k]).push([contact[k], k]);
  }
  const pairs = [];
  const all = [];
  for (const line of lines.values()) {
    line.sort(([a], [b]) => a - b);
    line.forEach(([place, point], index) => {
      all.push(point);
      if (index > 0 && place === line[index - 1][0] + 1) pairs.push(line[index - 1][1], point);
    });
  }
  const first = [...(lines.get(0) ?? lines.values().next().value ?? [])].map(([, point]) => point);
  return { pairs: new Uint32Array(pairs), all: new Uint32Array(all), places: first };
}

/** Whether the blades are on the side where z is positive. */
function opensUp(points, { all }) {
  if (all.length === 0) return true;
  const { middle } = extent(points);
  let sum = 0;
  for (const point of all) sum += points[3 * point + 2] - middle;
  return sum >= 0;
}
