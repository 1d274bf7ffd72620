// Units: of what sensors say, lengths by their names, and speeds.

import { rpm } from './format.js';

/** Sizes in metres. */
const LENGTHS = { m: 1, dm: 0.1, cm: 0.01, mm: 1e-3, um: 1e-6, nm: 1e-9, µm: 1e-6, μm: 1e-6, mil: 25.4e-6, in: 0.0254, inch: 0.0254, ft: 0.3048, foot: 0.3048, meter: 1, metre: 1, millimeter: 1e-3, millimetre: 1e-3 };

/** How many of the unit `to` are one of `from`; nothing where a name is not known. */
export function lengthIn(from, to) {
  if (from === to) return 1;
  const [a, b] = [LENGTHS[from.toLowerCase()], LENGTHS[to.toLowerCase()]];
  return a && b ? a / b : null;
}

/** How many of each unit of speed one rad/s is. */
export const OF_SPEED = { rad_s: 1, rpm: rpm(1), hz: 1 / (2 * Math.PI) };

/** A number without the last digits, which a change of units has spoilt. */
export function tidy(value) {
  return Number(value.toPrecision(12));
}

/** The unit of what a sensor says: a strain gauge says no length. */
export function unitOf(sensor, units) {
  return sensor.gauge ? 'strain' : units.length;
}
