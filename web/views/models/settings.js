// Fields for what a mesh file does not say, or says otherwise, about its model; they make the MeshSettings of the contract.

import { h, newId } from '../../lib/dom.js';
import { control, field } from '../../lib/form/fields.js';
import { unitIn } from '../../lib/form/words.js';
import { materialChoice } from '../../lib/materials.js';
import { OF_SPEED } from '../../lib/units.js';
import { unitSystem } from './unit-system.js';

/** What a value must be, and how that is said. */
const POSITIVE = { holds: (x) => Number.isFinite(x) && x > 0, words: 'A number above 0.' };
const WHOLE = { holds: (x) => Number.isInteger(x) && x >= 1, words: 'A whole number, at least 1.' };
const AT_LEAST_3 = { holds: (x) => Number.isInteger(x) && x >= 3, words: 'A whole number, at least 3.' };
const RATIO = { holds: (x) => x > -1 && x < 0.5, words: 'A number above -1 and below 0.5.' };
const ANY = { holds: (x) => Number.isFinite(x), words: 'A number.' };
const NODES = { holds: (list) => list.every((node) => Number.isInteger(node) && node >= 0), words: 'Numbers of nodes.' };
const TWO_NODES = { holds: (list) => list.length === 2 && NODES.holds(list), words: 'Numbers of two nodes.' };
const PLACE = { holds: (list) => list.length === 3 && list.every(Number.isFinite), words: 'Three numbers: x, y, z.' };

/** Settings as messages of the service name them, in the words of the form. */
const WORDS = {
  materials: '“Material”', sectors: '“Number of sectors”', axis: '“Axis of rotation”', clamp_set: '“Node set of the clamp”',
  clamp_at: '“Clamped patches”', contact_at: '“Patch of the tip”', contact_between: '“Ends of the contact line”',
  contact_set: '“Node set of the blade’s tip”', temperatures: '“Temperature”',
};

/** Fields of a material that belong together, and those that may be left out. */
const MATERIAL = ['modulus', 'ratio', 'density'];
const STRENGTHS = ['yields', 'ultimate', 'fatigue', 'source'];

/** One field: `words` is its help, `rule` what its value must be, `unit` stands beside it. */
function one(name, kind, words, { value, rule, unit = '', extra } = {}) {
  const made = control(kind, {}, value, false, name);
  if (kind === 'numbers') made.control.size = 16;
  const beside = h('span', { class: 'unit', id: newId('unit') }, unit);
  const shown = field(name, {}, made.control, { words, extra: [beside, extra] });
  made.control.setAttribute('aria-describedby', `${beside.id} ${made.control.getAttribute('aria-describedby')}`);
  made.control.addEventListener('input', () => shown.complain(null));
  return {
    ...shown,
    unit: beside,
    /** The value without complaint; nothing where it breaks its rule. */
    peek() {
      const is = made.read();
      return is === undefined || !rule || rule.holds(is) ? is : undefined;
    },
    read() {
      const is = made.read();
      const wrong = is !== undefined && rule && !rule.holds(is);
      shown.complain(wrong ? rule.words : null);
      return is;
    },
  };
}

