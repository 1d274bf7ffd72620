// A form made from a schema of the contract. Its value is the JSON that is sent; what is not said in it is left to the service.

import { h, replace } from '../dom.js';
import { control, field } from './fields.js';
import { completed, fits, help, kindOf, label, resolve } from './schema.js';
import { ordered, unitIn, wordsOf } from './words.js';

/**
 * A section of a form: the parts at its pointers, then those at the places in `rest` that no section names; `groups` are under headings of their own.
 * @typedef {{title: string, parts?: string[], rest?: string[], groups?: {title: string, parts: string[], rest?: string[]}[], above?: Node | null, below?: Node | null, state?: (value: any) => string,
 *   open?: boolean}} Section
 */

/**
 * A form.
 * @param {{schema: any, definitions: Record<string, any>, value: any, onChange: (pointer: string) => void,
 *   sections: Section[], units?: any, rare?: Record<string, [string, string[]]>, skip?: string[], initial?: (pointer: string) => any,
 *   beside?: (pointer: string) => Node | null}} what
 *   `sections` says in which order parts stand, `units` are those of the model, `rare` has by pointers the fields that few need, closed under a title, `skip` pointers that are asked
 *   elsewhere, `initial` says what a part begins with that is switched on, `beside` what stands beside a switch.
 */
export function form(what) {
  const context = { ...what, value: null, places: new Map() };
  const element = h('div');
  function set(value) {
    context.value = completed(value, what.schema, what.definitions);
    context.places.clear();
    context.states = [];
    const opened = [...element.children].map((one) => one.tagName === 'DETAILS' && one.open);
    replace(element, sections(context, resolve(what.schema, what.definitions), opened));
    tellStates(context);
  }
  set(what.value);
  return {
    element,
    value: () => context.value,
    /** Shows another value. */
    set,
    /** Gives a field, which is shown, another value; its user did not write it. */
    write(pointer, value) {
      change(context, pointer, value);
      const control = context.places.get(pointer)?.control;
      if (control) control.value = value;
    },
    /** Says at each field what the service finds wrong there; returns those errors that have no field. */
    complain(errors, focus) {
      for (const place of context.places.values()) place.complain(null);
      const homeless = [];
      let first = null;
      for (const error of errors) {
        const found = placeOf(context, error.pointer ?? '');
        if (!found) {
          homeless.push(error);
          continue;
        }
        found.complain(error.detail);
        reveal(found.control);
        first ??= found.control;
      }
      if (focus) first?.focus();
      return homeless;
    },
  };
}

/** Opens the groups that a field is in. */
function reveal(control) {
  for (let at = control.parentElement; at; at = at.parentElement) if (at.tagName === 'DETAILS') at.open = true;
}

/** The field of a pointer, or of the part around it. */
function placeOf(context, pointer) {
  for (let at = pointer; at !== ''; at = at.slice(0, at.lastIndexOf('/'))) {
    const place = context.places.get(at);
    if (place) return place;
  }
  return null;
}

const words = (pointer) => pointer.split('/').slice(1).map((word) => word.replaceAll('~1', '/').replaceAll('~0', '~'));

function get(context, pointer) {
  return words(pointer).reduce((value, word) => value?.[word], context.value);
}

/** Puts what the user wrote at a pointer. */
function put(context, pointer, value) {
  change(context, pointer, value);
  context.onChange(pointer);
}

/** Puts a value at a pointer, or takes away what is there; the parts around it are there already. */
function change(context, pointer, value) {
  const path = words(pointer);
  const last = path.pop();
  const copy = structuredClone(context.value);
  const parent = path.reduce((at, word) => at[word], copy);
  if (value === undefined) {
    if (Array.isArray(parent)) parent.splice(Number(last), 1);
    else delete parent[last];
  } else {
    parent[last] = value;
  }
  context.value = completed(copy, context.schema, context.definitions);
  tellStates(context);
}

/** Says beside the titles of sections what is in them. */
function tellStates(context) {
  for (const { place, state } of context.states) place.textContent = state(context.value);
}

