// Natural frequencies at a speed, and the mode shapes in 3D.

import { api, Refusal } from '../../lib/api.js';
import { h, newId, replace } from '../../lib/dom.js';
import { number, rpm } from '../../lib/format.js';
import { problem } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { showWheel } from '../../wheel/index.js';
import { select } from '../job/choices.js';

/** Modes of a nodal diameter that the table shows. */
const SHOWN = 10;

export async function show(place, { model, query, go }, signal) {
  if (model.reductions.length === 0) {
    replace(place, h('p', { class: 'note' }, 'Modes are computed from a reduction, which the first sweep or modal analysis makes: there is none yet. ',
      h('a', { href: `#/sweep?kind=modal_analysis&model=${model.id}` }, 'Start a modal analysis'), '.'));
    return;
  }
  const path = `/v1/models/${model.id}/modes`;
  const speed = query.get('speed_rad_s') ?? '0';
  const id = newId('speed');
  const input = h('input', { id, type: 'number', min: 0, max: Math.floor(rpm(model.speeds_rad_s.at(-1))), step: 'any', value: Math.round(rpm(Number(speed))) });
  input.addEventListener('change', () => go({ speed_rad_s: String(Number(input.value) / rpm(1)) }));
  const speedField = [h('label', { for: id }, 'Speed, rpm '), input];
  replace(place, h('div', { class: 'row' }, speedField));
  let list;
  try {
    list = await api.get(path, { query: { speed_rad_s: speed }, signal });
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    place.append(problem(error));
    return;
  }
  const diameter = Number(query.get('nd') ?? Math.min(2, list.nodal_diameters.length - 1));
  const mode = Number(query.get('mode') ?? 1);
  const stress = query.get('stress') === 'true';
  const single = diameter === 0 || 2 * diameter === model.sectors;
  const motion = single ? 'standing' : query.get('motion') ?? 'travelling';
  const wheel = h('div');
  const rows = list.nodal_diameters.map(({ nodal_diameter, frequencies_hz }) => ({ nodal_diameter, frequencies_hz }));
  const count = Math.min(SHOWN, Math.max(...rows.map((row) => row.frequencies_hz.length)));
  const columns = [
    { name: 'Nodal diameter', cell: (row) => row.nodal_diameter, number: true },
    ...Array.from({ length: count }, (_, index) => ({
      name: `Mode ${index + 1}, Hz`,
      number: true,
      cell: (row) => (row.frequencies_hz[index] === undefined ? '' : h('button', {
        type: 'button',
        'aria-pressed': String(row.nodal_diameter === diameter && index + 1 === mode),
        on: { click: () => go({ nd: String(row.nodal_diameter), mode: String(index + 1) }) },
      }, number(row.frequencies_hz[index], 5))),
    })),
  ];
  const frequency = rows[diameter]?.frequencies_hz[mode - 1];
  replace(place,
    h('div', { class: 'row' },
      speedField,
      single ? null : select('Motion', [['travelling', 'travelling with the rotation'], ['standing', 'standing']], motion, (chosen) => go({ motion: chosen })),
      model.mesh ? select('Colour', [['', 'displacement'], ['true', 'von Mises stress']], stress ? 'true' : '', (chosen) => go({ stress: chosen })) : null),
    h('p', { class: 'quiet small' }, `In the rotating frame, from the reduction with ${list.modes_per_speed} modes per speed. Choose a frequency to see its shape.`),
    table({ caption: 'Natural frequencies', columns, rows }),
    h('h2', {}, `Nodal diameter ${diameter}, mode ${mode}${frequency ? `: ${number(frequency, 5)} Hz` : ''}`),
    wheel);
  try {
    await showWheel(wheel, {
      path,
      query: { speed_rad_s: speed, nodal_diameter: diameter, mode, motion, stress: stress || null },
      animated: true,
      scalar: stress ? 'von_mises' : 'displacement',
      words: stress ? `von Mises stress for a largest displacement of 1 ${model.units.length}` : 'displacement, the largest 1',
      unit: stress ? `${model.units.force}/${model.units.length}²` : '',
      length: model.units.length,
      label: `Mode ${mode} of nodal diameter ${diameter}`,
    }, signal);
  } catch (error) {
    if (!(error instanceof Refusal) || error.status !== 409) throw error;
    replace(wheel, h('p', { class: 'note' }, error.detail));
  }
}
