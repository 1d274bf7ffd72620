// A field to search by, which goes on being written in while what it finds is shown.

import { debounced, h, newId } from './dom.js';

/** Milliseconds without a letter after which is searched. */
const PAUSE = 500;

/** The name of the field that was written in last: showing what it finds makes the view anew. */
let writing = null;

/**
 * A field with its label.
 * @param {{name: string, label: string, value: string | null}} what
 * @param {(text: string) => void} go searches
 * @param {AbortSignal} signal
 */
export function searchField({ name, label, value }, go, signal) {
  const id = newId(name);
  const field = h('input', { id, type: 'search', size: 14, value: value ?? '' });
  const search = debounced(() => {
    writing = document.activeElement === field ? name : null;
    go(field.value);
  }, PAUSE, signal);
  field.addEventListener('input', search);
  if (writing === name) {
    writing = null;
    queueMicrotask(() => {
      field.focus();
      field.setSelectionRange(field.value.length, field.value.length);
    });
  }
  return h('span', {}, h('label', { for: id }, `${label} `), field);
}
