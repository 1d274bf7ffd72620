// First view of a sweep: level of the wheel with ranges and limits, the three worst speeds, what is open, and the critical speeds of the wheel.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { inWords } from '../../lib/form/named.js';
import { unitIn, wordsOf } from '../../lib/form/words.js';
import { growing, moreSpeeds } from '../../lib/growing.js';
import { count, number, percent, speed } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { TAGS } from '../../lib/verdict-tag.js';
import { mendable } from '../request/mend.js';
import { select } from './choices.js';
import { fromHere } from './from-here.js';
import { recordedSpeeds } from './recorded.js';
import { theory } from './sweep-credentials.js';
import { wheelPicture } from './wheel-picture.js';

/** Quantities that are judged, called as where limits are asked for. */
const QUANTITIES = ['clearance_consumption', 'tip_motion', 'utilisation', 'node_force'];

const quantityWords = (name) => wordsOf(`/limits/${name}`)[0].toLowerCase();

/** Unit of a quantity behind its value; none of shares. */
function quantityUnit(name, units) {
  const [, code] = wordsOf(`/limits/${name}`);
  return /^[LF]$/.test(code) ? ` ${unitIn(code, units)}` : '';
}

/** Looks of a value against its limit. */
const STANDINGS = { kept: 'good', reached: 'warn', open: 'quiet', passed: 'bad' };

/** Standing of a value against its limit: `kept, 20 % left`, `passed by 36 %`. */
function standingWords({ standing, error, above_percent: above }) {
  const size = Math.abs(above);
  const by = `${size < 10 ? size.toFixed(1) : number(Math.round(size))} %`;
  if (standing === 'passed') return `passed by ${by}`;
  const open = error === undefined ? 'error not known' : 'within the error';
  return `${standing === 'open' ? open : 'kept'}, ${by} ${above > 0 ? 'above' : 'left'}`;
}

