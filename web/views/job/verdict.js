// The verdict on a sweep: one sentence, before everything else.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { problem } from '../../lib/problem.js';

/** Looks of the verdicts. */
const LOOKS = { act: 'bad', undecided: '', watch: 'warning', clear: 'fine' };

/** Shows the verdict on a sweep, and again when the job has ended. */
export async function verdict(element, { job, onChange }, signal) {
  const show = async () => {
    try {
      const { verdict: word, sentence } = await api.get(`/v1/jobs/${job.id}/verdict`, { signal });
      const colon = sentence.indexOf(':') + 1;
      replace(element, h('p', { class: `note ${LOOKS[word] ?? ''}`, 'data-verdict': word }, h('strong', {}, sentence.slice(0, colon)), sentence.slice(colon)));
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
