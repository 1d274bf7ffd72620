// A job: how far it is, and what it found.

import { part } from '../lib/api.js';
import { h, facts, replace } from '../lib/dom.js';
import { ended, follow, readJob } from '../lib/events.js';
import { bytes, count, moment, nameOf } from '../lib/format.js';
import { labelsButton } from '../lib/labels.js';
import { again, placeWith } from '../lib/place.js';
import { problem, unread } from '../lib/problem.js';
import { progressOf, showProgress } from '../lib/progress.js';
import { actions } from './job/actions.js';
import { verdict } from './job/verdict.js';

export const STATUSES = {
  accepted: 'waiting',
  running: 'running',
  paused: 'paused',
  successful: 'done',
  failed: 'failed',
  dismissed: 'cancelled',
};

/** What there is to see of a kind of job: names of tabs, and where they are loaded from. The first is shown when none is asked for. */
const TABS = {
  sweep: [
    ['overview', 'Verdict', () => import('./job/overview.js')],
    ['map', 'Interaction map', () => import('./job/map.js')],
    ['point', 'One speed', () => import('./job/point.js')],
    ['critical', 'Critical speeds', () => import('./job/critical.js')],
    ['campbell', 'Campbell', () => import('./job/campbell.js')],
    ['forces', 'Contact forces', () => import('./job/forces.js')],
    ['stress', 'Stress', () => import('./job/stress.js')],
    ['fields', 'Wheel in 3D', () => import('./job/fields.js')],
  ],
  modal_analysis: [
    ['campbell', 'Campbell', () => import('./job/campbell.js')],
    ['interference', 'Interference', () => import('./job/interference.js')],
    ['backbones', 'Backbone curves', () => import('./job/backbones.js')],
  ],
  model_generation: [],
  study: [
    ['study', 'Work and precision', () => import('./job/study.js')],
    ['lines', 'Histories', () => import('./job/histories.js')],
  ],
  case_study: [
    ['lines', 'Histories', () => import('./job/histories.js')],
    ['fields', 'Wheel in 3D', () => import('./job/fields.js')],
  ],
  branches: [['branches', 'Branches', () => import('./job/branches.js')]],
  run_up: [
    ['run-ups', 'Run-ups', () => import('./job/run-ups.js')],
    ['spectrogram', 'Spectrogram', () => import('./job/spectrogram.js')],
  ],
  campaign: [['campaign', 'Campaign', () => import('./job/campaign.js')]],
};
const FOR_ALL = [
  ['credentials', 'Credentials', () => import('./job/credentials.js')],
  ['downloads', 'Downloads', () => import('./job/downloads.js')],
];

/** Kinds whose results come as a whole, at the end, and kinds that have none before their first part; all others have what is finished. */
const WHOLE = new Set(['modal_analysis', 'study', 'case_study']);
const IN_PARTS = new Set(['branches', 'run_up']);

/** Whether the results of a job can be asked for. */
function hasResults(job) {
  return WHOLE.has(job.kind) ? job.status === 'successful' : !IN_PARTS.has(job.kind) || job.stored_bytes > 0;
}

