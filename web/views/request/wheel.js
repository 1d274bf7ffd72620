// The wheel in its casing, drawn as clearance and lobes are typed: along the blade in the meridional section, and around the circumference.

import { h, replace } from '../../lib/dom.js';
import { number, percent } from '../../lib/format.js';
import { drawing, line, s, words } from '../../lib/svg.js';
import { shapeOf } from './shape.js';

const [WIDTH, HEIGHT, MARGIN] = [360, 270, 26];
/** Pixels that the larger of clearance and height is drawn as. */
const SHOWN = 26;

/** What is drawn of a model's section whatever the casing: the line of the tips, its normals, and the silhouette, or nodes where there are no elements. */
function profileOf({ contact, nodes, silhouette = [], disk = [] }) {
  const points = contact.map(({ position: [r, , z] }) => [z, r]);
  return { points, normals: contact.map(({ normal: [r, , z] }) => [z, r]), body: silhouette, disk, dots: silhouette.length > 0 ? [] : nodes.map(({ position: [r, , z] }) => [z, r]) };
}

/** The meridional section: the wheel, its casing in the distance of the clearance, and where lobes stand. */
function meridian({ points, normals, body, disk, dots }, shape) {
  const all = [...body.flat(), ...dots, ...points];
  const extreme = (of, k) => all.reduce((so, point) => of(so, point[k]), all[0][k]);
  const [left, right, top] = [extreme(Math.min, 0), extreme(Math.max, 0), extreme(Math.max, 1)];
  const scale = Math.min((WIDTH - 2 * MARGIN - SHOWN) / (right - left || 1), (HEIGHT - MARGIN - SHOWN - 20) / (top || 1));
  const from = Math.max(MARGIN + SHOWN, (WIDTH - (right - left) * scale) / 2);
  const at = ([z, r]) => [from + (z - left) * scale, HEIGHT - 20 - r * scale];
  const times = SHOWN / (Math.max(...shape.clearances, shape.highest) || 1) / scale;
  const offset = (by) => points.map(([z, r], k) => {
    const distance = times * by(points.length < 2 ? 0 : k / (points.length - 1));
    return at([z + normals[k][0] * distance, r + normals[k][1] * distance]);
  });
  const casing = offset((share) => shape.at(share));
  const crest = shape.highest > 0 ? offset((share) => shape.at(share) - shape.highest) : null;
  return {
    times,
    picture: drawing('Meridional section: wheel, casing and crest of its shape', WIDTH, HEIGHT,
      [['body', body], ['body disk', disk]].map(([name, rings]) => s('path', { class: name, d: rings.map((ring) => line(ring.map(at), true)).join('') })),
      s('path', { class: 'dots', d: dots.map((dot) => `${line([at(dot)])}h0`).join('') }),
      s('path', { class: 'tip', d: line(points.map(at)) }),
      s('path', { class: 'casing', d: line(casing) }),
      crest ? s('path', { class: 'crest', d: line(crest) }) : null,
      s('path', { class: 'axis', d: line([[4, HEIGHT - 20], [WIDTH - 4, HEIGHT - 20]]) }),
      words(WIDTH - 4, HEIGHT - 6, 'axis of rotation', { 'text-anchor': 'end' }),
      words(casing[0][0] - 5, casing[0][1] + 4, 'casing', { 'text-anchor': 'end' })),
  };
}

