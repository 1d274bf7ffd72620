// Fields of a request that follow other fields until their user writes them: the height of the lobes follows the clearance, speeds follow the operating ranges.

import { endsOf, rangeOf, rangeWithin, endsOver } from './operation.js';
import { lobeHeight } from './sensible.js';

const LOBE = '/scene/casing/lobes/amplitude';

/**
 * Watches what the user writes in a request. `begin(request)` takes the request that is shown first, or another in its place; `range()` is what an operating range
 * begins with; `after(pointer, request)` lists the fields, by pointers with values, that follow what was written at a pointer.
 * @param {any} model
 * @param {any} fresh what a new request of the model begins with
 */
export function following(model, fresh) {
  /** Whether the height of the lobes follows the clearance. */
  let isHigh = false;
  /** Speeds that the user typed, rad/s. */
  let typed = null;
  /** Whether the operating range is still the one that was proposed. */
  let isProposed = false;

  function begin(request) {
    isHigh = followsClearance(request);
    typed = JSON.stringify(request.speeds) === JSON.stringify(fresh.speeds) ? null : endsOf(request.speeds);
    isProposed = false;
  }

  function after(pointer, request) {
    if (pointer === LOBE || pointer === '/scene/casing' || pointer === '/scene/casing/lobes') isHigh = followsClearance(request);
    if (pointer.startsWith('/scene/casing/clearance') && isHigh) {
      const height = lobeHeight(request.scene.casing.clearance);
      return height > 0 ? [[LOBE, height]] : [];
    }
    if (pointer.startsWith('/speeds')) {
      typed = endsOf(request.speeds);
      return isProposed && typed ? endsAt('/operation/ranges/0', rangeWithin(typed)) : [];
    }
    if (!pointer.startsWith('/operation')) return [];
    isProposed = pointer === '/operation' && Boolean(request.operation);
    const ends = pointer.endsWith('/name') || (isProposed && !typed) ? null : endsOver(model, request, typed);
    return ends ? endsAt('/speeds', ends) : [];
  }
  return { begin, after, range: () => (typed ? rangeOf(typed) : rangeWithin(endsOf(fresh.speeds))) };
}

/** Whether the lobes are as high as those of a new request with this clearance. */
function followsClearance({ scene }) {
  const { lobes, clearance } = scene?.casing ?? {};
  return Boolean(lobes) && lobes.amplitude === lobeHeight(clearance);
}

function endsAt(pointer, { from, to }) {
  return [[`${pointer}/from`, from], [`${pointer}/to`, to]];
}
