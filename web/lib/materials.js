// Typical values of alloys that impellers are made of, at room temperature: suggestions, to be confirmed by the certificate of the material.

import { h, newId, replace } from './dom.js';
import { number } from './format.js';
import { lengthIn } from './units.js';

const ASM = 'typical (ASM Metals Handbook)';
const BENDING = 'smooth, rotating bending, 5e8 cycles';
const RULE = '0.45 of the ultimate strength, a rule for smooth steel';

/**
 * Name; Young's modulus, GPa; Poisson's ratio; density, kg/m³; yield, ultimate and fatigue strength (amplitude of a fully reversed stress), MPa; where strengths are
 * from; what the fatigue strength is of.
 * @type {[string, number, number, number, number, number, number, string, string][]}
 */
const ALLOYS = [
  ['Ti-6Al-4V, annealed', 114, 0.33, 4430, 828, 895, 500, 'minimum of annealed bar (AMS 4928, MMPDS)', 'smooth, rotating bending, 1e7 cycles'],
  ['Ti-6Al-2Sn-4Zr-2Mo, duplex annealed', 114, 0.32, 4540, 828, 895, 480, 'minimum of bar (AMS 4975)', 'smooth, rotating bending, 1e7 cycles'],
  ['Aluminium 2618-T61, forged', 74.5, 0.33, 2760, 372, 441, 124, ASM, BENDING],
  ['Aluminium 2014-T6, forged', 73.1, 0.33, 2800, 414, 483, 124, ASM, BENDING],
  ['Aluminium 7075-T6, wrought', 71.7, 0.33, 2810, 503, 572, 159, ASM, BENDING],
  ['Aluminium A356-T6, cast', 72.4, 0.33, 2680, 205, 275, 90, 'typical of permanent-mould castings (ASM Metals Handbook)', BENDING],
  ['Steel 17-4 PH (1.4542), H1025', 197, 0.27, 7800, 1000, 1070, 480, 'minimum of bar (AMS 5643)', RULE],
  ['Steel 1.4313 (13Cr-4Ni), QT780', 200, 0.3, 7700, 620, 780, 350, 'minimum (EN 10088-3)', RULE],
  ['Steel 34CrNiMo6 (4340), quenched and tempered', 207, 0.29, 7850, 800, 1000, 450, 'minimum of 40 to 100 mm (EN 10083-3)', RULE],
  ['Duplex steel 1.4462 (2205)', 200, 0.3, 7800, 450, 650, 290, 'minimum of bar (EN 10088-3)', RULE],
  ['Nickel alloy 718, aged', 200, 0.29, 8190, 1034, 1276, 570, 'minimum (AMS 5663)', '0.45 of the ultimate strength, a cautious rule'],
  ['Nickel alloy 713LC, cast', 197, 0.3, 8000, 750, 895, 200, 'typical (maker’s data)', 'a cautious value for castings'],
];

/** Newtons and kilograms of units by their names. */
const FORCES = { N: 1, kN: 1e3, MN: 1e6, lbf: 4.4482216152605, kgf: 9.80665 };
const MASSES = { kg: 1, g: 1e-3, t: 1e3, tonne: 1e3, Mg: 1e3, slug: 14.593903, 'lbf·s²/in': 175.12684, lb: 0.45359237 };

const tidy = (value) => Number(value.toPrecision(4));

/** How many units of stress one pascal is, and of density one kg/m³; nothing where a unit is not known. */
function factors(units) {
  const [length, force, mass] = [lengthIn('m', units.length ?? ''), FORCES[units.force], MASSES[units.mass]];
  return length && force && mass ? { stress: 1 / (force * length ** 2), density: 1 / (mass * length ** 3) } : null;
}

/** A material of the contract in units of a model. */
function materialOf([name, modulus, ratio, density, yields, ultimate, fatigue, , of], { stress, density: dense }) {
  const mpa = (value) => tidy(value * 1e6 * stress);
  return {
    youngs_modulus: mpa(1e3 * modulus), poissons_ratio: ratio, density: tidy(density * dense),
    yield_strength: mpa(yields), ultimate_strength: mpa(ultimate),
    fatigue_strength: { amplitude: mpa(fatigue), source: `typical value of ${name}, not confirmed: ${of}, in air at 20 °C` },
  };
}

/**
 * A list of alloys. `take` gets the material of the contract, in the units that `units` says then; where they are not known it says so.
 * @param {() => any} units
 * @param {(material: any) => void} take
 */
export function materialChoice(units, take) {
  const id = newId('alloy');
  const told = h('div', { role: 'status', class: 'small' });
  const list = h('select', { id, value: '' }, h('option', { value: '' }, 'choose an alloy …'), ALLOYS.map(([name], k) => h('option', { value: k }, name)));
  list.addEventListener('change', () => {
    const alloy = ALLOYS[list.value];
    if (!alloy) {
      replace(told);
      return;
    }
    const found = factors(units());
    if (!found) {
      replace(told, h('p', { class: 'note warning' }, 'The units of the model are not among those that can be converted: enter the values by hand.'));
      return;
    }
    take(materialOf(alloy, found));
    const [name, modulus, , density, yields, ultimate, fatigue, source, of] = alloy;
    replace(told, h('p', { class: 'note warning' },
      `${name}: E ${number(modulus)} GPa, ρ ${number(density)} kg/m³ and strengths ${yields} / ${ultimate} / ±${fatigue} MPa (yield, ultimate, fatigue) at room temperature. `
      + `Strengths: ${source}; fatigue: ${of}. Values differ with product form, heat treatment, thickness, surface and temperature: confirm them by the certificate of your material.`));
  });
  return h('div', { class: 'wide field' }, h('label', { for: id }, 'Typical values of'), h('div', { class: 'row' }, list), told);
}
