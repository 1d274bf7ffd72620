// The interaction map: it grows while the job runs, and a click on it opens the speed.

import { api, Refusal } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { ended } from '../../lib/events.js';
import { growing, moreSpeeds } from '../../lib/growing.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { select, sensors } from './choices.js';
import { linear } from './linear.js';
import { has } from './recorded.js';
import { sweepCredentials } from './sweep-credentials.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/interaction-map`;
  const figure = h('div', { class: 'figure tall' });
  const told = h('div');
  const summary = h('div');
  const scale = query.get('scale') ?? 'log';
  replace(place,
    h('div', { class: 'row' },
      sensors(job.request, context),
      select('Upwards', [['engine_order', 'engine order'], ['frequency', 'frequency, Hz']], query.get('axis') ?? 'engine_order', (axis) => context.go({ axis })),
      select('Frame', [['rotating', 'rotating'], ['fixed', 'fixed']], query.get('frame') ?? 'rotating', (frame) => context.go({ frame })),
      select('Amplitude', [['log', 'logarithmic'], ['linear', 'linear']], scale, (chosen) => context.go({ scale: chosen })),
      select('Nodal diameter', [['', 'all'], ...await diameters(job, signal)], query.get('nodal_diameter') ?? '', (nodal_diameter) => context.go({ nodal_diameter })),
      has(job, 'stress') ? select('Level coloured by', [['', 'nothing'], ['utilisation', 'utilisation']], query.get('colour') ?? '', (colour) => context.go({ colour })) : null),
    told, figure,
    h('p', { class: 'quiet small' }, 'Click the map to open a speed; the arrow keys of “One speed” step through all speeds.'),
    summary);

  async function read() {
    try {
      const found = await api.figure(path, {
        sensor: query.get('sensor'), axis: query.get('axis'), frame: query.get('frame'), nodal_diameter: query.get('nodal_diameter'), colour: query.get('colour'),
      }, { signal });
      // What is zoomed stays so when the map grows.
      found.layout.uirevision = job.id;
      replace(told);
      await plot(figure, scale === 'linear' ? linear(found) : found, {
        signal, label: 'Interaction map', onClick: (event) => open(event, found, context),
      });
      if (ended(context.now())) await sweepCredentials(summary, context, signal);
    } catch (error) {
      if (!signal.aborted) replace(told, unread(error, signal));
    }
  }
  await growing(context, { read, grown: moreSpeeds(job) }, signal);
}

/** Nodal diameters to choose from: their number follows from that of the sectors; none where the model is deleted. */
async function diameters({ model }, signal) {
  try {
    const { sectors } = await api.get(`/v1/models/${model}`, { signal });
    return Array.from({ length: Math.floor(sectors / 2) + 1 }, (_, n) => [String(n), String(n)]);
  } catch (error) {
    if (error instanceof Refusal && error.status === 404) return [];
    throw error;
  }
}

/** Opens the speed that was clicked. */
function open(event, figure, context) {
  const point = event.points?.[0];
  const { speeds_rpm: speeds, speed_indices: indices } = figure.layout.meta ?? {};
  if (!point || !speeds?.length) return;
  let nearest = 0;
  speeds.forEach((speed, k) => {
    if (Math.abs(speed - point.x) < Math.abs(speeds[nearest] - point.x)) nearest = k;
  });
  context.go({ view: 'point', speed: indices[nearest] });
}
