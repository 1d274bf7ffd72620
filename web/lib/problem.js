// What went wrong, for the user.

import { h } from './dom.js';
import { Away, Refusal } from './api.js';
import { onBack } from './away.js';
import { again } from './place.js';

/** One of the errors of a refusal: where, and what. */
function item(error) {
  const row = error.row ?? error.line;
  const where = [error.file, row === undefined || row === null ? null : `line ${row}`, error.pointer, error.parameter].filter(Boolean);
  // Of a package the detail says it.
  const said = (error.detail ?? '').startsWith(where[0]);
  return h('li', {}, where.length > 0 && !said ? h('strong', {}, `${where.join(', ')}: `) : null, error.detail ?? '');
}

/** Something that failed, as an alert; a result that is not there yet as a calm note. */
export function problem(error) {
  if (error instanceof Away) {
    return h('p', { class: 'note warning', role: 'status' }, 'The service does not answer.');
  }
  if (!(error instanceof Refusal)) {
    console.error(error);
    return h('p', { class: 'note bad', role: 'alert' }, `The page failed: ${error.message}`);
  }
  if (error.status === 409 || error.type.endsWith('history-not-recorded')) {
    return h('p', { class: 'note' }, error.detail || error.title);
  }
  return h('div', { class: 'note bad', role: 'alert' },
    h('strong', {}, error.title),
    error.errors.length > 0 ? h('ul', {}, error.errors.map(item)) : h('p', {}, error.detail));
}

/**
 * Something that could not be read, in its place: it is read again when the service answers, by `retry` or with the view as a whole.
 * @param {any} error
 * @param {AbortSignal} signal
 * @param {() => void} [retry]
 */
export function unread(error, signal, retry = again) {
  if (error instanceof Away) onBack(retry, signal);
  return problem(error);
}
