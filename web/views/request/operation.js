// Operating ranges of a request and its speeds, which reach past the separation of each range: a verdict needs them to.

import { rpm } from '../../lib/format.js';
import { OF_SPEED, tidy } from '../../lib/units.js';

/** Separation of critical speeds from an operating range, as a share of its ends. */
const ASIDE = 0.05;
/** Share of a speed by which two count as one, as in verdicts: units are converted. */
export const SAME = 1e-9;

const isNumber = Number.isFinite;
const toRadS = (value, unit) => value / (OF_SPEED[unit] ?? 1);

/** Operating ranges with their ends and those of their separation in rad/s, those that are whole. */
export function rangesOf({ operation }) {
  const whole = (operation?.ranges ?? []).filter(({ from, to }) => isNumber(from) && isNumber(to) && from < to);
  return whole.map((range) => {
    const [from, to] = [toRadS(range.from, range.unit), toRadS(range.to, range.unit)];
    const aside = (isNumber(range.separation_percent) ? range.separation_percent : 0) / 100;
    return { name: range.name ?? '', from, to, lowest: from * (1 - aside), highest: to * (1 + aside) };
  });
}

/** Ends of speeds that are one range, rad/s; nothing of others. */
export function endsOf(speeds) {
  return isNumber(speeds?.from) && isNumber(speeds.to) ? { from: toRadS(speeds.from, speeds.unit), to: toRadS(speeds.to, speeds.unit) } : null;
}

/** Highest speed that a request can ask for, rad/s: stiffness is not extrapolated. */
export function highestOf(model, { scene }) {
  return scene?.centrifugal_stiffening ? Math.max(...model.speeds_rad_s) : Infinity;
}

/**
 * Ends of speeds, in their unit, that reach over all operating ranges with their separation, and over the ends in rad/s that are to be kept; nothing of speeds that are no range.
 * @param {any} model
 * @param {any} request
 * @param {{from: number, to: number} | null} kept
 */
export function endsOver(model, request, kept) {
  const ranges = rangesOf(request);
  const { speeds } = request;
  if (ranges.length === 0 || !endsOf(speeds)) return null;
  const from = Math.min(...ranges.map(({ lowest }) => lowest), kept?.from ?? Infinity);
  const to = Math.max(...ranges.map(({ highest }) => highest), kept?.to ?? 0);
  const highest = highestOf(model, request);
  const unit = OF_SPEED[speeds.unit] ?? 1;
  // Whole rpm, hundredths of other units.
  const parts = speeds.unit === 'rpm' ? 1 : 100;
  const rounded = (round, speed_rad_s) => tidy(round(speed_rad_s * unit * parts) / parts);
  return { from: rounded(Math.floor, from * (1 + SAME)), to: to < highest ? rounded(Math.ceil, to * (1 - SAME)) : rounded(Math.floor, highest) };
}

/** An operating range that ends, with its separation, where speeds in rad/s do. */
export function rangeWithin({ from, to }) {
  return { name: 'Operation', from: Math.ceil(rpm(from) / (1 - ASIDE)), to: Math.floor(rpm(to) / (1 + ASIDE)), unit: 'rpm', separation_percent: 100 * ASIDE };
}

/** An operating range of the speeds in rad/s that somebody typed, as they are; its separation ends below the highest speed. */
export function rangeOf({ from, to }, highest) {
  return { ...rangeWithin({ from, to }), from: tidy(rpm(from)), to: Math.min(tidy(rpm(to)), Math.floor(rpm(highest) / (1 + ASIDE))) };
}
