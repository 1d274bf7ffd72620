// The interference diagram of a modal analysis at one speed: modes over the nodal diameter, the zig-zag of engine orders, and the nearest order of
// every mode.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';
import { number, rpm } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';

export async function show(place, { job, query, go }, signal) {
  const path = `/v1/jobs/${job.id}/interference`;
  const asked = { unit: 'rpm', ...Object.fromEntries(['speed', 'lobes', 'from', 'to'].map((name) => [name, query.get(name)])) };
  const figure = h('div', { class: 'figure tall' });
  const modes = h('div');
  const told = h('div', { role: 'status' });
  const fields = h('div', { class: 'row' });
  replace(place, fields, told, h('div', { class: 'beside' }, figure, modes),
    h('div', { class: 'row', role: 'group', 'aria-label': 'Downloads' },
      ['json', 'csv', 'npz', 'svg', 'png'].map((form) => downloadButton(form, path, { ...asked, format: form }, `${job.id}-interference.${form}`, signal))));
  replace(fields, inputs(asked, {}, go));
  try {
    const [drawn, found] = await Promise.all([api.figure(path, asked, { signal }), api.get(path, { query: asked, signal })]);
    replace(fields, inputs(asked, found, go));
    replace(modes, tableOf(found));
    await plot(figure, drawn, { signal, label: 'Interference diagram' });
  } catch (error) {
    if (!signal.aborted) replace(told, unread(error, signal));
  }
}

/** Fields of the speed, the lobes and the operating range; a changed one is asked for at once. */
function inputs(asked, found, go) {
  const shown = { speed: asked.speed ?? (found.speed_rad_s === undefined ? '' : Math.round(rpm(found.speed_rad_s))), lobes: asked.lobes ?? found.lobes ?? '' };
  const field = (name, words, more = {}) => h('label', {}, `${words} `,
    h('input', { type: 'number', min: 0, step: 'any', value: shown[name] ?? asked[name] ?? '', ...more, on: { change: (event) => changed(name, event.target.value) } }));
  function changed(name, value) {
    const range = { from: asked.from, to: asked.to, [name]: value };
    // Half a range is none yet.
    if ((name === 'from' || name === 'to') && Boolean(range.from) !== Boolean(range.to)) {
      asked[name] = value;
      return;
    }
    go({ from: asked.from || null, to: asked.to || null, [name]: value || null });
  }
  return [
    field('speed', 'Speed, rpm'),
    field('lobes', 'Lobes', { min: 1, step: 1 }),
    field('from', 'Operating range from, rpm'),
    field('to', 'to, rpm'),
  ];
}

function tableOf(found) {
  return table({
    caption: 'Modes and their nearest engine order of the lobes',
    rows: found.modes,
    columns: [
      { name: 'Diameter', number: true, cell: (each) => each.nodal_diameter, sort: (each) => each.nodal_diameter },
      { name: 'Family', number: true, cell: (each) => each.family, sort: (each) => each.family },
      found.modes.some((each) => each.wave) ? { name: 'Wave', cell: (each) => each.wave ?? 'standing' } : null,
      { name: 'Hz', number: true, cell: (each) => number(each.frequency_hz), sort: (each) => each.frequency_hz },
      { name: 'Order', number: true, cell: (each) => each.nearest?.engine_order ?? 'none', sort: (each) => each.nearest?.engine_order ?? 0 },
      { name: 'Above, %', number: true, cell: (each) => (each.nearest ? number(each.nearest.margin_percent, 3) : '–'), sort: (each) => Math.abs(each.nearest?.margin_percent ?? 1e9) },
      found.range_rad_s ? { name: 'Met by', cell: (each) => (each.met_in_range ?? []).join(', ') || '–' } : null,
    ].filter(Boolean),
  });
}
