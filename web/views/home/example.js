// The example: a small wheel, swept through its speeds in an oval casing, with an operating range and limits.

import { api, submit } from '../../lib/api.js';
import { ended, follow } from '../../lib/events.js';

/** Tag by which the example is found again. */
const TAG = 'rubmap-example';

/** Ti-6Al-4V in mm, N, s, t; fatigue strength and its source as reports repeat it. */
const MATERIAL = {
  youngs_modulus: 114_000, poissons_ratio: 0.33, density: 4.43e-9, yield_strength: 828, ultimate_strength: 895,
  fatigue_strength: { amplitude: 500, source: 'example: Ti-6Al-4V, smooth, rotating bending, 1e7 cycles, 20 °C' },
};

/** Lobes 5 % higher than the clearance; the range has a critical speed inside. */
const SWEEP = {
  name: 'Example: 12,000 to 36,000 rpm, clearance 0.26 mm, 2 × 0.273 mm',
  tags: [TAG],
  speeds: { from: 12_000, to: 36_000, count: 31, unit: 'rpm' },
  scene: {
    centrifugal_stiffening: true,
    damping: { modal_ratio: 0.005 },
    casing: { clearance: { leading: 0.26, trailing: 0.26 }, lobes: { count: 2, amplitude: 0.273, width_rad: 0.35 } },
    contact: {},
  },
  operation: { ranges: [{ name: 'Cruise', from: 18_000, to: 24_000, unit: 'rpm', separation_percent: 5 }] },
  limits: { clearance_consumption: 0.9, utilisation: 1 },
  record: { stress: {} },
};

/**
 * The job of the example: an earlier one, or a new one of a wheel that is generated first.
 * @param {(words: string) => void} tell how far it is
 * @param {AbortSignal} signal
 * @returns {Promise<string>} id of the sweep
 */
export async function example(tell, signal) {
  const { jobs } = await api.get('/v1/jobs', { query: { kind: 'sweep', tag: TAG, limit: 20 }, signal });
  const earlier = jobs.find((job) => job.status === 'successful' || !ended(job));
  if (earlier) return earlier.id;
  tell('Generating the wheel …');
  const { id } = await submit('/v1/models', { preset: 'small', name: 'Example impeller', material: MATERIAL }, signal);
  let last = null;
  await follow(id, (now) => { last = now; }, signal);
  if (last?.status !== 'successful') throw new Error(last?.error?.detail ?? 'the example wheel could not be generated');
  tell('Starting the sweep …');
  return (await submit('/v1/sweeps', { model: last.model, ...SWEEP }, signal)).id;
}
