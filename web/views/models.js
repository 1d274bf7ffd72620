// The models of the service: a new one by upload, and those that are there.

import { api, Away, Refusal } from '../lib/api.js';
import { confirmed } from '../lib/confirm.js';
import { facts, h, newId, replace } from '../lib/dom.js';
import { bytes, moment, number, percent, rpm } from '../lib/format.js';
import { cursorOf, placeWith } from '../lib/place.js';
import { problem } from '../lib/problem.js';
import { narrowing, searchField } from '../lib/search.js';
import { upload } from '../lib/upload.js';

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
  return h('div', { class: 'note' },
    h('p', {}, 'There is no model yet. A model is one sector of a wheel from your finite-element program: a zip with the mass matrix, the stiffness at one or three speeds, nodes, and the nodes at which the blade may touch the casing.'),
    h('p', {}, 'To try the program without your own model, ', h('a', { href: '#/generate' }, 'generate an impeller'), ' in a few seconds.'));
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

/** Where packages are dropped or chosen. */
function drop(signal) {
  const id = newId('package');
  const told = h('div');
  const input = h('input', { id, type: 'file', accept: '.zip,application/zip' });
  const place = h('div', { class: 'drop' },
    h('label', { for: id }, 'Drop a model package (zip) here, or choose one: '), input, ' or ', h('a', { href: '#/generate' }, 'generate an impeller'), told);
  input.addEventListener('change', () => input.files[0] && send(input.files[0]));
  const over = (on) => (event) => {
    event.preventDefault();
    place.classList.toggle('over', on);
  };
  place.addEventListener('dragover', over(true));
  place.addEventListener('dragleave', over(false));
  place.addEventListener('drop', (event) => {
    over(false)(event);
    const [file] = event.dataTransfer.files;
    if (file) send(file);
  });
  let sending = false;
  return place;

  async function send(file) {
    if (sending) return;
    sending = true;
    const stop = new AbortController();
    const either = AbortSignal.any([signal, stop.signal]);
    const bar = h('progress', { max: file.size, 'aria-label': `Upload of ${file.name}` });
    const words = h('span', {}, `${file.name}, ${bytes(file.size)}`);
    replace(told, h('div', { class: 'row' }, bar, words, h('button', { type: 'button', on: { click: () => stop.abort() } }, 'Stop')));
    try {
      const { model, known } = await upload(file, (sent, all) => {
        bar.value = sent;
        words.textContent = sent < all ? `${file.name}: ${percent(sent / all)} of ${bytes(all)}` : `${file.name} is being checked …`;
      }, either);
      location.hash = `#/models/${model.id}${known ? '?known=yes' : ''}`;
    } catch (error) {
      if (signal.aborted) return;
      replace(told, stop.signal.aborted ? h('p', { role: 'status' }, 'The upload was stopped.') : refused(file, error));
    } finally {
      sending = false;
      input.value = '';
    }
  }
}

function refused(file, error) {
  if (error instanceof Away) {
    return h('p', { class: 'note bad', role: 'alert' }, `The upload of ${file.name} was interrupted. Choose it again once the service answers.`);
  }
  const heading = error instanceof Refusal ? h('p', {}, `The service refused ${file.name}:`) : null;
  return [heading, problem(error)];
}
