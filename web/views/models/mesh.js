// A model from a mesh: a short form, then the upload.

import { h, replace } from '../../lib/dom.js';
import { bytes } from '../../lib/format.js';
import { meshLook } from './look.js';
import { settingsFields } from './settings.js';

/**
 * The form of a mesh file.
 * @param {File} first
 * @param {{busy: () => boolean, send: (file: File, told: any, mesh: any) => Promise<void>}} sending
 * @param {() => void} close what is done when nothing is to be made of it
 * @param {AbortSignal} signal
 */
export function meshForm(first, sending, close, signal) {
  let file = first;
  const fields = settingsFields(nameOf(file));
  const heading = h('h2', {});
  const told = h('div');
  const make = h('button', { type: 'submit', class: 'main' }, 'Make the model');
  const ended = new AbortController();
  const left = () => {
    ended.abort();
    close();
  };
  const leave = h('button', { type: 'button', on: { click: left } }, 'Cancel');
  const seen = meshLook(fields, AbortSignal.any([signal, ended.signal]));
  const form = h('form', { novalidate: true, on: { submit } }, fields.element, seen.element, told, h('div', { class: 'row' }, make, leave, seen.price));
  const element = h('section', { 'aria-label': 'Model from a mesh' }, heading,
    h('p', {}, 'The mesh is that of one sector, one blade between two cyclic faces that are meshed alike. The service assembles its matrices. What is left out here is read from the file or found from its shape; the model then says what was found.'),
    form);
  title();
  seen.take(file);
  return {
    element,
    focus: fields.focus,
    /** Another file in place of the first. */
    take(other) {
      fields.rename(nameOf(file), nameOf(other));
      file = other;
      replace(told);
      title();
      seen.take(file);
      make.focus();
    },
  };

  function title() {
    heading.textContent = `Model from the mesh ${file.name} (${bytes(file.size)})`;
  }

  async function submit(event) {
    event.preventDefault();
    if (sending.busy()) return;
    replace(told);
    const read = fields.read();
    if (!read) {
      replace(told, h('p', { class: 'note bad', role: 'alert' }, 'Correct the marked fields.'));
      return;
    }
    make.disabled = leave.disabled = true;
    await sending.send(file, told, { ...read, words: fields.words });
    make.disabled = leave.disabled = false;
    // What is disabled loses the focus.
    if (document.activeElement === document.body) make.focus();
  }
}

/** The name of a model from that of its file. */
function nameOf(file) {
  return file.name.replace(/\.[^.]*$/, '') || file.name;
}
