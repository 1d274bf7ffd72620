// A campaign: severity over speed and a parameter, and its designs; they grow while the job runs.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';
import { count, known, number, speed } from '../../lib/format.js';
import { growing, moreSpeeds } from '../../lib/growing.js';
import { plot } from '../../lib/plot.js';
import { unread } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { select } from './choices.js';

/** Most designs that the table shows. */
const SHOWN = 500;

const MEETS = { true: 'meets the limit', false: 'exceeds it' };

export async function show(place, context, signal) {
  const { job, query } = context;
  const { parameters, threshold } = job.request;
  const path = `/v1/jobs/${job.id}/campaign`;
  const asked = { parameter: query.get('parameter') ?? threshold?.parameter ?? parameters[0].name };
  const figure = h('div', { class: 'figure tall' });
  const told = h('div', { role: 'status' });
  const found = h('div');
  const files = ['json', 'csv', 'npz', 'svg', 'png'].map((form) => downloadButton(form, path, { ...asked, format: form }, `${job.id}-campaign.${form}`, signal));
  const options = parameters.map(({ name }) => [name, name]);
  replace(place,
    h('div', { class: 'row' }, options.length > 1 ? select('Over', options, asked.parameter, (parameter) => context.go({ parameter })) : null),
    told, figure, found, h('div', { class: 'row', role: 'group', 'aria-label': 'Downloads' }, files));

  async function read() {
    try {
      const drawn = await api.figure(path, asked, { signal });
      // What is zoomed stays so when designs are added.
      drawn.layout.uirevision = job.id;
      replace(told);
      await plot(figure, drawn, { signal, label: 'Campaign' });
      replace(found, tables(await api.get(path, { signal })));
    } catch (error) {
      if (!signal.aborted) replace(told, unread(error, signal));
    }
  }
  await growing(context, { read, grown: moreSpeeds(job) }, signal);
}

function tables({ designs, sensitivities, threshold, comparison, settings, speeds_rad_s: speeds }) {
  const values = settings.parameters.map(({ name }, place) => ({
    name, number: true, cell: (design) => number(design.values[place]), sort: (design) => design.values[place],
  }));
  return [
    threshold ? h('p', {}, threshold.message) : null,
    comparison ? compared(comparison, speeds, settings) : null,
    sensitivities ? h('h2', {}, 'Sensitivities') : null,
    sensitivities ? table({
      caption: 'Shares of the variance of the severity',
      rows: sensitivities.parameters,
      columns: [
        { name: 'Parameter', cell: (one) => one.parameter, sort: (one) => one.parameter },
        { name: 'Alone', number: true, cell: (one) => known(one.first_order, one.first_order_error), sort: (one) => one.first_order },
        { name: 'With others', number: true, cell: (one) => known(one.total, one.total_error), sort: (one) => one.total },
      ],
    }) : null,
    h('h2', {}, count(designs.length, 'design')),
    designs.length > SHOWN ? h('p', { class: 'quiet' }, `The first ${SHOWN}; the files have all.`) : null,
    table({
      caption: 'Designs',
      rows: designs.slice(0, SHOWN),
      columns: [
        { name: 'Design', number: true, cell: (design) => design.index, sort: (design) => design.index },
        ...values,
        { name: 'Severity', number: true, cell: (design) => number(design.severity), sort: (design) => design.severity },
        { name: 'Worst at', number: true, cell: (design) => (design.worst_speed_rad_s ? speed(design.worst_speed_rad_s) : '–'), sort: (design) => design.worst_speed_rad_s },
        { name: 'Limit', cell: (design) => MEETS[design.meets_limit] ?? '–', sort: (design) => design.meets_limit },
        ...(comparison ? [{ name: 'Compared', number: true, cell: ({ compared: other }) => number(other.severity), sort: ({ compared: other }) => other.severity }] : []),
      ],
    }),
  ].filter(Boolean);
}

const VERDICTS = { greater: 'the compared model is more severe', smaller: 'the compared model is less severe', undecided: 'no larger than its error' };

/** How the model that is compared differs, at every speed. */
function compared({ model, message, by_speed: differences, limit }, speeds, settings) {
  const rows = speeds.map((rad_s, place) => ({ rad_s, of: differences[place] })).filter(({ of }) => of);
  return h('section', {},
    h('h2', {}, 'Compared with ', h('a', { href: `#/models/${model}` }, 'another model')),
    h('p', {}, message),
    limit ? h('p', {}, `Of the designs with a known outcome for both models, ${limit.both} meet the limit of ${number(settings.limit)} with both, ${limit.only_model} only with the campaign’s model, ${limit.only_compared} only with the compared one, ${limit.neither} with neither.`) : null,
    table({
      caption: 'Differences of the severity by speed',
      rows,
      columns: [
        { name: 'Speed', number: true, cell: ({ rad_s }) => speed(rad_s), sort: ({ rad_s }) => rad_s },
        { name: 'Difference', number: true, cell: ({ of }) => number(of.mean), sort: ({ of }) => of.mean },
        { name: 'From', number: true, cell: ({ of }) => number(of.from), sort: ({ of }) => of.from },
        { name: 'To', number: true, cell: ({ of }) => number(of.to), sort: ({ of }) => of.to },
        { name: 'Pairs', number: true, cell: ({ of }) => of.pairs, sort: ({ of }) => of.pairs },
        { name: 'Verdict', cell: ({ of }) => VERDICTS[of.verdict], sort: ({ of }) => of.verdict },
      ],
    }));
}
