// Stress and margin: Haigh diagram and the most utilised places.

import { api, submit } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { number, percent, speed } from '../../lib/format.js';
import { again } from '../../lib/place.js';
import { plot } from '../../lib/plot.js';
import { problem } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { select } from './choices.js';
import { has } from './recorded.js';
import { validityColumn } from './sweep-credentials.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/stress`;
  const colour = query.get('colour') ?? 'speed';
  const figure = h('div', { class: 'figure tall' });
  const below = h('div');
  if (!has(job, 'stress')) {
    await offer(place, job, signal);
    return;
  }
  if (job.status !== 'successful') {
    replace(place, h('p', { class: 'note' }, ended(job) ? 'The job ended without stress.' : 'Stress appears when the job has ended.'));
    context.onChange((now) => ended(now) && again());
    return;
  }
  const found = await api.get(path, { query: { speed: query.get('speed') }, signal });
  const lacking = [...new Set(found.speeds.map((at) => at.stress.lacking).filter(Boolean))];
  const colours = lacking.length === 0 ? [['speed', 'speed'], ['utilisation', 'utilisation']] : [['speed', 'speed']];
  replace(place, h('div', { class: 'row' }, select('Coloured by', colours, colour, (chosen) => context.go({ colour: chosen })),
    query.has('speed') ? h('a', { href: context.address({ speed: null }) }, 'All speeds') : null), lacking.map((words) => h('p', { class: 'note' }, `No utilisation: ${words}. Strengths belong to the material of the model’s mesh.`)), figure, below);
  const unit = `${found.units.force}/${found.units.length}²`;
  // Refinement adds speeds behind the others.
  const speeds = found.speeds.toSorted((a, b) => a.speed_rad_s - b.speed_rad_s);
  const worst = speeds.map((at) => ({ at, cycle: at.stress.cycles[0] ?? null }));
  replace(below,
    h('h2', {}, 'Over speed'),
    table({
      caption: 'Largest stress and utilisation at each speed',
      onChoose: ({ at }) => context.go({ view: 'point', speed: at.index }),
      rows: worst,
      columns: [
        { name: 'Speed', cell: ({ at }) => speed(at.speed_rad_s), sort: ({ at }) => at.speed_rad_s },
        { name: `Largest von Mises, ${unit}`, number: true, cell: ({ at }) => number(at.stress.largest.stress ?? at.stress.largest.von_mises), sort: ({ at }) => at.stress.largest.stress ?? at.stress.largest.von_mises },
        ...[
          { name: 'Over yield', number: true, cell: ({ at }) => percent(at.stress.largest_over_yield), sort: ({ at }) => at.stress.largest_over_yield },
          { name: 'Utilisation', number: true, cell: ({ cycle }) => percent(cycle?.utilisation), sort: ({ cycle }) => cycle?.utilisation },
        ].filter(({ sort }) => worst.some((row) => Number.isFinite(sort(row)))),
        { name: 'Node', number: true, cell: ({ cycle }) => cycle?.node ?? '–' },
        { name: 'Blade', number: true, cell: ({ cycle }) => cycle?.sector ?? '–' },
        validityColumn(job.request, ({ at }) => at.validity?.verdict),
      ],
    }));
  await plot(figure, await api.figure(path, { speed: query.get('speed'), colour }, { signal }), { signal, label: 'Haigh diagram' });
}

/** Where no stress was recorded: a button that asks the same sweep with it; a model without elements has none. */
async function offer(place, job, signal) {
  const model = await api.get(`/v1/models/${job.model}`, { signal });
  if (!model.mesh || !job.posted) {
    replace(place, h('p', { class: 'note' }, model.mesh ? 'An earlier version computed this sweep: post its request again with stress recorded.'
      : 'The model has matrices without elements: stress needs the mesh of the sector.'));
    return;
  }
  const told = h('div');
  const button = h('button', { type: 'button', class: 'main', on: { click: start } }, 'Same sweep, with stress');
  async function start() {
    button.disabled = true;
    replace(told);
    try {
      const { id } = await submit('/v1/sweeps', { ...job.posted, record: { ...job.posted.record, stress: {} } }, signal);
      location.hash = `#/jobs/${id}?view=stress`;
    } catch (error) {
      button.disabled = false;
      if (!signal.aborted) replace(told, problem(error));
    }
  }
  replace(place, h('div', { class: 'note' }, h('p', {}, 'No stress was recorded in this sweep. A new job can compute the same speeds and follow the stress at each.'), button, told));
}
