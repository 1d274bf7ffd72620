// The service, as openapi.yaml has it.

import { token, signOut } from './session.js';
import { isBack, isAway, onBack } from './away.js';
import { pause } from './dom.js';

/** A request that the service refused, in the words of RFC 9457; `errors` has pointers, parameters, files and rows. */
export class Refusal extends Error {
  constructor(status, problem) {
    super(problem.detail ?? problem.title ?? `status ${status}`);
    this.status = status;
    this.type = problem.type ?? '';
    this.title = problem.title ?? `The service answered ${status}`;
    this.detail = problem.detail ?? '';
    this.errors = problem.errors ?? [];
    this.retryAfter = 0;
  }
}

/** The service could not be reached. */
export class Away extends Error {}

/** Headers of every request. */
export function headers(more = {}) {
  const own = token();
  return own ? { Authorization: `Bearer ${own}`, ...more } : more;
}

/** What a failed answer says. */
export async function refusal(response) {
  let problem = {};
  try {
    problem = await response.json();
  } catch {
    problem = { title: `The service answered ${response.status} ${response.statusText}` };
  }
  const refused = new Refusal(response.status, problem);
  refused.retryAfter = Number(response.headers.get('retry-after')) || 0;
  if (response.status === 401) signOut();
  return refused;
}

/** An address with its parameters; those without a value are left out. */
export function address(path, query = {}) {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(query ?? {})) {
    if (value !== null && value !== undefined && value !== '') parameters.set(name, String(value));
  }
  const text = parameters.toString();
  return text ? `${path}${path.includes('?') ? '&' : '?'}${text}` : path;
}

/** What is awaited of the service; throws `Away` where it does not come. */
async function reached(coming) {
  try {
    return await coming;
  } catch (error) {
    // Browsers have no other name for it: "Failed to fetch", "network error", "Load failed", "Error in body stream".
    if (!(error instanceof TypeError)) throw error;
    isAway();
    throw new Away('the service cannot be reached');
  }
}

/** The answer to a request, whose body is yet to come; throws a `Refusal`, or `Away`. */
export async function request(path, { method = 'GET', query, signal, accept, body, type = 'application/json', idempotencyKey } = {}) {
  const head = headers(accept ? { Accept: accept } : {});
  if (body !== undefined) head['Content-Type'] = type;
  if (idempotencyKey) head['Idempotency-Key'] = idempotencyKey;
  const response = await reached(fetch(address(path, query), {
    method,
    signal,
    headers: head,
    body: body === undefined || type !== 'application/json' ? body : JSON.stringify(body),
  }));
  isBack();
  if (!response.ok) throw await refusal(response);
  return response;
}

export const api = {
  /** JSON of a path. */
  async get(path, options = {}) {
    return reached((await request(path, { accept: 'application/json', ...options })).json());
  },
  /** Posts text of another type; JSON of the answer. */
  async sendText(path, type, body, options = {}) {
    return reached((await request(path, { method: 'POST', type, body, ...options })).json());
  },
  /** Sends JSON; JSON of the answer, if it has any. */
  async send(method, path, body, options = {}) {
    const text = await reached((await request(path, { method, body, ...options })).text());
    return text ? JSON.parse(text) : null;
  },
  /** Text of a path. */
  async text(path, options = {}) {
    return reached((await request(path, options)).text());
  },
  /** File of a path. */
  async blob(path, options = {}) {
    return reached((await request(path, options)).blob());
  },
  /** A figure of Plotly. */
  async figure(path, query = {}, options = {}) {
    return reached((await request(path, { query: { ...query, format: 'plotly' }, ...options })).json());
  },
};

/** Whether something that failed may succeed when it is asked for again. */
export function passing(error) {
  return error instanceof Away || (error instanceof Refusal && [429, 502, 503, 504].includes(error.status));
}

/** Sends a submission until the service has answered; with one key, so that it becomes one job however often it is sent. */
export async function submit(path, body, signal) {
  const idempotencyKey = crypto.randomUUID?.() ?? `${Date.now()}-${Math.random()}`;
  for (let attempt = 0; ; attempt += 1) {
    try {
      return await api.send('POST', path, body, { signal, idempotencyKey });
    } catch (error) {
      if (!passing(error) || attempt >= 5) throw error;
      await pause(1000 * (error.retryAfter || 2 ** attempt), signal);
    }
  }
}

/** A part of the page that is loaded when it is wanted; the service may be away by then. */
export async function part(load) {
  try {
    return await load();
  } catch (error) {
    // Browsers have no name for it: "Failed to fetch dynamically imported module", "error loading …", "Importing a module script failed".
    if (!(error instanceof TypeError && /import/i.test(error.message))) throw error;
    // Browsers never ask for a module again that they could not have.
    onBack(() => location.reload());
    throw new Away(error.message);
  }
}

/** The forms of a result that the contract names, by its path; none where it has one form only. */
export function formsOf(path, contract) {
  const words = path.split('?')[0].split('/');
  const route = Object.entries(contract.paths).find(([pattern]) => {
    const parts = pattern.split('/');
    return parts.length === words.length && parts.every((one, k) => one.startsWith('{') || one === words[k]);
  });
  return route?.[1].get?.parameters?.find((parameter) => parameter.name === 'format')?.schema.enum ?? [];
}

let contract = null;
/** The contract; read once. */
export function openapi() {
  contract ??= api.get('/openapi.json').catch((error) => {
    contract = null;
    throw error;
  });
  return contract;
}
