// What was filled in, kept for this tab: it is there again after a reload, and when one comes back.

import { h } from './dom.js';
import { again } from './place.js';

/** The draft of the form at this address. */
export function draftHere() {
  const name = `draft ${location.hash}`;
  return {
    /** What was filled in, or `null`. */
    kept: () => JSON.parse(sessionStorage.getItem(name) ?? 'null'),
    keep: (value) => sessionStorage.setItem(name, JSON.stringify(value)),
    forget: () => sessionStorage.removeItem(name),
  };
}

/** Says that a form begins with a draft, and lets one begin anew. */
export function draftNote(draft) {
  const anew = () => {
    draft.forget();
    again();
  };
  return h('p', { class: 'note', role: 'status' }, 'This is what you had filled in here. ', h('button', { type: 'button', on: { click: anew } }, 'Begin anew'));
}