export async function show(main, { id, query }, signal) {
  const job = await readJob(id, signal);
  const has = { forces: () => job.request.scene.contact, backbones: () => job.request.backbones };
  const tabs = [...(TABS[job.kind] ?? []), ...FOR_ALL].filter(([name]) => !has[name] || has[name]());
  const tab = tabs.find(([name]) => name === query.get('view')) ?? tabs[0];
  const first = h('div');
  const state = h('div');
  const place = h('section', { 'aria-label': tab[1] });
  const listeners = [];
  replace(main,
    h('h1', {}, nameOf(job)),
    first,
    state,
    h('nav', { class: 'tabs', 'aria-label': 'Results' }, tabs.map(([name, words]) => h('a', {
      href: placeWith(`jobs/${id}`, query, { view: name }),
      'aria-current': name === tab[0] ? 'page' : null,
    }, words))),
    place);
  let shown = job;
  const stateOf = stateView(state, job, signal);
  const tell = (now) => {
    shown = now;
    stateOf(now);
    for (const f of listeners) f(now);
  };
  tell(job);
  /** What views of a job get: the job, the query, how to go elsewhere in it, and how to hear of changes. */
  const context = {
    job,
    query,
    now: () => shown,
    go: (changes) => { location.hash = placeWith(`jobs/${id}`, query, changes); },
    address: (changes) => placeWith(`jobs/${id}`, query, changes),
    onChange: (f) => listeners.push(f),
  };
  if (!ended(job)) {
    follow(id, tell, signal).catch((error) => {
      if (!signal.aborted) state.append(problem(error));
    });
  }
  if (!hasResults(job) && !FOR_ALL.includes(tab)) {
    const words = WHOLE.has(job.kind) ? 'Results are here when the job has ended.' : 'Nothing has been found yet: the first response is being computed.';
    replace(place, h('p', { class: 'note' }, ended(job) ? 'The job ended without a result.' : words));
    listeners.push((now) => (ended(now) || hasResults(now)) && again());
    return;
  }
  try {
    // The verdict is there before the view below it, which then stays where it is.
    const [view] = await Promise.all([part(tab[2]), job.kind === 'sweep' ? verdict(first, context, signal) : null]);
    await view.show(place, context, signal);
  } catch (error) {
    if (signal.aborted) return;
    replace(place, unread(error, signal));
    // What was not ready may be when the job has ended.
    if (!ended(job)) listeners.push((now) => ended(now) && again());
  }
}

/** Shows how far a job is, again and again; events do not repeat what was posted. Its buttons are made anew only when others are needed: one that has the focus keeps it. */
function stateView(element, { posted }, signal) {
  const tag = h('span');
  const words = h('span');
  const bar = h('progress', { max: 100, 'aria-label': 'Progress' });
  const lost = h('p', { class: 'note warning' });
  let going = null;
  return (job) => {
    const buttons = running(job) && job.status === 'paused' ? 'paused' : running(job);
    if (buttons !== going) {
      going = buttons;
      frame(job);
    }
    tag.className = `tag ${{ successful: 'good', failed: 'bad' }[job.status] ?? ''}`;
    replace(tag, STATUSES[job.status] ?? job.status);
    const { speeds } = job;
    const progress = progressOf({ ...job, posted });
    replace(words, running(job) ? progress.words : `${moment(job.finished_at)} · ${bytes(job.stored_bytes)}`);
    showProgress(bar, progress);
    lost.hidden = !speeds || speeds.diverged + speeds.failed === 0;
    if (!lost.hidden) replace(lost, `${count(speeds.diverged, 'speed')} diverged, ${speeds.failed} failed: they have no amplitude`);
  };

  function frame(job) {
    const told = h('div');
    if (running(job)) words.setAttribute('role', 'status');
    else words.removeAttribute('role');
    words.className = running(job) ? '' : 'quiet';
    replace(element,
      h('div', { class: 'row' }, tag, words),
      running(job) ? bar : null,
      lost,
      job.error ? h('div', { class: 'note bad', role: 'alert' }, h('strong', {}, job.error.title), ' ', job.error.detail) : null,
      h('div', { class: 'row' },
        job.model ? h('a', { class: 'button', href: `#/models/${job.model}` }, 'Its model') : null,
        job.kind === 'sweep' ? h('a', { class: 'button', href: `#/compare?jobs=${job.id}` }, 'Compare') : null,
        labelsButton(`/v1/jobs/${job.id}`, job, again, signal),
        actions(job, { told, deleted: () => { location.hash = '#/jobs'; } }, signal)),
      told,
      facts([['Notes', job.notes], ['Tags', (job.tags ?? []).join(', ')]]));
  }
}

function running(job) {
  return !ended(job);
}
