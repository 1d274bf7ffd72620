// Two or more sweeps over each other, and beside what was measured.

import { api } from '../lib/api.js';
import { h, replace } from '../lib/dom.js';
import { nameOf, number, percent, rpm } from '../lib/format.js';
import { plot } from '../lib/plot.js';
import { problem, unread } from '../lib/problem.js';
import { table } from '../lib/table.js';
import { lengthIn, unitOf } from '../lib/units.js';
import { difference } from './compare/difference.js';
import { levels } from './compare/levels.js';
import { measurement, overCampbell } from './compare/measured.js';
import { requestsApart } from './compare/requests.js';
import { analysisOf } from './job/campbell.js';
import { sensorWords } from './job/choices.js';
import { at, peakWords } from './job/critical.js';

/** Sweeps that one can choose from. */
const LISTED = 100;

export async function show(main, { query }, signal) {
  const chosen = (query.get('jobs') ?? '').split(',').filter(Boolean);
  const picker = h('div');
  const result = h('div');
  replace(main, h('h1', {}, 'Compare sweeps'), picker, result);
  const [list, ...found] = await Promise.allSettled([
    api.get('/v1/jobs', { query: { kind: 'sweep', status: 'successful', limit: LISTED }, signal }),
    ...chosen.map((id) => read(id, 0, signal)),
  ]);
  if (list.status === 'rejected') throw list.reason;
  const jobs = found.filter(({ status }) => status === 'fulfilled').map(({ value }) => value);
  const lost = found.filter(({ status }) => status === 'rejected').map(({ reason }) => unread(reason, signal));
  // What was chosen may be older than what is listed.
  const others = list.value.jobs.filter((job) => !jobs.some(({ id }) => id === job.id));
  showPicker(picker, [...jobs.map(({ job }) => job), ...others], chosen);
  replace(result, lost);
  if (jobs.length > 0) await compare(result, lost, await comparable(jobs, signal), signal);
}

/** A sweep with what is compared of it, seen by the sensor of this index. */
async function read(id, sensor, signal) {
  const query = { sensor };
  const [job, map, critical] = await Promise.all([
    api.get(`/v1/jobs/${id}`, { signal }),
    api.get(`/v1/jobs/${id}/interaction-map`, { query, signal }),
    api.get(`/v1/jobs/${id}/critical-speeds`, { query, signal }),
  ]);
  return { id, name: nameOf(job), job, map: ascending(map), critical, sensor };
}

/** A map whose speeds ascend: in a request a finer range may come after a coarse one, and refinement adds speeds at the end. */
function ascending(map) {
  const order = map.speeds_rad_s.map((_, k) => k).sort((a, b) => map.speeds_rad_s[a] - map.speeds_rad_s[b]);
  return {
    ...map,
    speeds_rad_s: order.map((k) => map.speeds_rad_s[k]),
    amplitude: order.map((k) => map.amplitude[k]),
    points: map.points.toSorted((a, b) => a.speed_rad_s - b.speed_rad_s),
  };
}

/**
 * Sweeps as they can be compared with the first: by the same sensor and in its unit of length. Those for which there is neither are told.
 * @returns {Promise<{jobs: any[], warnings: string[]}>}
 */
async function comparable([first, ...others], signal) {
  const jobs = [first];
  const warnings = [];
  const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
  for (const other of others) {
    const sensor = other.map.settings.sensors.findIndex((each) => same(each, first.map.settings.sensors[first.sensor]));
    const factor = first.map.sensor.gauge ? 1 : lengthIn(other.map.units.length, first.map.units.length);
    if (sensor < 0) {
      warnings.push(`${other.name} is left out: it has no sensor like the first of ${first.name} (${sensorWords(first.map.sensor)}).`);
    } else if (factor === null) {
      warnings.push(`${other.name} is left out: ${other.map.units.length} cannot be converted to ${first.map.units.length}.`);
    } else {
      jobs.push(scaled(sensor === other.sensor ? other : await read(other.id, sensor, signal), factor, first.map.units.length));
    }
  }
  return { jobs, warnings };
}

/** A sweep with its amplitudes in another unit of length. */
function scaled(job, factor, length) {
  if (factor === 1) return job;
  const response = (each) => ({ ...each, mean: factor * each.mean, rms: factor * each.rms, half_peak_to_peak: factor * each.half_peak_to_peak });
  const map = {
    ...job.map,
    units: { ...job.map.units, length },
    amplitude: job.map.amplitude.map((row) => row && row.map((value) => factor * value)),
    points: job.map.points.map((point) => ({ ...point, responses: point.responses.map(response) })),
  };
  const critical = { ...job.critical, critical_speeds: job.critical.critical_speeds.map((each) => ({ ...each, rms: factor * each.rms })) };
  return { ...job, map, critical };
}

function showPicker(element, jobs, chosen) {
  const boxes = jobs.map((job) => {
    const box = h('input', { type: 'checkbox', value: job.id, checked: chosen.includes(job.id) });
    return h('li', {}, h('label', {}, box, ' ', nameOf(job)));
  });
  const list = h('ul', { class: 'plain' }, boxes);
  function go() {
    const ids = [...list.querySelectorAll('input:checked')].map((box) => box.value);
    location.hash = `#/compare?jobs=${ids.join(',')}`;
  }
  replace(element, h('details', { open: chosen.length < 2 }, h('summary', {}, 'Sweeps to compare'),
    jobs.length === 0 ? h('p', {}, 'There is no finished sweep yet.') : list,
    h('button', { type: 'button', class: 'main', on: { click: go } }, 'Compare these')));
}