/** Questions that are open at a speed, in a few words; those of errors are told beside the limit. */
const questionWords = (request) => ({
  speeds_missing: 'no result yet',
  speeds_failed: 'not computed',
  not_settled: 'motion not settled',
  unsound_stiffness: 'stiffness at speed unsound',
  error_across_limit: null,
  error_unknown: null,
  value_unknown: 'value not known',
  peak_unresolved: 'peak not resolved',
  beyond_linear_theory: theory(request).words.beyond,
  linear_theory_not_checked: theory(request).words.not_checked,
});

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/level`;
  const ranges = h('div');
  const figure = h('div', { class: 'figure tall' });
  const told = h('div');
  const below = h('div');
  const quantity = query.get('quantity') ?? '';
  const options = [['', 'the quantity that decides'], ...QUANTITIES.map((name) => [name, quantityWords(name)])];
  replace(place,
    ranges,
    h('div', { class: 'row' }, select('Level of the wheel', options, quantity, (chosen) => context.go({ quantity: chosen }))),
    told, figure,
    h('p', { class: 'quiet small' }, 'Over all contact nodes, components and blades. Filled marks lie in a range or its separation. A click opens the speed.'),
    below);

  async function read() {
    try {
      const drawn = await api.figure(path, { quantity }, { signal });
      drawn.layout.uirevision = job.id;
      untitled(drawn.layout);
      replace(told);
      await plot(figure, drawn, { signal, label: 'Level of the wheel', onClick: (event) => open(event, context) });
      const level = await api.get(path, { signal });
      const recorded = await recordedSpeeds(context.now(), signal);
      if (signal.aborted) return;
      replace(ranges, rangeList(level.verdict));
      if (level.speeds.length === 0) replace(below, h('p', { class: 'note' }, ended(context.now()) ? 'No speed was finished.' : 'No speed has finished yet.'));
      else replace(below, worst(level.verdict, recorded, context, signal), questions(level.verdict, job), critical(level.verdict, context, !ended(context.now())));
    } catch (error) {
      if (!signal.aborted) replace(told, unread(error, signal));
    }
  }
  await growing(context, { read, grown: moreSpeeds(job) }, signal);
}

/** Takes the title out of a figure, which stands below the verdict, and the room that it has. */
function untitled(layout) {
  const lines = (text) => (text ? text.split('<br>').length : 0);
  const room = 20 * lines(layout.title?.text) + 15 * lines(layout.title?.subtitle?.text);
  delete layout.title;
  layout.margin = { ...layout.margin, t: layout.margin.t - room };
  layout.height -= room;
}

/** Opens the speed that was clicked. */
function open(event, context) {
  const index = event.points?.[0]?.customdata;
  if (Number.isInteger(index)) context.go({ view: 'point', speed: index });
}

/** Verdicts on the ranges; where none was given, how to give them. */
function rangeList({ ranges, ranges_given: given, settings }) {
  if (!given || !settings.limits) {
    const missing = [given ? null : 'operating ranges', settings.limits ? null : 'limits'].filter(Boolean).join(' and ');
    return h('p', { class: 'small quiet' }, `The request gives no ${missing}: “As this, but …” asks the same with them.`);
  }
  return h('ul', { class: 'plain' }, ranges.map((range) => {
    const near = [[range.critical_inside, 'inside'], [range.critical_within_separation, `within ${number(range.separation_percent)} % of its ends`]];
    const words = near.filter(([n]) => n > 0).map(([n, where]) => `${count(n, 'critical speed')} ${where}`).join(', ');
    return h('li', {}, h('span', { class: `tag ${TAGS[range.verdict]}` }, range.verdict), ' ',
      h('strong', {}, range.name), ` ${speed(range.from_rad_s)} to ${speed(range.to_rad_s)}: `, words || (range.speeds > 0 ? 'no critical speed was found near' : 'no speed has a result'));
  }));
}

/** How far a speed is from the nearest range, in words. */
export function positionWords(ranges) {
  const nearest = [...ranges].sort((a, b) => a.distance_percent - b.distance_percent)[0];
  if (!nearest) return '–';
  const away = `${number(nearest.distance_percent, 2)} %`;
  return { inside: `in ${nearest.range}`, within_separation: `${away} from ${nearest.range}, within its separation` }[nearest.position] ?? `${away} from ${nearest.range}`;
}

/** Engine order and nodal diameter of a speed, in words. */
function responseWords({ critical: isPeak, resolved, engine_order: order, nodal_diameter: diameter }) {
  return [
    isPeak ? (resolved ? 'peak' : 'peak, not resolved') : 'no peak',
    order === undefined ? null : `engine order ${number(order)}`,
    diameter === undefined ? null : `nodal diameter ${diameter}`,
  ].filter(Boolean).join(', ');
}

/** Value v with its unit and where it may lie: an error e, which the service gives as v e, leaves v/(1 + e) to v (1 + e). */
function valueWords({ limit, value, error }, units) {
  const [shown, below, above] = [value, value * value / (value + error), value + error].map((each) => number(each, 3));
  const ends = error > 0 && (below !== shown || above !== shown) ? ` (${below} to ${above})` : '';
  return `${shown}${ends}${quantityUnit(limit, units)}`;
}

/** The worst speeds as cards: what, where, which limit by how much, what would decide, and the wheel. */
function worst(verdict, recorded, context, signal) {
  if (verdict.worst.length === 0) return null;
  const known = questionWords(context.job.request);
  const card = (one) => {
    const asked = verdict.would_decide.filter((question) => (question.speeds ?? []).includes(one.index));
    const open = [...new Set(asked.map(({ what, finding }) => (what in known ? known[what] : inWords(finding))).filter(Boolean))];
    return h('li', { class: 'card' },
      h('h3', {}, h('a', { href: context.address({ view: 'point', speed: one.index }) }, speed(one.speed_rad_s))),
      h('p', { class: 'small' }, [responseWords(one), verdict.ranges_given ? positionWords(one.ranges) : null].filter(Boolean).join('; ')),
      one.limits.length > 0 ? limits(one, verdict.units) : tipWords(one, verdict.units),
      open.length > 0 ? h('p', { class: 'small' }, `Open here: ${open.join('; ')}`) : null,
      wheelPicture(context, one, recorded, signal),
      fromHere(context.job, one.speed_rad_s, signal));
  };
  return [h('h2', {}, 'The worst speeds'), h('ul', { class: 'cards' }, verdict.worst.map(card))];
}

function tipWords({ tip }, { length }) {
  return tip ? h('p', {}, `Tip motion ${number(tip.half_peak_to_peak, 3)} ${length} (blade ${tip.sector}, node ${tip.contact_node}, ${tip.component})`) : null;
}

function limits(one, units) {
  const sorted = [...one.limits].sort((a, b) => b.value / b.allowed - a.value / a.allowed);
  return h('ul', { class: 'plain small' }, sorted.map((judged) => {
    return h('li', {}, `${quantityWords(judged.limit)} ${valueWords(judged, units)}, limit ${number(judged.allowed)}: `, h('strong', { class: STANDINGS[judged.standing] }, standingWords(judged)));
  }));
}

/** What is open, each question once, and what would decide it, with the form in which it is filled in. */
function questions({ would_decide: open }, { id, posted }) {
  if (open.length === 0) return null;
  return [h('h2', {}, 'What would decide'), h('ul', {}, open.map(({ range, finding, remedy }) => {
    const mend = posted ? mendable(remedy) : null;
    const link = mend ? [' ', h('a', { href: `#/sweep?as=${id}&mend=${mend}`, 'aria-label': `Open the form with ${inWords(remedy)}` }, 'Open the form with that')] : null;
    return h('li', {}, range ? `${range}: ` : '', inWords(finding), ' → ', inWords(remedy), link ? '.' : null, link);
  }))];
}

