// Sign-in by a token.

import { api, Refusal } from '../lib/api.js';
import { h, replace } from '../lib/dom.js';
import { problem } from '../lib/problem.js';
import { signIn } from '../lib/session.js';

export async function show(main, { query }, signal) {
  const back = query.get('back') || '#/home';
  const told = h('div', { 'aria-live': 'polite' });
  const field = h('input', { id: 'token', type: 'password', autocomplete: 'off', required: true, size: '48' });
  const form = h('form', { on: { submit: enter } },
    h('div', { class: 'field' },
      h('label', { for: 'token' }, 'Token'),
      h('p', { class: 'help', id: 'token-help' }, 'The operator of the service creates tokens with `rubmap token new`. The token is stored for this tab only.'),
      field),
    h('button', { class: 'main', type: 'submit' }, 'Sign in'), told);
  field.setAttribute('aria-describedby', 'token-help');
  replace(main, h('h1', {}, 'Sign in'), form);
  field.focus();

  async function enter(event) {
    event.preventDefault();
    replace(told);
    const text = field.value.trim();
    // A header can carry nothing else.
    if (!/^[\x21-\x7e]+$/.test(text)) {
      replace(told, h('p', { class: 'note bad', role: 'alert' }, 'A token consists of letters, digits and symbols, without spaces.'));
      return;
    }
    signIn(text);
    try {
      await api.get('/v1/models', { query: { limit: 1 }, signal });
      // Only to a place of this page.
      location.hash = back.startsWith('#/') ? back : '#/home';
    } catch (error) {
      if (signal.aborted) return;
      const unknown = error instanceof Refusal && error.status === 401;
      replace(told, unknown ? h('p', { class: 'note bad', role: 'alert' }, 'The service does not know this token.') : problem(error));
    }
  }
}
