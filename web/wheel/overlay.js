// Over a picture in 3D: how the reader's coordinates lie, a bar of a round length, and a mark at a place.

import { number } from '../lib/format.js';
import { line, s, words } from '../lib/svg.js';

/** Pixels of an arm of the triad, of its middle from the corner, and of the bar at most. */
const [ARM, CORNER, BAR] = [30, 48, 140];

/** The largest of 1, 2 and 5 times a power of ten that is not above a value. */
export function round(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1) * power;
}

/**
 * What is drawn over a picture.
 * @param {number[][]} [axes] directions x, y and z in the coordinates of what is drawn, whose z is the axis of rotation
 * @param {string} [unit] of length; without it there is no bar
 */
export function overlay(axes = [], unit) {
  const element = s('svg', { class: 'overlay', 'aria-hidden': 'true' });
  let marked = null;
  return {
    element,
    /** Marks a point, in pixels, or none. */
    mark(place) {
      marked = place;
    },
    draw(eye, width, height) {
      const view = eye.view();
      const arm = (axis, k) => {
        const [x, y, z] = [0, 1, 2].map((row) => axis.reduce((sum, value, d) => sum + value * view[4 * d + row], 0));
        const end = [CORNER + ARM * x, height - CORNER - ARM * y];
        const name = `${'xyz'[k]}${Math.abs(axis[2]) > 0.999 ? ', axis' : ''}`;
        return { z, drawn: [s('path', { class: `arm-${k}`, d: line([[CORNER, height - CORNER], end]) }), words(end[0] + 7 * x - 3, end[1] - 7 * y + 4, name)] };
      };
      const length = round(BAR / eye.pixels(width, height));
      const wide = length * eye.pixels(width, height);
      const [right, foot] = [width - 16, height - 16];
      element.replaceChildren(
        ...axes.map(arm).sort((a, b) => a.z - b.z).flatMap(({ drawn }) => drawn),
        ...(unit ? [s('path', { class: 'bar', d: line([[right - wide, foot - 5], [right - wide, foot], [right, foot], [right, foot - 5]]) }),
          words(right - wide / 2, foot - 7, `${number(length)} ${unit}`, { 'text-anchor': 'middle' })] : []),
        ...(marked ? [s('circle', { class: 'probe', cx: marked[0], cy: marked[1], r: 6 })] : []));
    },
  };
}
