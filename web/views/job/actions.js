// What one does with a job as a whole.

import { api, submit } from '../../lib/api.js';
import { confirmed } from '../../lib/confirm.js';
import { h } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { nameOf } from '../../lib/format.js';
import { problem } from '../../lib/problem.js';

/**
 * Buttons of a job: pause and cancel while it runs; again, as it is or otherwise; delete when it has ended.
 * @param {any} job as a list or its own page has it
 * @param {{told: any, deleted: () => void | Promise<void>}} where `told` is an element that takes what is refused, `deleted` what is done then
 * @param {AbortSignal} signal
 */
export function actions(job, { told, deleted }, signal) {
  const name = nameOf(job);
  return [
    h('a', { class: 'button', href: `#/${job.kind === 'model_generation' ? 'generate' : 'sweep'}?as=${job.id}`, 'aria-label': `As ${name}, but …` }, 'As this, but …'),
    ended(job) ? button('Run again', `Run ${name} again`, again) : setAside(),
    ended(job)
      ? button('Delete', `Delete ${name}`, remove, 'bad')
      : button('Cancel', `Cancel ${name}`, cancel, 'bad'),
  ];

  function button(words, label, act, kind = null) {
    const made = h('button', { type: 'button', class: kind, 'aria-label': label }, words);
    made.addEventListener('click', async () => {
      made.disabled = true;
      told.replaceChildren();
      try {
        await act();
      } catch (error) {
        if (!signal.aborted) told.append(problem(error));
      } finally {
        made.disabled = false;
      }
    });
    return made;
  }

  async function again() {
    const whole = await api.get(`/v1/jobs/${job.id}`, { signal });
    const { name: called, tags, notes } = whole;
    if (!whole.posted) throw new Error('an earlier version did not keep the request of this job: begin a new one');
    const labels = Object.fromEntries(Object.entries({ name: called, tags, notes }).filter(([, value]) => value?.length > 0));
    // Histories of a sweep belong to it and have no labels of their own.
    const isOwn = whole.posted_to.split('/').length === 3;
    const made = await submit(whole.posted_to, isOwn ? { ...whole.posted, ...labels } : whole.posted, signal);
    location.hash = `#/jobs/${made.id}`;
  }

  function setAside() {
    const [words, verb] = job.status === 'paused' ? ['Continue', 'continue'] : ['Pause', 'pause'];
    return button(words, `${words} ${name}`, () => api.send('POST', `/v1/jobs/${job.id}/${verb}`, {}, { signal }));
  }

  async function cancel() {
    await api.send('DELETE', `/v1/jobs/${job.id}?cancel_only=true`, undefined, { signal });
  }

  async function remove() {
    if (!await confirmed(`Delete ${name} with all its results?`, 'Delete it', signal)) return;
    await api.send('DELETE', `/v1/jobs/${job.id}`, undefined, { signal });
    await deleted();
  }
}
