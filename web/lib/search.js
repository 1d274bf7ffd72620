// A field to search by.

import { debounced, h, newId } from './dom.js';

/** Milliseconds without a letter after which is searched. */
const PAUSE = 500;

/**
 * A field with its label.
 * @param {{name: string, label: string, value: string | null}} what
 * @param {(text: string) => void} go searches
 * @param {AbortSignal} signal
 */
export function searchField({ name, label, value }, go, signal) {
  const id = newId(name);
  const field = h('input', { id, type: 'search', size: 14, value: value ?? '' });
  field.addEventListener('input', debounced(() => go(field.value), PAUSE, signal));
  return h('span', {}, h('label', { for: id }, `${label} `), field);
}
