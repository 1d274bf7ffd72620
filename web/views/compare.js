// Two or more sweeps over each other, and beside what was measured.

import { api } from '../lib/api.js';
import { h, replace } from '../lib/dom.js';
import { nameOf, number, percent, rpm, speed } from '../lib/format.js';
import { plot } from '../lib/plot.js';
import { problem } from '../lib/problem.js';
import { table } from '../lib/table.js';
import { difference } from './compare/difference.js';
import { levels } from './compare/levels.js';
import { measurement, overCampbell } from './compare/measured.js';
import { analysisOf } from './job/campbell.js';

/** Sweeps that one can choose from. */
const LISTED = 100;

export async function show(main, { query }, signal) {
  const chosen = (query.get('jobs') ?? '').split(',').filter(Boolean);
  const picker = h('div');
  const result = h('div');
  replace(main, h('h1', {}, 'Compare sweeps'), picker, result);
  const [list, ...jobs] = await Promise.all([
    api.get('/v1/jobs', { query: { kind: 'sweep', status: 'successful', limit: LISTED }, signal }),
    ...chosen.map((id) => read(id, signal)),
  ]);
  // What was chosen may be older than what is listed.
  const others = list.jobs.filter((job) => !chosen.includes(job.id));
  showPicker(picker, [...jobs.map(({ job }) => job), ...others], chosen);
  if (jobs.length > 0) await compare(result, jobs, signal);
}

/** A sweep with what is compared of it. */
async function read(id, signal) {
  const [job, map, critical] = await Promise.all([
    api.get(`/v1/jobs/${id}`, { signal }),
    api.get(`/v1/jobs/${id}/interaction-map`, { signal }),
    api.get(`/v1/jobs/${id}/critical-speeds`, { signal }),
  ]);
  return { id, name: nameOf(job), job, map, critical };
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

async function compare(element, jobs, signal) {
  const level = h('div', { class: 'figure' });
  const apart = h('div', { class: 'figure tall' });
  const apartNote = h('div');
  const campbell = h('div', { class: 'figure tall' });
  const told = h('div');
  const units = new Set(jobs.map(({ map }) => `${map.units.length} ${map.units.force}`));
  replace(element,
    units.size > 1 ? h('p', { class: 'note warning', role: 'alert' }, 'These sweeps are of models in different units: their amplitudes cannot be compared.') : null,
    h('h2', {}, 'Level over speed'), level, measuredForm(told, show), told,
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
      if (!signal.aborted) replace(campbell, problem(error));
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
    caption: 'Critical speeds of all',
    rows: rows.sort((a, b) => a.each.speed_rad_s - b.each.speed_rad_s),
    columns: [
      { name: 'Sweep', cell: ({ of }) => h('a', { href: `#/jobs/${of.id}?view=critical` }, of.name), sort: ({ of }) => of.name },
      { name: 'Speed', cell: ({ each }) => `${speed(each.speed_rad_s)} ± ${number(Math.round(rpm(each.speed_error_rad_s)), 3)}`, sort: ({ each }) => each.speed_rad_s },
      { name: 'Engine order', number: true, cell: ({ each }) => number(each.dominant_engine_order), sort: ({ each }) => each.dominant_engine_order },
      { name: 'rms', number: true, cell: ({ of, each }) => `${number(each.rms)} ${of.map.units.length}`, sort: ({ each }) => each.rms },
      { name: 'Error', number: true, cell: ({ each }) => percent(each.amplitude_error), sort: ({ each }) => each.amplitude_error },
      { name: `From the nearest of ${jobs[0].name}`, number: true, cell: (row) => { const d = nearest(row); return d === null ? '–' : `${number(Math.round(rpm(d)), 4)} rpm`; }, sort: nearest },
    ],
  });
}

function measuredForm(told, onPoints) {
  const file = h('input', { type: 'file', accept: '.csv,text/csv,text/plain', id: 'measured' });
  const unit = h('select', { id: 'measured-unit' }, [['', 'as the header says'], ['rpm', 'rpm'], ['rad_s', 'rad/s'], ['hz', 'Hz']].map(([value, words]) => h('option', { value }, words)));
  async function read() {
    const [chosen] = file.files;
    if (!chosen) return;
    const { points, bad, words } = measurement(await chosen.text(), unit.value);
    replace(told,
      h('p', { role: 'status' }, words),
      bad.length > 0 ? h('div', { class: 'note warning' }, h('ul', {}, bad.map((line) => h('li', {}, line)))) : null);
    if (points.length > 0) onPoints(points);
  }
  file.addEventListener('change', read);
  unit.addEventListener('change', read);
  return h('div', { class: 'row' },
    h('label', { for: 'measured' }, 'Measured (CSV: speed, frequency in Hz, amplitude)'), file,
    h('label', { for: 'measured-unit' }, 'Speeds in'), unit);
}
