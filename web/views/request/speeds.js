// Speeds of a request over a small Campbell diagram of its model, with the operating ranges as bands.

import { api, submit } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { follow } from '../../lib/events.js';
import { count, number, rpm, speed } from '../../lib/format.js';
import { PALETTE } from '../../lib/plot.js';
import { problem } from '../../lib/problem.js';
import { drawing, line, s, words } from '../../lib/svg.js';
import { OF_SPEED } from '../../lib/units.js';
import { rangesOf } from './operation.js';
import { speedsOf } from './sensible.js';

const [WIDTH, HEIGHT] = [760, 300];
const PLOT = { left: 64, right: WIDTH - 10, top: 16, bottom: HEIGHT - 40 };
/** Modal analyses of the model that are looked at for one with the lobes of the request. */
const LOOKED_AT = 5;
/** Crossings within a range that are told one by one. */
const TOLD = 5;
/** Ticks of a range that are drawn. */
const MOST = 500;
/** Speeds of an analysis. */
const COUNT = 25;

const isNumber = Number.isFinite;
const toRadS = (value, unit) => value / (OF_SPEED[unit] ?? 1);

/** Speeds of one range, list or course. */
function named({ from, to, count: n, values, value, points, unit }) {
  const steps = Math.min(Math.max(1, (n || 2) - 1), MOST);
  const range = isNumber(from) && isNumber(to) ? Array.from({ length: steps + 1 }, (_, k) => from + ((to - from) * k) / steps) : [];
  const all = values ?? (isNumber(value) ? [value] : points?.map((point) => point.speed) ?? range);
  return Array.isArray(all) ? all.filter(isNumber).map((each) => toRadS(each, unit)) : [];
}

/** All speeds that a request names, rad/s, those of a range between its ends, too. */
export function askedSpeeds({ speeds, speed: one }) {
  return [speeds, one].flat().filter(Boolean).flatMap(named);
}

/** A step that divides an axis into a handful of round parts. */
function step(most) {
  const power = 10 ** Math.floor(Math.log10(most / 4));
  return [1, 2, 5, 10].map((each) => each * power).find((each) => most / each <= 6);
}

/** The drawing; a family that has no frequency at a speed leaves it out there. */
function diagram(campbell, ranges, asked) {
  const speeds = campbell?.speeds_rad_s ?? [];
  const right = 1.02 * Math.max(1, ...speeds, ...asked, ...ranges.map(({ highest: end }) => end));
  const waves = campbell?.waves;
  const tables = waves ? [['forward, ', waves.forward_hz], ['backward, ', waves.backward_hz]] : campbell ? [['', campbell.frequencies_hz]] : [];
  const highest = 1.05 * Math.max(1, ...tables.flatMap(([, table]) => table.flat(2)).filter(isNumber));
  const x = (omega) => PLOT.left + (omega / right) * (PLOT.right - PLOT.left);
  const y = (hz) => PLOT.bottom - (hz / highest) * (PLOT.bottom - PLOT.top);
  const ticks = (most, place) => Array.from({ length: Math.floor(most / step(most)) + 1 }, (_, k) => place(k * step(most)));
  const band = (from, to, kind) => s('rect', { class: kind, x: x(Math.max(0, from)), y: PLOT.top, width: Math.max(1, x(to) - x(Math.max(0, from))), height: PLOT.bottom - PLOT.top });
  const families = tables.flatMap(([wave, table]) => table[0].flatMap((list, diameter) => list.map((_, family) => {
    const points = speeds.map((omega, k) => [omega, table[k][diameter][family]]).filter(([, hz]) => isNumber(hz)).map(([omega, hz]) => [x(omega), y(hz)]);
    return s('path', { class: 'family', color: PALETTE[family % PALETTE.length], d: line(points) }, s('title', {}, `${wave}nodal diameter ${diameter}, family ${family + 1}`));
  })));
  const crossings = (campbell?.driven_crossings ?? []).filter((one) => one.speed_rad_s <= right && one.speed_rad_s > 0);
  const dots = crossings.map((one) => s('circle', { class: 'crossing', cx: x(one.speed_rad_s), cy: y(one.frequency_hz), r: 3.5 },
    s('title', {}, `${speed(one.speed_rad_s)}: engine order ${one.engine_order}, nodal diameter ${one.nodal_diameter}, family ${one.family}, ${number(one.frequency_hz, 5)} Hz`)));
  // Lines of engine orders from rest to where they leave the diagram, with their numbers where these have room.
  let labelled = 0;
  const orders = [...new Set(crossings.map((one) => one.engine_order))].sort((a, b) => b - a).map((order) => {
    const end = Math.min(right, (highest * 2 * Math.PI) / order);
    const [ex, ey] = [x(end), y((order * end) / (2 * Math.PI))];
    const isClose = end < right && ex < labelled + 22;
    if (!isClose) labelled = ex;
    return [s('path', { class: 'order', d: line([[x(0), y(0)], [ex, ey]]) }), isClose ? null : words(ex + (end < right ? 3 : -16), ey + (end < right ? 10 : -3), order)];
  });
  return drawing('Speeds, operating ranges and natural frequencies', WIDTH, HEIGHT,
    ranges.map(({ from, to, lowest, highest: end }) => [band(lowest, end, 'aside'), band(from, to, 'range')]),
    s('path', { class: 'frame', d: `M${PLOT.left} ${PLOT.top}V${PLOT.bottom}H${PLOT.right}` }),
    ticks(rpm(right), (value) => words(x(value / rpm(1)), PLOT.bottom + 26, number(value, 6), { 'text-anchor': 'middle' })),
    campbell ? ticks(highest, (value) => words(PLOT.left - 6, y(value) + 4, number(value, 6), { 'text-anchor': 'end' })) : null,
    words(PLOT.right, HEIGHT - 2, 'rpm', { 'text-anchor': 'end' }), campbell ? words(4, 12, 'Hz') : null,
    orders, families, dots,
    asked.map((omega) => s('path', { class: 'asked', d: `M${x(omega).toFixed(1)} ${PLOT.bottom}v10` })),
    ranges.map(({ name, from, to }, k) => words((x(from) + x(to)) / 2, PLOT.bottom - 6 - 14 * (k % 3), name, { 'text-anchor': 'middle', class: 'of-range' })));
}

