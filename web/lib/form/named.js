// Sentences of the service, which name fields of a request between backticks, in the words of its form.

import { AUTO } from './fields.js';
import { wordsOf } from './words.js';

/** A field in words, by its name with those of the parts around it; names that are words already stand as they are. */
function fieldWords(path) {
  const pointer = `/${path.replaceAll('.', '/')}`;
  const title = (wordsOf(pointer) ?? wordsOf(`/scene${pointer}`))?.[0];
  return title ? `“${title}”` : path.split('.').at(-1).replaceAll('_', ' ');
}

/** Names of fields in a sentence. */
export function fieldsIn(sentence) {
  return sentence.split('`').filter((_, k) => k % 2 === 1);
}

/** A sentence with the fields that it names, and the values that they are to have, in words. */
export function inWords(sentence) {
  const word = (path, value) => (value === 'auto' && AUTO[path.split('.').at(-1)]) || value;
  const valued = sentence.replace(/`([^`]+)` of (true|"(\w+)")/g, (_, path, value, quoted) => (value === 'true'
    ? `${fieldWords(path)} switched on` : `${fieldWords(path)} set to “${word(path, quoted)}”`));
  return valued.split('`').map((part, k) => (k % 2 === 1 ? fieldWords(part) : part)).join('');
}
