// Run-ups and run-downs: how far a sensor swings over the speed, run by run; they grow while the job runs.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';
import { ended } from '../../lib/events.js';
import { count, duration, number, percent, rate, rpm, speed } from '../../lib/format.js';
import { growing } from '../../lib/growing.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { unitOf } from '../../lib/units.js';
import { besideWords, sweepBeside } from './beside.js';
import { sensors } from './choices.js';

const STATUSES = {
  completed: 'completed',
  diverged: 'diverged',
  failed: 'could not be integrated',
};

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/run-ups`;
  const asked = { sensor: query.get('sensor'), sweep: query.get('sweep') };
  const sensor = Number(query.get('sensor') ?? 0);
  const figure = h('div', { class: 'figure tall' });
  const told = h('div', { role: 'status' });
  const found = h('div');
  const files = ['json', 'csv', 'npz', 'svg', 'png'].map((form) => downloadButton(form, path, { ...asked, format: form }, `${job.id}-run-ups.${form}`, signal));
  replace(place,
    h('div', { class: 'row' }, sensors(job.request.sweep, context), await sweepBeside(context, 'the chosen one', signal)),
    told, figure, besideWords(context), found,
    h('div', { class: 'row', role: 'group', 'aria-label': 'Downloads' }, files));

  async function read() {
    try {
      const drawn = await api.figure(path, asked, { signal });
      // What is zoomed stays so when runs grow.
      drawn.layout.uirevision = job.id;
      replace(told);
      await plot(figure, drawn, { signal, label: 'Run-ups' });
      replace(found, tables(await api.get(path, { signal }), sensor, context));
    } catch (error) {
      if (!signal.aborted) replace(told, unread(error, signal));
    }
  }
  await growing(context, { read, grown: further(job) }, signal);
}

/** What says of a job of runs whether it has gone on since it was asked last. */
export function further(job) {
  const place = ({ phase, progress }) => `${progress} ${phase}`;
  let last = place(job);
  return (now) => {
    const before = last;
    last = place(now);
    return last !== before;
  };
}

/** What a run is called: by its number, and by its rate where it has one. */
export function runWords(run, rad_s2) {
  return rad_s2 ? `${run + 1}: ${rate(rad_s2)}` : `${run + 1}`;
}

function tables(read, sensor, context) {
  const unit = unitOf(read.sensors[sensor] ?? {}, read.units);
  const { runs, units } = read;
  const endless = ended(context.now()) ? 'stopped' : 'under way';
  const largest = ({ frames, end }) => (end ? end.largest[sensor] : soFar(frames, sensor));
  const run = { name: 'Run', cell: (each) => each.run + 1, sort: (each) => each.run };
  const rates = { name: 'Rate, rad/s²', number: true, cell: (each) => (each.rate_rad_s2 ? number(each.rate_rad_s2) : 'through points'), sort: (each) => each.rate_rad_s2 };
  const done = runs.filter((each) => each.end);
  return [
    h('p', {}, summary(read)),
    h('h2', {}, 'Runs'),
    table({
      caption: 'Runs',
      // Its spectra are the other view.
      onChoose: (each) => context.go({ view: 'spectrogram', run: each.run }),
      rows: runs,
      columns: [
        run,
        rates,
        { name: 'Rate, rpm/s', number: true, cell: (each) => (each.rate_rad_s2 ? number(rpm(each.rate_rad_s2)) : '–'), sort: (each) => each.rate_rad_s2 },
        { name: `Largest displacement, ${unit}`, number: true, cell: (each) => number(largest(each)?.displacement), sort: (each) => largest(each)?.displacement },
        { name: 'At', number: true, cell: (each) => (largest(each) ? speed(largest(each).speed_rad_s) : '–'), sort: (each) => largest(each)?.speed_rad_s },
        { name: 'After, s', number: true, cell: (each) => number(largest(each)?.time_s), sort: (each) => largest(each)?.time_s },
        { name: 'Contact', number: true, cell: (each) => percent(each.end?.contact_share), sort: (each) => each.end?.contact_share },
        { name: 'End', cell: (each) => STATUSES[each.end?.status] ?? each.end?.status ?? endless, sort: (each) => each.end?.status },
      ],
    }),
    h('p', { class: 'quiet small' }, 'The largest displacement is the maximum of the sensor over all sectors; contact is the share of steps with contact. Click a run to open its spectrogram.'),
    messages(done),
    done.length === 0 ? null : h('h2', {}, 'What these numbers are worth'),
    done.length === 0 ? null : table({
      caption: 'What the runs are worth',
      rows: done,
      columns: [
        { ...run, number: true },
        rates,
        { name: 'Angle error, rad', number: true, cell: ({ end }) => number(end.largest_angle_error_rad, 2), sort: ({ end }) => end.largest_angle_error_rad },
        { name: 'Energy residual', number: true, cell: ({ end }) => number(end.energy_residual, 2), sort: ({ end }) => end.energy_residual },
        { name: 'Lost between segments', number: true, cell: ({ end }) => number(end.transfer_loss, 2), sort: ({ end }) => end.transfer_loss },
        { name: 'Euler force', number: true, cell: ({ end }) => number(end.euler_share, 2), sort: ({ end }) => end.euler_share },
        { name: `Remaining penetration, ${units.length}`, number: true, cell: ({ end }) => number(end.largest_penetration, 2), sort: ({ end }) => end.largest_penetration },
        { name: 'Scheme', cell: ({ end }) => end.scheme?.name ?? '–', sort: ({ end }) => end.scheme?.name },
        { name: 'Revolutions', number: true, cell: ({ end }) => number(end.revolutions, 9), sort: ({ end }) => end.revolutions },
        { name: 'Segments', number: true, cell: ({ end }) => number(end.segments, 9), sort: ({ end }) => end.segments },
        { name: 'Steps', number: true, cell: ({ end }) => number(end.steps, 9), sort: ({ end }) => end.steps },
        { name: 'Wall time', number: true, cell: ({ end }) => duration(end.wall_time_s), sort: ({ end }) => end.wall_time_s },
      ],
    }),
    done.length === 0 ? null : h('p', { class: 'quiet small' }, `Energies are shares of the largest energy; the Euler force, which ${read.settings.euler_force ? 'acts' : 'is not included'}, is a share of the centrifugal force.`),
  ];
}

/** The largest displacement of a sensor in frames of a run that has not ended. */
function soFar(frames, sensor) {
  const most = frames.reduce((best, frame) => (best && best.largest[sensor] >= frame.largest[sensor] ? best : frame), null);
  if (!most) return null;
  const middle = ([from, to]) => 0.5 * (from + to);
  return { displacement: most.largest[sensor], time_s: middle(most.times_s), speed_rad_s: middle(most.speeds_rad_s) };
}

/** How much there is, and how fast one must pass. */
function summary({ runs, complete, passing, settings, units }) {
  const frames = runs.reduce((sum, one) => sum + one.frames.length, 0);
  const much = `${count(runs.length, 'run')}, ${count(frames, 'frame')}${complete ? '' : ' so far'}.`;
  if (passing) {
    const about = passing.about_rad_s2 ? ` Between the two, about ${rate(passing.about_rad_s2)} is enough.` : '';
    return `${much} Limit ${number(passing.limit)} ${units.length}, for every sensor: ${passing.message}.${about}`;
  }
  const later = settings.limit && settings.speed.rates && !complete;
  return later ? `${much} How fast one must pass to stay below ${number(settings.limit)} ${units.length} is said when all have ended.` : much;
}

/** What must be known of runs, and why some did not come to their end. */
function messages(runs) {
  const some = runs.filter(({ end }) => end.message);
  if (some.length === 0) return null;
  return h('div', { class: 'note warning' }, h('ul', {}, some.map((each) => h('li', {}, `Run ${runWords(each.run, each.rate_rad_s2)}: ${each.end.message}`))));
}
