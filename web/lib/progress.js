// How far a running job is: no more than is known of it.

/** Percent from which on the speeds that a sweep was asked for are finished: what is added around peaks, and the control runs, are still to come. */
const ASKED_DONE = 99;

/** Number of speeds that the request of a sweep names; 0 where it is not at hand, as in lists. */
function askedCount({ posted }) {
  return [posted?.speeds ?? []].flat().reduce((sum, { values, count }) => sum + (values?.length ?? count ?? 0), 0);
}

/**
 * Words on a running job, and its percentage for a bar: `null` where nobody knows how much is left.
 * @param {any} job
 * @returns {{words: string, share: number | null}}
 */
export function progressOf(job) {
  const { kind, phase, progress, speeds } = job;
  const said = (...words) => words.filter(Boolean).join(' · ');
  if (kind !== 'sweep' || !speeds || progress < ASKED_DONE) return { words: said(`${progress} %`, phase), share: progress };
  const asked = askedCount(job);
  const added = asked > 0 && speeds.total > asked ? `all ${asked} speeds finished; refining: ${speeds.total - asked} added around peaks` : null;
  return { words: said(added, phase), share: speeds.finished < speeds.total ? 100 * speeds.finished / speeds.total : null };
}

/** Shows in a bar how far a job is; one that moves to and fro where nobody knows. */
export function showProgress(bar, { share }) {
  if (share === null) bar.removeAttribute('value');
  else bar.value = share;
}
