// Light and dark.

const KEY = 'rubmap-theme';
const dark = matchMedia('(prefers-color-scheme: dark)');
const listeners = new Set();

/** What the user chose: `system`, `light` or `dark`. */
export function choice() {
  return localStorage.getItem(KEY) ?? 'system';
}

/** Chooses a theme and shows it. */
export function choose(theme) {
  localStorage.setItem(KEY, theme);
  apply();
}

/** Shows the theme that was chosen. */
export function apply() {
  const theme = choice() === 'system' ? (dark.matches ? 'dark' : 'light') : choice();
  document.documentElement.dataset.theme = theme;
  for (const f of listeners) f();
}

/** A colour of the theme by its name in theme.css. */
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Calls `f` after each change of the theme, until `signal` is aborted. */
export function onTheme(f, signal) {
  listeners.add(f);
  signal?.addEventListener('abort', () => listeners.delete(f));
}

dark.addEventListener('change', apply);
