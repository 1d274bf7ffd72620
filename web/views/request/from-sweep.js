// Requests that begin at a speed of a sweep: with its scene, its modes, and its sensors.

import { rpm } from '../../lib/format.js';

/** Shares of a speed to either side of it: of a run-up, and of the speeds of a campaign. */
const BESIDE = { run_up: 0.1, campaign: 0.02 };
const SPEEDS = 5;

/**
 * The request of a kind of job as it begins with a model, with the speed, scene and settings of a sweep.
 * @param {'run_up' | 'campaign'} kind
 * @param {any} begun request of the model alone
 * @param {any} sweep job
 * @param {number} speed_rad_s
 */
export function fromSweep(kind, begun, sweep, speed_rad_s) {
  const at = rpm(speed_rad_s);
  const ends = { from: Math.round((1 - BESIDE[kind]) * at), to: Math.round((1 + BESIDE[kind]) * at) };
  const shared = { scene: sweep.request.scene, sensors: sweep.request.sensors ?? [] };
  if (Number.isInteger(sweep.request.modes_per_speed)) shared.modes_per_speed = sweep.request.modes_per_speed;
  if (kind === 'run_up') return { ...begun, ...shared, speed: { ...begun.speed, ...ends } };
  return { ...begun, ...shared, speeds: { ...ends, count: SPEEDS, unit: 'rpm' } };
}
