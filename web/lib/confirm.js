// A question before something is lost.

import { h } from './dom.js';

/**
 * Asks in a dialog; the answer is no unless somebody says so.
 * @param {string} question
 * @param {string} yes what the button says that does it
 * @param {AbortSignal} signal
 * @returns {Promise<boolean>}
 */
export function confirmed(question, yes, signal) {
  return new Promise((resolve) => {
    const dialog = h('dialog', { 'aria-label': question });
    const close = (answer) => () => dialog.close(answer);
    dialog.append(h('p', {}, question), h('div', { class: 'row' },
      h('button', { type: 'button', autofocus: true, on: { click: close('no') } }, 'Keep'),
      h('button', { type: 'button', class: 'bad', on: { click: close('yes') } }, yes)));
    const left = () => dialog.close('no');
    signal.addEventListener('abort', left);
    dialog.addEventListener('close', () => {
      signal.removeEventListener('abort', left);
      dialog.remove();
      resolve(dialog.returnValue === 'yes');
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