/** The form in its sections; those that are made anew stay as open as they were. */
function sections(context, schema, opened) {
  const all = context.sections.flatMap((section) => [section, ...(section.groups ?? [])]);
  const named = new Set([...all.flatMap((one) => one.parts ?? []), ...all.flatMap((one) => one.rest ?? [])]);
  const schemaAt = (pointer) => words(pointer).reduce((at, word) => resolve(at.properties?.[word] ?? {}, context.definitions), schema);
  const has = (pointer) => schemaAt(pointer).properties ?? {};
  const parent = (pointer) => pointer.slice(0, pointer.lastIndexOf('/'));
  const fieldsOf = ({ parts: own = [], rest = [] }) => {
    const others = rest.flatMap((at) => ordered(Object.keys(has(at)), at).map((name) => `${at}/${name}`).filter((pointer) => !named.has(pointer)));
    const places = [...own, ...others].filter((pointer) => pointer.split('/').at(-1) in has(parent(pointer)));
    return places.flatMap((pointer) => parts(context, schemaAt(parent(pointer)), parent(pointer), [pointer.split('/').at(-1)]));
  };
  return context.sections.map((section, k) => {
    const fields = fieldsOf(section);
    const groups = (section.groups ?? []).map((one) => [one.title, fieldsOf(one)]).filter(([, shown]) => shown.length > 0);
    if (fields.length === 0 && groups.length === 0) return h('div');
    const place = h('span', { class: 'state' });
    if (section.state) context.states.push({ place, state: section.state });
    return h('details', { class: 'section', open: opened[k] ?? section.open }, h('summary', {}, h('span', {}, section.title), ' ', place),
      section.above, h('div', { class: 'fields' }, fields),
      groups.map(([title, shown]) => [h('h3', {}, title), h('div', { class: 'fields switches' }, shown)]),
      section.below);
  });
}

/** Fields of the properties of an object, of all or of these; those that few need are closed. */
function parts(context, schema, pointer, names = ordered(Object.keys(schema.properties ?? {}), pointer)) {
  const required = new Set(schema.required ?? []);
  const [title, few] = context.rare?.[pointer.replace(/\/\d+/g, '/-')] ?? [null, []];
  // Names may be those of element sets, with any letters.
  const at = (name) => `${pointer}/${name.replaceAll('~', '~0').replaceAll('/', '~1')}`;
  const made = (name) => part(context, resolve(schema.properties[name], context.definitions), at(name), name, required.has(name));
  const shown = names.filter((name) => schema.properties[name] && !(context.skip ?? []).includes(at(name)));
  const hidden = shown.filter((name) => few.includes(name));
  const isGiven = (name) => get(context, at(name)) !== undefined;
  return [
    ...shown.filter((name) => !few.includes(name)).map(made),
    ...(hidden.length > 0 ? [h('details', { class: 'rare', open: hidden.some(isGiven) }, h('summary', {}, title), h('div', { class: 'fields' }, hidden.map(made)))] : []),
  ];
}

/** Label, help and unit of a field. */
function saying(context, pointer, name) {
  const [title, unit, text] = wordsOf(pointer) ?? [];
  return { title: title ?? label(name), unit: unit ? unitIn(unit, context.units) : '', words: text };
}

function part(context, whole, pointer, name, required) {
  const schema = one(context, whole, pointer);
  const wanted = kindOf(schema, context.definitions);
  const kind = fits(get(context, pointer), wanted) ? wanted : 'json';
  if (kind === 'object') return object(context, schema, pointer, name, required);
  if (kind === 'list') return list(context, schema, pointer, name);
  if (kind === 'json') return json(context, schema, pointer, name);
  const made = control(kind, schema, get(context, pointer), required, name);
  const shown = field(name, schema, made.control, { ...saying(context, pointer, name), extra: [made.beside, context.beside?.(pointer)] });
  made.control.addEventListener(kind === 'switch' || kind === 'word' ? 'change' : 'input', () => {
    shown.complain(null);
    put(context, pointer, made.read());
  });
  context.places.set(pointer, shown);
  if (kind === 'switch' && pointer.startsWith('/scene/')) shown.element.classList.add('switched');
  if (pointer === '/name' || name === 'source') shown.element.classList.add('wide');
  return shown.element;
}

