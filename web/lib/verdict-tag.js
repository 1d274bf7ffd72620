// The verdict on a finished sweep as one word in its colour.

import { h } from './dom.js';

/** Looks of the verdicts as tags. */
export const TAGS = { act: 'bad', undecided: '', watch: 'warn', clear: 'good' };

/** The tag of a job's verdict when it ended; nothing of a job without one. */
export function verdictTag({ verdict }) {
  if (!verdict) return null;
  return h('span', { class: `tag ${TAGS[verdict] ?? ''}`, 'data-verdict': verdict, title: 'Verdict by the operating ranges and limits of the request' }, verdict);
}
