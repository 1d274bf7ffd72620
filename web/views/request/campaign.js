// What a campaign is asked for: from a model.

import { CLEARANCE, sceneOf, speedsOf } from './sensible.js';

/** A first campaign of a model: tolerances of the clearance. */
export function campaignOfModel(model) {
  const closer = CLEARANCE * (model.contact_radius ?? 100);
  const ends = ['leading', 'trailing'].map((end) => `/scene/casing/clearance/${end}`);
  return {
    model: model.id,
    speeds: speedsOf(model, 9),
    scene: sceneOf(model),
    parameters: [{ name: 'clearance', at: ends, change: 'add', from: -Number((0.2 * closer).toPrecision(3)), to: Number((0.2 * closer).toPrecision(3)) }],
    design: { kind: 'sobol', size: 16 },
  };
}
