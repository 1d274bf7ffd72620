// Files of a model.

import { formsOf, openapi } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { downloadButton } from '../../lib/download.js';

const FILES = [['Mesh of the wheel', 'mesh'], ['Nodes and section', 'section']];

export async function show(place, { model }, signal) {
  const contract = await openapi();
  const file = (name, form) => downloadButton(form, `/v1/models/${model.id}/${name}`, { format: form }, `${model.id.slice(0, 12)}-${name}.${form}`, signal);
  const cards = FILES.map(([words, name]) => [words, formsOf(`/v1/models/${model.id}/${name}`, contract).map((form) => file(name, form))]);
  // Files of a mode are on the view of modes.
  if (model.reductions.length > 0) cards.push(['Natural frequencies', file('modes', 'json')]);
  replace(place, h('ul', { class: 'plain cards' }, cards.map(([words, buttons]) => h('li', { class: 'card' }, h('h2', {}, words), h('div', { class: 'row' }, buttons)))));
}
