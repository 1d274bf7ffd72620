// How far a running job is: no more than is known of it.

/** Percent from which on the speeds that a sweep was asked for are finished: what is added around peaks, and the control runs, are still to come. */
const ASKED_DONE = 99;

/**
 * Words on a running job, and its percentage for a bar: `null` where nobody knows how much is left.
 * @param {any} job
 * @returns {{words: string, share: number | null}}
 */
export function progressOf(job) {
  const { kind, phase, progress, speeds } = job;
  if (kind !== 'sweep' || !speeds || progress < ASKED_DONE) return { words: [`${progress} %`, phase].filter(Boolean).join(' · '), share: progress };
  return { words: phase ?? '', share: speeds.finished < speeds.total ? 100 * speeds.finished / speeds.total : null };
}

/** Shows in a bar how far a job is; one that moves to and fro where nobody knows. */
export function showProgress(bar, { share }) {
  if (share === null) bar.removeAttribute('value');
  else bar.value = share;
}
