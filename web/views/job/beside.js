// A sweep of the same model, whose speeds are drawn as dots beside what a job found.

import { api } from '../../lib/api.js';
import { h } from '../../lib/dom.js';
import { nameOf } from '../../lib/format.js';
import { select } from './choices.js';

/** Choice of such a sweep; `other` says what one is that is not in the list. */
export async function sweepBeside({ job, query, go }, other, signal) {
  const { jobs } = await api.get('/v1/jobs', { query: { kind: 'sweep', status: 'successful', model: job.model, limit: 100 }, signal });
  const chosen = query.get('sweep') ?? '';
  const options = [['', 'none'], ...jobs.map((each) => [each.id, nameOf(each)])];
  if (!options.some(([id]) => id === chosen)) options.push([chosen, other]);
  return options.length > 1 ? select('Sweep beside', options, chosen, (sweep) => go({ sweep })) : null;
}

/** What its dots are, where one is chosen. */
export function besideWords({ query }) {
  const sweep = query.get('sweep');
  if (!sweep) return null;
  return h('p', { class: 'quiet small' }, 'Dots are the speeds of ', h('a', { href: `#/jobs/${sweep}` }, 'the sweep beside'), ', which are of the same motion only where its scene is the same.');
}
