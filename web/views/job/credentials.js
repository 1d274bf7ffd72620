// What a job rests on: settings, reduction, choices, code.

import { facts, h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { duration, moment, number } from '../../lib/format.js';
import { again } from '../../lib/place.js';
import { sweepCredentials } from './sweep-credentials.js';

export async function show(place, context, signal) {
  const { job } = context;
  const { reduction, choice } = job;
  const worth = h('div');
  replace(place,
    worth,
    h('h2', {}, 'The job'),
    facts([
      ['Id', h('code', {}, job.id)],
      ['Accepted', moment(job.created_at)],
      ['Began', moment(job.started_at)],
      ['Ended', moment(job.finished_at)],
      ['Tags', (job.tags ?? []).join(', ')],
      ['Notes', job.notes],
    ]),
    reduction ? [
      h('h2', {}, 'The reduction'),
      facts([
        ['Modes per speed', reduction.modes_per_speed],
        ['Unknowns of the reduced wheel', number(reduction.wheel_unknowns, 9)],
        ['Unknowns by nodal diameter', reduction.unknowns.join(', ')],
        ['Largest residual of a mode', reduction.largest_mode_residual?.toExponential(1)],
        ['Modes counted', reduction.counted_modes === null || reduction.counted_modes === undefined ? null : 'none was missed (Sylvester’s law)'],
        ['Stiffening', reduction.stiffening?.verdict],
        ['Computed in', duration(reduction.wall_time_s)],
        ['Code', reduction.version],
      ]),
    ] : null,
    choice ? [h('h2', {}, 'Chosen setting'), h('pre', { tabindex: '0', 'aria-label': 'Choice' }, JSON.stringify(choice, null, 2))] : null,
    h('h2', {}, 'The request'),
    h('pre', { tabindex: '0', 'aria-label': 'Request' }, JSON.stringify(job.request, null, 2)));
  if (!ended(job)) context.onChange((now) => ended(now) && again());
  if (job.kind === 'sweep') await sweepCredentials(worth, context, signal);
}

