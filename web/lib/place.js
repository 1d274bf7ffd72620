// Places of the page: what follows the # in an address.

/**
 * The address of a view with its query, some of it changed: `null` and the empty text take away.
 * @param {string} path such as `jobs/ID`
 * @param {URLSearchParams} query
 * @param {Record<string, any>} changes
 */
export function placeWith(path, query, changes) {
  const next = new URLSearchParams(query);
  change(next, changes);
  const text = next.toString();
  return `#/${path}${text ? `?${text}` : ''}`;
}

/** Changes a query as `placeWith` does. */
export function change(query, changes) {
  for (const [name, value] of Object.entries(changes)) {
    if (value === null || value === undefined || value === '') query.delete(name);
    else query.set(name, String(value));
  }
}

/** Where the next page of a list begins, if there is one: the contract gives its whole address. */
export function cursorOf(list) {
  return list.next ? new URLSearchParams(list.next.split('?')[1]).get('cursor') : null;
}

/** Shows the view anew. */
export function again() {
  dispatchEvent(new HashChangeEvent('hashchange'));
}
