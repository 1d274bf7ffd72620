// The sector in the meridional section and the wheel in 3D, in the casing of a sweep.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { nameOf } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { showMesh } from '../../wheel/index.js';
import { select } from '../job/choices.js';

/** Sweeps whose casing one can choose. */
const LISTED = 50;

export async function show(place, { model, query, go }, signal) {
  const { jobs } = await api.get('/v1/jobs', { query: { kind: 'sweep', model: model.id, limit: LISTED }, signal });
  const sweep = query.get('sweep') ?? jobs[0]?.id ?? null;
  const view = query.get('section') ?? 'meridional';
  const section = h('div', { class: 'figure tall' });
  const wheel = h('div');
  replace(place,
    h('div', { class: 'row' },
      jobs.length > 0 ? select('Casing of', jobs.map((job) => [job.id, nameOf(job)]), sweep, (chosen) => go({ sweep: chosen }))
        : h('span', { class: 'quiet' }, 'The casing and its clearance are shown after the first sweep of this model.'),
      select('Section', [['meridional', 'meridional'], ['cyclic', 'along the axis'], ['around', 'casing around the wheel']], view, (chosen) => go({ section: chosen }))),
    h('div', { class: 'sketches' }, section, h('div', { class: 'wide' }, model.mesh ? null : h('p', { class: 'note' }, 'The package has no elements: only the contact lines of the wheel can be shown in 3D.'), wheel)));
  const path = `/v1/models/${model.id}/section`;
  const [figure, geometry] = await Promise.all([
    api.figure(path, { view, sweep }, { signal }),
    api.get(path, { query: { sweep }, signal }),
  ]);
  await plot(section, figure, { signal, label: `${view} section of ${model.name}` });
  await showMesh(wheel, model, geometry.contact, signal);
}
