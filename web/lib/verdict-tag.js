// The verdict on a finished sweep as one word in its colour: read when it comes into sight, few at a time, once.

import { api } from './api.js';
import { h } from './dom.js';

/** Looks of the verdicts. */
const LOOKS = { act: 'bad', watch: 'warn', undecided: '', clear: 'good' };
/** Verdicts that are read at a time. */
const AT_ONCE = 2;

/** Words that are known, by the ids of jobs. */
const known = new Map();
const waiting = [];
let reading = 0;

function show(tag, word) {
  tag.className = `tag ${LOOKS[word] ?? ''}`;
  tag.dataset.verdict = word;
  tag.textContent = word;
}

async function next() {
  if (reading >= AT_ONCE || waiting.length === 0) return;
  const { id, tag, signal } = waiting.shift();
  if (signal.aborted || !tag.isConnected) {
    next();
    return;
  }
  reading += 1;
  try {
    const { verdict } = await api.get(`/v1/jobs/${id}/verdict`, { signal });
    known.set(id, verdict);
    show(tag, verdict);
  } catch {
    // A list without a verdict is still a list.
  } finally {
    reading -= 1;
    next();
  }
}

/** The tag of a job; nothing of one that has no verdict. */
export function verdictTag({ id, kind, status }, signal) {
  if (kind !== 'sweep' || status !== 'successful') return null;
  const tag = h('span', { class: 'tag', title: 'Verdict by the operating ranges and limits of the request' }, '…');
  if (known.has(id)) {
    show(tag, known.get(id));
    return tag;
  }
  const seen = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    seen.disconnect();
    waiting.push({ id, tag, signal });
    next();
  });
  seen.observe(tag);
  signal.addEventListener('abort', () => seen.disconnect());
  return tag;
}
