// Which speeds of a sweep have states and histories, so that nothing is asked for that is not there.

import { api } from '../../lib/api.js';
import { ended } from '../../lib/events.js';

/** Whether a job has a result, by the links that it gives. */
export function has(job, rel) {
  return job.links.some((link) => link.rel === rel);
}

/** Indices of the speeds of which histories are stored, and whether states are as well. */
export async function recordedSpeeds(job, signal) {
  const wanted = job.request.record?.histories;
  const none = { speeds: new Set(), states: false };
  if (job.kind !== 'sweep' || !wanted || !ended(job) || job.status !== 'successful') return none;
  const states = has(job, 'fields');
  if (Array.isArray(wanted.speeds)) return { speeds: new Set(wanted.speeds), states };
  const wheel = await api.get(`/v1/jobs/${job.id}/critical-speeds/wheel`, { signal });
  return { speeds: new Set(wheel.sensors.flatMap((sensor) => sensor.critical_speeds.map((one) => one.index))), states };
}

/** Jobs of this tab that recorded speeds of a sweep: ids by the index of the speed. */
const KEY = (job) => `recorded ${job.id}`;

export function recordings(job) {
  return JSON.parse(sessionStorage.getItem(KEY(job)) ?? '{}');
}

export function remember(job, index, id) {
  sessionStorage.setItem(KEY(job), JSON.stringify({ ...recordings(job), [index]: id }));
}
