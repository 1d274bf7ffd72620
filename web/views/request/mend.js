// Changes of a sweep's request that would decide its verdict, by the field that the remedy names.

import { fieldsIn } from '../../lib/form/named.js';
import { endsOf, endsOver } from './operation.js';
import { beginning } from './sensible.js';
import { TARGETS, withAccuracy } from './settings.js';

/** Speeds that are simulated again at a finer setting; as many as the service takes where a limit is given. */
const CONTROL_SPEEDS = 5;
/** Revolutions after which a march ends that the request does not limit, and how much longer another one is. */
const MOST_REVOLUTIONS = 100;
const LONGER = 4;

const integrated = (request, settings) => ({ ...request, integration: { ...request.integration, ...settings } });

const MENDS = {
  refine: (request) => ({ ...request, refine: true }),
  control_speeds: (request) => ({ ...request, control_speeds: CONTROL_SPEEDS }),
  limits: (request, model) => ({ ...request, limits: beginning('/limits', model) }),
  accuracy: (request) => withAccuracy(request, TARGETS.find((target) => target < (request.accuracy?.target ?? TARGETS[1])) ?? TARGETS.at(-1)),
  speeds: (request, model) => {
    const ends = endsOver(model, request, endsOf(request.speeds));
    return ends ? { ...request, speeds: { ...request.speeds, ...ends } } : request;
  },
  'scene.geometric_nonlinearity': (request, model) => ({ ...request, scene: { ...request.scene, geometric_nonlinearity: beginning('/scene/geometric_nonlinearity', model) } }),
  'scene.geometric_nonlinearity.include': (request) => ({ ...request, scene: { ...request.scene, geometric_nonlinearity: { ...request.scene.geometric_nonlinearity, include: 'full' } } }),
  'integration.revolutions': (request) => integrated(request, { revolutions: 'auto' }),
  'integration.steady': (request) => integrated(request, { steady: 'auto' }),
  'integration.most_revolutions': (request) => integrated(request, { most_revolutions: LONGER * (request.integration?.most_revolutions ?? MOST_REVOLUTIONS) }),
};

/** The field that a remedy names first, of those that can be changed by themselves. */
export function mendable(remedy) {
  return fieldsIn(remedy).find((name) => Object.hasOwn(MENDS, name));
}

/** A request with a field changed. */
export function mended(request, name, model) {
  return Object.hasOwn(MENDS, name) ? MENDS[name](request, model) : request;
}
