// The wheel in 3D at a speed whose states were recorded: an instant, or the deflection shape of an engine order, with stress.

import { h, replace } from '../../lib/dom.js';
import { showWheel } from '../../wheel/index.js';
import { select } from './choices.js';

export async function show(place, context, signal) {
  const { job, query } = context;
  const order = query.get('engine_order') ?? '';
  const stress = query.get('stress') === 'true';
  const wheel = h('div');
  const field = h('input', { type: 'number', min: 0, step: 'any', size: 6, value: order, id: 'order', on: { change: () => context.go({ engine_order: field.value }) } });
  replace(place,
    h('div', { class: 'row' },
      h('span', {}, h('label', { for: 'order' }, 'Deflection shape of engine order '), field),
      select('Colour', [['', 'displacement'], ['true', 'von Mises stress of the vibration']], stress ? 'true' : '', (chosen) => context.go({ stress: chosen }))),
    order === '' ? h('p', { class: 'quiet small' }, 'Without an engine order: the instant at which a tip had moved most.') : null,
    wheel);
  await showWheel(wheel, {
    path: `/v1/jobs/${job.id}/fields`,
    query: { speed: query.get('speed'), engine_order: order, stress: stress || null },
    animated: order !== '',
    scalar: stress ? 'von_mises' : 'displacement',
    label: 'Wheel in 3D',
  }, signal);
}
