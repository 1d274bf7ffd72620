// Files to keep. They are fetched, because a link could not send the token.

import { api } from './api.js';
import { h } from './dom.js';
import { problem } from './problem.js';

/** Fetches a file and hands it to the browser under this name. */
export async function download(path, query, name, signal) {
  const blob = await api.blob(path, { query, signal });
  const url = URL.createObjectURL(blob);
  const link = h('a', { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** A button that downloads. What is refused stands beside it. */
export function downloadButton(label, path, query, name, signal) {
  const told = h('span', { role: 'status' });
  const button = h('button', { type: 'button', on: { click: start } }, label);
  async function start() {
    button.disabled = true;
    told.replaceChildren();
    try {
      await download(path, query, name, signal);
    } catch (error) {
      if (!signal?.aborted) told.append(problem(error));
    } finally {
      button.disabled = false;
    }
  }
  return h('span', {}, button, told);
}
