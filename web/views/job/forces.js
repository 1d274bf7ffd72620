// Contact forces and clearance consumption over speed and contact node.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { plot } from '../../lib/plot.js';
import { select } from './choices.js';

const QUANTITIES = [
  ['peak', 'largest force on a node'],
  ['impulse', 'impulse'],
  ['share', 'share of time in contact'],
  ['consumption', 'clearance consumption'],
];

export async function show(place, context, signal) {
  const { job, query } = context;
  const quantity = query.get('quantity') ?? 'peak';
  const figure = h('div', { class: 'figure tall' });
  replace(place, h('div', { class: 'row' }, select('Quantity', QUANTITIES, quantity, (chosen) => context.go({ quantity: chosen }))), figure);
  await plot(figure, await api.figure(`/v1/jobs/${job.id}/forces`, { quantity }, { signal }), { signal, label: 'Contact forces' });
}
