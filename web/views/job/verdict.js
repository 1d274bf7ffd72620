// The verdict on a sweep: one sentence, before everything else.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { problem } from '../../lib/problem.js';

/** Looks of the verdicts, as tags and as notes. */
export const TAGS = { act: 'bad', undecided: '', watch: 'warn', clear: 'good' };
const LOOKS = { act: 'bad', undecided: '', watch: 'warning', clear: 'fine' };

/** Text whose words between backticks are code. */
export function coded(text) {
  return text.split('`').map((part, k) => (k % 2 === 1 ? h('code', {}, part) : part));
}

/** Shows the verdict on a sweep, and again when the job has ended. */
export async function verdict(element, { job, onChange }, signal) {
  const show = async () => {
    try {
      const { verdict: word, sentence } = await api.get(`/v1/jobs/${job.id}/verdict`, { signal });
      const colon = sentence.indexOf(':') + 1;
      replace(element, h('p', { class: `note ${LOOKS[word] ?? ''}`, 'data-verdict': word }, h('strong', {}, sentence.slice(0, colon)), coded(sentence.slice(colon))));
    } catch (error) {
      if (!signal.aborted) replace(element, problem(error));
    }
  };
  let over = ended(job);
  onChange((now) => {
    if (over || !ended(now)) return;
    over = true;
    show();
  });
  await show();
}