/** Crossings within each range, in words. */
function inRanges(campbell, ranges) {
  const { driven_crossings: all } = campbell;
  return ranges.map(({ name, lowest, highest }) => {
    const inside = all.filter(({ speed_rad_s: at }) => at >= lowest && at <= highest).toSorted((a, b) => a.speed_rad_s - b.speed_rad_s);
    const some = inside.slice(0, TOLD).map((one) => `${speed(one.speed_rad_s)} (order ${one.engine_order}, nodal diameter ${one.nodal_diameter})`);
    const more = inside.length > TOLD ? `, and ${inside.length - TOLD} more` : '';
    return h('li', {}, h('strong', {}, `${name || 'Range'}: `), inside.length === 0 ? 'no crossing.' : `${count(inside.length, 'crossing')}: ${some.join(', ')}${more}.`);
  });
}

/**
 * The diagram, made anew by `show(request)`; where the model has no modal analysis a button asks for one.
 * @param {any} model
 * @param {AbortSignal} signal
 */
export function speedsOver(model, signal) {
  const picture = h('div', { class: 'sketches' });
  const told = h('div', { class: 'small' });
  const state = h('div', { role: 'status' });
  const start = h('button', { type: 'button', on: { click: analyse } }, 'Compute natural frequencies');
  const element = h('div', {}, picture, told, h('div', { class: 'row' }, start, state));
  /** Diagrams of analyses by their jobs, newest first. */
  let known = [];
  let last = null;
  find().catch(() => {});
  return { element, show };

  async function find() {
    const { jobs } = await api.get('/v1/jobs', { query: { kind: 'modal_analysis', status: 'successful', model: model.id, limit: LOOKED_AT }, signal });
    known = await Promise.all(jobs.map(({ id }) => api.get(`/v1/jobs/${id}/campbell`, { signal })));
    if (last) show(last);
  }

  function lobesOf(request) {
    return request.scene?.casing?.lobes?.count ?? request.lobes ?? 2;
  }

  function isSplit(request) {
    return Boolean(request.scene?.coriolis ?? request.coriolis);
  }

  function show(request) {
    last = request;
    const ranges = rangesOf(request);
    const lobes = lobesOf(request);
    const fits = known.find(({ settings }) => settings.lobes === lobes && Boolean(settings.coriolis) === isSplit(request));
    const campbell = fits ?? known[0] ?? null;
    replace(picture, diagram(campbell, ranges, askedSpeeds(request)));
    start.hidden = Boolean(fits) || !isNumber(lobes);
    const forces = model.gyroscopic ? `, ${isSplit(request) ? 'with' : 'without'} Coriolis forces` : '';
    start.textContent = campbell ? `Compute for ${count(lobes, 'lobe')}${forces}` : 'Compute natural frequencies';
    replace(told,
      h('p', { class: 'quiet' }, campbell
        ? `Lines: natural frequencies, a colour for each family; dashed: engine orders. Dots: where an engine order of ${count(campbell.settings.lobes, 'lobe')} meets a mode that it drives. Ticks below: the speeds asked for.${ranges.length > 0 ? ' Bands: operating ranges, with their separation.' : ''}`
        : 'Ticks: the speeds asked for. Natural frequencies of this model have not been computed yet.'),
      ranges.length > 0 && campbell ? h('ul', {}, inRanges(campbell, ranges)) : null);
  }

  async function analyse() {
    start.disabled = true;
    const { to } = speedsOf(model);
    const asked = { model: model.id, speeds: { from: 0, to, count: COUNT, unit: 'rpm' }, lobes: lobesOf(last), coriolis: isSplit(last) || undefined };
    try {
      const { id } = await submit('/v1/modal-analyses', asked, signal);
      await follow(id, (now) => {
        const words = now.status === 'successful' ? null : now.error ? `${now.error.title} ${now.error.detail}` : `${now.progress} % ${now.phase ?? ''}`;
        replace(state, words);
      }, signal);
      await find();
    } catch (error) {
      if (!signal.aborted) replace(state, problem(error));
    } finally {
      start.disabled = false;
    }
  }
}
