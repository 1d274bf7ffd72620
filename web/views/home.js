// The first page: three ways to a model, an example that opens with a result, and the latest jobs.

import { api } from '../lib/api.js';
import { h, replace } from '../lib/dom.js';
import { ended, poll } from '../lib/events.js';
import { KINDS, moment, nameOf } from '../lib/format.js';
import { problem } from '../lib/problem.js';
import { progressOf } from '../lib/progress.js';
import { verdictTag } from '../lib/verdict-tag.js';
import { example } from './home/example.js';
import { STATUSES } from './job.js';
import { ways } from './models/drop.js';

/** Jobs and models that are listed. */
const JOBS = 8;
const MODELS = 6;

/** Milliseconds between two looks: while something runs, and otherwise. */
const PACE = { running: 2000, calm: 10_000 };

export async function show(main, _where, signal) {
  const jobs = h('div');
  const models = h('div');
  replace(main,
    h('h1', {}, 'May this wheel run in this range with this clearance?'),
    h('p', {}, 'Contact of blade tips with the casing, over all speeds of a centrifugal impeller. Begin with the wheel:'),
    ways(signal), tryOut(signal), jobs, models);

  let pace = PACE.calm;
  let last = '';
  async function refresh() {
    const list = (await api.get('/v1/jobs', { query: { limit: JOBS }, signal })).jobs;
    pace = list.some((job) => !ended(job)) ? PACE.running : PACE.calm;
    const now = JSON.stringify(list);
    // What has not changed stays, and with it the focus.
    if (now === last) return;
    last = now;
    replace(jobs, list.length === 0 ? null : [h('h2', {}, 'Latest jobs'), h('ul', { class: 'plain jobs' }, list.map(row))]);
  }
  await refresh();
  const found = (await api.get('/v1/models', { query: { limit: MODELS }, signal })).models;
  replace(models, found.length === 0 ? null : [h('h2', {}, 'Latest models'),
    h('ul', { class: 'plain' }, found.map((model) => h('li', {}, h('a', { href: `#/models/${model.id}` }, model.name), ' · ', h('a', { href: `#/sweep?model=${model.id}`, 'aria-label': `New sweep of ${model.name}` }, 'new sweep'))))]);
  poll(refresh, () => pace, signal).catch((error) => {
    if (!signal.aborted) replace(jobs, problem(error));
  });
}

/** The button of the example. */
function tryOut(signal) {
  const told = h('span', { role: 'status' });
  const button = h('button', { type: 'button' }, 'Open an example');
  button.addEventListener('click', async () => {
    button.disabled = true;
    try {
      location.hash = `#/jobs/${await example((words) => replace(told, words), signal)}`;
    } catch (error) {
      if (!signal.aborted) replace(told, problem(error));
    } finally {
      button.disabled = false;
    }
  });
  return h('div', { class: 'row' }, button, h('span', { class: 'quiet' }, 'A small titanium wheel in an oval casing, with an operating range and limits; it takes about a minute when it is computed first.'), told);
}

function row(job) {
  const words = [KINDS[job.kind], ended(job) ? moment(job.finished_at) : progressOf(job).words].filter(Boolean).join(' · ');
  const tag = verdictTag(job) ?? h('span', { class: `tag ${job.status === 'failed' ? 'bad' : ''}` }, STATUSES[job.status] ?? job.status);
  return h('li', { class: 'row between' }, h('span', {}, h('a', { href: `#/jobs/${job.id}` }, nameOf(job)), ' ', h('span', { class: 'quiet small' }, words)), tag);
}
