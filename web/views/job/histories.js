// Histories of a case study or a study.

import { api, submit } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { plot } from '../../lib/plot.js';
import { problem } from '../../lib/problem.js';
import { select, sensors } from './choices.js';

export const QUANTITIES = [
  ['displacement', 'displacement'],
  ['velocity', 'velocity'],
  ['force', 'contact force'],
  ['contact', 'contact'],
  ['energy', 'energy'],
  ['trajectories', 'paths of the tips'],
];

/**
 * What stands where nothing was recorded of a speed: a button that has it simulated again with everything recorded, by a job of its own,
 * whose page is shown then.
 * @param {any} job a sweep
 * @param {number} index of the speed
 * @param {'lines' | 'fields'} view of that page
 * @param {AbortSignal} signal
 */
export function recorder(job, index, view, signal) {
  const told = h('div');
  const button = h('button', { type: 'button', on: { click: start } }, 'Record this speed');
  async function start() {
    button.disabled = true;
    replace(told);
    try {
      const quantities = ['displacement', 'velocity', 'contact_force', 'contact', 'energy', 'state'];
      const made = await submit(`/v1/jobs/${job.id}/histories`, { speeds: [index], quantities }, signal);
      location.hash = `#/jobs/${made.id}?view=${view}`;
    } catch (error) {
      button.disabled = false;
      if (!signal.aborted) replace(told, problem(error));
    }
  }
  return h('div', { class: 'note' },
    h('p', {}, 'No histories were recorded at this speed. A new job can simulate it again, bit for bit, and record histories and states; its page then opens.'),
    button, told);
}

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