async function compare(element, lost, { jobs, warnings }, signal) {
  const level = h('div', { class: 'figure' });
  const apart = h('div', { class: 'figure tall' });
  const apartNote = h('div');
  const campbell = h('div', { class: 'figure tall' });
  const told = h('div');
  const unit = unitOf(jobs[0].map.sensor, jobs[0].map.units);
  // Models may be gone; those of the list have names.
  const { models } = await api.get('/v1/models', { query: { limit: LISTED }, signal });
  replace(element,
    lost, warnings.map((words) => h('p', { class: 'note warning', role: 'alert' }, words)),
    h('p', { class: 'quiet' }, `At the sensor ${sensorWords(jobs[0].map.sensor)}; amplitudes in ${unit}.`),
    jobs.length > 1 ? [h('h2', {}, 'What differs in the requests'), requestsApart(jobs, models)] : null,
    h('h2', {}, 'Level over speed'), level, measuredForm(told, unit, show), told,
    jobs.length > 1 ? [h('h2', {}, 'Difference of the maps'), apartNote, apart] : null,
    h('h2', {}, 'Critical speeds'), criticalTable(jobs),
    h('h2', {}, `Campbell diagram of ${jobs[0].name}`), campbell);

  let measured = null;
  async function show(points) {
    measured = points;
    await plot(level, levels(jobs, measured), { signal, label: 'Level over speed' });
    await showCampbell();
  }
  async function showCampbell() {
    try {
      const analysis = await analysisOf(jobs[0].job, signal);
      if (!analysis) {
        replace(campbell, h('p', { class: 'note' }, 'There is no modal analysis of this model with the same modes and lobes: ',
          h('a', { href: `#/jobs/${jobs[0].id}?view=campbell` }, 'the sweep’s page'), ' computes one.'));
        return;
      }
      const figure = await api.figure(`/v1/jobs/${analysis.id}/campbell`, {}, { signal });
      await plot(campbell, overCampbell(figure, measured), { signal, label: 'Campbell diagram' });
    } catch (error) {
      if (!signal.aborted) replace(campbell, unread(error, signal));
    }
  }
  await plot(level, levels(jobs, null), { signal, label: 'Level over speed' });
  if (jobs.length > 1) {
    const found = difference(jobs[0], jobs[1]);
    replace(apartNote, h('p', { class: 'quiet' }, found.words));
    if (found.figure) await plot(apart, found.figure, { signal, label: 'Difference of the maps' });
    else apart.remove();
  }
  await showCampbell();
}

/** Critical speeds of all sweeps, by speed, each beside the nearest of the first sweep. */
function criticalTable(jobs) {
  const rows = jobs.flatMap((of) => of.critical.critical_speeds.map((each) => ({ of, each })));
  const nearest = ({ of, each }) => {
    if (of === jobs[0]) return null;
    const others = jobs[0].critical.critical_speeds.map((other) => each.speed_rad_s - other.speed_rad_s);
    return others.length > 0 ? others.reduce((a, b) => (Math.abs(b) < Math.abs(a) ? b : a)) : null;
  };
  return table({
    caption: 'Critical speeds of all sweeps',
    rows: rows.sort((a, b) => a.each.speed_rad_s - b.each.speed_rad_s),
    columns: [
      { name: 'Sweep', cell: ({ of }) => h('a', { href: `#/jobs/${of.id}?view=critical` }, of.name), sort: ({ of }) => of.name },
      { name: 'Speed', cell: ({ each }) => at(each), sort: ({ each }) => each.speed_rad_s },
      { name: 'Peak', cell: ({ each }) => peakWords(each), sort: ({ each }) => peakWords(each) },
      { name: 'Engine order', number: true, cell: ({ each }) => number(each.dominant_engine_order), sort: ({ each }) => each.dominant_engine_order },
      { name: 'rms', number: true, cell: ({ of, each }) => `${number(each.rms)} ${unitOf(of.map.sensor, of.map.units)}`, sort: ({ each }) => each.rms },
      { name: 'Error', number: true, cell: ({ each }) => percent(each.amplitude_error), sort: ({ each }) => each.amplitude_error },
      { name: `From the nearest of ${jobs[0].name}`, number: true, cell: (row) => { const d = nearest(row); return d === null ? '–' : `${number(Math.round(rpm(d)), 4)} rpm`; }, sort: nearest },
    ],
  });
}

function measuredForm(told, length, onPoints) {
  const file = h('input', { type: 'file', accept: '.csv,text/csv,text/plain', id: 'measured' });
  const unit = h('select', { id: 'measured-unit' }, [['', 'as the header says'], ['rpm', 'rpm'], ['rad_s', 'rad/s'], ['hz', 'Hz']].map(([value, words]) => h('option', { value }, words)));
  let chosen = null;
  async function read() {
    if (!chosen) return;
    try {
      const { points, bad, words } = measurement(await chosen.text(), unit.value, length);
      replace(told,
        h('p', { class: points.length > 0 ? null : 'note bad', role: points.length > 0 ? 'status' : 'alert' }, `${chosen.name}: ${words}`),
        bad.length > 0 ? h('div', { class: 'note warning' }, h('ul', {}, bad.map((line) => h('li', {}, line)))) : null);
      if (points.length > 0) await onPoints(points);
    } catch (error) {
      // A file may be gone, or not to be read, since it was chosen.
      replace(told, problem(error));
    }
  }
  file.addEventListener('change', () => {
    [chosen] = file.files;
    read();
    // The same file may be chosen again when it has changed.
    file.value = '';
  });
  unit.addEventListener('change', read);
  return h('div', { class: 'row' },
    h('label', { for: 'measured' }, 'Measured (CSV with a header such as speed_rpm, frequency_Hz, amplitude_mm)'), file,
    h('label', { for: 'measured-unit' }, 'Speeds in'), unit);
}
