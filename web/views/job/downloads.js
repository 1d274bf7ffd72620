// Every result in every form that it has, as the contract lists them.

import { formsOf, openapi } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { download } from '../../lib/download.js';
import { problem } from '../../lib/problem.js';

/** Endings of files whose form is none of the forms' words. */
const ENDINGS = { plotly: 'plotly.json', pvd: 'zip' };

/** Endings of files that have one form. */
const FILES = { archive: 'zip', report: 'html' };

export async function show(place, { job }, signal) {
  const contract = await openapi();
  const told = h('div', { 'aria-live': 'polite' });
  const speeds = h('input', { type: 'number', id: 'download-speed', min: 0, max: Math.max(0, (job.speeds?.total ?? 1) - 1), value: 0 });
  const indexed = job.links.some((link) => link.href.includes('{index}'));
  const items = job.links.filter((link) => link.rel !== 'self').map((link) => item(link, contract, job, { told, speeds }, signal));
  replace(place,
    indexed ? h('p', {}, h('label', { for: 'download-speed' }, 'Index of the speed, for results of a single speed: '), speeds) : null,
    items.length > 0 ? h('ul', { class: 'cards' }, items) : h('p', { class: 'note' }, 'There is nothing to download yet.'),
    told);
}

function item(link, contract, job, { told, speeds }, signal) {
  const forms = formsOf(link.href, contract);
  const words = link.rel.replaceAll('-', ' ');
  const button = (form) => h('button', {
    type: 'button', 'aria-label': `${words} as ${form ?? 'file'}`, on: { click: (event) => start(event.target, form) },
  }, form ?? 'file');
  async function start(pressed, form) {
    pressed.disabled = true;
    replace(told);
    try {
      const ending = form ? ENDINGS[form] ?? form : FILES[link.rel] ?? 'json';
      const of = link.href.includes('{index}') ? `-${speeds.value}` : '';
      await download(link.href.replace('{index}', speeds.value), form ? { format: form } : {}, `${job.id}-${link.rel}${of}.${ending}`, signal);
    } catch (error) {
      if (!signal.aborted) replace(told, problem(error));
    } finally {
      pressed.disabled = false;
    }
  }
  return h('li', { class: 'card' }, h('h2', {}, words), h('div', { class: 'row' }, forms.length > 0 ? forms.map(button) : button(null)));
}
