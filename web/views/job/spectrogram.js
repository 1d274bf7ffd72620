// The spectrogram of a run: amplitudes over speed and engine order or frequency; it grows while the run does.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';
import { ended } from '../../lib/events.js';
import { growing } from '../../lib/growing.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { select, sensors } from './choices.js';
import { linear } from './linear.js';
import { further, runWords } from './run-ups.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/spectrogram`;
  const asked = { run: query.get('run') ?? '0', sensor: query.get('sensor'), over: query.get('over') ?? 'order' };
  const scale = query.get('scale') ?? 'log';
  const runs = (job.request.speed.rates ?? [null]).map((rad_s2, run) => [run, runWords(run, rad_s2)]);
  const figure = h('div', { class: 'figure tall' });
  const told = h('div', { role: 'status' });
  const files = ['json', 'csv', 'npz', 'svg', 'png'].map((form) => downloadButton(form, path, { ...asked, format: form }, `${job.id}-spectrogram-${asked.run}.${form}`, signal));
  replace(place,
    h('div', { class: 'row' },
      runs.length > 1 ? select('Run', runs, asked.run, (run) => context.go({ run })) : null,
      sensors(job.request.sweep, context),
      select('Upwards', [['order', 'engine order'], ['hz', 'frequency, Hz']], asked.over, (over) => context.go({ over })),
      select('Amplitude', [['log', 'logarithmic'], ['linear', 'linear']], scale, (chosen) => context.go({ scale: chosen }))),
    told, figure,
    h('div', { class: 'row', role: 'group', 'aria-label': 'Downloads' }, files));

  async function read() {
    try {
      const { runs: begun } = await api.get(`/v1/jobs/${job.id}/run-ups`, { signal });
      if (!begun.some(({ run, frames }) => run === Number(asked.run) && frames.length > 0)) {
        replace(told, h('p', { class: 'note' }, ended(context.now()) ? 'The job ended before this run.' : 'Nothing of this run is there yet.'));
        return true;
      }
      const drawn = await api.figure(path, asked, { signal });
      // What is zoomed stays so when the run goes on.
      drawn.layout.uirevision = job.id;
      replace(told);
      await plot(figure, scale === 'linear' ? linear(drawn) : drawn, { signal, label: 'Spectrogram' });
    } catch (error) {
      if (!signal.aborted) replace(told, unread(error, signal));
    }
    return false;
  }
  await growing(context, { read, grown: further(job) }, signal);
}
