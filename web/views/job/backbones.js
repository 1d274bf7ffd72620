// Backbone curves of a modal analysis: frequency of free vibration over its amplitude, and why curves end.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';
import { number } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { table } from '../../lib/table.js';

export async function show(place, { job }, signal) {
  const path = `/v1/jobs/${job.id}/backbones`;
  const [drawn, found] = await Promise.all([api.figure(path, {}, { signal }), api.get(path, { signal })]);
  const figure = h('div', { class: 'figure tall' });
  replace(place,
    figure,
    h('div', { class: 'row', role: 'group', 'aria-label': 'Downloads' },
      ['json', 'csv', 'npz', 'svg', 'png'].map((form) => downloadButton(form, path, { format: form }, `${job.id}-backbones.${form}`, signal))),
    tableOf(found));
  await plot(figure, drawn, { signal, label: 'Backbone curves' });
}

function tableOf(found) {
  const last = (curve) => curve.points.at(-1);
  return table({
    caption: 'Curves and their ends',
    rows: found.curves,
    columns: [
      { name: 'Diameter', number: true, cell: (each) => each.nodal_diameter, sort: (each) => each.nodal_diameter },
      { name: 'Family', number: true, cell: (each) => each.family, sort: (each) => each.family },
      { name: 'Linear, Hz', number: true, cell: (each) => number(each.points[0].frequency_hz), sort: (each) => each.points[0].frequency_hz },
      { name: `To, ${found.units.length}`, number: true, cell: (each) => number(last(each).amplitude, 3), sort: (each) => last(each).amplitude },
      { name: 'Change, %', number: true, cell: (each) => number(last(each).change_percent, 3), sort: (each) => last(each).change_percent },
      { name: 'Outside, %', number: true, cell: (each) => number(100 * each.outside_coordinates, 2), sort: (each) => each.outside_coordinates },
      { name: 'End', cell: (each) => each.end },
    ],
  });
}