/** Critical speeds of the wheel against ranges and limits; those that the finished speeds show while the job runs. */
function critical({ critical_speeds: all, ranges_given: given, units, settings }, context, isRunning) {
  const asked = QUANTITIES.filter((name) => settings.limits?.[name] !== undefined && settings.limits[name] !== null);
  const of = (one, name) => one.limits.find((judged) => judged.limit === name);
  const value = (name) => ({
    name: wordsOf(`/limits/${name}`)[0], number: true, sort: (one) => of(one, name)?.value,
    cell: (one) => {
      const judged = of(one, name);
      return judged ? h('span', { class: STANDINGS[judged.standing], title: `${standingWords(judged)}; limit ${number(judged.allowed)}` }, valueWords(judged, units)) : '–';
    },
  });
  return [
    h('h2', {}, `${count(all.length, 'critical speed')} of the wheel${isRunning ? ' so far' : ''}`),
    all.length === 0 ? h('p', { class: 'quiet' }, `The response has no peak${isRunning ? ' at the speeds that are finished' : ''}.`) : table({
      caption: 'Critical speeds of the wheel against ranges and limits',
      onChoose: (one) => context.go({ view: 'point', speed: one.index }),
      rows: all,
      columns: [
        { name: 'Speed', cell: (one) => speed(one.speed_rad_s), sort: (one) => one.speed_rad_s },
        { name: 'Order', number: true, cell: (one) => number(one.engine_order), sort: (one) => one.engine_order },
        { name: 'Nodal diameter', number: true, cell: (one) => one.nodal_diameter ?? '–', sort: (one) => one.nodal_diameter },
        ...(given ? [{ name: 'Against the ranges', cell: (one) => positionWords(one.ranges) }] : []),
        { name: `Tip motion, ${units.length}`, number: true, cell: (one) => number(one.tip?.half_peak_to_peak, 3), sort: (one) => one.tip?.half_peak_to_peak },
        { name: 'Over clearance', number: true, cell: (one) => percent(one.tip?.over_clearance), sort: (one) => one.tip?.over_clearance },
        ...asked.filter((name) => name === 'utilisation' || name === 'node_force').map(value),
        { name: 'Peak', cell: (one) => (one.resolved ? 'resolved' : 'not resolved'), sort: (one) => Number(one.resolved) },
      ],
    }),
    h('p', { class: 'small' }, h('a', { href: context.address({ view: 'critical' }) }, 'With severity, credentials and the linear prediction')),
  ];
}
