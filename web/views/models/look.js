// Look at a mesh before a model is made of it: a picture and tables in which clamp and contact line are chosen.

import { api, Away, Refusal } from '../../lib/api.js';
import { debounced, h, newId, replace } from '../../lib/dom.js';
import { bytes, count, duration, number } from '../../lib/format.js';
import { problem } from '../../lib/problem.js';
import { table } from '../../lib/table.js';
import { COLOURS, sectorStage } from '../../wheel/sector.js';
import { readable } from './sending.js';

/** Milliseconds after a change of the form before the mesh is looked at again. */
const PAUSE = 500;

/** Patches, and chains, that the tables list at most. */
const LISTED = 40;

const ROLES = { low: 'low face', high: 'high face', clamp: 'clamp', contact: 'tip' };

/** Ways to use the pointer. */
const MODES = [['look', 'Look only'], ['clamp', 'Clamp'], ['contact', 'Contact line']];

/**
 * The look at a mesh, and the price of its model.
 * @param {{element: any, seen: () => any, chosen: () => any, choose: (texts: any) => void, words: (text: string) => string}} fields
 * @param {AbortSignal} signal
 */
export function meshLook(fields, signal) {
  const status = h('p', { role: 'status', class: 'quiet small' });
  const pointed = h('p', { class: 'small', 'aria-hidden': 'true' }, '\u00a0');
  const undo = h('button', { type: 'button', disabled: true, on: { click: back } }, 'Undo');
  const place = h('div');
  const told = h('div');
  const tables = h('div');
  const price = h('span', { class: 'quiet small' });
  const modes = modeChoice();
  const controls = h('div', { class: 'row' }, modes.element, undo);
  const body = h('div', { hidden: true }, controls, place, pointed, told, tables);
  const element = h('fieldset', {}, h('legend', {}, 'The mesh as it is seen'), status, body);
  const past = [];
  let [file, asked, running, view, shown] = [null, null, null, null, null];
  const again = debounced(() => look(false), PAUSE, signal);
  fields.element.addEventListener('change', again);
  return {
    element,
    price,
    /** Looks at another file, whose choices begin anew. */
    take(other) {
      file = other;
      past.length = 0;
      undo.disabled = true;
      look(true);
    },
  };

  /** Looks at the mesh, unless it was looked at with these settings. */
  async function look(anew) {
    const settings = JSON.stringify(fields.seen());
    if (signal.aborted || (!anew && settings === asked)) return;
    asked = settings;
    running?.abort();
    const mine = new AbortController();
    running = mine;
    replace(status, 'Looking at the mesh …');
    try {
      if (!await readable(file)) throw new Away('the file was changed or moved since it was chosen');
      const seen = await api.sendText('/v1/meshes/look', 'application/octet-stream', file, { query: { settings }, signal: AbortSignal.any([signal, mine.signal]) });
      if (!mine.signal.aborted) show(seen, anew);
    } catch (error) {
      if (mine.signal.aborted || signal.aborted) return;
      replace(price);
      if (error instanceof Refusal) error.detail = fields.words(error.detail);
      body.hidden = true;
      replace(status, 'The mesh cannot be shown. ', error instanceof Refusal ? error.detail || problem(error) : error.message);
    }
  }

  function show(seen, anew) {
    shown = seen;
    body.hidden = false;
    if (anew || !view) {
      view?.end();
      view = sectorView(seen);
      replace(place, view.element);
    } else {
      view.update(seen);
    }
    replace(told, findings(seen, fields.words));
    const focused = document.activeElement?.dataset?.choice;
    replace(tables, patchTable(seen), chainTable(seen));
    // A table that is made anew loses the focus.
    if (focused) tables.querySelector(`[data-choice="${focused}"]`)?.focus();
    const { unknowns, seconds, memory_bytes: memory, package_bytes: size } = seen.price;
    replace(price, `${number(unknowns, 6)} unknowns: about ${duration(seconds)}, ${bytes(memory)} of memory, a package of ${bytes(size)}`);
    replace(status, `${count(seen.patches.length, 'patch', 'patches')}, ${count(seen.chains.length, 'chain')} of sharp edges.`);
  }

  /** Picture, legend and what its pointer does. */
  function sectorView(seen) {
    const stop = new AbortController();
    const stage = sectorStage(seen, {
      label: 'Mesh of the sector',
      over: (part) => replace(pointed, part ? described(part) : '\u00a0'),
      clicked: (part) => click(part),
    }, AbortSignal.any([signal, stop.signal]));
    if (!stage) {
      modes.element.hidden = true;
      return { element: h('p', { class: 'note' }, 'This browser does not support WebGL 2, which the picture needs; choose in the tables.'), update() {}, light() {}, end() {} };
    }
    modes.element.hidden = false;
    const element = h('div', {}, stage.element, legend(),
      h('div', { class: 'row' }, h('button', { type: 'button', on: { click: stage.reset } }, 'Reset view')),
      h('p', { class: 'quiet small' }, 'Drag to turn, with shift to move; arrow keys turn, + and − zoom, 0 resets the view. The tables below choose by keyboard.'));
    return { element, update: stage.update, light: stage.light, end: () => stop.abort() };
  }

  function described(part) {
    if (part.chain !== undefined) {
      const chain = shown.chains[part.chain];
      return `Chain of sharp edges${chain.cyclic ? ' on a cyclic face' : ''}, ${ends(chain).join(' to ')}, length ${number(chain.length)}`;
    }
    const patch = shown.patches[part.patch];
    return `Patch ${part.patch + 1}${patch.role ? `, ${ROLES[patch.role]}` : ''}: area ${number(patch.area)}, ${count(patch.nodes, 'node')}`;
  }

  function ends(chain) {
    return [chain.nodes[0], chain.nodes.at(-1)].map((at) => shown.node_ids[at]);
  }

  function click(part) {
    const mode = modes.read();
    if (part.patch !== undefined && mode !== 'look') takePatch(mode, part.patch);
    else if (mode === 'contact') takeChain(part.chain);
    else if (mode === 'clamp') replace(status, 'A clamp is a patch: click beside the edge.');
  }

  function takePatch(mode, k) {
    const { at } = shown.patches[k];
    if (at.length === 0) {
      replace(status, 'This patch is a cyclic face, where the next sector begins: it can be neither clamp nor tip.');
    } else if (mode === 'contact') {
      choose({ contact: '', between: '', contactAt: at.join(', ') });
    } else {
      const now = fields.chosen().clampAt.split(/[\s;,]+/).filter(Boolean);
      const own = at.map(String);
      const has = own.every((node) => now.includes(node));
      const next = has ? now.filter((node) => !own.includes(node)) : [...now, ...own];
      choose({ clamp: '', clampAt: next.join(', ') });
    }
  }

  function takeChain(k) {
    const [from, to] = ends(shown.chains[k]);
    if (from === to) replace(status, 'This chain is closed and has no ends: click the patch of the tip, or name two of its nodes.');
    else choose({ contact: '', contactAt: '', between: `${from}, ${to}` });
  }

  function choose(texts) {
    past.push(fields.chosen());
    undo.disabled = false;
    fields.choose(texts);
    look(false);
  }

  function back() {
    fields.choose(past.pop());
    undo.disabled = past.length === 0;
    if (undo.disabled) modes.focus();
    look(false);
  }

  /** Button that takes a part, which is lit while the button has the focus or the pointer. */
  function taking(words, label, key, part, act) {
    const light = (on) => () => view?.light(on ? part : null);
    return h('button', {
      type: 'button', 'aria-label': label, 'data-choice': key, on: { click: act, focus: light(true), blur: light(false), pointerenter: light(true), pointerleave: light(false) },
    }, words);
  }

  function patchTable({ patches }) {
    const rows = patches.slice(0, LISTED).map((patch, k) => ({ ...patch, k }));
    const buttons = ({ at, k }) => (at.length === 0 ? '' : h('div', { class: 'row' },
      taking('Clamp', `Clamp patch ${k + 1}`, `clamp-${k}`, { patch: k }, () => takePatch('clamp', k)),
      taking('Tip', `Patch ${k + 1} is the tip`, `tip-${k}`, { patch: k }, () => takePatch('contact', k))));
    const column = (name, of, show = number) => ({ name, number: true, sort: of, cell: (row) => (of(row) === undefined ? '–' : show(of(row))) });
    return [h('h3', {}, 'Patches'), left(patches), table({
      caption: 'Patches of the skin',
      rows,
      columns: [
        column('Patch', ({ k }) => k + 1, String), { name: 'Take as', cell: buttons }, { name: 'Role', sort: ({ role }) => ROLES[role] ?? null, cell: ({ role }) => ROLES[role] ?? '' },
        column('Area', ({ area }) => area), column('Radius', ({ radius }) => radius), column('Along the axis', ({ axial }) => axial),
        column('Nodes', ({ nodes }) => nodes),
      ],
    })];
  }

  function chainTable({ chains }) {
    const free = chains.map((chain, k) => ({ ...chain, k })).filter(({ cyclic }) => !cyclic);
    return h('details', {}, h('summary', {}, `Sharp edges (${free.length})`), left(free), table({
      caption: 'Chains of sharp edges away from the cyclic faces',
      rows: free.slice(0, LISTED),
      columns: [
        { name: 'Between nodes', cell: (chain) => ends(chain).join(' and ') },
        { name: 'Length', number: true, sort: ({ length }) => length, cell: ({ length }) => number(length) },
        { name: 'Take as', cell: (chain) => taking('Contact line', `Contact line between ${ends(chain).join(' and ')}`, `chain-${chain.k}`, { chain: chain.k }, () => takeChain(chain.k)) },
      ],
    }));
  }
}

