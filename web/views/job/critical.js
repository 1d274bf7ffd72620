// Critical speeds: those of a sensor beside the linear prediction, and those of the whole wheel.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { number, percent, rpm, speed } from '../../lib/format.js';
import { again } from '../../lib/place.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { unitOf } from '../../lib/units.js';
import { select, sensors } from './choices.js';
import { fromHere } from './from-here.js';
import { SETTLED, SETTLING, theory, validityColumn } from './sweep-credentials.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/critical-speeds`;
  if (job.status !== 'successful') {
    replace(place, h('p', { class: 'note' }, ended(job) ? 'The job ended without a table of critical speeds.' : 'Critical speeds are found once all speeds are computed: they appear when the job has ended.'));
    context.onChange((now) => ended(now) && again());
    return;
  }
  const rank = query.get('rank');
  const of = query.get('of') ?? 'wheel';
  const asked = { sensor: of === 'sensor' ? query.get('sensor') : null, rank };
  const found = await api.get(of === 'wheel' ? `${path}/wheel` : path, { query: asked, signal });
  const figure = h('div', { class: 'figure' });
  replace(place,
    h('div', { class: 'row' },
      select('Seen by', [['wheel', 'the whole wheel: all tips and blades'], ['sensor', 'one sensor']], of, (chosen) => context.go({ of: chosen })),
      of === 'sensor' ? sensors(job.request, context) : null,
      select('Ranked by', [['', of === 'sensor' ? 'speed' : 'severity'], ['utilisation', 'utilisation of the strength']], rank ?? '', (chosen) => context.go({ rank: chosen }))),
    verdict(found),
    of === 'wheel' ? wheelTable(found, context, signal) : sensorTable(found, context, signal),
    legend(job.request),
    figure);
  if (of === 'wheel') return;
  try {
    await plot(figure, await api.figure(path, asked, { signal }), { signal, label: 'Critical speeds' });
  } catch (error) {
    if (!signal.aborted) replace(figure, unread(error, signal));
  }
}

/** In words what the table says, and what it may have missed. */
function verdict(found) {
  const n = found.critical_speeds.length;
  const open = found.critical_speeds.filter((each) => !each.resolved).length;
  return [
    h('p', {}, n === 0 ? 'No critical speed was found in this range.' : `${n} critical ${n === 1 ? 'speed' : 'speeds'}${open > 0 ? `, of which ${open} not resolved by the speeds of this sweep` : ', all resolved by the speeds of this sweep'}.`),
    found.missing.length > 0 ? h('p', { class: 'note warning' }, `${found.missing.length} speeds have no amplitude and may hide a peak.`) : null,
  ];
}

/** Whether the speeds of the sweep tell where a peak is. */
export function peakWords(each) {
  return each.on_branch ? 'on a branch' : each.resolved ? 'resolved' : each.at_edge ? 'at an edge' : 'not resolved';
}

/** Where a peak is, with as many digits as are known. */
export function at(each) {
  const error = rpm(each.speed_error_rad_s);
  return each.on_branch && error < 1 ? `${number(rpm(each.speed_rad_s), 7)} ± ${number(error, 1)} rpm` : `${speed(each.speed_rad_s)} ± ${number(Math.round(error), 3)}`;
}

const SEVERITY = 'Tip motion (half peak to peak) over the running clearance; where a node has none, over the length of the contact line. At 1 the tip moves by its whole clearance.';

/** Words of the columns, for readers without a pointer. */
function legend(request) {
  return h('details', {}, h('summary', {}, 'What the columns mean'), h('dl', { class: 'facts' }, [
    ['Severity', SEVERITY],
    ['Peak', 'Resolved: the neighbouring speeds show its top. Not resolved: the true peak may be higher and elsewhere; finer speeds show it.'],
    ['Error', 'Estimated error of the response, from control runs.'],
    ...Object.entries(SETTLED).map(([name, word]) => [word, SETTLING[name]]),
    [theory(request).name, theory(request).legend],
    ['Off by', 'Distance of the peak from the linear prediction (nodal diameter, family, superharmonic), as a share of the prediction.'],
  ].map(([name, words]) => [h('dt', {}, name), h('dd', {}, words)])));
}

