// A file on its way to the service, one at a time.

import { Away, Refusal } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { bytes, percent } from '../../lib/format.js';
import { problem } from '../../lib/problem.js';
import { upload } from '../../lib/upload.js';

/** Sends files; each becomes a model, which is shown then. */
export function sender(signal) {
  let sending = false;
  return {
    busy: () => sending,
    /**
     * Sends a package, or a mesh with name and settings of its model. Progress and what is refused are told in `told`.
     * @param {File} file
     * @param {any} told
     * @param {{name?: string, settings: any, words: (text: string) => string} | null} mesh `words` says a refusal in the words of its form
     */
    async send(file, told, mesh = null) {
      if (sending) return;
      sending = true;
      const stop = new AbortController();
      const { element, progress } = shown(file, mesh ? 'assembling matrices …' : 'is being checked …', stop);
      replace(told, element);
      try {
        // Files are read when they are sent: one that was changed meanwhile cannot be.
        if (!await readable(file)) throw new Changed();
        const { model, known } = await upload(file, mesh, progress, AbortSignal.any([signal, stop.signal]));
        location.hash = `#/models/${model.id}${known ? '?known=yes' : ''}`;
      } catch (error) {
        if (signal.aborted) return;
        replace(told, stop.signal.aborted ? h('p', { role: 'status' }, 'The upload was stopped.') : refused(file, mesh ? inWords(error, mesh.words) : error));
      } finally {
        sending = false;
      }
    },
  };
}

/** A file is no longer what it was when it was chosen. */
class Changed extends Error {}

/** Whether a file is still what it was when it was chosen. */
export async function readable(file) {
  try {
    await file.slice(0, 1).arrayBuffer();
    return true;
  } catch {
    return false;
  }
}

/** How much of a file was sent; `then` is what the service does when it has all. */
function shown(file, then, stop) {
  const bar = h('progress', { max: file.size, 'aria-label': `Upload of ${file.name}` });
  const words = h('span', {}, `${file.name}, ${bytes(file.size)}`);
  const last = h('span', { role: 'status' });
  const element = h('div', { class: 'row' }, bar, words, last, h('button', { type: 'button', on: { click: () => stop.abort() } }, 'Stop'));
  const progress = (sent, all) => {
    if (sent < all) {
      bar.value = sent;
      words.textContent = `${file.name}: ${percent(sent / all)} of ${bytes(all)}`;
    } else {
      // How long the rest takes nobody knows.
      bar.removeAttribute('value');
      words.textContent = `${file.name}:`;
      last.textContent = then;
    }
  };
  return { element, progress };
}

/** A refusal in the words of a form. */
function inWords(error, words) {
  if (!(error instanceof Refusal)) return error;
  error.detail = words(error.detail);
  error.errors = error.errors.map((one) => ({ ...one, detail: words(one.detail ?? '') }));
  return error;
}

function refused(file, error) {
  if (error instanceof Changed) {
    return h('p', { class: 'note bad', role: 'alert' }, `${file.name} was changed or moved since it was chosen. Choose it again.`);
  }
  if (error instanceof Away) {
    return h('p', { class: 'note bad', role: 'alert' }, `The upload of ${file.name} was interrupted. Choose it again once the service answers.`);
  }
  const heading = error instanceof Refusal ? h('p', {}, `The service refused ${file.name}:`) : null;
  return [heading, problem(error)];
}
