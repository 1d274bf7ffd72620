// Whether the service answers. While it does not, a line at the top says so, and asks until it does.

let asking = 0;
const waiting = new Set();

function line() {
  return document.getElementById('away');
}

/** The service did not answer. */
export function isAway() {
  if (asking) return;
  const shown = line();
  shown.textContent = 'The service does not answer. Trying again …';
  shown.hidden = false;
  asking = setInterval(async () => {
    try {
      await fetch('/healthz', { cache: 'no-store' });
      isBack();
    } catch {
      // Still away.
    }
  }, 1500);
}

/** The service answered. */
export function isBack() {
  if (!asking) return;
  clearInterval(asking);
  asking = 0;
  line().hidden = true;
  for (const f of waiting) f();
}

/** Something could not be had: asks for the service, and calls `f` whenever it answers until `signal` is aborted. */
export function onBack(f, signal) {
  isAway();
  waiting.add(f);
  signal?.addEventListener('abort', () => waiting.delete(f));
}
