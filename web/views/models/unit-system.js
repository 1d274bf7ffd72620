// The units of a mesh, which its file does not say: they must fit each other, so they are chosen together.

import { h, newId } from '../../lib/dom.js';

/** Length, force, time and mass of common systems. */
const SYSTEMS = [
  ['mm', 'N', 's', 't'],
  ['m', 'N', 's', 'kg'],
  ['in', 'lbf', 's', 'lbf·s²/in'],
  ['ft', 'lbf', 's', 'slug'],
];
const QUANTITIES = ['length', 'force', 'time', 'mass'];
const OTHER = 'other';

/** A choice of units; `changed` is called when they are others. */
export function unitSystem(changed) {
  const id = newId('units');
  const choice = h('select', { id, value: '0', 'aria-describedby': `${id}-help` },
    SYSTEMS.map((names, k) => h('option', { value: k }, names.join(', '))), h('option', { value: OTHER }, 'others'));
  const own = QUANTITIES.map((quantity, k) => ({
    quantity, input: h('input', { id: newId('unit'), type: 'text', size: 10, maxlength: 40, autocomplete: 'off', value: SYSTEMS[0][k] }),
  }));
  const others = h('fieldset', { hidden: true }, h('legend', {}, 'Other units'), h('div', { class: 'fields' },
    own.map(({ quantity, input }) => h('div', { class: 'field' }, h('label', { for: input.id }, `Unit of ${quantity}`), h('div', { class: 'row' }, input)))));
  const help = 'Length, force, time and mass as the file counts them; force = mass · length / time².';
  const read = () => {
    const names = choice.value === OTHER ? own.map(({ input }) => input.value.trim()) : SYSTEMS[choice.value];
    return Object.fromEntries(QUANTITIES.map((quantity, k) => [quantity, names[k]]));
  };
  choice.addEventListener('change', () => {
    others.hidden = choice.value !== OTHER;
    changed(read());
  });
  others.addEventListener('input', () => changed(read()));
  const element = h('div', { class: 'field' }, h('label', { for: id }, 'Units of the file'), h('div', { class: 'row' }, choice), h('div', { class: 'help', id: `${id}-help` }, help));
  return { element, others, read };
}
