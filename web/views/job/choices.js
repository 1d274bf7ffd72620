// Choices above a figure, kept in the address.

import { h, newId } from '../../lib/dom.js';

/** A list to choose from: `options` are pairs of a value and its words. */
export function select(label, options, value, onChange) {
  const id = newId('choice');
  const list = h('select', { id, value: value ?? '', on: { change: () => onChange(list.value) } },
    options.map(([name, words]) => h('option', { value: name }, words)));
  return h('span', {}, h('label', { for: id }, `${label} `), list);
}

/** What a sensor measures, in words. */
export function sensorWords(sensor) {
  const place = sensor.gauge ? 'strain gauge'
    : sensor.node !== null && sensor.node !== undefined ? `node ${sensor.node}`
    : sensor.nearest ? `near (${sensor.nearest.join(', ')})`
    : `contact node ${sensor.contact_node ?? 0}`;
  const direction = sensor.component ?? (sensor.direction ? 'in a direction' : '');
  return [direction, place, `sector ${sensor.sector ?? 0}`].filter(Boolean).join(', ');
}

/** Choice among the sensors of a request; nothing where there is one. */
export function sensors(request, context) {
  const list = request?.sensors ?? [];
  if (list.length < 2) return null;
  const options = list.map((sensor, index) => [index, `${index}: ${sensorWords(sensor)}`]);
  return select('Sensor', options, context.query.get('sensor') ?? '0', (sensor) => context.go({ sensor }));
}
