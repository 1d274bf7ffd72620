// The wheel in 3D: fields of it, and its mesh in the casing.

import { api } from '../lib/api.js';
import { h, newId, replace } from '../lib/dom.js';
import { number } from '../lib/format.js';
import { problem } from '../lib/problem.js';
import { aboutAxis, extent } from './body.js';
import { casing } from './casing.js';
import { colourKey } from './colours.js';
import { probe } from './probe.js';
import { rgb, stage } from './stage.js';
import { readSurface } from './vtp.js';

/** The largest displacement as it is drawn at first, of the wheel's radius. */
const DRAWN = 0.06;

/** Revolutions a second at which recorded states are played. */
const SLOW = 0.125;

/** Whether somebody wants things to stay where they are. */
const calm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

/**
 * Shows a field: displacement drawn larger than it is, coloured by it or by stress.
 * @param {HTMLElement} element
 * @param {{path: string, query: any, animated: boolean, scalar: 'displacement' | 'von_mises', words: string, unit: string, length: string, label: string,
 *   limit?: {value: number, words: string} | null, contact?: any[], instants?: () => Promise<number[]>}} what where the field is read; whether it moves
 *   periodically; what colours show, as a name, in words and with its unit; the unit of length; a limit of what colours show; the casing, drawn as much
 *   larger as displacement; and the instants of a revolution that can be played
 * @param {AbortSignal} signal
 */
export async function showWheel(element, { path, query, animated, scalar, label, words, unit, length, limit, contact, instants }, signal) {
  replace(element, h('p', { class: 'quiet', role: 'status' }, 'Computing the field …'));
  const read = async (more) => readSurface(await api.text(path, { query: { ...query, ...more, format: 'vtp' }, signal }));
  const surface = await read({});
  if (signal.aborted) return;
  const body = aboutAxis(surface);
  const size = extent(body.points);
  let { values, most } = shares(surface.arrays, scalar);
  const shown = stage({ label, ...size, front: body.front, axes: body.axes, unit: length }, signal);
  if (!shown) {
    await drawing(element, path, query, signal);
    return;
  }
  const largest = largestOf(surface.arrays);
  const automatic = largest > 0 ? DRAWN * size.wheel / largest : 0;
  const line = cased(contact);
  let now = wheelBody(body, values);
  const draw = () => shown.show([now, axisBody(size), ...(line ? [casingBody(line, body, Number(slider.value) * automatic)] : [])]);
  const key = h('div');
  const rescaled = () => {
    shown.limit(limit ? limit.value / most : Infinity);
    replace(key, values ? colourKey(most, unit ? `${words}, ${unit}` : words, limit) : null);
  };
  // A field says after how many revolutions it is that of an instant: the casing has turned back by them.
  const turned = (notes) => shown.spin(-2 * Math.PI * Number(/after ([\d.]+) revolutions/.exec(notes.join(' '))?.[1] ?? 0));
  const notes = h('ul', { class: 'plain small quiet' });
  const tell = (all) => replace(notes, all.map((note) => h('li', {}, note)));
  shown.hide('edges', true);
  const moves = animated && body.imaginary !== null;
  const caption = h('span', {});
  const slider = h('input', { type: 'range', id: newId('scale'), min: 0, max: 4, step: 0.05, value: 1, 'aria-label': 'Displacement as drawn' });
  const scaled = () => {
    const factor = Number(slider.value) * automatic;
    shown.scale(factor);
    if (line) draw();
    replace(caption, `Displacement${line ? ' and clearance' : ''} drawn ${number(factor, 2)} times as large`);
  };
  slider.addEventListener('input', scaled);
  /** Reads the instants of a revolution, and plays them with what lies between them in a straight line. */
  async function revolve(status) {
    const frames = [];
    const all = await instants();
    for (const instant of all) {
      replace(status, `Reading instant ${frames.length + 1} of ${all.length} …`);
      const at = await read({ instant });
      frames.push({ real: body.displacement(at), ...shares(at.arrays, scalar), notes: at.notes });
    }
    most = Math.max(...frames.map((frame) => frame.most));
    frames.forEach((frame) => { frame.values = frame.values?.map((value) => (value < 0 ? value : value * frame.most / most)); });
    values = frames[0].values;
    rescaled();
    let last = -1;
    shown.pace(SLOW, (angle) => {
      const place = (angle / (2 * Math.PI) % 1) * frames.length;
      const k = Math.floor(place);
      if (k !== last) {
        last = k;
        const { real, values: shownValues, notes: said } = frames[k];
        values = shownValues;
        now = { ...wheelBody(body, values), real, imaginary: frames[(k + 1) % frames.length].real };
        draw();
        turned(said);
        tell(said);
      }
      return [1 - place + k, k - place];
    });
  }
  replace(element,
    notes,
    shown.element,
    key,
    h('div', { class: 'row' },
      moves ? playButton(shown) : null,
      instants ? revolution(shown, revolve, signal) : null,
      slider, caption),
    h('div', { class: 'row' },
      toggle('Edges of elements', false, (on) => shown.hide('edges', !on)),
      line ? casingToggle(shown) : null,
      halfToggle(shown),
      h('button', { type: 'button', on: { click: shown.reset } }, 'Reset view')),
    probe(shown, () => ({ ...now, triangles: body.triangles }), surface, length, (point) => (values?.[point] >= 0 ? `; ${words} ${number(values[point] * most)} ${unit}` : '')),
    hint());
  tell(surface.notes);
  turned(surface.notes);
  rescaled();
  draw();
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
  const shown = stage({ label: `Mesh of ${model.name}`, ...size, front: body.front, axes: body.axes, unit: model.units.length }, signal);
  if (!shown) {
    await drawing(element, `/v1/models/${model.id}/section`, {}, signal);
    return;
  }
  const wheel = wheelBody(body, null);
  const line = cased(contact);
  const draw = (factor) => shown.show([wheel, axisBody(size), ...(line ? [casingBody(line, body, factor)] : [])]);
  const least = line && Math.min(...line.map((place) => place.clearance));
  const slider = h('input', { type: 'range', id: newId('scale'), min: 1, max: Math.max(2, 0.15 * size.wheel / least), step: 1, value: Math.max(1, 0.05 * size.wheel / least), 'aria-label': 'Clearance as drawn' });
  const caption = h('span', {});
  const scaled = () => {
    draw(Number(slider.value));
    replace(caption, `Clearance and shape drawn ${number(Number(slider.value), 2)} times as large`);
  };
  slider.addEventListener('input', scaled);
  if (line) scaled();
  else draw(1);
  replace(element,
    shown.element,
    h('div', { class: 'row' },
      toggle('Edges of elements', true, (on) => shown.hide('edges', !on)),
      line ? [casingToggle(shown), slider, caption] : null,
      halfToggle(shown),
      h('button', { type: 'button', on: { click: shown.reset } }, 'Reset view')),
    probe(shown, () => body, surface, model.units.length, () => ''),
    hint());
}

