// The Campbell diagram with the lobes' crossings: of a modal analysis, and beside a sweep that of its model with the same modes.

import { api, submit } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { follow } from '../../lib/events.js';
import { again } from '../../lib/place.js';
import { plot } from '../../lib/plot.js';
import { problem } from '../../lib/problem.js';
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
  replace(place,
    h('div', { class: 'row' }, select('Frame', [['rotating', 'rotating, as seen by the blades'], ['fixed', 'fixed, as seen by the casing']], frame, (chosen) => context.go({ frame: chosen }))),
    figure,
    h('p', { class: 'quiet small' }, 'A family is the rank of a frequency at its speed: modes that cross exchange their families.'),
    analysis === job ? null : h('p', { class: 'quiet small' }, 'Of the ', h('a', { href: `#/jobs/${analysis.id}` }, 'modal analysis'), ' of the same model with the same modes, lobes and Coriolis forces.'));
  const read = await api.figure(`/v1/jobs/${analysis.id}/campbell`, { frame }, { signal });
  await plot(figure, read, { signal, label: 'Campbell diagram' });
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
