// Critical speeds: those of a sensor beside the linear prediction, and those of the whole wheel.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { number, percent, rpm, speed } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { unitOf } from '../../lib/units.js';
import { select, sensors } from './choices.js';
import { followButton } from './follow.js';
import { SETTLING, VALIDITY } from './verdicts.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/critical-speeds`;
  const rank = query.get('rank');
  const of = query.get('of') ?? 'sensor';
  const asked = { sensor: of === 'sensor' ? query.get('sensor') : null, rank };
  const found = await api.get(of === 'wheel' ? `${path}/wheel` : path, { query: asked, signal });
  const figure = h('div', { class: 'figure' });
  replace(place,
    h('div', { class: 'row' },
      select('Seen by', [['sensor', 'one sensor'], ['wheel', 'the whole wheel: all tips and blades']], of, (chosen) => context.go({ of: chosen })),
      of === 'sensor' ? sensors(job.request, context) : null,
      select('Ranked by', [['', of === 'sensor' ? 'speed' : 'severity'], ['utilisation', 'utilisation of the strength']], rank ?? '', (chosen) => context.go({ rank: chosen }))),
    verdict(found),
    of === 'wheel' ? wheelTable(found, context, signal) : sensorTable(found, context, signal),
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

const open = (context) => (each) => context.go({ view: 'point', speed: each.index });
const common = [
  { name: 'Peak', cell: (each) => peakWords(each), sort: (each) => Number(each.resolved) },
  { name: 'Error', number: true, cell: (each) => percent(each.amplitude_error), sort: (each) => each.amplitude_error },
  { name: 'Settling', cell: (each) => SETTLING[each.settling] ?? each.settling },
  { name: 'Linear theory', cell: (each) => VALIDITY[each.validity] ?? '–' },
  { name: 'Utilisation', number: true, cell: (each) => percent(each.utilisation), sort: (each) => each.utilisation },
];

/** What a periodic response does beside a critical speed is another job's. */
const following = ({ job }, signal) => ({
  name: 'Branches', cell: (each) => followButton(job, each.speed_rad_s, signal, 'Follow'),
});

function sensorTable(found, context, signal) {
  const unit = unitOf(found.sensor, found.units);
  return table({
    caption: 'Critical speeds of a sensor',
    onChoose: open(context),
    rows: found.critical_speeds,
    columns: [
      { name: 'Speed', cell: at, sort: (each) => each.speed_rad_s },
      { name: 'Engine order', number: true, cell: (each) => number(each.dominant_engine_order), sort: (each) => each.dominant_engine_order },
      { name: 'Nodal diameter', number: true, cell: (each) => each.dominant_nodal_diameter ?? '–', sort: (each) => each.dominant_nodal_diameter },
      { name: `rms, ${unit}`, number: true, cell: (each) => number(each.rms), sort: (each) => each.rms },
      { name: `Half peak to peak, ${unit}`, number: true, cell: (each) => number(each.half_peak_to_peak), sort: (each) => each.half_peak_to_peak },
      { name: 'Distance from it', number: true, cell: (each) => (each.distance_rad_s === null || each.distance_rad_s === undefined ? '–' : percent(each.distance_rad_s / each.speed_rad_s)), sort: (each) => each.distance_rad_s },
      { name: 'Nearest linear crossing', cell: (each) => predicted(each.nearest_crossing) },
      ...common,
      following(context, signal),
    ],
  });
}

function predicted(crossing) {
  if (!crossing) return '–';
  return `${speed(crossing.speed_rad_s)}: nodal diameter ${crossing.nodal_diameter}, family ${crossing.family}, n = ${crossing.superharmonic}`;
}

function wheelTable(found, context, signal) {
  const { length, force } = found.units;
  return table({
    caption: 'Critical speeds of the wheel',
    onChoose: open(context),
    rows: found.critical_speeds,
    columns: [
      { name: 'Speed', cell: at, sort: (each) => each.speed_rad_s },
      { name: 'Severity', number: true, cell: (each) => number(each.severity), sort: (each) => each.severity },
      { name: 'Tip', cell: (each) => `blade ${each.tip.sector}, node ${each.tip.contact_node}, ${each.tip.component}` },
      { name: `Half peak to peak, ${length}`, number: true, cell: (each) => number(each.tip.half_peak_to_peak), sort: (each) => each.tip.half_peak_to_peak },
      { name: 'Clearance consumed', number: true, cell: (each) => percent(each.clearance_consumption), sort: (each) => each.clearance_consumption },
      { name: `Largest force, ${force}`, number: true, cell: (each) => number(each.peak_force), sort: (each) => each.peak_force },
      ...common,
      following(context, signal),
    ],
  });
}
