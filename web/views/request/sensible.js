// Defaults of a request for a model: speeds and a casing in proportion to the wheel.

import { rpm } from '../../lib/format.js';

/** Running clearance over the radius at which the tips lie: 0.2 to 0.4 mm of wheels with a radius of 100 to 200 mm. */
export const CLEARANCE = 0.002;
/** Height of a lobe over the clearance: every passage pushes the tips, by a little. */
const LOBE = 1.05;
/** Speeds of a sweep. */
const SPEEDS = 40;
/** Where a sweep begins, over where it ends. */
const LOWEST = 1 / 3;

/** Rounds to two significant digits: the numbers are to be read and edited. */
export function round(value) {
  return Number(value.toPrecision(2));
}

/** Speeds up to the highest at which the model has its stiffness; of one at rest only, one thousand rpm and up. */
export function speedsOf(model, count = SPEEDS) {
  const highest = Math.max(...(model.speeds_rad_s ?? [0]));
  const to = highest > 0 ? Math.round(rpm(highest)) : 3000;
  return { from: Math.round(LOWEST * to), to, count, unit: 'rpm' };
}

/** Height of a lobe for a clearance along the blade; nothing where that is not whole. */
export function lobeHeight(clearance) {
  const smallest = Math.min(...(Array.isArray(clearance?.values) ? clearance.values : [clearance?.leading, clearance?.trailing]));
  return Number.isFinite(smallest) ? Number((LOBE * smallest).toPrecision(3)) : undefined;
}

/** A scene with contact. */
export function sceneOf(model) {
  const closer = round(CLEARANCE * (model.contact_radius ?? 100));
  const clearance = { leading: closer, trailing: closer };
  return {
    centrifugal_stiffening: (model.speeds_rad_s ?? []).length > 1,
    damping: { modal_ratio: 0.005 },
    casing: {
      clearance,
      lobes: { count: 2, amplitude: lobeHeight(clearance), width_rad: 0.35 },
    },
    contact: {},
  };
}

/** Values of a part of a request when it is switched on: in proportion to the model and to what the request says; to be changed. */
export function beginning(pointer, model, request = {}) {
  const radius = model.contact_radius ?? 100;
  const scene = sceneOf(model);
  const height = lobeHeight(request.scene?.casing?.clearance);
  const known = {
    '/scene/casing': scene.casing,
    '/scene/casing/lobes': height > 0 ? { ...scene.casing.lobes, amplitude: height } : scene.casing.lobes,
    '/scene/damping': scene.damping,
    '/limits': { clearance_consumption: 0.9, ...((model.mesh?.sets ?? []).some((set) => set.ultimate && set.fatigue) && { utilisation: 1 }) },
    '/scene/friction': { coefficient: 0.15 },
    '/scene/geometric_nonlinearity': { include: 'full' },
    '/scene/casing/single_lobes/-': { angle_rad: 0, amplitude: scene.casing.lobes.amplitude, width_rad: 0.35 },
    '/scene/casing/waves/-': { order: 2, amplitude: round(0.5 * scene.casing.lobes.amplitude) },
    '/scene/casing/tilt': { angle_rad: 1e-4 },
    '/scene/clearance_change': { course: [{ revolutions: 10, change: -round(0.2 * CLEARANCE * radius) }] },
    '/scene/clearance_change/course/-': { revolutions: 20, change: 0 },
    '/scene/orbit': { radius: round(0.1 * CLEARANCE * radius) },
    '/speed/points/-': { time_s: 0, speed: speedsOf(model).from },
    '/scene/engine_order_excitation/-': { order: 2, contact_nodes: [0], component: 'axial', amplitude: 1 },
    '/record/stress': {},
    '/record/stress/strengths': {},
    '/record/histories': { speeds: 'critical' },
    '/accuracy': { target: 0.01 },
    '/budget': { seconds: 600 },
    '/sensors/-': { contact_node: 0, sector: 0, component: 'normal' },
  };
  return known[pointer];
}
