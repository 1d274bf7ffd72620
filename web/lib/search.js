// A field to search by.

import { debounced, h, newId, replace } from './dom.js';
import { change, placeWith } from './place.js';
import { problem } from './problem.js';

/** Milliseconds without a letter after which is searched. */
const PAUSE = 500;

/**
 * What narrows a list: changes the query of its view and the address, and reads the list again. The view is not begun anew: in a field that
 * is being written in no letter is lost.
 * @param {string} path of the view
 * @param {URLSearchParams} query
 * @param {{read: () => Promise<void>, told: HTMLElement}} list what is refused goes to `told`
 * @param {AbortSignal} signal
 * @returns {(changes: Record<string, any>) => void}
 */
export function narrowing(path, query, { read, told }, signal) {
  return (changes) => {
    const from = { cursor: null, ...changes };
    history.pushState(null, '', placeWith(path, query, from));
    change(query, from);
    replace(told);
    read().catch((error) => {
      if (!signal.aborted) replace(told, problem(error));
    });
  };
}

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
