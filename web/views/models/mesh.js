// A model from a mesh: a short form, then the upload.

import { h, replace } from '../../lib/dom.js';
import { bytes } from '../../lib/format.js';
import { settingsFields } from './settings.js';

/**
 * The form of a mesh file.
 * @param {File} first
 * @param {{busy: () => boolean, send: (file: File, told: any, mesh: any) => Promise<void>}} sending
 * @param {() => void} close what is done when nothing is to be made of it
 */
export function meshForm(first, sending, close) {
  let file = first;
  const fields = settingsFields(nameOf(file));
  const heading = h('h2', {});
  const told = h('div');
  const make = h('button', { type: 'submit', class: 'main' }, 'Make the model');
  const leave = h('button', { type: 'button', on: { click: close } }, 'Cancel');
  const form = h('form', { novalidate: true, on: { submit } }, fields.element, told, h('div', { class: 'row' }, make, leave));
  const element = h('section', { 'aria-label': 'Model from a mesh' }, heading,
    h('p', {}, 'The mesh is that of one sector, one blade between two cyclic faces that are meshed alike. The service assembles its matrices. What is left out here is read from the file or found from its shape; the model then says what was found.'),
    form);
  title();
  return {
    element,
    focus: fields.focus,
    /** Another file in place of the first. */
    take(other) {
      fields.rename(nameOf(file), nameOf(other));
      file = other;
      replace(told);
      title();
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