const open = (context) => (each) => context.go({ view: 'point', speed: each.index });
const common = ({ request }) => [
  { name: 'Peak', cell: (each) => peakWords(each), sort: (each) => Number(each.resolved) },
  { name: 'Error', number: true, cell: (each) => percent(each.amplitude_error), sort: (each) => each.amplitude_error },
  { name: 'Steady state', cell: (each) => h('span', { title: SETTLING[each.settling] }, SETTLED[each.settling] ?? each.settling), sort: (each) => each.settling },
  validityColumn(request, (each) => each.validity),
  { name: 'Utilisation', number: true, cell: (each) => percent(each.utilisation), sort: (each) => each.utilisation },
];

/** What can be asked next of a critical speed is another job's. */
const next = ({ job }, signal) => ({ name: 'Look closer', cell: (each) => fromHere(job, each.speed_rad_s, signal, true) });

function sensorTable(found, context, signal) {
  const unit = unitOf(found.sensor, found.units);
  return table({
    caption: 'Critical speeds of a sensor',
    onChoose: open(context),
    rows: found.critical_speeds,
    columns: [
      { name: 'Speed', cell: at, sort: (each) => each.speed_rad_s },
      { name: 'Order', number: true, cell: (each) => number(each.dominant_engine_order), sort: (each) => each.dominant_engine_order },
      { name: 'Nodal diameter', number: true, cell: (each) => each.dominant_nodal_diameter ?? '–', sort: (each) => each.dominant_nodal_diameter },
      { name: `rms, ${unit}`, number: true, cell: (each) => number(each.rms), sort: (each) => each.rms },
      { name: `Half peak to peak, ${unit}`, number: true, cell: (each) => number(each.half_peak_to_peak), sort: (each) => each.half_peak_to_peak },
      { name: 'Nearest linear prediction', cell: (each) => predicted(each.nearest_crossing) },
      { name: 'Off by', number: true, cell: offWords, sort: off },
      ...common(context.job),
      next(context, signal),
    ],
  });
}

/** How far a critical speed lies from the prediction, as a share of the prediction; the report has the same number. */
function off({ speed_rad_s: found, nearest_crossing: crossing }) {
  return crossing ? found / crossing.speed_rad_s - 1 : undefined;
}

function offWords(each) {
  const share = off(each);
  return share === undefined ? '–' : `${share > 0 ? '+' : ''}${number(100 * share, 2)} %`;
}

function predicted(crossing) {
  if (!crossing) return '–';
  return h('span', { title: `nodal diameter ${crossing.nodal_diameter}, family ${crossing.family}, superharmonic ${crossing.superharmonic}` },
    `${speed(crossing.speed_rad_s)} (${crossing.nodal_diameter}, ${crossing.family}, ${crossing.superharmonic})`);
}

function wheelTable(found, context, signal) {
  const { length, force } = found.units;
  return table({
    caption: 'Critical speeds of the wheel',
    onChoose: open(context),
    rows: found.critical_speeds,
    columns: [
      { name: 'Speed', cell: at, sort: (each) => each.speed_rad_s },
      { name: 'Severity', title: SEVERITY, number: true, cell: (each) => number(each.severity, 3), sort: (each) => each.severity },
      { name: 'Tip', cell: (each) => `blade ${each.tip.sector}, node ${each.tip.contact_node}, ${each.tip.component}` },
      { name: `Tip motion, ${length}`, number: true, cell: (each) => number(each.tip.half_peak_to_peak), sort: (each) => each.tip.half_peak_to_peak },
      { name: 'Clearance consumption', title: 'Largest share of its clearance that the outward motion of a node uses', number: true, cell: (each) => percent(each.clearance_consumption), sort: (each) => each.clearance_consumption },
      { name: `Force, ${force}`, title: 'Largest sum of all contact forces', number: true, cell: (each) => number(each.peak_force), sort: (each) => each.peak_force },
      ...common(context.job),
      next(context, signal),
    ],
  });
}
