// What accuracy costs: errors over time or step, with the chosen setting marked.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { duration, percent, speed } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { table } from '../../lib/table.js';
import { select } from './choices.js';
import { SETTLING, steadyWords } from './sweep-credentials.js';

const QUANTITIES = [
  ['amplitude', 'steady amplitude'],
  ['engine_orders', 'peaks at engine orders'],
  ['history', 'first revolutions'],
  ['impulse', 'contact impulse'],
  ['stress', 'largest stress'],
];

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/work-precision`;
  const chosen = { quantity: query.get('quantity') ?? 'amplitude', speed: query.get('speed') ?? '0', over: query.get('over') ?? 'time' };
  const found = await api.get(path, { signal });
  const figure = h('div', { class: 'figure tall' });
  const below = h('div');
  replace(place,
    h('div', { class: 'row' },
      select('Error of', QUANTITIES, chosen.quantity, (quantity) => context.go({ quantity })),
      select('Over', [['time', 'computing time'], ['step', 'step']], chosen.over, (over) => context.go({ over })),
      select('Speed', found.speeds.map((at, k) => [k, speed(at.speed_rad_s)]), chosen.speed, (index) => context.go({ speed: index }))),
    figure, below);
  const runs = found.speeds[Number(chosen.speed)]?.runs ?? [];
  replace(below, h('h2', {}, 'All runs at this speed'), table({
    caption: 'Runs of the study',
    rows: runs,
    columns: [
      { name: 'Scheme', cell: (run) => run.scheme ?? '–', sort: (run) => run.scheme },
      { name: 'Modes', number: true, cell: (run) => run.modes_per_speed ?? '–', sort: (run) => run.modes_per_speed },
      { name: 'Steps a revolution', number: true, cell: (run) => run.steps_per_revolution ?? '–', sort: (run) => run.steps_per_revolution },
      { name: 'Time of a run', number: true, cell: (run) => duration(run.time_s), sort: (run) => run.time_s },
      { name: 'Error', number: true, cell: (run) => percent(run.errors?.[chosen.quantity]), sort: (run) => run.errors?.[chosen.quantity] },
      { name: 'Steady state', cell: (run) => SETTLING[run.verdict] ?? '–' },
      ...(runs.some((run) => run.steady) ? [{ name: 'Periodic response', cell: (run) => steadyWords(run.steady) ?? '–' }] : []),
      { name: 'Remarks', cell: (run) => [run.status, run.pareto?.length ? 'Pareto-optimal: none is both faster and more accurate' : null, run.message].filter(Boolean).join('; ') },
    ],
  }));
  await plot(figure, await api.figure(path, chosen, { signal }), { signal, label: 'Work and precision' });
}
