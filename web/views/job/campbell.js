// The Campbell diagram with the lobes' crossings and its frequencies in tables: of a modal analysis, and beside a sweep that of its model with the
// same modes.

import { api, submit } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { follow } from '../../lib/events.js';
import { count, number, rpm, speed } from '../../lib/format.js';
import { again } from '../../lib/place.js';
import { plot } from '../../lib/plot.js';
import { problem } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { select } from './choices.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const analysis = job.kind === 'modal_analysis' ? job : await analysisOf(job, signal);
  if (!analysis) {
    offer(place, job, signal);
    return;
  }
  const frame = query.get('frame') ?? 'rotating';
  const figure = h('div', { class: 'figure tall' });
  const tables = h('div');
  replace(place,
    h('div', { class: 'row' }, select('Frame', [['rotating', 'rotating, as seen by the blades'], ['fixed', 'fixed, as seen by the casing']], frame, (chosen) => context.go({ frame: chosen }))),
    h('div', { class: 'beside' }, figure, tables),
    analysis === job ? null : h('p', { class: 'quiet small' }, 'Of the ', h('a', { href: `#/jobs/${analysis.id}` }, 'modal analysis'), ' of the same model with the same modes, lobes and Coriolis forces.'));
  const path = `/v1/jobs/${analysis.id}/campbell`;
  const [drawn, found] = await Promise.all([api.figure(path, { frame }, { signal }), api.get(path, { signal })]);
  replace(tables, tablesOf(found, context));
  await plot(figure, drawn, { signal, label: 'Campbell diagram' });
}

/** Course of two families where they come closest, in words. */
const COURSES = { crosses: 'cross', exchanges: 'veer, exchange their shapes', stays: 'veer, stay on their branches' };

/** Driven crossings, frequencies at a speed, and veerings. */
function tablesOf(found, context) {
  const speeds = found.speeds_rad_s;
  const at = Math.min(Math.max(0, Number(context.query.get('at') ?? speeds.length - 1)), speeds.length - 1);
  const branches = found.waves ? [['forward', found.waves.forward_hz], ['backward', found.waves.backward_hz]] : [['', found.frequencies_hz]];
  const modes = branches.flatMap(([wave, hz]) => hz[at].flatMap((line, i) => line.map((each, j) => ({ i, j, wave, hz: each, assurance: found.followed?.assurance[at]?.[i]?.[j] }))));
  const mode = [
    { name: 'Diameter', number: true, cell: (each) => each.i, sort: (each) => each.i },
    { name: 'Family', number: true, cell: (each) => each.j + 1, sort: (each) => each.j },
  ];
  const titled = (caption, what) => [h('h2', { class: 'small' }, `${caption} ${count(what.rows.length, 'speed')}`), table({ caption, ...what })];
  return [
    titled('Engine orders of the lobes meet modes at', {
      rows: found.driven_crossings,
      columns: [
        { name: 'rpm', number: true, cell: (each) => number(rpm(each.speed_rad_s), 5), sort: (each) => each.speed_rad_s },
        { name: 'Order', number: true, cell: (each) => each.engine_order, sort: (each) => each.engine_order },
        { name: 'Diameter', number: true, cell: (each) => each.nodal_diameter, sort: (each) => each.nodal_diameter },
        { name: 'Family', number: true, cell: (each) => each.family, sort: (each) => each.family },
        { name: 'Hz', number: true, cell: (each) => number(each.frequency_hz), sort: (each) => each.frequency_hz },
      ],
    }),
    h('div', { class: 'row' }, select('Frequencies at', speeds.map((each, index) => [index, speed(each)]), at, (chosen) => context.go({ at: chosen }))),
    table({
      caption: 'Natural frequencies in the rotating frame',
      rows: modes,
      columns: [
        ...mode,
        found.waves ? { name: 'Wave', cell: (each) => each.wave } : null,
        { name: 'Hz', number: true, cell: (each) => number(each.hz), sort: (each) => each.hz },
        modes.some((each) => each.assurance < 0.75) ? { name: 'Shape', cell: (each) => (each.assurance < 0.75 ? `mixed, ${number(each.assurance, 2)} its own` : 'its own') } : null,
      ].filter(Boolean),
    }),
    found.followed?.veerings.length ? titled('Families cross or veer at', {
      rows: found.followed.veerings,
      columns: [
        { name: 'rpm', number: true, cell: (each) => number(rpm(each.speed_rad_s), 5), sort: (each) => each.speed_rad_s },
        { name: 'Diameter', number: true, cell: (each) => each.nodal_diameter, sort: (each) => each.nodal_diameter },
        { name: 'Families', cell: (each) => each.families.join(' and ') },
        { name: 'Hz', number: true, cell: (each) => number(each.frequency_hz), sort: (each) => each.frequency_hz },
        { name: 'Apart, Hz', number: true, cell: (each) => number(each.distance_hz), sort: (each) => each.distance_hz },
        { name: 'They', cell: (each) => COURSES[each.course] ?? each.course },
      ],
    }) : null,
    h('p', { class: 'quiet small' }, found.followed
      ? 'A family is the mode with the shape that it had at rest, followed over speed by modal assurance. The speeds asked for change no names.'
      : 'A family is the rank of a frequency at its speed: modes that cross exchange their families.'),
  ];
}

/** The newest finished modal analysis that says of a sweep's model what the sweep needs. */
export async function analysisOf(sweep, signal) {
  const { jobs } = await api.get('/v1/jobs', { query: { kind: 'modal_analysis', status: 'successful', model: sweep.model, limit: 100 }, signal });
  for (const { id } of jobs) {
    const found = await api.get(`/v1/jobs/${id}`, { signal });
    const wanted = requestOf(sweep);
    const same = (name) => wanted[name] === undefined || found.request[name] === wanted[name];
    if (same('modes_per_speed') && same('lobes') && Boolean(found.request.coriolis) === Boolean(wanted.coriolis)) return found;
  }
  return null;
}

/** The modal analysis that belongs to a sweep: its modes, its lobes, and its speeds from rest. */
function requestOf({ model, request }) {
  const { speeds, scene } = request;
  const list = Array.isArray(speeds) ? speeds : [speeds];
  const top = Math.max(...list.map((some) => some.to ?? Math.max(...(some.values ?? [0]))));
  return {
    model,
    modes_per_speed: Number.isInteger(request.modes_per_speed) ? request.modes_per_speed : undefined,
    lobes: scene?.casing?.lobes?.count,
    coriolis: scene?.coriolis ? true : undefined,
    speeds: { from: 0, to: top, count: 25, unit: list[0].unit },
  };
}

/** A button that computes it. */
function offer(place, job, signal) {
  const told = h('div', { role: 'status' });
  const start = async (event) => {
    event.target.disabled = true;
    try {
      const { id } = await submit('/v1/modal-analyses', requestOf(job), signal);
      await follow(id, (now) => {
        const words = now.status === 'successful' ? null : now.error ? `${now.error.title} ${now.error.detail}` : `${now.progress} % ${now.phase ?? ''}`;
        replace(told, words, ' ', h('a', { href: `#/jobs/${id}` }, 'The analysis'));
        if (now.status === 'successful') again();
      }, signal);
    } catch (error) {
      if (!signal.aborted) replace(told, problem(error));
    }
    event.target.disabled = false;
  };
  replace(place,
    h('p', {}, 'Natural frequencies over speed come from a modal analysis of the same model; there is none with these modes and lobes yet. The reduction exists already, so this takes seconds.'),
    h('button', { type: 'button', class: 'main', on: { click: start } }, 'Compute the Campbell diagram'), told);
}
