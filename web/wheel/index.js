// The wheel in 3D: fields of it, and its mesh in the casing.

import { api } from '../lib/api.js';
import { h, newId, replace } from '../lib/dom.js';
import { number } from '../lib/format.js';
import { aboutAxis, extent } from './body.js';
import { casing } from './casing.js';
import { colourKey } from './colours.js';
import { rgb, stage } from './stage.js';
import { readSurface } from './vtp.js';

/** The largest displacement as it is drawn at first, of the wheel's radius. */
const DRAWN = 0.06;

/** Whether somebody wants things to stay where they are. */
const calm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

/**
 * Shows a field: displacement drawn larger than it is, coloured by it or by stress.
 * @param {HTMLElement} element
 * @param {{path: string, query: any, animated: boolean, scalar: 'displacement' | 'von_mises', words: string, label: string}} what
 *   where the field is read; whether it moves periodically; what colours show, as a name and in words
 * @param {AbortSignal} signal
 */
export async function showWheel(element, { path, query, animated, scalar, label, words }, signal) {
  replace(element, h('p', { class: 'quiet', role: 'status' }, 'Computing the field …'));
  const surface = readSurface(await api.text(path, { query: { ...query, format: 'vtp' }, signal }));
  if (signal.aborted) return;
  const body = aboutAxis(surface);
  const size = extent(body.points);
  const { values, most } = shares(surface.arrays, scalar);
  const shown = stage({ label, ...size, front: body.front }, signal);
  if (!shown) {
    await drawing(element, path, query, signal);
    return;
  }
  const largest = largestOf(surface.arrays);
  const automatic = largest > 0 ? DRAWN * size.wheel / largest : 0;
  shown.show([wheelBody(body, values)]);
  shown.hide('edges', true);
  const moves = animated && body.imaginary !== null;
  const caption = h('span', {});
  const slider = h('input', { type: 'range', id: newId('scale'), min: 0, max: 4, step: 0.05, value: 1, 'aria-label': 'Displacement as drawn' });
  const scaled = () => {
    const factor = Number(slider.value) * automatic;
    shown.scale(factor);
    replace(caption, `Displacement drawn ${number(factor, 2)} times as large`);
  };
  slider.addEventListener('input', scaled);
  replace(element,
    h('ul', { class: 'plain small quiet' }, surface.notes.map((note) => h('li', {}, note))),
    shown.canvas,
    values ? colourKey(most, words) : null,
    h('div', { class: 'row' },
      moves ? playButton(shown) : null,
      slider, caption,
      toggle('Edges of elements', false, (on) => shown.hide('edges', !on)),
      h('button', { type: 'button', on: { click: shown.reset } }, 'Reset view')),
    hint());
  scaled();
}

/**
 * Shows a mesh with its contact line, and the casing of a sweep if there is one.
 * @param {HTMLElement} element
 * @param {any} model as the service tells of it
 * @param {any[] | null} contact places with clearances and heights of the casing, as `/section` tells them
 * @param {AbortSignal} signal
 */
export async function showMesh(element, model, contact, signal) {
  replace(element, h('p', { class: 'quiet', role: 'status' }, 'Reading the mesh …'));
  const path = `/v1/models/${model.id}/mesh`;
  const surface = readSurface(await api.text(path, { query: { format: 'vtp' }, signal }));
  if (signal.aborted) return;
  const body = aboutAxis(surface);
  const size = extent(body.points);
  const shown = stage({ label: `Mesh of ${model.name}`, ...size, front: body.front }, signal);
  if (!shown) {
    await drawing(element, `/v1/models/${model.id}/section`, {}, signal);
    return;
  }
  const wheel = wheelBody(body, null);
  const line = contact?.filter((place) => place.clearance !== null && place.clearance !== undefined) ?? [];
  const draw = (factor) => shown.show(line.length > 1 ? [wheel, casingBody(line, body, factor)] : [wheel]);
  const least = Math.min(...line.map((place) => place.clearance));
  const slider = h('input', { type: 'range', id: newId('scale'), min: 1, max: Math.max(2, 0.15 * size.wheel / least), step: 1, value: Math.max(1, 0.05 * size.wheel / least), 'aria-label': 'Clearance as drawn' });
  const caption = h('span', {});
  const scaled = () => {
    draw(Number(slider.value));
    replace(caption, `Clearance and shape drawn ${number(Number(slider.value), 2)} times as large`);
  };
  slider.addEventListener('input', scaled);
  if (line.length > 1) scaled();
  else draw(1);
  replace(element,
    shown.canvas,
    h('div', { class: 'row' },
      toggle('Edges of elements', true, (on) => shown.hide('edges', !on)),
      line.length > 1 ? [toggle('Casing', true, (on) => {
        shown.hide('casing', !on);
        shown.hide('rims', !on);
      }), slider, caption] : null,
      h('button', { type: 'button', on: { click: shown.reset } }, 'Reset view')),
    hint());
}

