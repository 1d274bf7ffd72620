// The frame: which view an address means, and what stays between views.

import { api, part, Refusal } from './lib/api.js';
import { h, replace } from './lib/dom.js';
import { unread } from './lib/problem.js';
import { onSession, signOut, token } from './lib/session.js';
import { apply, choice, choose } from './lib/theme.js';

/** Views by the first words of an address, `:id` standing for any. Each has `show(main, {id, query}, signal)`. */
const VIEWS = [
  ['home', () => import('./views/home.js')],
  ['models', () => import('./views/models.js')],
  ['models/:id', () => import('./views/model.js')],
  ['generate', () => import('./views/generate.js')],
  ['sweep', () => import('./views/new-job.js')],
  ['study', () => import('./views/study.js')],
  ['jobs', () => import('./views/jobs.js')],
  ['jobs/:id', () => import('./views/job.js')],
  ['compare', () => import('./views/compare.js')],
  ['sign-in', () => import('./views/sign-in.js')],
];

const main = document.getElementById('main');
let leave = new AbortController();

/** The view of an address, with its id and parameters. */
function find(hash) {
  const [path, search] = hash.replace(/^#\/?/, '').split('?', 2);
  const words = (path || 'home').split('/').filter(Boolean);
  for (const [pattern, load] of VIEWS) {
    const parts = pattern.split('/');
    if (parts.length === words.length && parts.every((part, k) => part === ':id' || part === words[k])) {
      const id = words[parts.indexOf(':id')] ?? null;
      return { load, id, query: new URLSearchParams(search ?? '') };
    }
  }
  return null;
}

/** What a control is known by when a view is made anew. */
function nameOf(control) {
  return `${control.tagName} ${control.getAttribute('aria-label') ?? control.labels?.[0]?.textContent ?? control.textContent}`;
}

/** Gives the focus to the control of this name, unless the reader has given it to another. */
function focusAgain(place, name) {
  if (document.activeElement !== document.body) return;
  const control = [...place.querySelectorAll('a, button, input, select, textarea')].find((one) => nameOf(one) === name);
  control?.focus({ preventScroll: true });
}

/** Shows the view of the address. */
async function show() {
  leave.abort(new DOMException('the view was left', 'AbortError'));
  leave = new AbortController();
  const { signal } = leave;
  for (const link of document.querySelectorAll('header nav a')) {
    const here = location.hash === link.hash || location.hash.startsWith(`${link.hash}/`) || location.hash.startsWith(`${link.hash}?`);
    if (here) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  }
  const found = find(location.hash);
  const place = h('div');
  const focused = main.contains(document.activeElement) && document.activeElement !== main ? nameOf(document.activeElement) : null;
  if (!found) {
    document.title = 'Not found · rubmap';
    replace(main, h('h1', {}, 'This page does not exist'), h('p', {}, h('a', { href: '#/home' }, 'To the first page')));
    return;
  }
  main.setAttribute('aria-busy', 'true');
  replace(main, place);
  try {
    const view = await part(found.load);
    if (signal.aborted) return;
    const shown = view.show(place, { id: found.id, query: found.query }, signal);
    focusAgain(place, focused);
    await shown;
    focusAgain(place, focused);
  } catch (error) {
    if (signal.aborted || (error instanceof Refusal && error.status === 401)) return;
    if (!place.querySelector('h1')) place.prepend(h('h1', {}, 'This page cannot be shown'));
    place.append(unread(error, signal), h('p', {}, h('button', { type: 'button', on: { click: show } }, 'Try again')));
  } finally {
    if (!signal.aborted) {
      main.removeAttribute('aria-busy');
      const heading = place.querySelector('h1');
      document.title = heading ? `${heading.textContent} · rubmap` : 'rubmap';
    }
  }
}

/** Whether the last thing that a reader used was the keyboard: only then is the place of the focus shown around the whole content. */
let byKeys = false;
addEventListener('keydown', () => { byKeys = true; }, true);
addEventListener('pointerdown', () => { byKeys = false; }, true);
function focusMain(options) {
  main.classList.toggle('by-keys', byKeys);
  main.focus(options);
}

let path = null;
/** A view is begun anew when its place changes; a reader is then at its top. */
function moved() {
  const now = location.hash.split('?')[0];
  if (path !== null && now !== path) {
    focusMain({ preventScroll: true });
    scrollTo(0, 0);
  }
  path = now;
  show();
}

const theme = /** @type {HTMLSelectElement} */ (document.getElementById('theme'));
theme.value = choice();
theme.addEventListener('change', () => choose(theme.value));
apply();

const out = document.getElementById('sign-out');
out.addEventListener('click', signOut);
const session = () => {
  out.hidden = !token();
};
onSession(session);
session();

document.getElementById('skip').addEventListener('click', (event) => {
  event.preventDefault();
  focusMain();
});

addEventListener('hashchange', moved);
moved();

api.get('/v1/version').then((version) => {
  document.getElementById('version').textContent = `rubmap ${version.version} (${version.commit.slice(0, 7)})`;
}).catch(() => {});
