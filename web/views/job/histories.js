// Histories of a case study or a study.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { plot } from '../../lib/plot.js';
import { select, sensors } from './choices.js';

export const QUANTITIES = [
  ['displacement', 'displacement'],
  ['velocity', 'velocity'],
  ['force', 'contact force'],
  ['contact', 'contact'],
  ['energy', 'energy'],
  ['trajectories', 'paths of the tips'],
];

export async function show(place, context, signal) {
  const { job, query } = context;
  const quantity = query.get('quantity') ?? 'displacement';
  const figure = h('div', { class: 'figure tall' });
  replace(place, h('div', { class: 'row' },
    sensors(job.request, context),
    job.kind === 'study' ? null : select('Quantity', QUANTITIES, quantity, (chosen) => context.go({ quantity: chosen }))), figure);
  const asked = { sensor: query.get('sensor'), quantity: job.kind === 'study' ? null : quantity, speed: query.get('speed') };
  await plot(figure, await api.figure(`/v1/jobs/${job.id}/histories`, asked, { signal }), { signal, label: 'Histories' });
}
