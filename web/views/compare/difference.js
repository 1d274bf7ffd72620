// The difference of two interaction maps, where both have speeds and engine orders.

import { rpm, speed } from '../../lib/format.js';
import { plain } from '../../lib/plot.js';
import { unitOf } from '../../lib/units.js';

/** Values of a row at other engine orders; both ascend, and columns are matched where they are equal. */
function columns(a, b) {
  const of = new Map(b.map((order, k) => [Math.round(1e6 * order), k]));
  return a.map((order, k) => [k, of.get(Math.round(1e6 * order))]).filter(([, k]) => k !== undefined);
}

/** A row of the other map at a speed between its own: linear between its neighbours, nothing beside one without a result. */
function between(map, omega, column) {
  const speeds = map.speeds_rad_s;
  const above = speeds.findIndex((each) => each >= omega - 1e-9);
  if (above < 0) return null;
  const high = map.amplitude[above]?.[column] ?? null;
  if (high === null || Math.abs(speeds[above] - omega) < 1e-9 * Math.max(1, omega)) return high;
  if (above === 0) return null;
  const low = map.amplitude[above - 1]?.[column] ?? null;
  if (low === null) return null;
  const share = (omega - speeds[above - 1]) / (speeds[above] - speeds[above - 1]);
  return low + share * (high - low);
}

/** A map of b − a at the speeds of a within the range of b; nothing where they have none in common. */
export function difference(a, b) {
  const pairs = columns(a.map.engine_orders, b.map.engine_orders);
  const [first, last] = [b.map.speeds_rad_s[0], b.map.speeds_rad_s.at(-1)];
  const rows = a.map.speeds_rad_s.map((omega, k) => [omega, k]).filter(([omega]) => omega >= first - 1e-9 && omega <= last + 1e-9);
  if (pairs.length === 0 || rows.length === 0) {
    return { words: `${a.name} and ${b.name} have no speeds or no engine orders in common.`, figure: null };
  }
  const z = pairs.map(([own, other]) => rows.map(([omega, k]) => {
    const here = a.map.amplitude[k]?.[own] ?? null;
    const there = between(b.map, omega, other);
    return here === null || there === null ? null : there - here;
  }));
  const largest = z.flat().reduce((most, value) => Math.max(most, Math.abs(value ?? 0)), 0);
  const unit = unitOf(a.map.sensor, a.map.units);
  return {
    words: `${b.name} less ${a.name}, at the ${rows.length} speeds of ${a.name} from ${speed(rows[0][0])} to ${speed(rows.at(-1)[0])} that lie within ${b.name}, and at the engine orders of both; `
      + `${b.name} is interpolated between its speeds.`,
    figure: {
      data: [{
        type: 'heatmap', x: rows.map(([omega]) => rpm(omega)), y: pairs.map(([own]) => a.map.engine_orders[own]), z,
        // A map for both signs that colour-blind readers can tell apart.
        colorscale: [[0, '#0571b0'], [0.5, '#f7f7f7'], [1, '#ca0020']], zmin: -largest || -1, zmax: largest || 1,
        colorbar: { title: { text: `difference, ${unit}` } }, hovertemplate: `%{x:.0f} rpm, engine order %{y}: %{z:.3g} ${unit}<extra></extra>`,
      }],
      layout: { title: { text: plain(`${b.name} less ${a.name}`) }, xaxis: { title: { text: 'rotational speed Ω, rpm' } }, yaxis: { title: { text: 'engine order' } }, height: 520 },
    },
  };
}
