// A model: what was sent, and what was found about it.

import { api, part } from '../lib/api.js';
import { facts, h, replace } from '../lib/dom.js';
import { bytes, moment, number, rpm, short } from '../lib/format.js';
import { labelsButton } from '../lib/labels.js';
import { again, placeWith } from '../lib/place.js';
import { unread } from '../lib/problem.js';
import { stiffeningNote } from './model/stiffening.js';
import { deleteButton } from './models.js';

/** What there is to see of a model; the first is shown when none is asked for. */
const TABS = [
  ['mesh', 'In its casing', () => import('./model/mesh.js')],
  ['modes', 'Modes', () => import('./model/modes.js')],
  ['reductions', 'Reductions', () => import('./model/reductions.js')],
  ['downloads', 'Downloads', () => import('./model/downloads.js')],
];

/** Mass, radius and materials, to be compared with what one knows. */
function sizes({ mass_kg, contact_radius_m, materials = [] }) {
  const of = ({ set, youngs_modulus_pa, density_kg_m3 }) => `${set}: E ${number(youngs_modulus_pa / 1e9, 4)} GPa, ρ ${number(density_kg_m3, 4)} kg/m³`;
  return [`${number(mass_kg, 4)} kg`, `contact nodes up to ${number(contact_radius_m, 4)} m`, ...materials.map(of)].join('; ');
}

/** What was found in the mesh that a model was made from, to be compared with what one knows. */
function foundInMesh(found) {
  if (found.length === 0) return null;
  return h('section', { 'aria-label': 'Found in the mesh' }, h('h2', {}, 'Found in the mesh'), h('ul', {}, found.map((sentence) => h('li', {}, sentence))));
}

export async function show(main, { id, query }, signal) {
  const model = await api.get(`/v1/models/${id}`, { signal });
  const tab = TABS.find(([name]) => name === query.get('view')) ?? TABS[0];
  // A reduction knows more than the package alone.
  const stiffening = model.reductions?.at(-1)?.stiffening ?? model.stiffening;
  const told = h('div');
  const place = h('section', { 'aria-label': tab[1] });
  const address = (changes) => placeWith(`models/${id}`, query, { known: null, ...changes });
  replace(main,
    h('h1', {}, model.name),
    query.get('known') ? h('p', { class: 'note', role: 'status' }, 'The service already has a model with this content; this is that model, under its existing name.') : null,
    facts([
      ['Sectors', model.sectors],
      ['Unknowns of a sector', number(model.own_dofs, 7)],
      ['Contact nodes', `${model.contact_nodes}, up to radius ${number(model.contact_radius, 5)} ${model.units.length}`],
      ['Stiffness at', `${model.speeds_rad_s.map((speed) => number(Math.round(rpm(speed)), 6)).join(', ')} rpm`],
      ['Units', [model.units.length, model.units.mass, model.units.time, model.units.force].join(', ')],
      ['In SI units', model.in_si ? sizes(model.in_si) : null],
      ['Coriolis forces', model.gyroscopic ? 'available' : 'not available: the package has no gyroscopic matrix'],
      ['Elements', model.mesh ? number(model.mesh.elements, 7) : 'none: stress cannot be computed'],
      ['Package', `${bytes(model.size_bytes)}, ${moment(model.created_at)}, digest ${short(model.id)}…`],
      ['Notes', model.notes],
      ['Tags', model.tags.join(', ')],
    ]),
    foundInMesh(model.found ?? []),
    (model.warnings ?? []).map((warning) => h('p', { class: 'note warning' }, warning)),
    stiffening ? stiffeningNote(stiffening) : null,
    h('div', { class: 'row' },
      h('a', { class: 'button main', href: `#/sweep?model=${id}` }, 'New sweep'),
      h('a', { class: 'button', href: `#/study?model=${id}` }, 'New study'),
      h('a', { class: 'button', href: `#/sweep?kind=modal_analysis&model=${id}` }, 'Modal analysis'),
      h('a', { class: 'button', href: `#/jobs?model=${id}` }, 'Its jobs'),
      labelsButton(`/v1/models/${id}`, model, again, signal),
      deleteButton(model, { told, deleted: () => { location.hash = '#/models'; } }, signal)),
    told,
    h('nav', { class: 'tabs', 'aria-label': 'Parts of the model' }, TABS.map(([name, words]) => h('a', {
      href: address({ view: name }), 'aria-current': name === tab[0] ? 'page' : null,
    }, words))),
    place);
  try {
    await (await part(tab[2])).show(place, { model, query, go: (changes) => { location.hash = address(changes); } }, signal);
  } catch (error) {
    if (signal.aborted) return;
    replace(place, unread(error, signal));
  }
}
