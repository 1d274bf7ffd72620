// What a job or a model is called.

import { api } from './api.js';
import { h, newId, replace } from './dom.js';
import { problem } from './problem.js';

/**
 * A button that asks for name, tags and notes, and changes them.
 * @param {string} path of the job or model
 * @param {{name?: string, tags?: string[], notes?: string}} labels as they are
 * @param {() => void} changed what is done then
 * @param {AbortSignal} signal
 */
export function labelsButton(path, labels, changed, signal) {
  const button = h('button', { type: 'button' }, 'Name, tags, notes');
  button.addEventListener('click', () => ask(path, labels, changed, signal));
  return button;
}

function ask(path, { name, tags, notes }, changed, signal) {
  const fields = {
    name: h('input', { id: newId('label'), value: name, maxlength: 200 }),
    tags: h('input', { id: newId('label'), value: (tags ?? []).join(', ') }),
    notes: h('textarea', { id: newId('label'), value: notes, rows: 4, maxlength: 4000 }),
  };
  const told = h('div');
  const words = { name: 'Name', tags: 'Tags, with commas between them', notes: 'Notes' };
  const dialog = h('dialog', { 'aria-label': 'Name, tags, notes' },
    h('form', {},
      Object.entries(fields).map(([key, field]) => [h('label', { for: field.id }, words[key]), field]),
      told,
      h('div', { class: 'row' },
        h('button', { type: 'button', on: { click: () => dialog.close() } }, 'Leave as it is'),
        h('button', { type: 'submit', class: 'main' }, 'Save'))));
  const left = () => dialog.close();
  signal.addEventListener('abort', left);
  dialog.addEventListener('close', () => {
    signal.removeEventListener('abort', left);
    dialog.remove();
  });
  dialog.querySelector('form').addEventListener('submit', async (event) => {
    event.preventDefault();
    const listed = fields.tags.value.split(',').map((tag) => tag.trim()).filter(Boolean);
    try {
      await api.send('PATCH', path, { name: fields.name.value.trim() || null, tags: listed, notes: fields.notes.value.trim() || null }, { signal });
      dialog.close();
      changed();
    } catch (error) {
      if (!signal.aborted) replace(told, problem(error));
    }
  });
  document.body.append(dialog);
  dialog.showModal();
}
