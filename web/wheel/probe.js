// The node of a surface under the pointer, in words, and marked in the picture.

import { h, replace } from '../lib/dom.js';
import { number } from '../lib/format.js';

/**
 * A line that says which node is under the pointer, where it is and what it has.
 * @param {any} shown the stage
 * @param {() => any} bodyNow what is drawn
 * @param {ReturnType<import('./vtp.js').readSurface>} surface
 * @param {string} length unit of length
 * @param {(point: number) => string} values words for what a point has
 */
export function probe(shown, bodyNow, { points, arrays }, length, values) {
  const IDLE = 'Point at the wheel to read a node.';
  const line = h('p', { class: 'small probed' }, IDLE);
  let waiting = null;
  const look = () => {
    const event = waiting;
    waiting = null;
    const body = bodyNow();
    const { triangle, at } = shown.under(body, event);
    if (triangle < 0) {
      forget();
      return;
    }
    const box = shown.canvas.getBoundingClientRect();
    const away = (point) => Math.hypot(at[3 * point] - event.clientX + box.left, at[3 * point + 1] - event.clientY + box.top);
    const point = [...body.triangles.subarray(3 * triangle, 3 * triangle + 3)].sort((a, b) => away(a) - away(b))[0];
    const [x, y, z] = [...points.subarray(3 * point, 3 * point + 3)].map((value) => number(value));
    const has = (name) => (arrays.has(name) ? Number(arrays.get(name)[point]) : 0);
    const contact = has('contact') > 0 ? `, contact node ${has('contact') - 1}` : '';
    replace(line, `Node ${has('node')}${contact}, sector ${has('sector')}: x ${x}, y ${y}, z ${z} ${length}${values(point)}`);
    shown.mark([at[3 * point], at[3 * point + 1]]);
  };
  const forget = () => {
    shown.mark(null);
    replace(line, IDLE);
  };
  const ask = (event) => {
    if (waiting === null) requestAnimationFrame(look);
    waiting = event;
  };
  shown.canvas.addEventListener('pointermove', (event) => event.buttons === 0 && ask(event));
  shown.canvas.addEventListener('click', ask);
  shown.canvas.addEventListener('pointerdown', () => shown.mark(null));
  shown.canvas.addEventListener('pointerleave', (event) => event.pointerType === 'mouse' && forget());
  return line;
}
