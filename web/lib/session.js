// The token, kept for this tab only.

const KEY = 'rubmap-token';
let listener = () => {};

/** The token, or nothing. */
export function token() {
  return sessionStorage.getItem(KEY);
}

/** Keeps a token for this tab. */
export function signIn(text) {
  sessionStorage.setItem(KEY, text);
  listener();
}

/** Forgets the token and asks for another. */
export function signOut() {
  sessionStorage.removeItem(KEY);
  listener();
  const here = location.hash;
  if (!here.startsWith('#/sign-in')) location.hash = `#/sign-in?back=${encodeURIComponent(here)}`;
}

/** Tells when a token comes or goes. */
export function onSession(f) {
  listener = f;
}
