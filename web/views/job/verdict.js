// The verdict on a sweep: one sentence, before everything else.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { growing, moreSpeeds } from '../../lib/growing.js';
import { problem } from '../../lib/problem.js';

/** Looks of the verdicts as notes. */
const LOOKS = { act: 'bad', undecided: '', watch: 'warning', clear: 'fine' };

/** Text whose words between backticks are code. */
export function coded(text) {
  return text.split('`').map((part, k) => (k % 2 === 1 ? h('code', {}, part) : part));
}

/** Shows the verdict on a sweep, again when more speeds are finished, and when the job has ended. */
export async function verdict(element, context, signal) {
  const { job } = context;
  const read = async () => {
    try {
      const { verdict: word, sentence } = await api.get(`/v1/jobs/${job.id}/verdict`, { signal });
      const colon = sentence.indexOf(':') + 1;
      replace(element, h('p', { class: `note ${LOOKS[word] ?? ''}`, 'data-verdict': word }, h('strong', {}, sentence.slice(0, colon)), coded(sentence.slice(colon))));
    } catch (error) {
      if (!signal.aborted) replace(element, problem(error));
    }
  };
  await growing(context, { read, grown: moreSpeeds(job) }, signal);
}
