// A form made from a schema of the contract. Its value is the JSON that is sent; what is not said in it is left to the service.

import { h, replace } from '../dom.js';
import { control, field } from './fields.js';
import { completed, fits, help, kindOf, label, resolve } from './schema.js';

/**
 * A form.
 * @param {{schema: any, definitions: Record<string, any>, value: any, onChange: (value: any) => void,
 *   groups: {title: string | null, names: string[], open?: boolean}[], skip?: string[], initial?: (pointer: string) => any,
 *   beside?: (pointer: string) => Node | null, open?: string[]}} what
 *   `groups` says in which order properties stand, `skip` has pointers that are asked elsewhere, `initial` says what a part begins with that is switched on, `beside` what stands
 *   beside a switch, `open` the pointers of parts that are open at first.
 */
export function form(what) {
  const context = { ...what, value: null, places: new Map() };
  const element = h('div');
  function set(value) {
    context.value = completed(value, what.schema, what.definitions);
    context.places.clear();
    replace(element, groups(context, resolve(what.schema, what.definitions)));
  }
  set(what.value);
  return {
    element,
    value: () => context.value,
    /** Shows another value. */
    set,
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

/** Puts a value at a pointer, or takes away what is there; the parts around it are there already. */
function put(context, pointer, value) {
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
  context.onChange(context.value);
}

/** The properties of the whole in groups; those that no group names are in the last. */
function groups(context, schema) {
  const named = new Set(context.groups.flatMap(({ names }) => names));
  const rest = Object.keys(schema.properties).filter((name) => !named.has(name));
  return context.groups.map(({ title, names, open }, index) => {
    const all = index === context.groups.length - 1 ? [...names, ...rest] : names;
    const shown = parts(context, schema, '', all);
    if (shown.length === 0) return null;
    const fields = h('div', { class: 'fields' }, shown);
    return title ? h('details', { open }, h('summary', {}, title), fields) : fields;
  });
}

/** Fields of the properties of an object, of all or of these. */
function parts(context, schema, pointer, names = Object.keys(schema.properties ?? {})) {
  const required = new Set(schema.required ?? []);
  return names
    .filter((name) => schema.properties[name] && !(context.skip ?? []).includes(`${pointer}/${name}`))
    .map((name) => part(context, resolve(schema.properties[name], context.definitions), `${pointer}/${name}`, name, required.has(name)));
}

function part(context, whole, pointer, name, required) {
  const schema = one(context, whole, pointer);
  const wanted = kindOf(schema, context.definitions);
  const kind = fits(get(context, pointer), wanted) ? wanted : 'json';
  if (kind === 'object') return object(context, schema, pointer, name, required);
  if (kind === 'list') return list(context, schema, pointer, name);
  if (kind === 'json') return json(context, schema, pointer, name);
  const made = control(kind, schema, get(context, pointer), required, name);
  const shown = field(name, schema, made.control, { extra: [made.beside, context.beside?.(pointer)] });
  made.control.addEventListener(kind === 'switch' || kind === 'word' ? 'change' : 'input', () => {
    shown.complain(null);
    put(context, pointer, made.read());
  });
  context.places.set(pointer, shown);
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
  const empty = Object.keys(schema.properties ?? {}).length === 0;
  const fill = () => replace(body, get(context, pointer) === undefined || get(context, pointer) === null ? null : h('div', { class: 'fields' }, parts(context, schema, pointer)));
  if (required) {
    fill();
    const error = h('div', { class: 'error', role: 'alert' });
    context.places.set(pointer, { control: error, complain: (message) => { error.textContent = message ?? ''; } });
    return group(context, pointer, name, h('div', {}, error, body));
  }
  const box = h('input', { type: 'checkbox', checked: get(context, pointer) !== undefined && get(context, pointer) !== null });
  const shown = field(name, schema, box, { extra: context.beside?.(pointer), words: help(schema) });
  box.addEventListener('change', () => {
    put(context, pointer, box.checked ? structuredClone(context.initial?.(pointer) ?? {}) : undefined);
    fill();
  });
  context.places.set(pointer, shown);
  fill();
  return empty ? shown.element : h('fieldset', {}, h('legend', { class: 'visually-hidden' }, label(name)), shown.element, body);
}

function group(context, pointer, name, body) {
  if (pointer.split('/').length > 2) return h('fieldset', {}, h('legend', {}, label(name)), body);
  return h('details', { open: (context.open ?? []).includes(pointer) }, h('summary', {}, label(name)), body);
}

/** A list of objects, which can grow and shrink. */
function list(context, schema, pointer, name) {
  const items = resolve(schema.items, context.definitions);
  const body = h('div');
  const more = h('button', { type: 'button' }, `Add to ${label(name).toLowerCase()}`);
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
      return h('fieldset', {}, h('legend', {}, `${label(name)} ${index + 1}`), h('div', { class: 'fields' }, parts(context, items, at)), remove);
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
  return h('fieldset', {}, h('legend', {}, label(name), ' ', context.beside?.(pointer)), h('p', { class: 'help quiet small' }, help(schema)), error, body, more);
}

/** What has no fields of its own, as JSON; what is none goes as a text, which the service refuses where the contract has none. */
function json(context, schema, pointer, name) {
  const value = get(context, pointer);
  const text = h('textarea', { rows: 3, spellcheck: 'false', value: value === undefined ? '' : JSON.stringify(value) });
  const shown = field(name, schema, text);
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
