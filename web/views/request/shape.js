// The casing's shape by a request: how high it stands inward, and how that compares with the clearance.

/** Number of angles at which a shape is looked at. */
const AROUND = 720;

const turn = 2 * Math.PI;
/** Distance of two angles, at most half a turn. */
const apart = (a, b) => Math.abs(((a - b) % turn + 1.5 * turn) % turn - turn / 2);
const bulge = (amplitude, distance, width) => amplitude * Math.exp(-((distance / width) ** 2));

/** Height of measured points at an angle, linear between them. */
function measuredAt({ angles_rad: angles, heights }, angle) {
  const line = heights[0] ?? [];
  if (angles.length < 2) return 0;
  const k = angles.findIndex((one) => one > angle);
  const [a, b] = k < 1 ? [angles.length - 1, 0] : [k - 1, k];
  const span = (angles[b] - angles[a] + turn) % turn || turn;
  const share = ((angle - angles[a] + turn) % turn) / span;
  return line[a] + share * (line[b] - line[a]);
}

/** Height inward at an angle, of all shapes together, where they are whole. */
function heightAt({ lobes, single_lobes: single = [], waves = [], measured }, angle) {
  let height = 0;
  if (lobes) {
    for (let k = 0; k < lobes.count; k += 1) height += bulge(lobes.amplitude, apart(angle, (lobes.phase_rad ?? 0) + (k * turn) / lobes.count), lobes.width_rad);
  }
  for (const one of single) height += bulge(one.amplitude, apart(angle, one.angle_rad), one.width_rad);
  for (const one of waves) height += one.amplitude * Math.cos(one.order * (angle - (one.phase_rad ?? 0)));
  if (measured?.angles_rad) height += measuredAt(measured, angle);
  return height;
}

/** Whether all numbers of a casing that a drawing needs are there. */
function whole({ clearance, lobes, single_lobes: single = [], waves = [] }) {
  const numbers = [
    ...(clearance?.values ?? [clearance?.leading, clearance?.trailing]),
    ...(lobes ? [lobes.count, lobes.amplitude, lobes.width_rad] : []),
    ...single.flatMap((one) => [one.amplitude, one.angle_rad, one.width_rad]),
    ...waves.flatMap((one) => [one.amplitude, one.order]),
  ];
  return numbers.every(Number.isFinite) && (!lobes || (lobes.count >= 1 && lobes.count <= 100 && lobes.width_rad > 0));
}

/**
 * The shape of a casing with heights around, clearances along the blade, and what the highest place leaves of the smallest clearance; nothing where numbers are missing.
 * @param {any} casing of a request
 */
export function shapeOf(casing) {
  if (!casing || !whole(casing)) return null;
  const { clearance } = casing;
  const clearances = clearance.values ?? [clearance.leading, clearance.trailing];
  const heights = Array.from({ length: AROUND }, (_, k) => heightAt(casing, (k * turn) / AROUND));
  const smallest = Math.min(...clearances);
  const highest = Math.max(...heights);
  return {
    clearances, heights, smallest, highest,
    left: smallest - highest,
    /** The clearance at a share of the way along the blade. */
    at(share) {
      const place = share * (clearances.length - 1);
      const k = Math.min(Math.floor(place), clearances.length - 2);
      return k < 0 ? clearances[0] : clearances[k] + (place - k) * (clearances[k + 1] - clearances[k]);
    },
  };
}
