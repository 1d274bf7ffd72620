// Results that grow while their job runs.

import { ended } from './events.js';

/** What grows is read again at most so often. */
const PAUSE_MS = 5000;

/**
 * Reads a result now, and again when its job has gone on: never twice at once, and only while somebody sees it.
 * @param {{now: () => any, onChange: (f: (job: any) => void) => void}} context of the view
 * @param {{read: () => Promise<boolean | void>, grown: (job: any) => boolean}} what `read` tells itself what fails, and whether there is nothing yet, so
 *   that it is read again even where the job does not say that it has gone on; `grown` whether there is more than when it was asked last
 * @param {AbortSignal} signal
 */
export async function growing(context, { read, grown }, signal) {
  let last = 0;
  let reading = false;
  let again = false;
  let timer = 0;
  // Whether it has grown while nobody saw it.
  let missed = false;
  signal.addEventListener('abort', () => clearTimeout(timer));

  async function refresh() {
    if (reading) {
      again = true;
      return;
    }
    reading = true;
    last = Date.now();
    try {
      if (await read() && !ended(context.now())) again = true;
    } finally {
      reading = false;
    }
    if (again) {
      again = false;
      soon();
    }
  }
  function soon() {
    clearTimeout(timer);
    const wait = ended(context.now()) ? 0 : Math.max(0, last + PAUSE_MS - Date.now());
    timer = setTimeout(() => {
      missed = document.hidden;
      if (!signal.aborted && !missed) refresh();
    }, wait);
  }
  context.onChange((now) => {
    const more = grown(now);
    if (more || ended(now)) soon();
  });
  document.addEventListener('visibilitychange', () => !document.hidden && missed && soon(), { signal });
  await refresh();
}

/** Whether more speeds of a job are finished than when it was asked last. */
export function moreSpeeds(job) {
  let finished = job.speeds?.finished ?? 0;
  return (now) => {
    const before = finished;
    finished = now.speeds?.finished ?? 0;
    return finished > before;
  };
}
