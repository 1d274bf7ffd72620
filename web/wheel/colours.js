// Colours for magnitudes: cividis, which looks alike to those who do not tell red from green (Nuñez, Anderton and Renslow, 2018).

import { h } from '../lib/dom.js';
import { number } from '../lib/format.js';
import { round } from './overlay.js';

/** From low to high, red, green, blue from 0 to 1, evenly spaced. */
const CIVIDIS = [
  [0.000, 0.135, 0.305], [0.000, 0.202, 0.443], [0.208, 0.272, 0.423], [0.318, 0.340, 0.424], [0.404, 0.407, 0.442],
  [0.486, 0.475, 0.471], [0.574, 0.546, 0.475], [0.667, 0.621, 0.458], [0.765, 0.701, 0.422], [0.868, 0.786, 0.359], [0.995, 0.909, 0.218],
];

/** The colours as a texture's bytes, one row. */
export function texels() {
  return new Uint8Array(CIVIDIS.flatMap((colour) => [...colour.map((part) => Math.round(255 * part)), 255]));
}

/**
 * A key of the colours, with ticks at round values.
 * @param {number} most the value at the upper end; the lower is 0
 * @param {string} words quantity and unit
 * @param {{value: number, words: string} | null} [limit] above which values are striped
 */
export function colourKey(most, words, limit = null) {
  const bar = h('span', { class: 'colour-bar', role: 'img', 'aria-label': `Colours from 0 to ${number(most, 3)}` });
  const stops = CIVIDIS.map((colour) => `rgb(${colour.map((part) => Math.round(255 * part)).join(' ')})`);
  bar.style.setProperty('background-image', `linear-gradient(to right, ${stops.join(', ')})`);
  const step = round(most / 4);
  const rounds = Array.from({ length: Math.floor(most / step) + 1 }, (_, k) => k * step).filter((value) => value < 0.76 * most);
  const ticks = [...rounds, most].map((value) => {
    const tick = h('span', { class: 'tick' }, number(value, 3));
    tick.style.setProperty('left', `${100 * value / most}%`);
    return tick;
  });
  return h('div', { class: 'row small' }, h('span', {}, words), h('span', { class: 'colour-scale' }, bar, ticks),
    limit ? h('span', {}, `${most > limit.value ? 'striped' : 'nothing'}: above ${limit.words}`) : null);
}
