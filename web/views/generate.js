// A parametric impeller, from a preset and what is to be otherwise.

import { api, openapi, Refusal, submit } from '../lib/api.js';
import { debounced, facts, h, newId, replace } from '../lib/dom.js';
import { draftHere, draftNote } from '../lib/draft.js';
import { ended, follow } from '../lib/events.js';
import { form } from '../lib/form/form.js';
import { bytes, nameOf, number, speed } from '../lib/format.js';
import { materialChoice } from '../lib/materials.js';
import { problem } from '../lib/problem.js';
import { sketch } from './generate/sketch.js';

const PRESETS = {
  small: 'small: seconds; for trying out the program',
  medium: 'medium: a minute; a mesh for real studies',
  paper: 'paper: the size of the published example',
};

/** Sections, the sketch above the shape and the alloys above the material. */
function sections(picture, alloys) {
  const shape = ['sectors', 'outlet_radius', 'inlet_tip_radius', 'inlet_hub_radius', 'bore_radius', 'axial_length', 'outlet_blade_height', 'rim_thickness', 'root_thickness', 'tip_thickness', 'wrap_deg', 'backsweep_deg', 'splitter'];
  const at = (names) => names.map((name) => `/${name}`);
  return [
    { title: 'Shape', parts: at(shape), above: picture, open: true },
    { title: 'Material', parts: ['/material'], above: alloys, open: true, state: ({ material }) => (material?.ultimate_strength && material?.fatigue_strength ? 'with strengths' : 'without strengths') },
    { title: 'Speed and contact line', parts: at(['top_speed_rad_s', 'contact_nodes', 'gyroscopic']), open: true, state: (now) => `up to ${speed(now.top_speed_rad_s)}` },
    { title: 'Mesh and units', parts: at(['element_order', 'mesh', 'units']), rest: [''], state: ({ units = {} }) => [units.length, units.force, units.time, units.mass].filter(Boolean).join(', ') },
    { title: 'Name, tags, notes', parts: at(['name', 'tags', 'notes']), open: true, state: ({ name }) => name ?? '' },
  ];
}

export async function show(main, { query }, signal) {
  const definitions = (await openapi()).components.schemas;
  const earlier = query.has('as') ? await api.get(`/v1/jobs/${query.get('as')}`, { signal }) : null;
  const preset = query.get('preset') in PRESETS ? query.get('preset') : 'small';
  // What an earlier request does not have is not to come from a preset.
  const base = earlier ? { splitter: null } : { preset };
  const aside = h('aside', { 'aria-label': 'Resulting model', 'aria-live': 'polite' });
  const told = h('div');
  const bar = h('progress', { max: 100, hidden: true, 'aria-label': 'Progress' });
  const phase = h('p', { role: 'status' });
  const id = newId('preset');
  const choice = h('select', { id, value: earlier ? '' : preset, on: { change: () => { location.hash = `#/generate?preset=${choice.value}`; } } },
    earlier ? h('option', { value: '' }, nameOf(earlier)) : null,
    Object.entries(PRESETS).map(([name, words]) => h('option', { value: name }, words)));
  const button = h('button', { type: 'submit', class: 'main' }, 'Generate');
  const fields = h('div', {}, h('p', { class: 'quiet' }, 'Reading the preset …'));
  replace(main,
    h('h1', {}, earlier ? `As ${nameOf(earlier)}, but …` : 'Generate an impeller'),
    h('p', {}, 'A centrifugal impeller on a solid hub, meshed, with stiffness at three speeds: a complete model package, whose size and mesh you choose.'),
    h('div', { class: 'field' }, h('label', { for: id }, 'Start from'), choice),
    h('div', { class: 'columns' },
      h('form', { novalidate: true, on: { submit: start } }, fields, told, phase, bar, h('div', { class: 'row' }, button)),
      aside));
  // The plan tells every parameter of the preset.
  const whole = await api.send('POST', '/v1/models/plan', earlier?.posted ?? base, { signal });
  const draft = draftHere();
  const kept = draft.kept();
  const value = kept ?? Object.fromEntries(Object.entries(whole.settings).filter(([, part]) => part !== null));
  const picture = sketch();
  const unitsOf = (now) => ({ ...whole.settings.units, ...now.units });
  const alloys = materialChoice(() => unitsOf(made.value()), (material) => {
    made.set({ ...made.value(), material });
    changed(made.value());
  });
  const changed = (now) => {
    draft.keep(now);
    picture.show(now);
    plan();
  };
  const made = form({
    schema: { $ref: '#/components/schemas/ImpellerRequest' },
    definitions, value, sections: sections(picture.element, alloys), units: unitsOf(value), skip: ['/preset'],
    initial: (pointer) => (pointer === '/splitter' ? {} : undefined),
    onChange: () => changed(made.value()),
  });
  picture.show(value);
  let asking = new AbortController();
  const plan = debounced(async () => {
    asking.abort();
    asking = new AbortController();
    const { signal: own } = asking;
    try {
      showPlan(aside, await api.send('POST', '/v1/models/plan', request(), { signal: AbortSignal.any([signal, own]) }));
      made.complain([], false);
      replace(told);
    } catch (error) {
      if (!own.aborted && !signal.aborted) complain(error, false);
    }
  }, 400, signal);
  replace(fields, kept ? draftNote(draft) : null, made.element);
  showPlan(aside, whole);
  if (kept) plan();

  function request() {
    return { ...base, ...made.value() };
  }
  function complain(error, focus) {
    const homeless = error instanceof Refusal ? made.complain(error.errors, focus) : [error];
    showPlan(aside, null);
    const marked = error instanceof Refusal && error.errors.length > 0 && homeless.length === 0;
    replace(told, marked ? h('p', { class: 'note bad', role: 'alert' }, 'Correct the marked fields.') : problem(error));
  }
  async function start(event) {
    event.preventDefault();
    if (button.disabled) return;
    button.disabled = true;
    bar.hidden = false;
    try {
      const { id: job } = await submit('/v1/models', request(), signal);
      draft.forget();
      await follow(job, (now) => {
        bar.value = now.progress;
        if (phase.textContent !== (now.phase ?? '')) phase.textContent = now.phase ?? '';
        if (now.status === 'successful') location.hash = `#/models/${now.model}`;
        else if (ended(now)) location.hash = `#/jobs/${job}`;
      }, signal);
    } catch (error) {
      if (!signal.aborted) complain(error, true);
    } finally {
      button.disabled = false;
      bar.hidden = true;
      phase.textContent = '';
    }
  }
}

function showPlan(element, plan) {
  replace(element, h('h2', {}, 'Resulting model'), plan === null ? h('p', { class: 'note' }, 'Not available yet: correct the marked fields.') : facts([
    ['Nodes of a sector', number(plan.nodes, 7)],
    ['Rows of its matrices', number(plan.dofs, 7)],
    ['Memory for generating it', bytes(plan.memory_bytes)],
  ]));
}
