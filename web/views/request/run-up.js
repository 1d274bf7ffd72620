// What run-ups are asked for: from a model, and as those that are there.

import { OF_SPEED, tidy } from '../../lib/units.js';
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

/** How the speed changes, which a job keeps in rad/s, in the unit in which its numbers are shortest: that in which it was asked for. */
function inItsUnit({ from, to, rates, hold_s, points, course }) {
  const speeds = [from, to, ...rates ?? [], ...(points ?? []).map((point) => point.speed)].filter((value) => typeof value === 'number');
  const length = (unit) => speeds.reduce((sum, value) => sum + String(tidy(OF_SPEED[unit] * value)).length, 0);
  const unit = Object.keys(OF_SPEED).reduce((best, other) => (length(other) < length(best) ? other : best));
  const of = (value) => (unit === 'rad_s' || typeof value !== 'number' ? value : tidy(OF_SPEED[unit] * value));
  return { unit, from: of(from), to: of(to), rates: rates?.map(of), hold_s, points: points?.map(({ time_s, speed }) => ({ time_s, speed: of(speed) })), course };
}

/** The request of a job of this kind, which keeps it as settings of a sweep of its lowest and its highest speed. */
export function runUpsOf(job) {
  const { sweep, speed, euler_force, angle_tolerance_rad, frame_revolutions, limit } = job.request;
  const { scheme, kept_modes, steps_per_revolution, ramp_revolutions } = sweep.integration ?? {};
  return {
    model: job.model,
    modes_per_speed: sweep.modes_per_speed ?? 'auto',
    speed: inItsUnit(speed),
    scene: sweep.scene,
    integration: { scheme, kept_modes, steps_per_revolution, ramp_revolutions },
    sensors: sweep.sensors ?? [],
    euler_force,
    max_engine_order: sweep.max_engine_order,
    angle_tolerance_rad,
    frame_revolutions,
    limit,
  };
}
