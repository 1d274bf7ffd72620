// Accuracy as a dial with its cost.

import { api } from '../../lib/api.js';
import { debounced, h, newId, replace } from '../../lib/dom.js';
import { duration, number } from '../../lib/format.js';
import { between } from './plan.js';
import { TARGETS } from './settings.js';

const PAUSE_MS = 1500;

/**
 * A choice among accuracies, each with its time where pilot runs of earlier jobs tell it, and the settings as they are.
 * @param {string} path of the plan
 * @param {(target: number | null) => void} choose
 * @param {AbortSignal} signal
 */
export function accuracyDial(path, choose, signal) {
  const name = newId('accuracy');
  const costs = new Map();
  let asking = new AbortController();
  const option = (target) => {
    const cost = h('span', { class: 'quiet' });
    costs.set(target, cost);
    const button = h('input', { type: 'radio', name, value: target ?? '', checked: target === null, on: { change: () => choose(target) } });
    return h('li', {}, h('label', {}, button, ' ', target === null ? 'as the settings below say' : `${number(100 * target, 2)} %`, ' ', cost));
  };
  const list = h('ul', { class: 'plain' }, [null, ...TARGETS].map(option));
  const element = h('fieldset', {}, h('legend', {}, 'Accuracy'),
    h('p', { class: 'help quiet small' }, 'The program chooses modes and steps for the requested error. The computing time is known after the pilot runs of a job with this scene.'), list);

  const refresh = debounced(async (request) => {
    asking.abort();
    asking = new AbortController();
    const own = AbortSignal.any([signal, asking.signal]);
    for (const target of TARGETS) {
      const asked = { ...request, accuracy: { ...request.accuracy, target }, modes_per_speed: 'auto' };
      delete asked.budget;
      delete asked.integration;
      try {
        const plan = await api.send('POST', path, asked, { signal: own });
        const time = plan.estimate ? between(plan.estimate.wall_time_s, duration) : null;
        replace(costs.get(target), time && !plan.pilot_speeds_rad_s ? time : 'pilot runs first');
      } catch {
        if (own.aborted) return;
        replace(costs.get(target));
      }
    }
  }, PAUSE_MS, signal);

  /** Shows which one a request asks for. */
  function show(request) {
    const target = request.accuracy?.target ?? null;
    for (const button of list.querySelectorAll('input')) button.checked = button.value === String(target ?? '');
  }
  return { element, refresh, show };
}
