// Elements of the page. Texts become text nodes, never markup.

/**
 * An element. Properties are attributes (left out where `null`, `undefined` or `false`, empty where `true`), `on` has handlers by event;
 * children are elements, texts, numbers, lists of them, or nothing.
 * @param {string} tag
 * @param {Record<string, any>} [properties]
 * @param {...any} children
 * @returns {any}
 */
export function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties ?? {})) {
    if (name === 'on') {
      for (const [event, handler] of Object.entries(value)) element.addEventListener(event, handler);
    } else if (name === 'value') {
      element.value = value ?? '';
    } else if (value !== null && value !== undefined && value !== false) {
      element.setAttribute(name, value === true ? '' : String(value));
    }
  }
  append(element, children);
  // The choice of a list can be made only when it has its options.
  if (tag === 'select' && 'value' in (properties ?? {})) element.value = properties.value ?? '';
  return element;
}

function append(element, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child instanceof Node ? child : String(child));
  }
}

/** Puts these children in place of those that an element has. */
export function replace(element, ...children) {
  element.replaceChildren();
  append(element, children);
  return element;
}

/** Facts as a list of names and values; those without a value are left out. */
export function facts(pairs) {
  const shown = pairs.filter(([, value]) => value !== null && value !== undefined && value !== '');
  return h('dl', { class: 'facts' }, shown.map(([name, value]) => [h('dt', {}, name), h('dd', {}, value)]));
}

let ids = 0;
/** An id that no other element has. */
export function newId(prefix = 'e') {
  ids += 1;
  return `${prefix}-${ids}`;
}

/** Calls `f` once nothing has asked for it for a while; stops with `signal`. */
export function debounced(f, milliseconds, signal) {
  let timer = 0;
  signal?.addEventListener('abort', () => clearTimeout(timer));
  return (...values) => {
    clearTimeout(timer);
    if (!signal?.aborted) timer = setTimeout(() => f(...values), milliseconds);
  };
}

/** Waits, or rejects when `signal` is aborted. */
export function pause(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    signal?.throwIfAborted();
    const left = () => {
      clearTimeout(timer);
      reject(signal.reason);
    };
    const timer = setTimeout(() => {
      signal?.removeEventListener('abort', left);
      resolve();
    }, milliseconds);
    signal?.addEventListener('abort', left);
  });
}
