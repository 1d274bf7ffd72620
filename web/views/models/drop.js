// Where packages and meshes are dropped or chosen.

import { h, newId, replace } from '../../lib/dom.js';
import { meshForm } from './mesh.js';
import { sender } from './sending.js';

/** Endings of mesh files that file choosers offer; what a file is the service finds from its content. */
const MESHES = ['.inp', '.msh', '.bdf', '.dat', '.nas', '.cdb', '.vtu'];

function isPackage(file) {
  return /\.zip$/i.test(file.name) || /^application\/(x-)?zip/.test(file.type);
}

/** The place for files; a package is sent at once, for a mesh a form opens below. */
export function drop(signal) {
  const id = newId('package');
  const told = h('div');
  const below = h('div');
  const sending = sender(signal);
  const input = h('input', { id, type: 'file', accept: ['.zip', 'application/zip', ...MESHES].join() });
  const place = h('div', { class: 'drop' },
    h('label', { for: id }, `Drop a model package (zip) or a mesh of one sector (${MESHES.join(', ')}) here, or choose one: `), input,
    ' or ', h('a', { href: '#/generate' }, 'generate an impeller'), told);
  let form = null;
  input.addEventListener('change', () => input.files[0] && take(input.files[0]));
  const over = (on) => (event) => {
    event.preventDefault();
    place.classList.toggle('over', on);
  };
  place.addEventListener('dragover', over(true));
  place.addEventListener('dragleave', over(false));
  place.addEventListener('drop', (event) => {
    over(false)(event);
    const [file] = event.dataTransfer.files;
    if (file) take(file);
  });
  return h('div', {}, place, below);

  async function take(file) {
    if (sending.busy()) return;
    replace(told);
    if (isPackage(file)) {
      await sending.send(file, told);
    } else if (form) {
      // Another mesh, or the same one mended: what was filled in stays.
      form.take(file);
    } else {
      form = meshForm(file, sending, () => {
        form = null;
        replace(below);
        input.focus();
      }, signal);
      replace(below, form.element);
      form.focus();
    }
    // The same file may be chosen again.
    input.value = '';
  }
}
