// What a request would do and cost, asked again as it changes.

import { api, Refusal } from '../../lib/api.js';
import { debounced, facts, h, replace } from '../../lib/dom.js';
import { bytes, count, duration, number, rate } from '../../lib/format.js';
import { wordsOf } from '../../lib/form/words.js';
import { unread } from '../../lib/problem.js';

/** How long nothing must change before the plan is asked for. */
const PAUSE_MS = 400;

/** Most runs that are told one by one. */
const LISTED = 12;

/** From the cost without any contact to that with contact in every step; where marches end by themselves, from the shortest to the longest. */
export function between(range, words) {
  if (!range) return null;
  const [free, contact] = [words(range.free), words(range.contact)];
  return free === contact ? free : `${free} to ${contact}`;
}

/**
 * An aside with the plan. `refresh(request)` asks for it; `tell` hears of the plan, or of the refusal.
 * @param {string} path
 * @param {(found: {plan?: any, refusal?: Refusal}) => void} tell
 * @param {AbortSignal} signal
 */
export function planAside(path, tell, signal) {
  const body = h('div', { role: 'status', 'aria-label': 'Plan' });
  let asking = new AbortController();
  const refresh = debounced(async (request) => {
    asking.abort();
    asking = new AbortController();
    const { signal: own } = asking;
    body.setAttribute('aria-busy', 'true');
    try {
      const plan = await api.send('POST', path, request, { signal: AbortSignal.any([signal, own]) });
      replace(body, shown(plan));
      tell({ plan });
    } catch (error) {
      if (own.aborted || signal.aborted) return;
      replace(body, error instanceof Refusal ? h('p', { class: 'note' }, `Not complete yet: ${count(Math.max(1, error.errors.length), 'field')} to correct.`) : unread(error, signal, () => refresh(request)));
      tell(error instanceof Refusal ? { refusal: error } : {});
    } finally {
      if (!own.aborted) body.removeAttribute('aria-busy');
    }
  }, PAUSE_MS, signal);
  return { element: h('aside', { class: 'card sticky' }, h('h2', {}, 'Cost'), body), refresh };
}

/** Whether every speed takes as many revolutions as the request says. */
function takesAll(integration) {
  return !integration || (integration.revolutions !== 'auto' && integration.steady === 'march');
}

/** How long choosing a setting may take, in words. */
function atMost(settings) {
  if (settings?.accuracy) return `, for at most ${duration(settings.accuracy.seconds)}`;
  return settings?.budget ? `; the whole job is planned for ${duration(settings.budget.seconds)}` : '';
}

/** What each run takes; as long as there is no reduction, its steps and its time are not known. */
function runs(list) {
  if (!list) return null;
  const words = (run) => [
    duration(run.duration_s),
    count(run.revolutions, 'revolution'),
    `${count(run.segments, 'segment')} of one speed`,
    run.steps ? count(run.steps, 'step') : null,
    run.computing_time_s ? `${between(run.computing_time_s, duration)} to compute` : null,
  ].filter(Boolean).join(', ');
  return h('ul', { class: 'plain' },
    list.slice(0, LISTED).map((run) => h('li', {}, run.rate_rad_s2 ? h('strong', {}, `${rate(run.rate_rad_s2)}: `) : null, words(run))),
    list.length > LISTED ? h('li', {}, `and ${list.length - LISTED} more`) : null);
}

function shown(whole) {
  // A campaign has the plan of its scene beside its own numbers.
  const plan = { ...whole.scene, ...whole };
  const { estimate } = plan;
  const scheme = (plan.point ?? plan.points?.[0] ?? plan.runs?.[0])?.scheme;
  const off = (plan.effects ?? []).filter((effect) => !effect.on).map(({ name }) => (wordsOf(`/scene/${name}`)?.[0] ?? name).toLowerCase());
  const [time, computing] = [estimate?.wall_time_s, estimate?.computing_time_s].map((range) => between(range, duration));
  return [
    // What keeps one run from being integrated keeps others, too.
    [...new Set([plan.point, ...(plan.runs ?? [])].map((one) => one?.message))].filter(Boolean).map((text) => h('p', { class: 'note warning' }, text)),
    [...(plan.warnings ?? []), ...(plan.compared?.warnings ?? [])].map((text) => h('p', { class: 'note warning' }, text)),
    facts([
      ['Time', time?.includes(' to ') ? `${time}: the more contact, the longer` : time],
      ['Computing time', computing === time ? null : computing],
      ['Backbone curves', plan.backbones_time_s === undefined ? null : `${duration(plan.backbones_time_s)} to compute`],
      ['Designs', plan.designs_at_most > plan.designs ? `${plan.designs}, at most ${plan.designs_at_most}` : plan.designs],
      ['Speeds', plan.speeds],
      ['Runs', runs(plan.runs)],
      ['Simulations', plan.simulations],
      ['Points', plan.points_at_least ? `at least ${plan.points_at_least} (the basis of the times); at most ${plan.points_at_most}, plus those of doubled branches` : null],
      ['Steps', estimate && !plan.points_at_least ? `${takesAll(plan.settings?.integration) ? '' : 'at most '}${number(estimate.steps, 3)}` : null],
      ['Steps', plan.steps ? number(plan.steps, 3) : null],
      ['Memory', estimate ? bytes(estimate.memory_bytes) : null],
      ['Disk', plan.basis_bytes_at_most ? `at most ${bytes(plan.basis_bytes_at_most)}` : null],
      ['Disk for stress', plan.stress_bytes ? bytes(plan.stress_bytes) : null],
      ['Reductions', plan.reductions ? `with ${plan.reductions.join(', ')} modes per speed` : null],
      ['Reduction', plan.reduction === 'to be computed' ? 'has to be computed first; times are known after that' : plan.reduction],
      ['Unknowns', plan.reduced_unknowns_at_most ? `at most ${number(plan.reduced_unknowns_at_most, 9)}` : null],
      ['Contact pairs', plan.contact_pairs],
      ['Workers', plan.workers],
      ['Times apply to', plan.machine ? `${plan.machine.name}: ${plan.machine.processors} × ${plan.machine.processor}` : null],
      ['Scheme', scheme ? `${scheme.name}: ${scheme.reason}` : null],
      ['Chosen setting', plan.choice?.reason],
      ['Pilot runs', plan.pilot_speeds_rad_s ? `${count(plan.pilot_speeds_rad_s.length, 'speed')} first, to choose the setting${atMost(plan.settings)}` : null],
      ['Left out', off.length > 0 ? off.join(', ') : null],
    ]),
  ];
}
