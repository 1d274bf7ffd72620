// Files of a model.

import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';

const FILES = [
  ['Mesh of the wheel', 'mesh', ['vtu', 'vtp', 'npz']],
  ['Nodes and section', 'section', ['json', 'csv', 'npz', 'svg', 'png']],
  ['Natural frequencies', 'modes', ['json']],
];

export function show(place, { model }, signal) {
  const files = FILES.filter(([, name]) => name !== 'modes' || model.reductions.length > 0);
  replace(place, h('ul', { class: 'plain cards' }, files.map(([words, name, forms]) => h('li', { class: 'card' },
    h('h2', {}, words),
    h('div', { class: 'row' }, forms.map((form) => downloadButton(form, `/v1/models/${model.id}/${name}`, { format: form }, `${model.id.slice(0, 12)}-${name}.${form}`, signal)))))));
}