/** The fields; the model is called `name` unless another is given. */
export function settingsFields(name) {
  const unitOfSpeed = h('select', { 'aria-label': 'Unit of the top speed', value: 'rpm' }, [['rpm', 'rpm'], ['rad_s', 'rad/s']].map(([value, words]) => h('option', { value }, words)));
  const fields = {
    name: one('Name', 'text', 'What the model is called.', { value: name }),
    speed: one('Top speed', 'number', 'Highest speed of rotation that the model is for. It gets its stiffness at rest, at this speed and between.', { rule: POSITIVE, extra: unitOfSpeed }),
    sectors: one('Number of sectors', 'number', 'Left out: found from the mesh. A single blade on a rigid disk has 1.', { rule: WHOLE }),
    clamp: one('Node set of the clamp', 'text', 'Name of the set that is held. Left out: the nodes that the file holds, or else those of the bore.'),
    contact: one('Node set of the blade’s tip', 'text', 'Name of the set of the contact line, a line of nodes or the whole tip. Left out: the longest tip that is found.'),
    clampAt: one('Clamped patches', 'numbers', 'Instead of a set: a node inside of each. A click in the picture below chooses them.', { rule: NODES }),
    contactAt: one('Patch of the tip', 'numbers', 'Instead of a set: a node inside of it, or all corners of one of its faces.', { rule: NODES }),
    between: one('Ends of the contact line', 'numbers', 'Instead of a set: two nodes on sharp edges.', { rule: TWO_NODES }),
    nodes: one('Number of contact nodes', 'number', 'At most so many along the tip, evenly spaced.', { value: 10, rule: AT_LEAST_3, unit: 'nodes' }),
    modulus: one('Young’s modulus E', 'number', '', { rule: POSITIVE }),
    ratio: one('Poisson’s ratio ν', 'number', '', { rule: RATIO, unit: 'no unit' }),
    density: one('Density ρ', 'number', '', { rule: POSITIVE }),
    yields: one('Yield strength', 'number', '', { rule: POSITIVE }),
    ultimate: one('Ultimate strength', 'number', '', { rule: POSITIVE }),
    fatigue: one('Fatigue strength', 'number', 'Amplitude of a fully reversed stress.', { rule: POSITIVE }),
    source: one('Source of the fatigue strength', 'text', 'Standard or test, number of cycles, surface, temperature.'),
    point: one('Point on the axis', 'numbers', 'Left out: the origin.', { rule: PLACE }),
    direction: one('Direction of the axis', 'numbers', 'Left out: as the file says, or else x, y or z through the origin, whichever fits.', { rule: PLACE, unit: 'any length' }),
    temperature: one('Temperature', 'number', 'At which the wheel runs; only where the file has a material at several temperatures.', { rule: ANY, unit: 'as in the file' }),
  };
  const units = unitSystem(beside);
  beside(units.read());
  const alloys = materialChoice(() => units.read(), ({ youngs_modulus: modulus, poissons_ratio: ratio, density, yield_strength: yields, ultimate_strength: ultimate, fatigue_strength: { amplitude: fatigue, source } }) => {
    for (const [key, text] of Object.entries({ modulus, ratio, density, yields, ultimate, fatigue, source })) {
      fields[key].control.value = text;
      fields[key].complain(null);
    }
  });
  fields.source.element.classList.add('wide');
  const { name: called, speed, sectors, clamp, contact, clampAt, contactAt, between, nodes, point, direction, temperature } = fields;
  const more = h('details', {}, h('summary', {}, 'Axis of rotation, temperature'), h('div', { class: 'fields' }, [point, direction, temperature].map(({ element }) => element)));
  const element = h('div', {},
    h('div', { class: 'fields' }, [speed, called, sectors, clamp, contact, clampAt, contactAt, between, nodes, units].map((each) => each.element), units.others),
    h('fieldset', {}, h('legend', {}, 'Material'),
      h('p', { class: 'quiet small' }, 'Left out: that of the file, which has no strengths. What is given here replaces it for all elements (*); without strengths there is no utilisation.'),
      alloys,
      h('div', { class: 'fields' }, [...MATERIAL, ...STRENGTHS].map((key) => fields[key].element))),
    more);
  const choice = { clamp, contact, clampAt, contactAt, between };
  return { element, read, seen, chosen, choose, words, rename, focus: () => speed.control.focus() };

  /** Settings for a look at the mesh: those that are right so far. */
  function seen() {
    const is = Object.fromEntries(Object.entries(fields).map(([key, each]) => [key, each.peek()]));
    const whole = MATERIAL.every((key) => is[key] !== undefined);
    return { ...settingsOf(is, whole), top_speed_rad_s: undefined };
  }

  /** The choice of clamp and contact line as texts of their fields. */
  function chosen() {
    return Object.fromEntries(Object.entries(choice).map(([key, each]) => [key, each.control.value]));
  }

  /** Makes another choice of clamp and contact line; fields that are not named stay. */
  function choose(texts) {
    for (const [key, text] of Object.entries(texts)) {
      choice[key].control.value = text;
      choice[key].complain(null);
    }
  }

  /** Units beside the fields that have some. */
  function beside(now) {
    for (const key of ['modulus', 'yields', 'ultimate', 'fatigue']) fields[key].unit.textContent = unitIn('F/L²', now);
    fields.density.unit.textContent = unitIn('M/L³', now);
    fields.point.unit.textContent = now.length;
  }

  /** Name and settings, or nothing where a field must be corrected: the first of them has the focus then. */
  function read() {
    const is = Object.fromEntries(Object.entries(fields).map(([key, each]) => [key, each.read()]));
    if (is.speed === undefined) speed.complain('The top speed is needed.');
    const given = [...MATERIAL, ...STRENGTHS].filter((key) => is[key] !== undefined);
    if (given.length > 0) MATERIAL.filter((key) => is[key] === undefined).forEach((key) => fields[key].complain('Give all three, or none.'));
    if (is.fatigue !== undefined && !is.source?.trim()) fields.source.complain('A fatigue strength names its source.');
    if (is.point !== undefined && is.direction === undefined) direction.complain('An axis has a direction, too.');
    const wrong = Object.values(fields).find((each) => each.control.getAttribute('aria-invalid') === 'true');
    if (wrong) {
      if (more.contains(wrong.control)) more.open = true;
      wrong.control.focus();
      return null;
    }
    return { name: is.name?.trim() || name, settings: settingsOf(is, given.length > 0) };
  }

  /** Settings from the values of the fields, with the material or without. */
  function settingsOf(is, withMaterial) {
    return {
      top_speed_rad_s: is.speed / OF_SPEED[unitOfSpeed.value],
      units: units.read(),
      sectors: is.sectors,
      clamp_set: is.clamp?.trim() || undefined,
      clamp_at: is.clampAt,
      contact_set: is.contact?.trim() || undefined,
      contact_at: is.contactAt,
      contact_between: is.between,
      contact_nodes: is.nodes,
      materials: withMaterial ? { '*': materialOf(is) } : undefined,
      axis: is.direction && { origin: is.point ?? [0, 0, 0], direction: is.direction },
      temperatures: is.temperature === undefined ? undefined : { '*': is.temperature },
    };
  }

  /** A model that has the name of its file gets that of another file. */
  function rename(before, after) {
    if (called.control.value === before) called.control.value = after;
    name = after;
  }
}

/** The material of the fields, with those strengths that are given. */
function materialOf({ modulus, ratio, density, yields, ultimate, fatigue, source }) {
  return {
    youngs_modulus: modulus, poissons_ratio: ratio, density, yield_strength: yields, ultimate_strength: ultimate,
    fatigue_strength: fatigue === undefined ? undefined : { amplitude: fatigue, source: source?.trim() },
  };
}

/** A message of the service with the names of fields in place of those of settings. */
function words(text) {
  return text.replace(/`(\w+)`/g, (all, setting) => WORDS[setting] ?? all);
}
