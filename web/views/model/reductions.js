// The reductions of a model with their certificates.

import { h, replace } from '../../lib/dom.js';
import { duration, number, percent, speed } from '../../lib/format.js';
import { table } from '../../lib/table.js';
import { stiffeningNote } from './stiffening.js';

export function show(place, { model }) {
  if (model.reductions.length === 0) {
    replace(place, h('p', { class: 'note' }, 'There is no reduction yet: the first sweep or modal analysis computes one.'));
    return;
  }
  replace(place, model.reductions.map((reduction) => {
    const indefinite = reduction.full_model.some((at) => at.indefinite.length > 0);
    return h('article', { class: 'card' },
      h('h2', {}, `${reduction.modes_per_speed} modes per speed`),
      h('p', {}, `${reduction.wheel_unknowns} unknowns of the wheel; ${reduction.counted_modes} of ${reduction.modes} fixed-interface modes proven to be the lowest by a count of eigenvalues; `
        + `largest residual ${number(reduction.largest_mode_residual, 2)}. Computed in ${duration(reduction.wall_time_s)} by version ${reduction.version}.`),
      stiffeningNote(reduction.stiffening, indefinite),
      table({
        caption: 'Reduced and full model',
        rows: reduction.full_model,
        columns: [
          { name: 'Speed', cell: (row) => speed(row.speed_rad_s), sort: (row) => row.speed_rad_s, number: true },
          { name: 'Largest difference of the ten lowest frequencies', cell: (row) => (row.largest ? percent(row.largest.relative, 2) : '–'), sort: (row) => row.largest?.relative, number: true },
          { name: 'Nodal diameter', cell: (row) => row.largest?.nodal_diameter ?? '–', number: true },
          { name: 'Mode', cell: (row) => row.largest?.mode ?? '–', number: true },
          { name: 'Full model, Hz', cell: (row) => (row.largest ? number(row.largest.full_hz, 6) : '–'), number: true },
          { name: 'K(Ω) not positive definite at', cell: (row) => (row.indefinite.length > 0 ? `nodal diameters ${row.indefinite.join(', ')}` : 'none') },
        ],
      }));
  }));
}
