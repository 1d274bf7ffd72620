// Branches of periodic responses: they grow while the job runs.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';
import { growing } from '../../lib/growing.js';
import { count, known, number, rpm } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { unitOf } from '../../lib/units.js';
import { besideWords, sweepBeside } from './beside.js';
import { sensors } from './choices.js';
import { STABILITY } from './sweep-credentials.js';

const KINDS = {
  fold: 'fold: it turns back',
  flip: 'flip: the period doubles',
  neimark_sacker: 'Neimark–Sacker: a second frequency, lines split',
  branching: 'branching: another branch meets this one',
};

const ENDS = {
  leaves_range: () => 'leaves the range',
  joins: () => 'returns to the branch whose period it doubles',
  most_points: () => 'reached the requested number of points',
  lost: ({ reason }) => `could not be followed further: ${reason}`,
};

const AXES = {
  speed: 'Speed, rpm',
  clearance: 'Clearance / that of the scene',
  lobe_amplitude: 'Height of the lobes / that of the scene',
  damping: 'Damping / that of the scene',
};

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/branches`;
  const asked = { sensor: query.get('sensor'), sweep: query.get('sweep') };
  const sensor = Number(query.get('sensor') ?? 0);
  const figure = h('div', { class: 'figure tall' });
  const told = h('div', { role: 'status' });
  const found = h('div');
  const files = ['json', 'csv', 'npz', 'svg', 'png'].map((form) => downloadButton(form, path, { ...asked, format: form }, `${job.id}-branches.${form}`, signal));
  replace(place,
    h('div', { class: 'row' }, sensors(job.request.sweep, context), job.request.along.parameter === 'speed' ? await sweepBeside(context, 'the sweep it began at', signal) : null),
    told, figure, besideWords(context), found,
    h('div', { class: 'row', role: 'group', 'aria-label': 'Downloads' }, files));

  async function read() {
    try {
      const drawn = await api.figure(path, asked, { signal });
      // What is zoomed stays so when branches grow.
      drawn.layout.uirevision = job.id;
      replace(told);
      await plot(figure, drawn, { signal, label: 'Branches' });
      replace(found, tables(await api.get(path, { signal }), sensor));
    } catch (error) {
      if (!signal.aborted) replace(told, unread(error, signal));
    }
  }
  let phase = job.phase;
  const grown = (now) => {
    const before = phase;
    phase = now.phase;
    return phase !== before;
  };
  await growing(context, { read, grown }, signal);
}

function tables(read, sensor) {
  const { parameter, units, branches } = read;
  const unit = unitOf(read.sensors[sensor] ?? {}, units);
  const drawn = (value) => (parameter === 'speed' ? rpm(value) : value);
  const value = { name: AXES[parameter], number: true, cell: (each) => known(drawn(each.value), drawn(each.error)), sort: (each) => each.value };
  const branch = { name: 'Branch', number: true, cell: (each) => each.branch + 1, sort: (each) => each.branch };
  const every = (what) => branches.flatMap((one) => one[what].map((each) => ({ ...each, branch: one.branch })));
  const bifurcations = every('bifurcations');
  const maxima = every('maxima').filter((each) => each.sensor === sensor);
  return [
    h('p', {}, summary(read)),
    h('ul', {}, branches.map((one) => h('li', {}, branchWords(one, drawn, parameter)))),
    h('h2', {}, 'Bifurcations'),
    bifurcations.length === 0 ? h('p', { class: 'quiet' }, 'None was found.') : table({
      caption: 'Bifurcations',
      rows: bifurcations,
      columns: [
        branch,
        { name: 'What happens', cell: (each) => KINDS[each.kind] ?? each.kind, sort: (each) => each.kind },
        value,
        { name: `Half peak to peak, ${unit}`, number: true, cell: (each) => number(each.half_peak_to_peak[sensor]), sort: (each) => each.half_peak_to_peak[sensor] },
        { name: 'Line offset, orders', number: true, cell: (each) => number(each.multiplier?.order_offset), sort: (each) => each.multiplier?.order_offset },
        { name: 'Nodal diameter', number: true, cell: (each) => each.multiplier?.nodal_diameter ?? '–', sort: (each) => each.multiplier?.nodal_diameter },
        { name: '|μ| on the stable side', number: true, cell: (each) => number(each.stable_modulus), sort: (each) => each.stable_modulus },
      ],
    }),
    h('h2', {}, 'Maxima of this sensor'),
    maxima.length === 0 ? h('p', { class: 'quiet' }, 'None was found.') : table({
      caption: 'Maxima of the amplitude',
      rows: maxima,
      columns: [
        branch,
        value,
        { name: `Half peak to peak, ${unit}`, number: true, cell: (each) => number(each.half_peak_to_peak), sort: (each) => each.half_peak_to_peak },
        { name: 'Stability', cell: (each) => STABILITY[each.stability] ?? each.stability, sort: (each) => each.stability },
      ],
    }),
  ];
}

function summary({ branches, complete }) {
  const points = branches.reduce((sum, one) => sum + one.points.length, 0);
  return `${count(points, 'point')} on ${count(branches.length, 'branch', 'branches')}${complete ? ', followed to their ends' : ' so far'}.`;
}

function branchWords({ branch, lobe_passages: lobes, doubles, points, ends }, drawn, parameter) {
  const at = (value) => (parameter === 'speed' ? `${number(Math.round(drawn(value)), 5)} rpm` : number(value));
  const words = [`Branch ${branch + 1}: ${count(points.length, 'point')}`];
  if (doubles) words.push(`from the flip of branch ${doubles[0] + 1} at ${at(doubles[1])}`);
  if (lobes) words.push(`repeats after ${lobes} passages of a lobe`);
  // Both ends may be alike.
  return [...new Set([words.join(', '), ...ends.map((end) => ENDS[end.why]?.(end) ?? end.why)])].join('; ');
}