/** Of what may be one object or a list of such, the one, unless a list is given. */
function one(context, schema, pointer) {
  if (!schema.oneOf || Array.isArray(get(context, pointer))) return schema;
  const ones = schema.oneOf.map((each) => resolve(each, context.definitions));
  const single = ones.length === 2 && ones.some((each) => each.type === 'array') && ones.find((each) => each.properties);
  return single ? { ...single, description: schema.description } : schema;
}

/** An object: a group of fields; one that may be left out has a switch. */
function object(context, schema, pointer, name, required) {
  const body = h('div');
  const { title, words: text } = saying(context, pointer, name);
  const empty = Object.keys(schema.properties ?? {}).length === 0;
  const fill = () => replace(body, get(context, pointer) === undefined || get(context, pointer) === null ? null : h('div', { class: 'fields' }, parts(context, schema, pointer)));
  if (required) {
    fill();
    const error = h('div', { class: 'error', role: 'alert' });
    context.places.set(pointer, { control: error, complain: (message) => { error.textContent = message ?? ''; } });
    return h('fieldset', {}, h('legend', {}, title), text ? h('p', { class: 'help quiet small' }, text) : null, error, body);
  }
  const box = h('input', { type: 'checkbox', checked: get(context, pointer) !== undefined && get(context, pointer) !== null });
  const shown = field(name, schema, box, { title, extra: context.beside?.(pointer), words: text ?? help(schema) });
  box.addEventListener('change', () => {
    put(context, pointer, box.checked ? structuredClone(context.initial?.(pointer) ?? {}) : undefined);
    fill();
  });
  context.places.set(pointer, shown);
  fill();
  if (empty) shown.element.classList.add('switched');
  return empty ? shown.element : h('fieldset', { class: 'switched' }, h('legend', { class: 'visually-hidden' }, title), shown.element, body);
}

/** A list of objects, which can grow and shrink. */
function list(context, schema, pointer, name) {
  const items = resolve(schema.items, context.definitions);
  const body = h('div');
  const { title, words: text } = saying(context, pointer, name);
  // A list that its part is about needs no frame of its own.
  const bare = text === '';
  const more = h('button', { type: 'button' }, `${bare ? 'Another' : 'Add to'} ${title.toLowerCase()}`);
  const fill = () => {
    replace(body, (get(context, pointer) ?? []).map((_, index) => {
      const at = `${pointer}/${index}`;
      const remove = h('button', { type: 'button', class: 'bad' }, `Remove ${index + 1}`);
      remove.addEventListener('click', () => {
        put(context, at, undefined);
        if (get(context, pointer).length === 0) put(context, pointer, undefined);
        fill();
        more.focus();
      });
      return h('fieldset', {}, h('legend', {}, `${title} ${index + 1}`), h('div', { class: 'fields' }, parts(context, items, at)), remove);
    }));
  };
  more.addEventListener('click', () => {
    const before = get(context, pointer) ?? [];
    put(context, pointer, [...before, structuredClone(context.initial?.(`${pointer}/-`) ?? {})]);
    fill();
  });
  const error = h('div', { class: 'error' });
  context.places.set(pointer, { control: more, complain: (message) => { error.textContent = message ?? ''; } });
  fill();
  const told = text ?? help(schema);
  if (bare) return h('div', { class: 'wide' }, error, body, more);
  return h('fieldset', { class: 'switched' }, h('legend', {}, title, ' ', context.beside?.(pointer)), told ? h('p', { class: 'help quiet small' }, told) : null, error, body, more);
}

/** What has no fields of its own, as JSON; what is none goes as a text, which the service refuses where the contract has none. */
function json(context, schema, pointer, name) {
  const value = get(context, pointer);
  const text = h('textarea', { rows: 3, spellcheck: 'false', value: value === undefined ? '' : JSON.stringify(value) });
  const shown = field(name, schema, text, saying(context, pointer, name));
  text.addEventListener('input', () => {
    const words = text.value.trim();
    shown.complain(null);
    try {
      put(context, pointer, words === '' ? undefined : JSON.parse(words));
    } catch {
      put(context, pointer, words);
    }
  });
  context.places.set(pointer, shown);
  return shown.element;
}