/** Note on the rows that a table leaves out, if it does. */
function left(rows) {
  return rows.length > LISTED ? h('p', { class: 'quiet small' }, `The largest ${LISTED} of ${rows.length}.`) : null;
}

function modeChoice() {
  const name = newId('mode');
  const boxes = MODES.map(([value, words]) => ({ words, box: h('input', { type: 'radio', name, value, checked: value === 'look' }) }));
  const element = h('div', { class: 'row', role: 'radiogroup', 'aria-label': 'A click in the picture chooses' },
    h('span', {}, 'A click in the picture chooses:'), boxes.map(({ words, box }) => h('label', {}, box, ' ', words)));
  return { element, read: () => boxes.find(({ box }) => box.checked).box.value, focus: () => boxes.find(({ box }) => box.checked).box.focus() };
}

function legend() {
  const entry = ([colour, words]) => {
    const mark = h('span', { class: 'swatch' });
    mark.style.setProperty('background-color', `rgb(${COLOURS[colour].map((part) => Math.round(255 * part)).join(' ')})`);
    return h('li', {}, mark, ' ', words);
  };
  return h('ul', { class: 'plain row small', 'aria-label': 'Colours of the picture' },
    [['low', 'low cyclic face'], ['high', 'high cyclic face'], ['clamp', 'clamp'], ['contact', 'tip'], ['line', 'contact line and contact nodes'], ['lit', 'under the pointer']].map(entry));
}

/** Lists of refusals and of findings. */
function findings({ found, refusals }, words) {
  return [
    refusals.length > 0 ? h('div', { class: 'note warning' }, h('ul', {}, refusals.map(({ detail }) => h('li', {}, words(detail))))) : null,
    h('details', { open: true }, h('summary', {}, 'Found'), h('ul', { class: 'plain small' }, found.map((line) => h('li', {}, line)))),
  ];
}
