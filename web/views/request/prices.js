// The price of every effect of a scene: what the plan says with it and without it.

import { api } from '../../lib/api.js';
import { debounced, h, replace } from '../../lib/dom.js';
import { number } from '../../lib/format.js';
import { beginning } from './sensible.js';

/** Effects change seldom, and each costs a plan. */
const PAUSE_MS = 1200;

/**
 * Prices beside the switches of effects. `beside(pointer)` gives the place of one, `refresh(request, plan)` finds them anew.
 * @param {string} path of the plan
 * @param {any} model
 * @param {AbortSignal} signal
 */
export function prices(path, model, signal) {
  const places = new Map();
  let asking = new AbortController();

  function beside(pointer) {
    const name = /^\/scene\/([a-z_]+)$/.exec(pointer)?.[1];
    if (!name) return null;
    const before = places.get(name);
    const place = h('span', { class: 'tag quiet', hidden: !before?.textContent });
    place.textContent = before?.textContent ?? '';
    place.title = before?.title ?? '';
    places.set(name, place);
    return place;
  }

  const refresh = debounced(async (request, plan) => {
    asking.abort();
    asking = new AbortController();
    const own = AbortSignal.any([signal, asking.signal]);
    const whole = plan.estimate?.wall_time_s.contact;
    for (const effect of plan.effects ?? []) {
      const place = places.get(effect.name);
      if (!place || !whole) continue;
      const other = changed(request, effect, model);
      let words = '';
      try {
        if (other) {
          const without = (await api.send('POST', path, other, { signal: own })).estimate?.wall_time_s.contact;
          if (without) words = effect.on ? share(whole / without - 1) : share(without / whole - 1);
        }
      } catch {
        // A scene that makes no sense with it, or without it, has no price.
        if (own.aborted) return;
      }
      const said = words ? `${effect.on ? 'takes' : 'would take'} ${words}` : '';
      place.hidden = said === '';
      replace(place, said);
      place.title = effect.adds ?? '';
    }
  }, PAUSE_MS, signal);
  return { beside, refresh };
}

/** Effects that need another one. */
const NEEDS = { contact: ['casing'], friction: ['contact'], abradable: ['contact'], flexible_casing: ['contact'], orbit: ['casing'], clearance_change: ['contact'] };

/** The request with an effect switched, unless the scene would make no sense then or what it begins with is not known. */
function changed(request, { name, on }, model) {
  const { scene } = request;
  const other = structuredClone(request);
  if (on) {
    if (Object.entries(NEEDS).some(([user, needs]) => needs.includes(name) && scene[user])) return null;
    delete other.scene[name];
    return other;
  }
  if ((NEEDS[name] ?? []).some((needed) => !scene[needed])) return null;
  if (name === 'coriolis' && !model.gyroscopic) return null;
  if (name === 'geometric_nonlinearity' && (!model.mesh || scene.friction)) return null;
  if (name === 'centrifugal_stiffening' && model.speeds_rad_s.length < 2) return null;
  const begun = ['coriolis', 'centrifugal_stiffening'].includes(name) ? true : beginning(`/scene/${name}`, model);
  if (begun === undefined) return null;
  other.scene[name] = begun;
  return other;
}

/** Least share of the time that is told: plans differ by less from one moment to the next. */
const TOLD = 0.05;

/** How much longer a job takes with an effect, in words; nothing where that is not sure. */
function share(part) {
  if (part > 2) return `about ${number(1 + part, 2)} times as long`;
  return part < TOLD ? '' : `${number(100 * part, part < 0.1 ? 1 : 2)} % longer`;
}
