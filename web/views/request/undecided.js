// What leaves the verdict on a sweep undecided whatever the sweep finds: told before the start, each with a button that mends it where that is simple.

import { h, replace } from '../../lib/dom.js';
import { count, number, percent, speed } from '../../lib/format.js';
import { OF_SPEED } from '../../lib/units.js';
import { endsOf, endsOver, highestOf, rangesOf, SAME } from './operation.js';
import { beginning } from './sensible.js';
import { shapeOf } from './shape.js';
import { askedSpeeds } from './speeds.js';

/** Widest step between speeds by which a range counts as covered, as a share of the higher one, as in verdicts. */
const WIDEST = 0.05;
/** Speeds from which on a sweep adds others around its peaks by itself. */
const REFINED = 20;

/**
 * Notes on a request, made anew by `show(request)`.
 * @param {any} model
 * @param {(request: any) => void} put takes the request that a button makes
 */
export function undecided(model, put) {
  const element = h('div', { role: 'status', 'aria-label': 'Before the start' });
  function show(request) {
    const found = [noLimit, notReached, wideSteps, nothingTouches, noContact, noStrength, noThickness, unsound, notRefined].flatMap((rule) => rule(request, model) ?? []);
    replace(element, found.length === 0 ? null : h('div', { class: 'note warning' }, h('strong', {}, 'The verdict would stay undecided:'),
      h('ul', {}, found.map(({ words, mend }) => h('li', {}, words, mend ? [' ', h('button', { type: 'button', on: { click: () => put({ ...request, ...mend[1] }) } }, mend[0])] : null)))));
  }
  return { element, show };
}

function noLimit({ limits }, model) {
  if (Object.values(limits ?? {}).some((limit) => limit !== null && limit !== undefined)) return null;
  const begun = beginning('/limits', model);
  return { words: 'no limit is given.', mend: [`Limit the clearance consumption to ${percent(begun.clearance_consumption)}${begun.utilisation ? ' and the utilisation to 100 %' : ''}`, { limits: begun }] };
}

/** Ranges whose ends, or those of their separation, the speeds do not reach. */
function notReached(request, model) {
  const asked = askedSpeeds(request);
  const [first, last] = [Math.min(...asked), Math.max(...asked)];
  const short = asked.length === 0 ? [] : rangesOf(request).filter(({ lowest, highest }) => first > lowest * (1 + SAME) || last < highest * (1 - SAME));
  const most = highestOf(model, request);
  const ends = endsOver(model, request, endsOf(request.speeds));
  return short.map(({ name, to, lowest, highest }) => {
    const aside = highest > to ? ' with their separation' : '';
    if (highest > most * (1 + SAME)) return { words: `the stiffness of the model ends at ${speed(most)}, below the end of ${name || 'the range'}${aside}, ${speed(highest)}.` };
    const words = `the speeds do not reach the ends of ${name || 'the range'}${aside}: ask for ${speed(lowest)} to ${speed(highest)}.`;
    return { words, mend: ends ? [`Ask for ${number(ends.from, 6)} to ${number(ends.to, 6)} ${{ rad_s: 'rad/s', hz: 'Hz' }[request.speeds.unit] ?? 'rpm'}`, { speeds: { ...request.speeds, ...ends } }] : null };
  });
}

/** Steps between speeds, within the ranges or the sweep, that whole critical speeds may lie in. */
function wideSteps(request) {
  const asked = askedSpeeds(request).toSorted((a, b) => a - b);
  const ranges = rangesOf(request);
  const isJudged = (from, to) => ranges.length === 0 || ranges.some(({ lowest, highest }) => to > lowest * (1 + SAME) && from < highest * (1 - SAME));
  const wide = asked.slice(1).map((to, k) => [asked[k], to]).filter(([from, to]) => to - from > WIDEST * to && isJudged(from, to));
  if (wide.length === 0) return null;
  const [from, to] = wide[0];
  const words = `from ${speed(from)} to ${speed(to)} is a step of ${percent(1 - from / to)}: more than ${percent(WIDEST)} may pass over a critical speed.`;
  const ends = endsOf(request.speeds);
  const enough = ends ? Math.ceil((1 + SAME) * (ends.to - ends.from) / (WIDEST * from / (1 - WIDEST))) + 1 : Infinity;
  return { words, mend: enough <= 400 ? [`Ask for ${count(enough, 'speed')}`, { speeds: { ...request.speeds, count: enough } }] : null };
}

/** Casings that no tip reaches, of a wheel that no force moves. */
function nothingTouches({ scene }) {
  const shape = shapeOf(scene?.casing);
  const isMoved = (scene?.engine_order_excitation ?? []).length > 0 || scene?.casing?.tilt || scene?.orbit || scene?.initial || scene?.clearance_change;
  return shape && shape.left > 0 && !isMoved ? { words: 'no tip touches the casing and no force moves the wheel: make the lobes higher than the clearance.' } : null;
}

/** A limited clearance consumption where nothing can touch. */
function noContact({ limits, scene }) {
  return typeof limits?.clearance_consumption === 'number' && !scene?.contact
    ? { words: 'the clearance consumption is limited, but contact is switched off.', mend: ['Switch contact on', { scene: { ...scene, contact: {} } }] } : null;
}

/** Linear theory that cannot be checked. */
function noThickness({ blade_thickness: thickness }, model) {
  return Number.isFinite(thickness ?? model.mesh?.tip_thickness) ? null : { words: 'the model has no elements that show it: without the blade thickness at the tip linear theory cannot be checked: give it under “Accuracy”.' };
}

/** Stiffness over speed that no result can rest on. */
function unsound({ scene }, model) {
  return scene?.centrifugal_stiffening && model.stiffening?.verdict === 'unsound' ? { words: 'the stiffness of the model over speed is unsound: its page says why.' } : null;
}

/** A limited utilisation without the elements or the strengths that it needs. */
function noStrength({ limits, record }, model) {
  if (typeof limits?.utilisation !== 'number') return null;
  if (!model.mesh) return { words: 'the utilisation is limited, but the model has no elements to compute stress in.' };
  const given = record?.stress?.strengths ?? {};
  const lacking = model.mesh.sets.filter(({ set, ultimate, fatigue }) => !(ultimate && fatigue) && !given[set]).map(({ set }) => set);
  return lacking.length > 0 ? { words: `the utilisation is limited, but ${lacking.join(', ')} has no strengths: give them under “Recorded”, with stress.` } : null;
}

/** Speeds around peaks that would not be added. */
function notRefined(request) {
  const n = askedSpeeds(request).length;
  const isOn = request.refine ?? (n >= REFINED && !request.budget && (request.sweep ?? 'independent') === 'independent');
  return isOn || n < 2 ? null : { words: 'peaks between these speeds may stay unresolved.', mend: ['Add speeds around peaks', { refine: true }] };
}
