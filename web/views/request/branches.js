// What branches are asked for: from a speed of a sweep.

import { rpm } from '../../lib/format.js';
import { tidy } from '../../lib/units.js';

/** What may change along branches. */
export const PARAMETERS = {
  speed: 'speed',
  clearance: 'clearance',
  lobe_amplitude: 'height of the lobes',
  damping: 'damping',
};

/** How much of a speed a branch is followed to either side of it, and of other things: shares to begin with, to be changed. */
const ASIDE = { speed: 0.1, others: 0.5 };

/** Those that a scene has, so that something would change. */
export function changeable(scene) {
  const there = { speed: true, clearance: scene?.casing, lobe_amplitude: scene?.casing?.lobes, damping: scene?.damping };
  return Object.keys(PARAMETERS).filter((name) => there[name]);
}

/** A range to begin with: rpm about a speed, otherwise multiples of what the scene says. */
export function rangeOf(parameter, speed_rad_s) {
  if (parameter !== 'speed') return { from: 1 - ASIDE.others, to: 1 + ASIDE.others };
  const at = rpm(speed_rad_s);
  return { from: Math.round((1 - ASIDE.speed) * at), to: Math.round((1 + ASIDE.speed) * at) };
}

/** A sweep's settings that branches have as well. A response is always sought, so that how a sweep comes to it is left out. */
function shared(sweep) {
  const { steady, ...integration } = sweep.integration ?? {};
  return {
    modes_per_speed: sweep.modes_per_speed ?? 'auto',
    scene: sweep.scene,
    integration,
    sensors: sweep.sensors ?? [],
    max_engine_order: sweep.max_engine_order,
  };
}

/** The request of branches of a sweep's scene that begin at a speed. */
export function branchesFrom(job, speed_rad_s, along) {
  return { model: job.model, speed: { value: tidy(rpm(speed_rad_s)), unit: 'rpm' }, along, ...shared(job.request) };
}
