// The view of a new job: a form made from the contract, its plan, and its JSON.

import { api, openapi, Refusal, submit } from '../../lib/api.js';
import { h, newId, replace } from '../../lib/dom.js';
import { draftHere, draftNote } from '../../lib/draft.js';
import { form } from '../../lib/form/form.js';
import { materialChoice } from '../../lib/materials.js';
import { problem } from '../../lib/problem.js';
import { accuracyDial } from './accuracy.js';
import { casingTable } from './casing.js';
import { editor } from './editor.js';
import { planAside } from './plan.js';
import { prices } from './prices.js';
import { RARE, sectionsOf } from './sections.js';
import { following } from './following.js';
import { beginning } from './sensible.js';
import { settingsOf, withAccuracy, withSettings } from './settings.js';
import { speedsOver } from './speeds.js';
import { undecided } from './undecided.js';
import { wheelInCasing } from './wheel.js';

/**
 * A form for requests of one kind.
 * @param {HTMLElement} place
 * @param {{model: any, kind: {schema: string, path: string, plan: string | null, priced: boolean, judged?: boolean}, value: any, words: string}} what
 * @param {AbortSignal} signal
 */
export async function requestForm(place, { model, kind, value, words }, signal) {
  // A section that cannot be read is no reason not to ask.
  const [contract, section] = await Promise.all([openapi(), api.get(`/v1/models/${model.id}/section`, { signal }).catch(() => null)]);
  const definitions = withSets(contract.components.schemas, model);
  const draft = draftHere();
  const begun = draft.kept() ?? value;
  const wheel = wheelInCasing(model, section);
  const campbell = speedsOver(model, signal);
  const plan = kind.plan ? planAside(kind.plan, planned, signal) : null;
  const follower = following(model, kind.begin(model));
  const initial = (pointer) => {
    if (pointer === '/operation') return { ranges: [follower.range(fields.value())] };
    return pointer === '/operation/ranges/-' ? { ...follower.range(fields.value()), name: 'Another' } : beginning(pointer, model, fields.value());
  };
  const cost = kind.priced ? prices(kind.plan, model, signal) : null;
  const dial = kind.priced ? accuracyDial(kind.plan, chooseAccuracy, signal) : null;
  const table = casingTable((measured) => {
    const now = structuredClone(fields.value());
    now.scene.casing.measured = measured;
    put(now);
  }, signal);
  const alloys = materialChoice(() => model.units, (material) => {
    const now = structuredClone(fields.value());
    now.record.stress.strengths = Object.fromEntries(setsOf(model).map((set) => [set, strengthsOf(material)]));
    put(now);
  });
  const open = kind.judged ? undecided(model, put) : null;
  const told = h('div');
  const unsent = h('div');
  const json = editor((now) => put(now, json));
  const fields = form({
    schema: { $ref: `#/components/schemas/${kind.schema}` },
    definitions, value: begun, initial,
    skip: ['/model', '/accuracy'].slice(0, kind.priced ? 2 : 1),
    units: model.units, rare: RARE,
    beside: (pointer) => (pointer === '/record/stress/strengths' ? alloys : cost?.beside(pointer) ?? table.beside(pointer)),
    sections: sectionsOf({ value: begun, begun: kind.begin(model), units: model.units, wheel: wheel.element, campbell: campbell.element, dial: dial?.element }),
    onChange: (pointer) => {
      for (const [at, following] of follower.after(pointer, fields.value())) fields.write(at, following);
      changed();
    },
  });
  const button = h('button', { type: 'submit', class: 'main' }, 'Start');
  const element = h('form', { novalidate: true, on: { submit: start } }, fields.element, json.element, open?.element, told, unsent, h('div', { class: 'row' }, button));
  replace(place, draft.kept() ? draftNote(draft) : null, words ? h('p', {}, words) : null, h('div', { class: 'columns' }, element, plan?.element));
  follower.begin(begun);
  tell();

  /** Shows another request. */
  function put(now, by = null) {
    fields.set(now);
    follower.begin(now);
    changed(by);
  }
  function changed(by = null) {
    draft.keep(fields.value());
    tell(by);
  }
  /** Shows the request everywhere but in what has changed it. */
  function tell(by = null) {
    const now = fields.value();
    if (by !== json) json.show(now);
    wheel.show(now);
    campbell.show(now);
    open?.show(now);
    dial?.show(now);
    plan?.refresh(now);
  }
  function planned({ plan: found, refusal }) {
    const homeless = fields.complain(refusal?.errors ?? [], false);
    replace(told, homeless.length > 0 ? problem(Object.assign(refusal, { errors: homeless })) : null);
    if (!found) return;
    cost?.refresh(fields.value(), found);
    dial?.refresh(fields.value());
  }
  // The settings in whose place an accuracy was put.
  let settings = {};
  function chooseAccuracy(target) {
    const now = fields.value();
    if (!now.accuracy) settings = settingsOf(now);
    put(target === null ? withSettings(now, settings) : withAccuracy(now, target));
  }
  async function start(event) {
    event.preventDefault();
    if (button.disabled) return;
    const broken = json.isBroken();
    replace(unsent, broken ? h('p', { class: 'note bad', role: 'alert' }, 'The JSON of the request is not complete: correct it, or undo your changes.') : null);
    if (broken) return;
    button.disabled = true;
    replace(told);
    try {
      const { id } = await submit(kind.path, fields.value(), signal);
      draft.forget();
      location.hash = `#/jobs/${id}`;
    } catch (error) {
      if (signal.aborted) return;
      const homeless = error instanceof Refusal ? fields.complain(error.errors, true) : null;
      replace(told, homeless && homeless.length < error.errors.length && homeless.length === 0
        ? h('p', { class: 'note bad', role: 'alert' }, 'The service refused the request: correct the marked fields.')
        : problem(error));
      button.disabled = false;
    }
  }
}

/** Names of the element sets of a model. */
function setsOf(model) {
  return (model.mesh?.sets ?? []).map(({ set }) => set);
}

/** The schemas of the contract with the element sets of the model where strengths have names of any. */
function withSets(schemas, model) {
  const stress = schemas.StressRequest;
  const { strengths } = stress.properties;
  if (!strengths?.additionalProperties) return schemas;
  const properties = Object.fromEntries(setsOf(model).map((set) => [set, strengths.additionalProperties]));
  return { ...schemas, StressRequest: { ...stress, properties: { ...stress.properties, strengths: { ...strengths, properties } } } };
}

function strengthsOf({ yield_strength, ultimate_strength, fatigue_strength }) {
  return { yield_strength, ultimate_strength, fatigue_strength };
}

/** A choice of the model, where none is given. */
export async function chooseModel(place, go, signal) {
  const { models } = await api.get('/v1/models', { query: { limit: 200 }, signal });
  if (models.length === 0) {
    replace(place, h('p', { class: 'note' }, 'There is no model yet: ', h('a', { href: '#/models' }, 'upload one'), ' or ', h('a', { href: '#/generate' }, 'generate one'), '.'));
    return;
  }
  const id = newId('model');
  const list = h('select', { id, value: models[0].id }, models.map((model) => h('option', { value: model.id }, `${model.name} (${model.id.slice(0, 8)})`)));
  replace(place, h('div', { class: 'field' }, h('label', { for: id }, 'Model'), list), h('button', { type: 'button', class: 'main', on: { click: () => go(list.value) } }, 'Continue'));
}
