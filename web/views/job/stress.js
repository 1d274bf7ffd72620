// Stress and margin: Haigh diagram and the most utilised places.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { number, percent, speed } from '../../lib/format.js';
import { plot } from '../../lib/plot.js';
import { table } from '../../lib/table.js';
import { select } from './choices.js';
import { VALIDITY } from './verdicts.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const path = `/v1/jobs/${job.id}/stress`;
  const colour = query.get('colour') ?? 'speed';
  const figure = h('div', { class: 'figure tall' });
  const below = h('div');
  // Without stress this is refused, and says how to get it.
  const found = await api.get(path, { query: { speed: query.get('speed') }, signal });
  replace(place, h('div', { class: 'row' }, select('Coloured by', [['speed', 'speed'], ['utilisation', 'utilisation']], colour, (chosen) => context.go({ colour: chosen })),
    query.has('speed') ? h('a', { href: context.address({ speed: null }) }, 'All speeds') : null), figure, below);
  const unit = `${found.units.force}/${found.units.length}²`;
  const worst = found.speeds.map((at) => ({ at, cycle: at.stress.cycles[0] ?? null }));
  replace(below,
    h('h2', {}, 'Over speed'),
    table({
      caption: 'Largest stress and utilisation at each speed',
      onChoose: ({ at }) => context.go({ view: 'point', speed: at.index }),
      rows: worst,
      columns: [
        { name: 'Speed', cell: ({ at }) => speed(at.speed_rad_s), sort: ({ at }) => at.speed_rad_s },
        { name: `Largest von Mises, ${unit}`, number: true, cell: ({ at }) => number(at.stress.largest.stress ?? at.stress.largest.von_mises), sort: ({ at }) => at.stress.largest.stress ?? at.stress.largest.von_mises },
        { name: 'Over yield', number: true, cell: ({ at }) => percent(at.stress.largest_over_yield), sort: ({ at }) => at.stress.largest_over_yield },
        { name: 'Utilisation', number: true, cell: ({ cycle }) => percent(cycle?.utilisation), sort: ({ cycle }) => cycle?.utilisation },
        { name: 'Node', number: true, cell: ({ cycle }) => cycle?.node ?? '–' },
        { name: 'Blade', number: true, cell: ({ cycle }) => cycle?.sector ?? '–' },
        { name: 'Linear theory', cell: ({ at }) => VALIDITY[at.validity?.verdict] ?? '–' },
        { name: 'Missing strengths', cell: ({ at }) => at.stress.lacking ?? '' },
      ],
    }));
  await plot(figure, await api.figure(path, { speed: query.get('speed'), colour }, { signal }), { signal, label: 'Haigh diagram' });
}
