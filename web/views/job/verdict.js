// The verdict on a sweep: one sentence, before everything else.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { inWords } from '../../lib/form/named.js';
import { growing, moreSpeeds } from '../../lib/growing.js';
import { problem } from '../../lib/problem.js';

/** Looks of the verdicts as notes. */
const LOOKS = { act: 'bad', undecided: '', watch: 'warning', clear: 'fine' };

/** Shows the verdict on a sweep, again when more speeds are finished, and when the job has ended. */
export async function verdict(element, context, signal) {
  const { job } = context;
  const read = async () => {
    try {
      const { verdict: word, sentence } = await api.get(`/v1/jobs/${job.id}/verdict`, { signal });
      const colon = sentence.indexOf(':') + 1;
      replace(element, h('p', { class: `note ${LOOKS[word] ?? ''}`, 'data-verdict': word }, h('strong', {}, sentence.slice(0, colon)), inWords(sentence.slice(colon))));
    } catch (error) {
      if (!signal.aborted) replace(element, problem(error));
    }
  };
  await growing(context, { read, grown: moreSpeeds(job) }, signal);
}
