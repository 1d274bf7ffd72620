// The wheel at one speed of a sweep, as a small picture; where nothing was recorded, a button that records it.

import { api, submit } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { follow } from '../../lib/events.js';
import { speed } from '../../lib/format.js';
import { problem } from '../../lib/problem.js';
import { recordings, remember } from './recorded.js';

const RECORDED = ['displacement', 'velocity', 'contact_force', 'contact', 'energy', 'state'];

/**
 * Picture of the wheel at the instant of its largest tip motion, or a button that makes it.
 * @param {any} context of the sweep's page
 * @param {{index: number, speed_rad_s: number}} one speed
 * @param {{speeds: Set<number>, states: boolean}} recorded
 * @param {AbortSignal} signal
 */
export function wheelPicture(context, one, recorded, signal) {
  const { job } = context;
  const element = h('div');
  const own = recorded.states && recorded.speeds.has(one.index);
  const other = recordings(job)[one.index];
  if (own) drawn(`/v1/jobs/${job.id}/fields`, { speed: one.index }, context.address({ view: 'fields', speed: one.index }));
  else if (other) elsewhere(other);
  else offer();
  return element;

  /** Picture of a recording by a job of its own, which may be deleted by now. */
  async function elsewhere(id) {
    try {
      const { jobs } = await api.get('/v1/jobs', { query: { kind: 'case_study', status: 'successful', model: job.model, limit: 100 }, signal });
      if (jobs.some((each) => each.id === id)) await drawn(`/v1/jobs/${id}/fields`, {}, `#/jobs/${id}?view=fields`);
      else offer();
    } catch (error) {
      if (!signal.aborted) replace(element, problem(error));
    }
  }

  async function drawn(path, query, href) {
    replace(element, h('p', { class: 'quiet small', role: 'status' }, 'Drawing the wheel …'));
    try {
      const address = URL.createObjectURL(await api.blob(path, { query: { ...query, format: 'svg' }, signal }));
      signal.addEventListener('abort', () => URL.revokeObjectURL(address));
      replace(element, h('a', { href }, h('img', { class: 'drawing', src: address, alt: `The wheel at ${speed(one.speed_rad_s)}, at its largest tip motion` })));
    } catch (error) {
      if (!signal.aborted) replace(element, problem(error));
    }
  }

  function offer() {
    if (job.status !== 'successful') return;
    const told = h('div', { role: 'status' });
    const button = h('button', { type: 'button', 'aria-label': `Record the wheel at ${speed(one.speed_rad_s)}`, on: { click: start } }, 'Record the wheel here');
    replace(element, button, told);
    async function start() {
      button.disabled = true;
      try {
        const made = await submit(`/v1/jobs/${job.id}/histories`, { speeds: [one.index], quantities: RECORDED }, signal);
        await follow(made.id, (now) => replace(told, `${now.progress} %`), signal);
        const done = await api.get(`/v1/jobs/${made.id}`, { signal });
        if (done.error) throw new Error(`${done.error.title} ${done.error.detail}`);
        remember(job, one.index, made.id);
        await drawn(`/v1/jobs/${made.id}/fields`, {}, `#/jobs/${made.id}?view=fields`);
      } catch (error) {
        button.disabled = false;
        if (!signal.aborted) replace(told, problem(error));
      }
    }
  }
}
