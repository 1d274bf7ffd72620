// The JSON of a request, which can be edited too.

import { h, newId, replace } from '../../lib/dom.js';

/** Where in a text JSON ends to make sense, as a line. */
function lineOf(error, text) {
  const position = /position (\d+)/.exec(error.message)?.[1];
  return position ? text.slice(0, Number(position)).split('\n').length : null;
}

/**
 * An editor. `onEdit` hears of every text that is an object; others are said below it, and the form stays as it is.
 * @param {(value: any) => void} onEdit
 */
export function editor(onEdit) {
  const id = newId('json');
  const told = h('div', { class: 'error', role: 'status', id: `${id}-told` });
  const text = h('textarea', { id, rows: 22, spellcheck: 'false', 'aria-describedby': `${id}-told` });
  text.addEventListener('input', () => {
    try {
      const value = JSON.parse(text.value);
      if (typeof value !== 'object' || value === null || Array.isArray(value)) throw new Error('a request is an object: { … }');
      replace(told);
      text.removeAttribute('aria-invalid');
      onEdit(value);
    } catch (error) {
      const line = lineOf(error, text.value);
      replace(told, `${line ? `line ${line}: ` : ''}${error.message}. The form stays as it was.`);
      text.setAttribute('aria-invalid', 'true');
    }
  });
  const element = h('details', {}, h('summary', {}, 'The request as JSON'), h('label', { for: id }, 'Request; the form follows what you write'), text, told);
  return {
    element,
    /** Whether there is a text that makes no sense; shows it then. */
    isBroken() {
      const broken = text.hasAttribute('aria-invalid');
      if (broken) {
        element.open = true;
        text.focus();
      }
      return broken;
    },
    /** Shows a request, unless it is being written. */
    show(value) {
      if (document.activeElement === text) return;
      text.value = JSON.stringify(value, null, 2);
      text.removeAttribute('aria-invalid');
      replace(told);
    },
  };
}
