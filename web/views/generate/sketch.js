// What the lengths and angles of a generated impeller measure: in section, along the axis, and across a blade.

import { h, replace } from '../../lib/dom.js';
import { number } from '../../lib/format.js';
import { drawing, line, s, words } from '../../lib/svg.js';

const [WIDTH, HEIGHT] = [360, 300];
/** Points of a curve. */
const POINTS = 40;

const LENGTHS = ['outlet_radius', 'inlet_tip_radius', 'inlet_hub_radius', 'bore_radius', 'axial_length', 'outlet_blade_height', 'rim_thickness', 'root_thickness', 'tip_thickness'];
const ANGLES = ['wrap_deg', 'backsweep_deg', 'sectors'];

/** Quarter ellipse from (0, r0), where it is axial, to (z1, r1), where it is radial, as points (z, r). */
function turning(r0, z1, r1) {
  return Array.from({ length: POINTS + 1 }, (_, k, phi = (k / POINTS) * (Math.PI / 2)) => [z1 * Math.sin(phi), r1 - (r1 - r0) * Math.cos(phi)]);
}

/** A line between two points with a symbol beside its middle. */
function dimension([x1, y1], [x2, y2], symbol, [dx, dy] = [5, 4]) {
  return [s('path', { class: 'dimension', d: line([[x1, y1], [x2, y2]]) }), words((x1 + x2) / 2 + dx, (y1 + y2) / 2 + dy, symbol, { class: 'symbol' })];
}

function meridian(p) {
  const back = p.axial_length + p.rim_thickness;
  const hub = turning(p.inlet_hub_radius, p.axial_length, p.outlet_radius);
  const shroud = turning(p.inlet_tip_radius, p.axial_length - p.outlet_blade_height, p.outlet_radius);
  const scale = Math.min((WIDTH - 150) / back, (HEIGHT - 60) / p.outlet_radius);
  const at = ([z, r]) => [70 + z * scale, HEIGHT - 24 - r * scale];
  const low = 24;
  const radius = (z, r, symbol, beside) => dimension(at([z, 0]), at([z, r]), symbol, beside);
  const step = 15 / scale;
  return drawing('Meridional section with the lengths of the form', WIDTH, HEIGHT,
    s('path', { class: 'body', d: line([[0, p.bore_radius], ...hub, [back, p.outlet_radius], [back, p.bore_radius]].map(at), true) }),
    s('path', { class: 'flow', d: line([...hub, ...shroud.toReversed()].map(at), true) }),
    s('path', { class: 'tip', d: line(shroud.map(at)) }),
    s('path', { class: 'axis', d: line([[8, HEIGHT - low], [WIDTH - 8, HEIGHT - low]]) }),
    radius(-step, p.inlet_hub_radius, 'R1h', [-28, 4]), radius(-2.9 * step, p.inlet_tip_radius, 'R1t', [-26, -20]),
    radius(back + step, p.outlet_radius, 'R2'), radius(back * 0.55, p.bore_radius, 'Rb'),
    dimension(at([0, p.outlet_radius + step]), at([p.axial_length, p.outlet_radius + step]), 'Z', [-4, -5]),
    dimension(at([p.axial_length, p.outlet_radius + 0.4 * step]), at([back, p.outlet_radius + 0.4 * step]), 't', [-2, -14]),
    dimension(at([p.axial_length - p.outlet_blade_height, p.outlet_radius - 0.6 * step]), at([p.axial_length, p.outlet_radius - 0.6 * step]), 'b2', [-6, 15]));
}

/** Radius and angle of a blade's middle line along the shroud, as the generator has it. */
function camber(p) {
  const hub = turning(p.inlet_hub_radius, p.axial_length, p.outlet_radius);
  const shroud = turning(p.inlet_tip_radius, p.axial_length - p.outlet_blade_height, p.outlet_radius);
  const along = (points) => points.reduce((sums, point, k) => [...sums, k === 0 ? 0 : sums[k - 1] + Math.hypot(point[0] - points[k - 1][0], point[1] - points[k - 1][1])], []);
  const lengths = along(shroud);
  const mean = (along(hub).at(-1) + lengths.at(-1)) / 2;
  const wrap = (p.wrap_deg * Math.PI) / 180;
  const slope = (Math.tan((p.backsweep_deg * Math.PI) / 180) * mean) / p.outlet_radius;
  return shroud.map(([, r], k, _all, share = lengths[k] / lengths.at(-1)) => [r, -(wrap * share + (slope - wrap) * share * (share - 1))]);
}

