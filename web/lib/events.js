// A job as it goes on.

import { api, passing, request } from './api.js';
import { pause } from './dom.js';

const ENDED = new Set(['successful', 'failed', 'dismissed']);

/** Whether a job has ended. */
export function ended(job) {
  return ENDED.has(job.status);
}

/**
 * Tells of every change of a job until it has ended or `signal` is aborted: by the stream of events, which needs a token's header and is
 * therefore read here. A broken stream is taken up again.
 * @param {string} id
 * @param {(job: any) => void} tell
 * @param {AbortSignal} signal
 */
export async function follow(id, tell, signal) {
  let wait = 500;
  let last = null;
  const told = (job) => {
    wait = 500;
    last = job;
    tell(job);
  };
  while (!signal.aborted && !(last && ended(last))) {
    try {
      await stream(id, told, signal);
    } catch (error) {
      if (signal.aborted) return;
      // A stream that breaks off is a TypeError.
      if (!passing(error) && !(error instanceof TypeError)) throw error;
    }
    if (last && ended(last)) return;
    await pause(wait, signal).catch(() => {});
    wait = Math.min(2 * wait, 10_000);
  }
}

async function stream(id, tell, signal) {
  const response = await request(`/v1/jobs/${id}/events`, { signal, accept: 'text/event-stream' });
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = '';
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    text += value;
    const events = text.split('\n\n');
    text = events.pop();
    for (const event of events) {
      const data = event.split('\n').filter((line) => line.startsWith('data:')).map((line) => line.slice(5).trimStart());
      if (data.length > 0) tell(JSON.parse(data.join('\n')));
    }
  }
}

/** Does something again and again while a view is open and visible; `f` may take as long as it likes. `milliseconds` says how long is waited after it. */
export async function poll(f, milliseconds, signal) {
  while (!signal.aborted) {
    if (!document.hidden) {
      try {
        await f();
      } catch (error) {
        if (!passing(error) && !signal.aborted) throw error;
      }
    }
    await pause(milliseconds(), signal).catch(() => {});
  }
}

/** The job as it is now. */
export function readJob(id, signal) {
  return api.get(`/v1/jobs/${id}`, { signal });
}
