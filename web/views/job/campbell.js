// The Campbell diagram with the lobes' crossings.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { plot } from '../../lib/plot.js';
import { select } from './choices.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const frame = query.get('frame') ?? 'rotating';
  const figure = h('div', { class: 'figure tall' });
  replace(place,
    h('div', { class: 'row' }, select('Frame', [['rotating', 'rotating, as the blades feel it'], ['fixed', 'fixed, as the casing feels it']], frame, (chosen) => context.go({ frame: chosen }))),
    figure);
  const read = await api.figure(`/v1/jobs/${job.id}/campbell`, { frame }, { signal });
  await plot(figure, read, { signal, label: 'Campbell diagram' });
}
