// What run-ups are asked for: from a model.

import { CLEARANCE, round, sceneOf, speedsOf } from './sensible.js';

/** The middle of a first run, over the highest speed at which the model has its stiffness, and its ends, over the middle. */
const MIDDLE = 0.6;
const ENDS = [0.8, 1.2];
/** Revolutions of the slowest of the first runs: as a sweep, which takes up to a hundred at each of so many speeds. */
const REVOLUTIONS = 2000;
/** How much faster the others are: the last one passes a critical speed within a few revolutions. */
const FASTER = [1, 4, 16];
/** Revolutions before the speed changes, in which dies away what begins with the run. */
const HELD = 50;

/** First run-ups of a model: three rates, and as the limit the clearance. */
export function runUpsOfModel(model) {
  const middle = MIDDLE * speedsOf(model).to;
  const [from, to] = ENDS.map((end) => Math.round(end * middle));
  const slowest = (to - from) * (middle / 60) / REVOLUTIONS;
  return {
    model: model.id,
    speed: { unit: 'rpm', from, to, rates: FASTER.map((times) => round(times * slowest)), hold_s: round(60 * HELD / from) },
    scene: sceneOf(model),
    limit: round(CLEARANCE * (model.contact_radius ?? 100)),
  };
}
