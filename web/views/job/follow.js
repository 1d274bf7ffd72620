// From a speed of a sweep to branches that begin there.

import { submit } from '../../lib/api.js';
import { h, newId, replace } from '../../lib/dom.js';
import { speed } from '../../lib/format.js';
import { problem } from '../../lib/problem.js';
import { branchesFrom, changeable, PARAMETERS, rangeOf } from '../request/branches.js';

/**
 * A button that asks what is to change, and has the periodic response at a speed followed while it does: by a job of its own, whose page
 * is shown then, with the speeds of the sweep beside.
 * @param {any} job a sweep
 * @param {number} speed_rad_s
 * @param {AbortSignal} signal
 * @param {string} words
 */
export function followButton(job, speed_rad_s, signal, words) {
  return h('button', { type: 'button', 'aria-label': `Follow branches from ${speed(speed_rad_s)}`, on: { click: () => ask(job, speed_rad_s, signal) } }, words);
}

function ask(job, speed_rad_s, signal) {
  const ids = { parameter: newId('follow'), from: newId('follow'), to: newId('follow') };
  const end = (name) => h('input', { id: ids[name], type: 'text', inputmode: 'decimal', size: 12, autocomplete: 'off' });
  const ends = { from: end('from'), to: end('to') };
  const parameter = h('select', { id: ids.parameter, value: 'speed', on: { change: begin } },
    changeable(job.request.scene).map((name) => h('option', { value: name }, PARAMETERS[name])));
  const unit = h('p', { class: 'quiet small' });
  const told = h('div');
  const start = h('button', { type: 'submit', class: 'main' }, 'Follow');
  const dialog = h('dialog', { 'aria-label': 'Follow branches' },
    h('form', { on: { submit: send } },
      h('p', {}, `The periodic response at ${speed(speed_rad_s)} is found and followed in both directions, around folds, stable or not.`),
      h('label', { for: ids.parameter }, 'What changes'), parameter,
      h('label', { for: ids.from }, 'From'), ends.from,
      h('label', { for: ids.to }, 'To'), ends.to,
      unit, told,
      h('div', { class: 'row' }, h('button', { type: 'button', on: { click: () => dialog.close() } }, 'Close'), start)));
  const left = () => dialog.close();
  signal.addEventListener('abort', left);
  dialog.addEventListener('close', () => {
    signal.removeEventListener('abort', left);
    dialog.remove();
  });
  begin();
  document.body.append(dialog);
  dialog.showModal();

  function begin() {
    const range = rangeOf(parameter.value, speed_rad_s);
    for (const name of ['from', 'to']) ends[name].value = range[name];
    replace(unit, parameter.value === 'speed' ? `In rpm; the range must contain ${speed(speed_rad_s)}.` : 'Multiples of the scene’s value; the range must contain 1.');
  }
  async function send(event) {
    event.preventDefault();
    const read = (name) => (ends[name].value.trim() === '' || Number.isNaN(Number(ends[name].value)) ? ends[name].value : Number(ends[name].value));
    start.disabled = true;
    replace(told);
    try {
      const along = { parameter: parameter.value, from: read('from'), to: read('to') };
      const made = await submit('/v1/branches', branchesFrom(job, speed_rad_s, along), signal);
      dialog.close();
      location.hash = `#/jobs/${made.id}${along.parameter === 'speed' ? `?sweep=${job.id}` : ''}`;
    } catch (error) {
      start.disabled = false;
      if (!signal.aborted) replace(told, problem(error));
    }
  }
}