function wheelBody(body, values) {
  const own = rgb('edge');
  return {
    points: body.points, real: body.real, imaginary: body.imaginary, values,
    parts: [
      { name: 'faces', mode: 'triangles', indices: body.triangles, colour: [0.62, 0.66, 0.72, 1] },
      { name: 'edges', mode: 'lines', indices: body.edges, colour: [...own.map((part) => 0.6 * part), 1], nearer: 0.0004 },
      { name: 'line', mode: 'lines', indices: body.line.pairs, colour: [0.84, 0.37, 0, 1], nearer: 0.002 },
      { name: 'nodes', mode: 'points', indices: body.line.all, colour: [0.84, 0.37, 0, 1], nearer: 0.002, size: 5 },
    ].filter((part) => part.indices.length > 0),
  };
}

/** The casing where the wheel is drawn: its first contact node says how those coordinates lie to the package's. */
function casingBody(line, body, factor) {
  const at = 3 * body.line.places[0];
  const [x, y, z] = body.points.subarray(at, at + 3);
  const shift = { z: z - line[0].position[2], theta: Math.atan2(y, x) - line[0].position[1] };
  const { points, triangles, edges } = casing(line, shift, factor);
  return {
    points, real: null, imaginary: null, values: null,
    parts: [
      { name: 'rims', mode: 'lines', indices: edges, colour: [0, 0.45, 0.7, 1] },
      { name: 'casing', mode: 'triangles', indices: triangles, colour: [0.2, 0.6, 0.85, 0.3] },
    ],
  };
}

/** The scalar of every point as a share of the largest, and that. */
function shares(arrays, scalar) {
  const name = scalar === 'displacement' && arrays.has('displacement_amplitude') ? 'displacement_amplitude' : scalar;
  if (!arrays.has(name)) return { values: null, most: 0 };
  const raw = arrays.get(name);
  const wide = name === 'displacement' ? 3 : 1;
  const values = new Float32Array(raw.length / wide);
  let most = 0;
  for (let k = 0; k < values.length; k += 1) {
    const value = wide === 3 ? Math.hypot(raw[3 * k], raw[3 * k + 1], raw[3 * k + 2]) : raw[k];
    values[k] = Number.isFinite(value) ? value : -1;
    most = Math.max(most, values[k]);
  }
  if (arrays.has('excluded') && scalar === 'von_mises') {
    const excluded = arrays.get('excluded');
    most = 0;
    values.forEach((value, k) => {
      if (excluded[k] === 1) values[k] = -1;
      else most = Math.max(most, value);
    });
  }
  return { values: most > 0 ? values.map((value) => (value < 0 ? -1 : value / most)) : values, most };
}

function largestOf(arrays) {
  return shares(arrays, 'displacement').most;
}

function playButton(shown) {
  let playing = !calm();
  const button = h('button', { type: 'button', 'aria-pressed': String(playing) });
  const set = () => {
    button.setAttribute('aria-pressed', String(playing));
    button.textContent = playing ? 'Pause' : 'Play';
    shown.play(playing);
  };
  button.addEventListener('click', () => {
    playing = !playing;
    set();
  });
  set();
  return button;
}

function toggle(words, on, change) {
  const box = h('input', { type: 'checkbox', checked: on, on: { change: () => change(box.checked) } });
  return h('label', {}, box, ' ', words);
}

function hint() {
  return h('p', { class: 'quiet small' }, 'Drag to turn, with shift to move; arrow keys turn, + and − zoom, 0 resets the view.');
}

/** The service's drawing, where the browser draws nothing in 3D. */
async function drawing(element, path, query, signal) {
  const blob = await api.blob(path, { query: { ...query, format: 'svg' }, signal });
  const address = URL.createObjectURL(blob);
  signal.addEventListener('abort', () => URL.revokeObjectURL(address));
  replace(element,
    h('p', { class: 'note' }, 'This browser does not support WebGL 2, which the 3D view needs; the service has drawn this picture instead.'),
    h('img', { class: 'drawing', src: address, alt: 'Drawing of the wheel' }));
}
