// What differs between the requests of sweeps.

import { h } from '../../lib/dom.js';
import { short } from '../../lib/format.js';
import { label } from '../../lib/form/schema.js';
import { unitIn, wordsOf } from '../../lib/form/words.js';
import { table } from '../../lib/table.js';

/** Labels are no settings. */
const LABELS = ['name', 'tags', 'notes'];
/** Differences that are listed. */
const LISTED = 40;
/** Numbers of a list that are written out. */
const WRITTEN = 6;

/** Every number, word and list of numbers in a request by its pointer. */
function leaves(value, at = '') {
  const isPart = typeof value === 'object' && value !== null && !(Array.isArray(value) && value.every((one) => typeof one !== 'object'));
  if (!isPart) return [[at, value]];
  const parts = Object.entries(value).filter(([name]) => at !== '' || !LABELS.includes(name));
  return parts.length === 0 && at !== '' ? [[at, true]] : parts.flatMap(([name, part]) => leaves(part, `${at}/${name}`));
}

function said(value, called) {
  if (value === undefined || value === null) return '–';
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (typeof value === 'number') return value.toLocaleString('en', { maximumSignificantDigits: 9 });
  if (Array.isArray(value)) return value.length > WRITTEN ? `${value.length} values` : value.map((one) => said(one, called)).join(', ');
  return called.get(value) ?? (value.length > 40 ? `${short(value)}…` : value.replaceAll('_', ' '));
}

/** Words of a pointer: those of its parts, with the unit of the last; items of a list are counted. */
function fieldOf(pointer, units, request) {
  const words = pointer.split('/').slice(1);
  const titles = words.map((word, k) => {
    if (/^\d+$/.test(word)) return Number(word) + 1;
    return wordsOf(`/${words.slice(0, k + 1).join('/')}`)?.[0] ?? label(word);
  });
  const own = unitIn(wordsOf(pointer)?.[1] ?? '', units);
  // Speeds have theirs beside them.
  const unit = own || (/\/(from|to|value|values)$/.test(pointer) ? request.get(`${pointer.slice(0, pointer.lastIndexOf('/'))}/unit`)?.replace('rad_s', 'rad/s') : '');
  // The scene is all of it.
  return `${titles.slice(words[0] === 'scene' ? 1 : 0).join(' › ')}${unit ? `, ${unit}` : ''}`;
}

/**
 * A table of what differs.
 * @param {{name: string, job: any}[]} jobs
 * @param {any[]} models those that are known
 */
export function requestsApart(jobs, models) {
  const called = new Map(models.map(({ id, name, units: { length } }) => [id, `${name} (${length})`]));
  const units = new Map(models.map((model) => [model.id, model.units]));
  const asked = jobs.map(({ job }) => new Map(leaves({ ...job.request, model: job.model })));
  const pointers = [...new Set(asked.flatMap((one) => [...one.keys()]))];
  const rows = pointers.filter((pointer) => new Set(asked.map((one) => JSON.stringify(one.get(pointer)))).size > 1);
  if (rows.length === 0) return h('p', {}, 'The requests are the same but for names, tags and notes.');
  // Requests are in the units of their models; where these differ, the model says so.
  const lengths = new Set(asked.map((one) => units.get(one.get('/model'))?.length));
  const shared = lengths.size === 1 ? units.get(asked[0].get('/model')) : null;
  return h('div', {},
    table({
      caption: 'What differs in the requests',
      rows: rows.slice(0, LISTED),
      columns: [
        { name: 'Setting', cell: (pointer) => (pointer === '/model' ? 'Model' : fieldOf(pointer, shared, asked[0])) },
        ...jobs.map(({ name }, k) => ({ name, cell: (pointer) => said(asked[k].get(pointer), called) })),
      ],
    }),
    rows.length > LISTED ? h('p', { class: 'quiet' }, `and ${rows.length - LISTED} more`) : null);
}
