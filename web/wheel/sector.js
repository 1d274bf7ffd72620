// The skin of a sector, whose patches and sharp edges can be pointed at.

import { rgb, stage } from './stage.js';

/** Colours of parts by their role, which readers with any kind of colour vision can distinguish. */
export const COLOURS = {
  low: [0.34, 0.71, 0.91], high: [0, 0.45, 0.7], clamp: [0, 0.62, 0.45], contact: [0.9, 0.62, 0], line: [0.84, 0.2, 0], lit: [0.94, 0.89, 0.26],
};
const FREE = [0.62, 0.66, 0.72];

/** Pixels by which a pointer may move for its way to be a click. */
const STILL = 5;

/** Distance of the camera, in parts of that from which everything is in the picture however it is turned. */
const CLOSE = 0.75;

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / Math.hypot(...a));

/** Points of a look about their middle, z along the axis of rotation, and their reach. */
function placed({ positions, axis, contact_line: line }) {
  const z = unit(axis?.[1] ?? [0, 0, 1]);
  const x = unit(cross(Math.abs(z[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1], z));
  const frame = [x, cross(z, x), z];
  const points = new Float32Array(positions.length);
  for (let k = 0; k < positions.length; k += 3) {
    const at = positions.slice(k, k + 3);
    frame.forEach((direction, d) => { points[k + d] = dot(direction, at); });
  }
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  points.forEach((value, k) => {
    low[k % 3] = Math.min(low[k % 3], value);
    high[k % 3] = Math.max(high[k % 3], value);
  });
  const middle = low.map((value, d) => (value + high[d]) / 2);
  points.forEach((value, k) => { points[k] = value - middle[k % 3]; });
  const radius = Math.hypot(...high.map((value, d) => (value - low[d]) / 2));
  const up = line.reduce((sum, node) => sum + points[3 * node + 2], 0);
  return { points, radius, front: up >= 0, axes: [0, 1, 2].map((d) => frame.map((direction) => direction[d])) };
}

/** Everything of a look that does not change with the pointer. */
function bodyOf(look) {
  const triangles = new Uint32Array(look.triangles);
  const chains = look.chains.map((chain) => chain.nodes);
  const starts = [0];
  for (const patch of look.patches) starts.push(starts.at(-1) + patch.triangles);
  const ofPatch = (k) => triangles.subarray(3 * starts[k], 3 * starts[k + 1]);
  return { ...placed(look), triangles, chains, starts, ofPatch, look };
}

/** Lines from node to node. */
const segments = (nodes) => nodes.slice(1).flatMap((node, k) => [nodes[k], node]);

function joined(arrays) {
  const all = new Uint32Array(arrays.reduce((sum, array) => sum + array.length, 0));
  let at = 0;
  for (const array of arrays) {
    all.set(array, at);
    at += array.length;
  }
  return all;
}

/** Parts as they are drawn, the lit one above all others. */
function partsOf(body, lit) {
  const { look, ofPatch, chains } = body;
  const ofRole = (role) => joined(look.patches.flatMap((patch, k) => ((patch.role ?? null) === role ? [ofPatch(k)] : [])));
  const faces = [null, 'low', 'high', 'clamp', 'contact'].map((role) => ({
    name: role ?? 'free', mode: 'triangles', indices: ofRole(role), colour: [...(role ? COLOURS[role] : FREE), 1],
  }));
  const lines = (nodes, colour, nearer) => ({ name: 'edges', mode: 'lines', indices: new Uint32Array(nodes), colour: [...colour, 1], nearer });
  const dots = (nodes, colour, size) => ({ name: 'nodes', mode: 'points', indices: new Uint32Array(nodes), colour: [...colour, 1], nearer: 0.003, size });
  const bySet = look.patches.some((patch) => patch.role === 'clamp') ? [] : look.clamped;
  const onChain = lit?.chain === undefined ? [] : chains[lit.chain];
  return [
    ...faces,
    lit?.patch === undefined ? null : { name: 'lit', mode: 'triangles', indices: ofPatch(lit.patch), colour: [...COLOURS.lit, 1], nearer: 0.0005 },
    lines(chains.flatMap(segments), rgb('edge').map((part) => 0.6 * part), 0.001),
    lines(segments(look.contact_line), COLOURS.line, 0.002),
    dots(bySet, COLOURS.clamp, 4),
    dots(look.contact, COLOURS.line, 6),
    lines(segments(onChain), COLOURS.lit, 0.003),
    dots(onChain, COLOURS.lit, 6),
  ].filter((part) => part?.indices.length > 0);
}

/**
 * A stage with the skin of a sector; nothing where the browser cannot draw in 3D.
 * @param {any} first a look at the mesh, as the service answers
 * @param {{label: string, over: (part: any) => void, clicked: (part: any) => void}} what is called with `{patch}`, `{chain}` or null
 * @param {AbortSignal} signal
 */
export function sectorStage(first, { label, over, clicked }, signal) {
  let body = bodyOf(first);
  const shown = stage({ label, middle: 0, radius: CLOSE * body.radius, front: body.front, axes: body.axes }, signal);
  if (!shown) return null;
  let lit = null;
  let down = null;
  const draw = () => shown.show([{ points: body.points, real: null, imaginary: null, values: null, parts: partsOf(body, lit) }]);
  const light = (part) => {
    if (part?.patch === lit?.patch && part?.chain === lit?.chain) return;
    lit = part;
    draw();
  };
  const at = (event) => {
    const { triangle, chain } = shown.under(body, event);
    if (chain >= 0) return { chain };
    return triangle < 0 ? null : { patch: body.starts.findIndex((start) => start > triangle) - 1 };
  };
  shown.canvas.addEventListener('pointerdown', (event) => { down = event; });
  shown.canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0) return;
    const part = at(event);
    light(part);
    over(part);
  });
  shown.canvas.addEventListener('pointerleave', () => {
    light(null);
    over(null);
  });
  shown.canvas.addEventListener('click', (event) => {
    const part = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < STILL ? at(down) : null;
    if (part) clicked(part);
  });
  draw();
  return {
    element: shown.element,
    reset: shown.reset,
    light,
    /** Another look at the mesh, from the same side. */
    update(look) {
      body = bodyOf(look);
      lit = null;
      draw();
    },
  };
}
