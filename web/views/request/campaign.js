// What a campaign is asked for: from a model, and as one that is there.

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

/** The request of a job of this kind, which keeps it as settings of a sweep. */
export function campaignOf(job) {
  const { sweep, compared, parameters, design, severity, limit, threshold } = job.request;
  const { modes_per_speed, speeds, scene, integration, sensors, max_engine_order, record, fields } = sweep;
  return {
    model: job.model,
    compared_model: compared?.model,
    modes_per_speed, speeds, scene, integration,
    // Those that a model has by itself are at other nodes of the other.
    sensors: compared && isOwn(sensors) && isOwn(compared.sensors) ? [] : sensors,
    max_engine_order,
    stress: record?.stress,
    fields,
    parameters, design, severity, limit, threshold,
  };
}

/** Whether sensors may be those that a model has where none are given: radial, at its first and last contact node. */
function isOwn(sensors) {
  return sensors.length <= 2 && sensors[0]?.contact_node === 0 && sensors.every(({ component, sector }) => component === 'radial' && sector === 0);
}
