// Credentials of a sweep in words: steady state, error bars, validity of its theory.

import { api } from '../../lib/api.js';
import { h, replace, facts } from '../../lib/dom.js';
import { count, number, percent } from '../../lib/format.js';

export const SETTLING = {
  periodic: 'repeats every revolution',
  subharmonic: 'repeats after several revolutions',
  aperiodic: 'does not repeat; only its statistics are meaningful',
  not_settled: 'had not settled when the run ended',
};
/** Settling in one word, for tables. */
export const SETTLED = { periodic: 'periodic', subharmonic: 'subharmonic', aperiodic: 'aperiodic', not_settled: 'not settled' };
export const STABILITY = {
  stable: 'stable',
  narrow: 'stable against very small disturbances only',
  flip: 'unstable: its period doubles',
  fold: 'unstable: another response of the same period takes over',
  neimark_sacker: 'unstable: a second frequency appears',
  undecided: 'stability could not be decided',
};

/** Verdicts in one word, for tables. */
const VERDICTS = { linear: 'holds', not_checked: 'not checked', doubtful: 'doubtful', beyond: 'beyond' };
const LINEAR = {
  name: 'Linear theory',
  legend: 'Whether displacements are small enough: holds, not checked, doubtful, or beyond it.',
  words: {
    linear: 'within linear theory',
    not_checked: 'linear theory not checked',
    doubtful: 'linear theory is doubtful',
    beyond: 'beyond linear theory',
  },
};
const BENDING = {
  name: 'Bending simulated',
  legend: 'Whether the bending that the scene simulates is enough: holds, not checked, doubtful, or beyond it.',
  words: {
    linear: 'within what the scene simulates',
    not_checked: 'not checked whether the scene simulates enough',
    doubtful: 'doubtful: the scene may simulate too little',
    beyond: 'beyond what the scene simulates',
  },
};

/** Theory that a request's validity is about, its name and words: linear theory, or what the scene simulates of blades that bend far. */
export function theory(request) {
  return request.scene.geometric_nonlinearity ? BENDING : LINEAR;
}

/** Column of a table with the verdict on the theory that `verdict` reads of a row. */
export function validityColumn(request, verdict) {
  const { name, words } = theory(request);
  return { name, cell: (each) => h('span', { title: words[verdict(each)] }, VERDICTS[verdict(each)] ?? '–'), sort: verdict };
}

const MEASURED = {
  excess_energy: 'excess energy',
  second_order_gap: 'second-order motion over clearance',
  outside_coordinates: 'motion outside the coordinates of bending',
};

/** Verdict on the theory at a speed, with what was measured for it. */
export function validityWords(request, validity) {
  if (!validity) return null;
  const measured = validity.checks.filter((check) => check.what in MEASURED);
  const scaled = measured.some((check) => check.scaled_from !== undefined);
  return [theory(request).words[validity.verdict], ...measured.map((check) => `${MEASURED[check.what]} ${percent(check.value)}`), scaled ? 'scaled from another motion' : null]
    .filter(Boolean).join('; ');
}

/** How many of `points` have each value of `what`, in words. */
function tally(points, what, words) {
  const counts = new Map();
  for (const point of points) {
    const value = what(point);
    if (value) counts.set(value, (counts.get(value) ?? 0) + 1);
  }
  return [...counts].map(([value, n]) => `${n} × ${words[value] ?? value}`).join('; ') || null;
}

/** The points of a sweep; read without amplitudes, which are not needed. */
export function points(job, signal) {
  return api.get(`/v1/jobs/${job.id}/interaction-map`, { query: { orders: '0' }, signal });
}

/** Shows the credentials of a sweep. */
export async function sweepCredentials(element, { job }, signal) {
  const map = await points(job, signal);
  if (signal.aborted) return;
  const errors = map.errors;
  const lost = map.points.filter((point) => point.status !== 'completed');
  const energy = Math.max(0, ...map.points.map((point) => point.energy_residual ?? 0));
  replace(element,
    h('h2', {}, 'What these numbers are worth'),
    facts([
      ['Speeds', `${count(map.points.length, 'speed')} finished${lost.length > 0 ? `, ${lost.length} of them diverged or failed and have no amplitude` : ''}`],
      ['Steady state', tally(map.points, (point) => point.settling?.verdict, SETTLING)],
      [theory(job.request).name, tally(map.points, (point) => point.validity?.verdict, theory(job.request).words)],
      ['Estimated error', errors ? `at most ${percent(errors.largest)}${errors.largest_of_stress ? `, of stress ${percent(errors.largest_of_stress)}` : ''}. ${errors.message}` : 'not estimated: the request asked for no control runs'],
      ['Energy identity', `violated by at most ${energy.toExponential(1)} of the largest energy`],
      ['Stiffening', map.stiffening && map.stiffening !== 'sound' && map.stiffening !== 'absent' ? map.stiffening : null],
      ['Code', map.version],
    ]));
}

/** How the periodic response was found, whether it lasts, and how fast what disturbs it grows or decays. */
export function steadyWords(steady) {
  if (!steady) return null;
  const stability = STABILITY[steady.stability];
  const leading = steady.multipliers?.[0];
  return [
    steady.taken ? 'used' : `not used: ${steady.reason}`,
    stability,
    leading ? `|μ| = ${number(leading.modulus)} per return map, nodal diameter ${leading.nodal_diameter}, lines offset by ${number(leading.order_offset)} orders` : null,
    `${number(steady.revolutions, 3)} revolutions`,
  ].filter(Boolean).join('; ');
}
