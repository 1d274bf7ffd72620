// Names for jobs, from what is asked: model, range of speeds and clearance.

import { number, rpm } from '../../lib/format.js';
import { shapeOf } from './shape.js';
import { askedSpeeds } from './speeds.js';

/** Characters of the model's name that a name has at most. */
const MODEL = 60;

const KINDS = {
  '/v1/modal-analyses': 'natural frequencies', '/v1/studies': 'study', '/v1/case-studies': 'case', '/v1/branches': 'branches', '/v1/run-ups': 'run-up', '/v1/campaigns': 'campaign',
};

/** A name for a request to this path, such as `Impeller: 12,730 to 38,200 rpm, clearance 0.26 mm, 2 lobes of 0.27 mm`. */
export function proposedName(request, model, path) {
  const speeds = askedSpeeds(request).map((each) => Math.round(rpm(each)));
  const [least, most] = [Math.min(...speeds), Math.max(...speeds)].map((each) => number(each, 4));
  const { length } = model.units;
  const { clearances } = shapeOf(request.scene?.casing) ?? { clearances: [] };
  const { lobes } = request.scene?.casing ?? {};
  const ends = [...new Set([clearances[0], clearances.at(-1)])].map((each) => number(each, 3));
  const called = model.name.length > MODEL ? `${model.name.slice(0, MODEL - 1).trim()}…` : model.name;
  return `${called}: ${[
    KINDS[path],
    speeds.length === 0 ? null : least === most ? `${least} rpm` : `${least} to ${most} rpm`,
    clearances.length > 0 ? `clearance ${ends.join('–')} ${length}` : null,
    clearances.length > 0 && lobes ? `${lobes.count} × ${number(lobes.amplitude, 3)} ${length}` : null,
  ].filter(Boolean).join(', ')}`.slice(0, 200);
}