/** The circumference: tips on a circle, the casing about them, its distance exaggerated. */
function around(sectors, shape) {
  const centre = [WIDTH / 2, HEIGHT / 2];
  const largest = Math.max(...shape.clearances, shape.highest - Math.min(...shape.heights)) || 1;
  const tips = HEIGHT / 2 - SHOWN - 14;
  const pixels = SHOWN / largest;
  const gaps = shape.heights.map((height) => shape.smallest - height);
  const point = (radius, k) => {
    const angle = (2 * Math.PI * k) / gaps.length;
    return [centre[0] + radius * Math.cos(angle), centre[1] - radius * Math.sin(angle)];
  };
  const pressed = [];
  gaps.forEach((gap, k) => {
    if (gap >= 0) return;
    if (gaps[k - 1] >= 0 || k === 0) pressed.push([]);
    pressed.at(-1).push(k);
  });
  const blades = Array.from({ length: sectors }, (_, k) => {
    const at = ((k + 0.5) / sectors) * gaps.length;
    return s('path', { class: 'blade', d: line([point(tips * 0.42, at - 0.03 * gaps.length), point(tips, at)]) });
  });
  return {
    pixels,
    tips,
    picture: drawing('Around the circumference: tips and casing', WIDTH, HEIGHT,
      s('circle', { class: 'body', cx: centre[0], cy: centre[1], r: (tips * 0.42).toFixed(1) }), sectors <= 200 ? blades : null,
      s('circle', { class: 'tip', cx: centre[0], cy: centre[1], r: tips.toFixed(1) }),
      s('path', { class: 'casing', d: line(gaps.map((gap, k) => point(tips + pixels * gap, k)), true) }),
      pressed.map((list) => s('path', { class: 'pressed', d: line([...list.map((k) => point(tips, k)), ...list.toReversed().map((k) => point(tips + pixels * gaps[k], k))], true) }))),
  };
}

/** A magnification as one says it. */
const said = (times) => number(times, times < 10 ? 1 : 2);

/** What the shape leaves of the clearance, before anything moves. */
function verdictOf(shape, { length }, cold) {
  const { left, smallest, highest } = shape;
  const state = cold ? 'The clearance is that of the cold wheel, which grows at speed and leaves less. ' : '';
  if (smallest < 0) return [true, `${state}The casing is ${number(-smallest, 3)} ${length} smaller than the wheel: all tips are pressed.`];
  if (highest <= 0) return [false, `${state}The casing is round: tips touch only where something else moves them by ${number(smallest, 3)} ${length}.`];
  if (left > 0) return [true, `${state}The casing’s highest place leaves ${number(left, 3)} ${length} of the clearance: no tip touches unless something else moves it by that, and a sweep decides nothing.`];
  const share = smallest > 0 ? ` (${percent(-left / smallest)} of it)` : '';
  const words = `${state}The casing reaches ${number(-left, 3)} ${length} past the clearance${share}: every tip is pushed by that much as it passes.`;
  return [smallest > 0 && -left > 0.25 * smallest, `${words}${-left > 0.25 * smallest ? ' That is a lot: stress and motion may exceed what the wheel can bear.' : ''}`];
}

/**
 * Drawings of a model's wheel in the casing of a request, made anew by `show(request)`.
 * @param {any} model
 * @param {any} section of the model; without it only the circumference is drawn
 */
export function wheelInCasing(model, section) {
  const told = h('p', { class: 'note', role: 'status' });
  const pictures = h('div', { class: 'sketches' });
  const profile = section && profileOf(section);
  const element = h('div', {}, pictures, told);
  function show(request) {
    const casing = request.scene?.casing;
    element.hidden = !casing;
    const shape = shapeOf(casing);
    if (!shape) {
      replace(told, casing ? 'The drawing needs clearance, and of each lobe number or angle, height and width.' : '');
      told.className = 'note';
      return;
    }
    const { contact_radius: radius, units: { length } } = model;
    const round = around(model.sectors, shape);
    const cut = profile ? meridian(profile, shape) : null;
    const figure = (picture, caption) => h('figure', {}, picture, h('figcaption', { class: 'quiet small' }, caption));
    replace(pictures,
      cut ? figure(cut.picture, `In section: clearance drawn ${said(cut.times)} times as large${shape.highest > 0 ? '; dashed: where the casing stands farthest in' : ''}.`) : null,
      figure(round.picture, `Around: ${model.sectors} tips${radius ? ` at radius ${number(radius)} ${length}` : ''}, the casing at its smallest clearance; its distance drawn ${radius ? `${said(round.pixels / (round.tips / radius))} times as large` : 'larger'}.`));
    const [much, text] = verdictOf(shape, model.units, casing.clearance.given === 'cold');
    told.className = `note ${much ? 'warning' : ''}`;
    replace(told, text);
  }
  return { element, show };
}
