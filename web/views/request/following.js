// Fields of a request that follow other fields until their user writes them: the height of the lobes follows the clearance, speeds follow the operating ranges.

import { endsOf, endsOver, highestOf, rangeOf, rangeWithin } from './operation.js';
import { lobeHeight } from './sensible.js';

const LOBE = '/scene/casing/lobes/amplitude';

/**
 * Watches what the user writes in a request. `begin(request)` takes the request that is shown first, or another in its place; `range(request)` is what an operating range
 * begins with; `after(pointer, request)` lists the fields, by pointers with values, that follow what was written at a pointer.
 * @param {any} model
 * @param {any} fresh what a new request of the model begins with
 */
export function following(model, fresh) {
  /** Whether the height of the lobes follows the clearance. */
  let lobesFollow = false;
  /** Speeds that the user typed, rad/s. */
  let typed = null;
  /** Whether the operating range is still the one that was proposed. */
  let isProposed = false;

  function begin(request) {
    lobesFollow = followsClearance(request);
    const isFresh = ['from', 'to', 'unit'].every((name) => request.speeds?.[name] === fresh.speeds?.[name]);
    typed = isFresh ? null : endsOf(request.speeds);
    isProposed = false;
  }

  function after(pointer, request) {
    if (pointer === LOBE || pointer === '/scene/casing' || pointer === '/scene/casing/lobes') lobesFollow = followsClearance(request);
    if (pointer.startsWith('/scene/casing/clearance') && lobesFollow) {
      const height = lobeHeight(request.scene.casing.clearance);
      return height > 0 ? [[LOBE, height]] : [];
    }
    if (['/speeds/from', '/speeds/to', '/speeds/unit'].includes(pointer)) {
      typed = endsOf(request.speeds);
      return isProposed && typed ? endsAt('/operation/ranges/0', rangeWithin(typed)) : [];
    }
    if (!pointer.startsWith('/operation') || pointer.endsWith('/name')) return [];
    isProposed = pointer === '/operation' && Boolean(request.operation);
    const ends = isProposed && !typed ? null : endsOver(model, request, typed);
    return ends ? endsAt('/speeds', ends) : [];
  }
  return { begin, after, range: (request) => (typed ? rangeOf(typed, highestOf(model, request)) : rangeWithin(endsOf(fresh.speeds))) };
}

/** Whether the lobes are as high as those of a new request with this clearance. */
function followsClearance({ scene }) {
  const { lobes, clearance } = scene?.casing ?? {};
  return Boolean(lobes) && lobes.amplitude === lobeHeight(clearance);
}

function endsAt(pointer, { from, to }) {
  return [[`${pointer}/from`, from], [`${pointer}/to`, to]];
}
