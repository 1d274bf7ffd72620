// What can be asked next of a speed of a sweep: branches, a run-up through it, a campaign at it.

import { h } from '../../lib/dom.js';
import { speed } from '../../lib/format.js';
import { followButton } from './follow.js';

/** Buttons that begin these jobs with the sweep's model, scene and the speed filled in; `brief` as links in a table. */
export function fromHere(job, speed_rad_s, signal, brief = false) {
  if (job.status !== 'successful') return null;
  const begun = (kind) => `#/sweep?kind=${kind}&model=${job.model}&of=${job.id}&at=${speed_rad_s}`;
  const link = (kind, words) => h('a', { class: brief ? null : 'button', href: begun(kind), 'aria-label': `${words} ${speed(speed_rad_s)}` }, brief ? words.split(' ')[0] : words);
  return h('div', { class: brief ? 'next' : 'row small' }, followButton(job, speed_rad_s, signal, brief ? 'Branches' : 'Follow branches'), link('run_up', 'Run-up through'), link('campaign', 'Campaign at'));
}
