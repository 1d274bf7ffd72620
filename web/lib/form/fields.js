// Fields of a form for values that have no parts.

import { h, newId } from '../dom.js';
import { help, label, withRange } from './schema.js';

/** A field with its label, its unit, its help and a place for what is wrong with it. */
export function field(name, schema, control, { extra, words, title, unit } = {}) {
  const id = newId('field');
  const errorId = `${id}-error`;
  control.id = id;
  const text = withRange(words ?? help(schema), schema);
  const told = text ? h('div', { class: 'help', id: `${id}-help` }, text) : null;
  const measured = unit ? h('span', { class: 'unit', id: `${id}-unit` }, unit) : null;
  control.setAttribute('aria-describedby', [measured?.id, told?.id, errorId].filter(Boolean).join(' '));
  const error = h('div', { class: 'error', id: errorId });
  const heading = h('label', { for: id }, title ?? label(name));
  const element = control.type === 'checkbox'
    ? h('div', { class: 'field' }, h('div', { class: 'row' }, control, heading, extra), told, error)
    : h('div', { class: 'field' }, heading, h('div', { class: 'row' }, control, measured, extra), told, error);
  return {
    element,
    control,
    /** Says what is wrong, or that nothing is. */
    complain(message) {
      error.textContent = message ?? '';
      if (message) control.setAttribute('aria-invalid', 'true');
      else control.removeAttribute('aria-invalid');
    },
  };
}

/** What a text says as a number; `undefined` for nothing, `null` for what is none: a comma may part thousands or decimals. */
function readNumber(text) {
  const words = text.trim();
  if (words === '') return undefined;
  const value = Number(words);
  return Number.isFinite(value) ? value : null;
}

/** What `"auto"` means of a field, where other words say it better. */
export const AUTO = { revolutions: 'until it repeats' };

/** Words of a contract that are no words. */
const OPTIONS = { rad_s: 'rad/s', hz: 'Hz', running: 'at speed', cold: 'cold, at rest' };

/**
 * The control of a value without parts, what stands beside it, and how it is read: `undefined` means that it is left out.
 * @returns {{control: any, beside?: any, read: () => any} | null}
 */
export function control(kind, schema, value, required, name) {
  switch (kind) {
    case 'switch': {
      if (schema.nullable) {
        // Nothing said, yes and no are three.
        const list = h('select', { value: value ?? '' }, [['', 'default'], ['true', 'yes'], ['false', 'no']].map(([one, words]) => h('option', { value: one }, words)));
        return { control: list, read: () => (list.value === '' ? undefined : list.value === 'true') };
      }
      const box = h('input', { type: 'checkbox', checked: value === true });
      return { control: box, read: () => (box.checked ? true : required || value === false ? false : undefined) };
    }
    case 'word': {
      const options = required ? schema.enum : ['', ...schema.enum];
      const list = h('select', { value: value ?? schema.default ?? '' }, options.map((one) => h('option', { value: one }, one === '' ? 'default' : OPTIONS[one] ?? String(one).replaceAll('_', ' '))));
      return { control: list, read: () => (list.value === '' ? undefined : list.value) };
    }
    case 'number': {
      const input = h('input', { type: 'text', inputmode: 'decimal', size: 12, autocomplete: 'off', placeholder: schema.default ?? '', value: value ?? '' });
      return { control: input, read: () => readNumber(input.value) ?? (input.value.trim() === '' ? undefined : input.value) };
    }
    case 'number_or_word': {
      const words = AUTO[name] ?? 'auto';
      const choices = h('datalist', { id: newId('choices') }, h('option', { value: words }));
      const input = h('input', { type: 'text', size: Math.max(12, words.length), autocomplete: 'off', list: choices.id, placeholder: words, value: value === 'auto' ? words : value ?? '' });
      const read = () => {
        const text = input.value.trim();
        return readNumber(text) ?? (text === '' ? undefined : text === words ? 'auto' : text);
      };
      return { control: input, beside: choices, read };
    }
    case 'text': {
      const input = h('input', { type: 'text', size: 32, autocomplete: 'off', maxlength: schema.maxLength, value: value ?? '' });
      return { control: input, read: () => (input.value === '' ? undefined : input.value) };
    }
    case 'numbers': {
      const input = h('input', { type: 'text', size: 32, autocomplete: 'off', value: (value ?? []).join(', ') });
      return {
        control: input,
        read: () => {
          const words = input.value.split(/[\s;,]+/).filter(Boolean);
          return words.length === 0 ? undefined : words.map((word) => readNumber(word) ?? word);
        },
      };
    }
    case 'words': {
      const input = h('input', { type: 'text', size: 32, autocomplete: 'off', value: (value ?? []).join(', ') });
      return {
        control: input,
        read: () => {
          const list = input.value.split(',').map((word) => word.trim()).filter(Boolean);
          return list.length === 0 ? undefined : list;
        },
      };
    }
    default:
      return null;
  }
}
