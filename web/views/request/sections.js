// Sections of a form for requests, in the order in which an engineer thinks, and what is said of each where it is closed.

import { count, number, percent, rpm } from '../../lib/format.js';
import { wordsOf } from '../../lib/form/words.js';
import { shapeOf } from './shape.js';
import { askedSpeeds } from './speeds.js';

/** Fields that few need, by the part that they are in. */
export const RARE = {
  '/scene/casing': ['Other shapes: single lobes, waves, a measured casing, a tilt', ['single_lobes', 'waves', 'measured', 'tilt']],
  '/scene/casing/clearance': ['Node by node, or of the cold wheel', ['given', 'values']],
  '/scene/casing/lobes': ['More of lobes', ['phase_rad', 'along_chord']],
  '/sensors/-': ['Other places and directions', ['direction', 'node', 'nearest', 'gauge']],
  '/scene/damping': ['Family by family', ['family_ratios']],
  '/speeds': ['Single speeds', ['values']],
};

/** Names of effects, those that are switched on. */
function effects({ scene = {} }) {
  const on = Object.entries(scene).filter(([name, value]) => !['casing', 'damping'].includes(name) && value !== false && value !== null && !(Array.isArray(value) && value.length === 0));
  return on.map(([name]) => (wordsOf(`/scene/${name}`)?.[0] ?? name).toLowerCase()).join(', ') || 'none';
}

function casing({ scene }, { length }) {
  const shape = shapeOf(scene?.casing);
  if (!scene?.casing) return 'no casing';
  if (!shape) return 'not complete';
  const ends = [...new Set([shape.clearances[0], shape.clearances.at(-1)])].map((each) => number(each, 3)).join('–');
  const { lobes } = scene.casing;
  return `clearance ${ends} ${length}${lobes ? `, ${count(lobes.count, 'lobe')} of ${number(lobes.amplitude, 3)} ${length}` : ''}`;
}

function speeds(request) {
  const all = askedSpeeds(request).map(rpm);
  if (all.length === 0) return '';
  const [least, most] = [Math.min(...all), Math.max(...all)].map((each) => number(Math.round(each), 5));
  return least === most ? `${least} rpm` : `${least} to ${most} rpm`;
}

/** Whether anything at one of these pointers is said otherwise than at first. */
function differs(value, begun, pointers) {
  const at = (whole, pointer) => pointer.split('/').slice(1).reduce((part, word) => part?.[word], whole);
  return pointers.some((pointer) => JSON.stringify(at(value, pointer)) !== JSON.stringify(at(begun, pointer)));
}

/**
 * The sections of a request.
 * @param {{value: any, begun: any, units: any, wheel: Node | null, campbell: Node | null, dial: Node | undefined}} what `value` is shown at first, `begun` what a new request begins with;
 *   sections in which they agree are closed
 * @returns {import('../../lib/form/form.js').Section[]}
 */
export function sectionsOf({ value, begun, units, wheel, campbell, dial }) {
  const scene = ['contact', 'friction', 'abradable', 'clearance_change', 'centrifugal_stiffening', 'coriolis', 'geometric_nonlinearity', 'mistuning', 'initial', 'flexible_casing', 'orbit', 'engine_order_excitation', 'symmetry', 'probe'];
  const at = (...names) => names.map((name) => `/scene/${name}`);
  const open = (...pointers) => differs(value, begun, pointers);
  const recorded = ['/sensors', '/record', '/stress', '/fields'];
  return [
    { title: 'The wheel in its casing', parts: at('casing'), above: wheel, open: true, state: (now) => casing(now, units) },
    {
      title: 'Speeds and operation', open: true, state: speeds, below: campbell,
      parts: ['/speeds', '/speed', '/along', '/lobes', '/superharmonics', '/families', '/coriolis', '/operation', '/limits', '/limit', '/grid', '/history_revolutions'],
    },
    { title: 'Designs', parts: ['/parameters', '/design', '/severity', '/threshold', '/compared_model'], open: true },
    { title: 'Damping', parts: at('damping'), open: open('/scene/damping'), state: ({ scene: now }) => (now?.damping ? `ζ = ${percent(now.damping.modal_ratio)}` : 'none') },
    {
      title: 'Effects', open: open(...at(...scene), '/euler_force'), state: effects,
      groups: [
        { title: 'At the contact', parts: at('contact', 'friction', 'abradable', 'clearance_change') },
        { title: 'In the wheel', parts: [...at('centrifugal_stiffening', 'coriolis', 'geometric_nonlinearity', 'mistuning', 'initial'), '/euler_force'] },
        { title: 'Around it', parts: at('flexible_casing', 'orbit', 'engine_order_excitation') },
        { title: 'How it is computed', parts: at('symmetry', 'probe'), rest: ['/scene'] },
      ],
    },
    {
      title: 'Recorded', parts: recorded, open: open(...recorded),
      state: ({ sensors, record, stress }) => [sensors?.length ? count(sensors.length, 'sensor') : null, record?.stress || stress ? 'stress' : null, record?.histories ? 'histories' : null].filter(Boolean).join(', ') || 'defaults',
    },
    {
      title: 'Accuracy', above: dial, open: open('/accuracy', '/budget', '/modes_per_speed', '/integration', '/refine', '/control_speeds', '/sweep', '/max_engine_order', '/peak_prominence'),
      state: ({ accuracy, budget }) => (accuracy ? `error below ${percent(accuracy.target)}` : budget ? 'within a budget of time' : 'default settings'),
      parts: ['/budget', '/modes_per_speed', '/refine', '/control_speeds', '/integration', '/blade_thickness'], rest: [''],
    },
    { title: 'Name, tags, notes', parts: ['/name', '/tags', '/notes'], open: open('/name', '/tags', '/notes'), state: ({ name }) => name ?? 'named by model, speeds and clearance' },
  ];
}
