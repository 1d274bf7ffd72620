// The models of the service: a new one by upload, and those that are there.

import { api } from '../lib/api.js';
import { confirmed } from '../lib/confirm.js';
import { facts, h, replace } from '../lib/dom.js';
import { bytes, moment, number, rpm } from '../lib/format.js';
import { cursorOf, placeWith } from '../lib/place.js';
import { problem } from '../lib/problem.js';
import { narrowing, searchField } from '../lib/search.js';
import { drop } from './models/drop.js';

/** Models of a page. */
const LIMIT = 50;

export async function show(main, { query }, signal) {
  const told = h('div');
  const shown = h('div');
  replace(main, h('h1', {}, 'Models'), drop(signal), filter(query, narrowing('models', query, { read, told }, signal), signal), told, shown);
  await read();

  async function read() {
    const place = query.toString();
    const asked = { name: query.get('name'), tag: query.get('tag'), cursor: query.get('cursor'), limit: LIMIT };
    const list = await api.get('/v1/models', { query: asked, signal });
    if (query.toString() !== place) return;
    const { models } = list;
    const cursor = cursorOf(list);
    const filtered = query.get('name') || query.get('tag');
    replace(shown,
      models.length > 0 ? h('ul', { class: 'plain cards' }, models.map((model) => card(model, { told, read }, signal)))
        : filtered ? h('p', { class: 'quiet' }, 'No model matches.') : introduction(),
      h('div', { class: 'row' },
        query.get('cursor') ? h('a', { class: 'button', href: placeWith('models', query, { cursor: null }) }, 'Newest') : null,
        cursor ? h('a', { class: 'button', href: placeWith('models', query, { cursor }) }, 'Older') : null));
  }
}

function filter(query, go, signal) {
  const search = (name, label) => searchField({ name, label, value: query.get(name) }, (text) => go({ [name]: text }), signal);
  return h('div', { class: 'row', role: 'search' }, search('name', 'Name has'), search('tag', 'Tag'));
}

function introduction() {
  return h('p', { class: 'note' }, 'There is no model yet: ', h('a', { href: '#/home' }, 'three ways to one'), '.');
}

function card(model, { told, read }, signal) {
  const name = model.name;
  return h('li', { class: 'card' },
    h('h2', {}, h('a', { href: `#/models/${model.id}` }, name)),
    facts([
      ['Sectors', model.sectors],
      ['Unknowns of a sector', number(model.own_dofs, 6)],
      ['Contact nodes', model.contact_nodes],
      ['Stiffness at', `${model.speeds_rad_s.map((speed) => number(Math.round(rpm(speed)), 5)).join(', ')} rpm`],
      ['Package', `${bytes(model.size_bytes)}, ${moment(model.created_at)}`],
      ['Tags', model.tags.join(', ')],
    ]),
    h('div', { class: 'row' },
      h('a', { class: 'button main', href: `#/sweep?model=${model.id}`, 'aria-label': `New sweep of ${name}` }, 'New sweep'),
      h('a', { class: 'button', href: `#/jobs?model=${model.id}`, 'aria-label': `Jobs of ${name}` }, 'Jobs'),
      deleteButton(model, { told, deleted: read }, signal)));
}

/** A button that deletes a model; what is refused goes to `told`. */
export function deleteButton(model, { told, deleted }, signal) {
  const button = h('button', { type: 'button', class: 'bad', 'aria-label': `Delete ${model.name}` }, 'Delete');
  button.addEventListener('click', async () => {
    if (!await confirmed(`Delete ${model.name}? Jobs keep their results, but fields of this model can no longer be computed.`, 'Delete it', signal)) return;
    replace(told);
    try {
      await api.send('DELETE', `/v1/models/${model.id}`, undefined, { signal });
      await deleted();
    } catch (error) {
      if (!signal.aborted) replace(told, problem(error));
    }
  });
  return button;
}
