// Where packages and meshes are dropped or chosen.

import { part } from '../../lib/api.js';
import { h, newId, replace } from '../../lib/dom.js';
import { problem } from '../../lib/problem.js';
import { sender } from './sending.js';

/** Endings of mesh files that file choosers offer; what a file is the service finds from its content. */
const MESHES = ['.inp', '.msh', '.bdf', '.dat', '.nas', '.cdb', '.vtu'];
const PACKAGES = ['.zip', 'application/zip'];

function isPackage(file) {
  return /\.zip$/i.test(file.name) || /^application\/(x-)?zip/.test(file.type);
}

/** Takes files from several places; a package is sent at once, for a mesh a form opens in `below`. */
function taker(below, signal) {
  const sending = sender(signal);
  let form = null;
  return async (file, told, input) => {
    if (sending.busy()) return;
    replace(told);
    if (isPackage(file)) {
      await sending.send(file, told);
    } else if (form) {
      // Another mesh, or the same one mended: what was filled in stays.
      form.take(file);
    } else {
      const made = await part(() => import('./mesh.js')).catch((error) => {
        replace(told, problem(error));
      });
      if (!made || signal.aborted) return;
      form = made.meshForm(file, sending, () => {
        form = null;
        replace(below);
        input.focus();
      }, signal);
      replace(below, form.element);
      form.focus();
    }
  };
}

/** A place for files with its label; `more` stands behind the button. */
function placeFor(take, label, accept, more = null) {
  const id = newId('package');
  const told = h('div');
  const input = h('input', { id, type: 'file', accept: accept.join() });
  const place = h('div', { class: 'drop' }, h('label', { for: id }, label), input, more, told);
  const taken = async (file) => {
    await take(file, told, input);
    // The same file may be chosen again.
    input.value = '';
  };
  input.addEventListener('change', () => input.files[0] && taken(input.files[0]));
  const over = (on) => (event) => {
    event.preventDefault();
    place.classList.toggle('over', on);
  };
  place.addEventListener('dragover', over(true));
  place.addEventListener('dragleave', over(false));
  place.addEventListener('drop', (event) => {
    over(false)(event);
    const [file] = event.dataTransfer.files;
    if (file) taken(file);
  });
  return place;
}

/** One place for all files. */
export function drop(signal) {
  const below = h('div');
  const label = `Drop a model package (zip) or a mesh of one sector (${MESHES.join(', ')}) here, or choose one: `;
  return h('div', {}, placeFor(taker(below, signal), label, [...PACKAGES, ...MESHES], [' or ', h('a', { href: '#/generate' }, 'generate an impeller')]), below);
}

/** The three ways to a model, each with what it needs. */
export function ways(signal) {
  const below = h('div');
  const take = taker(below, signal);
  const way = (title, text, ...action) => h('li', { class: 'card' }, h('h2', {}, title), h('p', {}, text), action);
  return h('div', {},
    h('ul', { class: 'plain cards' },
      way('From a mesh', 'The mesh of one sector, one blade between two cyclic faces, from Abaqus, CalculiX, Gmsh, Nastran, Ansys or VTK. The service assembles its matrices.',
        placeFor(take, 'Drop a mesh here, or choose one: ', MESHES)),
      way('From matrices', 'A package (zip) with mass and stiffness of one sector at one or three speeds, nodes, and the nodes at which the blade may touch the casing.',
        placeFor(take, 'Drop a package here, or choose one: ', PACKAGES)),
      way('Without a model', 'An impeller from a few lengths and angles, meshed in seconds: to try the program, or for first estimates.',
        h('p', {}, h('a', { class: 'button main', href: '#/generate' }, 'Generate an impeller')))),
    below);
}
