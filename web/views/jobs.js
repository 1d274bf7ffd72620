// All jobs, kept up to date.

import { api } from '../lib/api.js';
import { h, replace } from '../lib/dom.js';
import { ended, poll } from '../lib/events.js';
import { bytes, count, KINDS, moment, nameOf, short } from '../lib/format.js';
import { cursorOf, placeWith } from '../lib/place.js';
import { problem } from '../lib/problem.js';
import { progressOf, showProgress } from '../lib/progress.js';
import { narrowing, searchField } from '../lib/search.js';
import { verdictTag } from '../lib/verdict-tag.js';
import { STATUSES } from './job.js';
import { actions } from './job/actions.js';
import { select } from './job/choices.js';

/** Jobs of a page. */
const LIMIT = 50;
/** Models whose names are known. */
const MODELS = 200;

/** Milliseconds between two looks: while something runs, and otherwise, for jobs that others post. */
const PACE = { running: 1500, calm: 10_000 };

/** What is chosen to be compared, on whatever page of the list. */
const chosen = new Set();

const FILTERS = ['status', 'kind', 'model', 'name', 'tag'];

export async function show(main, { query }, signal) {
  const told = h('div');
  const rows = h('ul', { class: 'plain jobs' });
  const pages = h('div', { class: 'row' });
  const compare = h('button', { type: 'button', disabled: chosen.size < 2, on: { click: () => { location.hash = `#/compare?jobs=${[...chosen].join(',')}`; } } }, 'Compare the chosen');
  replace(main,
    h('h1', {}, 'Jobs'),
    filters(query, narrowing('jobs', query, { read: refresh, told }, signal), signal),
    h('div', { class: 'row' }, compare, h('span', { class: 'quiet small' }, 'Choose two or more finished sweeps to overlay them.')),
    told, rows, pages);

  const shown = new Map();
  let pace = PACE.calm;
  const context = {
    // Names of models by their ids, for jobs whose own do not say them.
    models: new Map(),
    told,
    signal,
    refresh,
    choose(id, on) {
      if (on) chosen.add(id);
      else chosen.delete(id);
      compare.disabled = chosen.size < 2;
    },
  };

  async function refresh() {
    const place = query.toString();
    const asked = Object.fromEntries(FILTERS.map((name) => [name, query.get(name)]));
    const list = await api.get('/v1/jobs', { query: { ...asked, limit: LIMIT, cursor: query.get('cursor') }, signal });
    if (query.toString() !== place) return;
    pace = list.jobs.some((job) => !ended(job)) ? PACE.running : PACE.calm;
    update(rows, shown, list.jobs, context);
    if (list.jobs.length === 0) {
      const filtered = FILTERS.some((name) => query.get(name));
      replace(rows, h('li', { class: 'quiet' }, filtered ? 'No job matches.' : ['There is no job yet. ', h('a', { href: '#/sweep' }, 'Start a sweep'), '.']));
    }
    const cursor = cursorOf(list);
    replace(pages,
      query.get('cursor') ? h('a', { class: 'button', href: placeWith('jobs', query, { cursor: null }) }, 'Newest') : null,
      cursor ? h('a', { class: 'button', href: placeWith('jobs', query, { cursor }) }, 'Older') : null);
  }

  for (const { id, name } of (await api.get('/v1/models', { query: { limit: MODELS }, signal })).models) context.models.set(id, name);
  await refresh();
  poll(refresh, () => pace, signal).catch((error) => {
    if (!signal.aborted) replace(told, problem(error));
  });
}

function filters(query, go, signal) {
  const all = [['', 'all']];
  const search = (name, label) => searchField({ name, label, value: query.get(name) }, (text) => go({ [name]: text }), signal);
  return h('div', { class: 'row', role: 'search' },
    select('Status', [...all, ...Object.entries(STATUSES)], query.get('status') ?? '', (status) => go({ status })),
    select('Kind', [...all, ...Object.entries(KINDS)], query.get('kind') ?? '', (kind) => go({ kind })),
    search('name', 'Name has'),
    search('tag', 'Tag'),
    query.get('model') ? h('button', { type: 'button', on: { click: () => { location.hash = placeWith('jobs', query, { cursor: null, model: null }); } } }, `Of model ${short(query.get('model'))}… ✕`) : null);
}

/** Draws what is new or has changed, and leaves the rest, where the reader may be. */
function update(list, shown, jobs, context) {
  const now = new Set(jobs.map((job) => job.id));
  for (const [id, { item }] of shown) {
    if (now.has(id)) continue;
    item.remove();
    shown.delete(id);
  }
  if (shown.size === 0) list.replaceChildren();
  let before = null;
  for (const job of jobs) {
    const known = shown.get(job.id);
    const state = known ?? { item: h('li', { class: 'card' }), status: null, progress: h('div') };
    if (state.status !== job.status) row(state, job, context);
    state.status = job.status;
    progress(state.progress, job, context.models.get(job.model));
    if (before ? before.nextSibling !== state.item : list.firstChild !== state.item) {
      if (before) before.after(state.item);
      else list.prepend(state.item);
    }
    shown.set(job.id, state);
    before = state.item;
  }
}

function row({ item, progress }, job, context) {
  const box = job.kind === 'sweep' && job.status === 'successful'
    ? h('input', { type: 'checkbox', checked: chosen.has(job.id), 'aria-label': `Compare ${nameOf(job)}`, on: { change: () => context.choose(job.id, box.checked) } }) : null;
  replace(item,
    h('div', { class: 'row between' },
      h('span', {}, box, ' ', h('a', { href: `#/jobs/${job.id}` }, nameOf(job))),
      h('span', {}, verdictTag(job), ' ', h('span', { class: `tag ${{ successful: 'good', failed: 'bad' }[job.status] ?? ''}` }, STATUSES[job.status] ?? job.status))),
    progress,
    h('div', { class: 'row' }, actions(job, { told: context.told, deleted: () => {
      context.choose(job.id, false);
      return context.refresh();
    } }, context.signal)));
}

function progress(element, job, model) {
  const what = [KINDS[job.kind], model && !nameOf(job).includes(model) ? model : null, job.speeds ? count(job.speeds.total, 'speed') : null, (job.tags ?? []).map((tag) => `#${tag}`).join(' ')];
  if (ended(job)) {
    const bad = (job.speeds?.diverged ?? 0) + (job.speeds?.failed ?? 0);
    replace(element, h('p', { class: 'quiet small' }, [...what, moment(job.finished_at), bytes(job.stored_bytes)].filter(Boolean).join(' · '), bad > 0 ? h('span', { class: 'warn' }, ` · ${count(bad, 'speed')} without a result`) : null));
    return;
  }
  const bar = h('progress', { max: 100, 'aria-label': `Progress of ${nameOf(job)}` });
  const now = progressOf(job);
  showProgress(bar, now);
  replace(element, bar, h('p', { class: 'small' }, [...what, now.words].filter(Boolean).join(' · ')));
}
