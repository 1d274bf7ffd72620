// What can be asked next of a speed of a sweep: branches, a run-up through it, a campaign at it.

import { h } from '../../lib/dom.js';
import { speed } from '../../lib/format.js';
import { followButton } from './follow.js';

/** Buttons that begin these jobs with the sweep's model, scene and the speed filled in. */
export function fromHere(job, speed_rad_s, signal) {
  if (job.status !== 'successful') return null;
  const begun = (kind) => `#/sweep?kind=${kind}&model=${job.model}&of=${job.id}&at=${speed_rad_s}`;
  const link = (kind, words) => h('a', { class: 'button', href: begun(kind), 'aria-label': `${words} ${speed(speed_rad_s)}` }, words);
  return h('div', { class: 'row small' }, followButton(job, speed_rad_s, signal, 'Follow branches'), link('run_up', 'Run-up through'), link('campaign', 'Campaign at'));
}
