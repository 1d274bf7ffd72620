// One speed of a sweep: its credentials, spectrum, histories, forces and stress.

import { api } from '../../lib/api.js';
import { facts, h, replace } from '../../lib/dom.js';
import { duration, number, percent, speed, speedLong } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { select, sensors } from './choices.js';
import { fromHere } from './from-here.js';
import { QUANTITIES, recorder } from './histories.js';
import { recordedSpeeds } from './recorded.js';
import { points, SETTLING, steadyWords, validityWords } from './sweep-credentials.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const map = await points(job, signal);
  // By speed: in a request a finer range may come after a coarse one, and refinement adds speeds at the end.
  const list = map.points.toSorted((a, b) => a.speed_rad_s - b.speed_rad_s);
  if (list.length === 0) {
    replace(place, h('p', { class: 'note' }, 'No speed has finished yet.'));
    return;
  }
  const asked = Number(query.get('speed') ?? list[0].index);
  const at = Math.max(0, list.findIndex((point) => point.index === asked));
  const point = list[at];
  const go = (k) => context.go({ view: 'point', speed: list[k].index });
  const step = (by) => at + by >= 0 && at + by < list.length && go(at + by);
  const button = (words, by) => h('button', { type: 'button', disabled: at + by < 0 || at + by >= list.length, on: { click: () => step(by) } }, words);
  const spectrum = h('div', { class: 'figure' });
  const histories = h('div');
  const frame = query.get('frame') ?? 'rotating';
  replace(place,
    h('div', { class: 'row' },
      button('Previous speed', -1),
      select('Speed', list.map((each, k) => [k, `${speed(each.speed_rad_s)}${each.status === 'completed' ? '' : ` (${each.status})`}`]), at, (k) => go(Number(k))),
      button('Next speed', 1),
      sensors(job.request, context),
      select('Frame', [['rotating', 'rotating'], ['fixed', 'fixed']], frame, (chosen) => context.go({ frame: chosen }))),
    h('h2', {}, speedLong(point.speed_rad_s)),
    point.status === 'completed' ? fromHere(job, point.speed_rad_s, signal) : null,
    point.message ? h('p', { class: 'note warning' }, point.message) : null,
    h('div', { class: 'columns' }, h('div', {}, h('h3', {}, 'Spectrum'), spectrum, h('h3', {}, 'Histories'), histories),
      h('aside', {}, h('h3', {}, 'Credentials'), credentials(job, point, map))));
  // Arrow keys go from speed to speed, unless they are needed by what has the focus.
  document.addEventListener('keydown', (event) => {
    if (event.target.closest('input, select, textarea, canvas, [role="region"], .js-plotly-plot') || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === 'ArrowLeft') step(-1);
    if (event.key === 'ArrowRight') step(1);
  }, { signal });

  if (point.status === 'completed') {
    await section(spectrum, signal, async () => {
      const read = await api.figure(`/v1/jobs/${job.id}/spectra/${point.index}`, { sensor: query.get('sensor'), frame }, { signal });
      await plot(spectrum, read, { signal, label: 'Spectrum' });
    });
  } else {
    replace(spectrum, h('p', { class: 'note' }, 'A speed without a result has no spectrum.'));
  }
  await showHistories(histories, context, point, signal);
}

/** Fills a part of the view; what fails stays in that part. */
async function section(element, signal, fill) {
  try {
    await fill();
  } catch (error) {
    if (!signal.aborted) replace(element, unread(error, signal));
  }
}

async function showHistories(element, context, point, signal) {
  const { job, query } = context;
  const quantity = query.get('quantity') ?? 'displacement';
  const figure = h('div', { class: 'figure' });
  replace(element,
    select('Quantity', QUANTITIES, quantity, (chosen) => context.go({ quantity: chosen })), figure,
    h('p', {}, h('a', { href: context.address({ view: 'fields', speed: point.index }) }, 'The wheel at this speed in 3D')));
  try {
    const { speeds } = await recordedSpeeds(job, signal);
    if (!speeds.has(point.index)) {
      replace(figure, job.status === 'successful' && point.status === 'completed' ? recorder(job, point.index, 'lines', signal)
        : h('p', { class: 'note' }, 'No histories are recorded of this speed.'));
      return;
    }
    const asked = { speed: point.index, sensor: query.get('sensor'), quantity };
    await plot(figure, await api.figure(`/v1/jobs/${job.id}/histories`, asked, { signal }), { signal, label: 'Histories' });
  } catch (error) {
    if (!signal.aborted) replace(figure, unread(error, signal));
  }
}

/** How long a speed was marched that was to end once it repeats. */
function marchWords(march) {
  if (!march) return null;
  const ended = march.reason ?? `repeats every ${march.period_revolutions === 1 ? 'revolution' : `${march.period_revolutions} revolutions`}, to ${percent(march.remaining_change)}`;
  return `${march.revolutions} revolutions; ${ended}`;
}

/** What is known of one speed. */
function credentials({ request }, point, map) {
  const error = map.errors?.points.find((each) => each.index === point.index);
  const { length, force } = map.units;
  const settling = point.settling;
  return facts([
    ['Status', point.status],
    ['Steady state', settling ? `${SETTLING[settling.verdict]}${settling.after_revolutions ? `, after ${settling.after_revolutions} revolutions` : ''}` : null],
    ['Marched', marchWords(point.march)],
    ['Periodic response', steadyWords(point.steady)],
    ['Largest change between periods', settling?.largest_change === undefined ? null : percent(settling.largest_change)],
    ['Validity', validityWords(request, point.validity)],
    ['Estimated error', error ? `${percent(error.estimated_error)}${error.controlled ? ', simulated again' : ', interpolated from its neighbours'}` : 'not estimated'],
    ['Energy residual', point.energy_residual?.toExponential(1)],
    ['Work of stiffening blades against their energy', point.energy?.bending_residual?.toExponential(1)],
    ['Remaining penetration', point.largest_penetration === null || point.largest_penetration === undefined ? null : `${number(point.largest_penetration, 2)} ${length}`],
    ['Contact', `${percent(point.contact_share)} of the steps`],
    ['Largest force on a node', point.contact ? `${number(point.contact.peak_node_force)} ${force}` : null],
    ['Clearance consumption', point.contact ? percent(point.contact.clearance_consumption) : null],
    ['Largest tip motion', point.tip ? `blade ${point.tip.sector}, ${point.tip.component}, half peak to peak ${number(point.tip.half_peak_to_peak)} ${length}` : null],
    ['Largest von Mises stress', point.stress ? `${number(point.stress.largest.von_mises)} ${force}/${length}²` : null],
    ['Scheme', point.scheme ? `${point.scheme.name}: ${point.scheme.reason}` : null],
    ['Steps', `${number(point.steps, 9)}, ${point.steps_per_revolution} a revolution`],
    ['Wall time', duration(point.wall_time_s)],
    ['Code', point.version],
  ]);
}