/** The contact line with the clearance of each place, if it is known. */
function cased(contact) {
  const line = contact?.filter(({ clearance }) => clearance !== null && clearance !== undefined) ?? [];
  return line.length > 1 ? line : null;
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

/** The axis of rotation, dashed and dotted from before the wheel to behind it. */
function axisBody({ middle, wheel, radius }) {
  const reach = Math.sqrt(radius ** 2 - wheel ** 2) + 0.25 * wheel;
  const [dash, gap, dot] = [0.1, 0.03, 0.01].map((part) => part * wheel);
  const points = [];
  for (let z = -reach; z < reach; z += dash + dot + 2 * gap) {
    for (const [from, to] of [[z, z + dash], [z + dash + gap, z + dash + gap + dot]]) points.push(0, 0, middle + from, 0, 0, middle + to);
  }
  const indices = Uint32Array.from({ length: points.length / 3 }, (_, k) => k);
  return { points: new Float32Array(points), real: null, imaginary: null, values: null, parts: [{ name: 'axis', mode: 'lines', indices, colour: [...rgb('edge'), 1] }] };
}

/** The casing where the wheel is drawn: its first contact node says how those coordinates lie to the package's. */
function casingBody(line, body, factor) {
  const at = 3 * body.line.places[0];
  const [x, y, z] = body.points.subarray(at, at + 3);
  const shift = { z: z - line[0].position[2], theta: Math.atan2(y, x) - line[0].position[1] };
  const { points, triangles, edges } = casing(line, shift, factor);
  return {
    points, real: null, imaginary: null, values: null, spins: true,
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

/** Button that reads the states of a revolution when it is first asked to, and plays them. */
function revolution(shown, revolve, signal) {
  const status = h('span', { role: 'status' });
  const button = h('button', { type: 'button', on: { click: start } }, 'Play a revolution');
  async function start() {
    button.disabled = true;
    try {
      await revolve(status);
      replace(status);
      button.replaceWith(playButton(shown));
    } catch (error) {
      button.disabled = false;
      if (!signal.aborted) replace(status, problem(error));
    }
  }
  return [button, status];
}

const casingToggle = (shown) => toggle('Casing', true, (on) => ['casing', 'rims'].forEach((name) => shown.hide(name, !on)));
const halfToggle = (shown) => toggle('Half the wheel', false, shown.halve);

function toggle(words, on, change) {
  const box = h('input', { type: 'checkbox', checked: on, on: { change: () => change(box.checked) } });
  return h('label', {}, box, ' ', words);
}

function hint() {
  return h('p', { class: 'quiet small' }, 'Drag to turn, with shift to move; arrow keys turn, + and − zoom, 0 resets the view. The dash-dotted line is the axis of rotation.');
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