function along(p) {
  const centre = [WIDTH / 2, HEIGHT / 2];
  const scale = (HEIGHT / 2 - 22) / p.outlet_radius;
  const blade = camber(p);
  const point = ([r, angle], turn = 0) => [centre[0] + r * scale * Math.cos(angle + turn), centre[1] - r * scale * Math.sin(angle + turn)];
  const start = Math.PI / 2 + (p.wrap_deg * Math.PI) / 360;
  const [first, last] = [blade[0], blade.at(-1)];
  const ray = (angle) => s('path', { class: 'dimension', d: line([centre, point([p.outlet_radius * 1.08, angle], start)]) });
  const radial = [p.outlet_radius * 1.1, last[1]];
  const before = blade.at(-4);
  const tangent = [last[0] + (last[0] - before[0]) * 1.6, last[1] + (last[1] - before[1]) * 1.6];
  const circle = (r, kind) => s('circle', { class: kind, cx: centre[0], cy: centre[1], r: (r * scale).toFixed(1) });
  const middle = point([p.inlet_tip_radius * 0.45, last[1] / 2], start);
  return drawing('View along the axis with wrap and backsweep', WIDTH, HEIGHT,
    circle(p.outlet_radius, 'body'), circle(p.bore_radius, 'bore'),
    p.sectors <= 60 ? Array.from({ length: p.sectors }, (_, k) => s('path', { class: 'blade', d: line(blade.map((one) => point(one, start + (2 * Math.PI * k) / p.sectors))) })) : null,
    s('path', { class: 'tip', d: line(blade.map((one) => point(one, start))) }),
    ray(first[1]), ray(last[1]), words(middle[0] - 16, middle[1], 'wrap', { class: 'symbol' }),
    s('path', { class: 'dimension', d: line([point(last, start), point(tangent, start)]) }),
    words(point(radial, start)[0] + 4, point(radial, start)[1] + 2, 'backsweep', { class: 'symbol' }));
}

function across(p) {
  const [x, top, bottom] = [64, 40, HEIGHT - 60];
  const scale = 90 / Math.max(p.root_thickness, p.tip_thickness);
  const [root, tip] = [p.root_thickness * scale, p.tip_thickness * scale];
  const section = [[x - root / 2, bottom], [x - tip / 2, top], [x + tip / 2, top], [x + root / 2, bottom]];
  return drawing('Section across a blade with its thickness at hub and tip', 128, HEIGHT,
    s('path', { class: 'body', d: line([[2, bottom], [126, bottom], [126, bottom + 26], [2, bottom + 26]], true) }), s('path', { class: 'flow', d: line(section, true) }),
    dimension(section[1], section[2], 'tip', [-8, -8]), dimension([section[0][0], bottom + 8], [section[3][0], bottom + 8], 'hub', [-10, 16]));
}

/** Drawings of the parameters, made anew by `show(parameters)`. */
export function sketch() {
  const element = h('div', { class: 'sketches' });
  return {
    element,
    show(p) {
      const isWhole = LENGTHS.every((name) => p[name] > 0) && ANGLES.every((name) => Number.isFinite(p[name]));
      const fits = isWhole && p.outlet_blade_height < p.axial_length && p.inlet_tip_radius <= p.outlet_radius && p.wrap_deg <= 120 && p.backsweep_deg <= 75;
      if (!fits) {
        replace(element, h('p', { class: 'quiet' }, 'The sketch needs lengths that fit each other.'));
        return;
      }
      const figure = (picture, caption, kind) => h('figure', { class: kind }, picture, h('figcaption', { class: 'quiet small' }, caption));
      replace(element,
        figure(meridian(p), 'In section: radii from the axis of rotation, lengths along it.'),
        figure(along(p), `Along the axis: ${number(p.sectors)} blades; wrap ${number(p.wrap_deg)}°, backsweep ${number(p.backsweep_deg)}° from the radius.`),
        figure(across(p), 'Across a blade.', 'narrow'));
    },
  };
}
