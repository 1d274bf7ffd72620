// The wheel in 3D at a speed whose states were recorded: an instant, or the deflection shape of an engine order, with stress.

import { api } from '../../lib/api.js';
import { h, newId, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { number, speed as speedWords } from '../../lib/format.js';
import { again } from '../../lib/place.js';
import { unread } from '../../lib/problem.js';
import { showWheel } from '../../wheel/index.js';
import { select } from './choices.js';
import { recorder } from './histories.js';
import { recordedSpeeds } from './recorded.js';

/** Instants of a revolution that is played. */
const FRAMES = 36;

/** What colours show, and what is asked for: stress alone or with that of the centrifugal load, which only instants have. */
const COLOURS = [
  ['', 'displacement', {}],
  ['stress', 'von Mises stress of the vibration', { stress: true }],
  ['total', 'von Mises stress with the static part', { stress: true, static: 'include' }],
];

export async function show(place, context, signal) {
  const { job, query } = context;
  if (!ended(job)) {
    replace(place, h('p', { class: 'note' }, 'The wheel is here when the job has ended.'));
    context.onChange((now) => ended(now) && again());
    return;
  }
  if (job.kind === 'sweep' && await unrecorded(place, context, signal)) return;
  const order = query.get('engine_order') ?? '';
  const model = await api.get(`/v1/models/${job.model}`, { signal });
  const colours = COLOURS.filter(([name]) => name === '' || (model.mesh && (name !== 'total' || order === '')));
  const [name, words, asked] = colours.find(([one]) => one === query.get('colour')) ?? colours[0];
  const recorded = job.request.record?.histories?.speeds;
  const speed = query.get('speed') ?? (Array.isArray(recorded) ? String(recorded[0]) : null);
  const id = newId('order');
  const field = h('input', { id, type: 'number', min: 0, step: 1, value: order });
  field.addEventListener('change', () => context.go({ engine_order: field.value }));
  const wheel = h('div');
  replace(place,
    h('div', { class: 'row' },
      Array.isArray(recorded) && recorded.length > 1 ? select('Speed', recorded.map((index) => [String(index), `index ${index}`]), speed, (chosen) => context.go({ speed: chosen })) : null,
      h('span', {}, h('label', { for: id }, 'Deflection shape of engine order '), field),
      select('Colour', colours.map(([one, text]) => [one, text]), name, (chosen) => context.go({ colour: chosen }))),
    order === '' ? h('p', { class: 'quiet small' }, 'Without an engine order: the instant of the largest tip motion, or a revolution of recorded instants.') : null,
    wheel);
  const { length, force } = model.units;
  const unit = asked.stress ? `${force}/${length}²` : length;
  const yields = (model.mesh?.sets ?? []).map((set) => (job.request.sweep ?? job.request).record?.stress?.strengths?.[set.set]?.yield_strength ?? set.yield_strength).filter(Number.isFinite);
  try {
    const casing = order === '' ? await api.get(`/v1/models/${job.model}/section`, { query: { sweep: job.id }, signal }) : null;
    await showWheel(wheel, {
      path: `/v1/jobs/${job.id}/fields`,
      query: { speed, engine_order: order, ...asked },
      animated: order !== '',
      scalar: asked.stress ? 'von_mises' : 'displacement',
      words,
      unit,
      length,
      limit: name === 'total' && yields.length > 0 ? { value: Math.min(...yields), words: `the yield strength, ${number(Math.min(...yields))} ${unit}` } : null,
      contact: casing?.contact,
      instants: casing && (() => instantsOf(job, speed, signal)),
      label: 'Wheel in 3D',
    }, signal);
  } catch (error) {
    if (signal.aborted) return;
    // What is asked for stays there to be changed.
    replace(wheel, unread(error, signal));
  }
}

/** Instants of the last revolution that was recorded. */
async function instantsOf(job, speed, signal) {
  const { revolutions: [begin, end], samples_per_revolution: samples } = await api.get(`/v1/jobs/${job.id}/histories`, { query: { speed }, signal });
  return Array.from({ length: FRAMES }, (_, k) => (end - begin - 1) * samples + Math.floor(k * samples / FRAMES));
}

/** Where no state of the speed was recorded: a button that records it, of a speed that can be chosen. */
async function unrecorded(place, { job, query, go }, signal) {
  const { speeds, states } = await recordedSpeeds(job, signal);
  const asked = query.get('speed');
  if (states && (asked === null ? speeds.size > 0 : speeds.has(Number(asked)))) return false;
  const { points } = await api.get(`/v1/jobs/${job.id}/interaction-map`, { query: { orders: '0' }, signal });
  const done = points.filter((point) => point.status === 'completed').toSorted((a, b) => a.speed_rad_s - b.speed_rad_s);
  const words = (point) => `${speedWords(point.speed_rad_s)}${states && speeds.has(point.index) ? ', recorded' : ''}`;
  const most = done.reduce((best, point) => ((point.tip?.rms ?? 0) > (best?.tip?.rms ?? -1) ? point : best), null);
  const chosen = asked ?? (most ? String(most.index) : null);
  replace(place,
    done.length > 0 ? select('Speed', done.map((point) => [String(point.index), words(point)]), chosen, (speed) => go({ speed })) : null,
    chosen !== null && job.status === 'successful' ? recorder(job, Number(chosen), 'fields', signal)
      : h('p', { class: 'note' }, 'No state is recorded. When the job is done, any of its speeds can be recorded here.'));
  return true;
}
