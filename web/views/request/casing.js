// A measured casing from a file: the service reads it, and says what stands out of it.

import { api } from '../../lib/api.js';
import { h, replace } from '../../lib/dom.js';
import { number } from '../../lib/format.js';

/** Where a request has it. */
const AT = '/scene/casing/measured';

/** Most things of a kind that are said one by one. */
const SAID = 5;

/**
 * A button beside the switch of a measured casing. `beside(pointer)` gives it, or nothing of another field.
 * @param {(measured: any) => void} onRead takes what the service read
 * @param {AbortSignal} signal
 */
export function casingTable(onRead, signal) {
  // Kept: the form is made anew with what was read.
  const told = h('div', { class: 'small', role: 'status' });
  function beside(pointer) {
    if (pointer !== AT) return null;
    const file = h('input', { type: 'file', accept: '.csv,text/csv,text/plain', 'aria-label': 'Table of a measured casing (CSV)' });
    file.addEventListener('change', async () => {
      const [table] = file.files;
      if (!table) return;
      replace(told, `Reading ${table.name} …`);
      try {
        const found = await api.sendText('/v1/casing-tables', 'text/csv', await table.text(), { signal });
        onRead(found.measured);
        replace(told, words(table.name, found).map((line) => h('div', {}, line)));
      } catch (error) {
        if (signal.aborted) return;
        replace(told, h('div', { class: 'bad' }, `${table.name}: ${error.message}`));
      }
    });
    return h('div', {}, file, told);
  }
  return { beside };
}

function words(name, { measured, survey, filled_count: filled }) {
  const degrees = (angle) => `${number(angle * 180 / Math.PI, 4)}°`;
  const place = (line) => (measured.chord ? `${number(measured.chord[line], 3)} of the chord` : `contact node ${line}`);
  const lines = [`${name}: ${measured.angles_rad.length} angles, ${measured.heights.length} lines; ${survey.interpolation}`];
  for (const one of survey.outliers.slice(0, SAID)) lines.push(`stands alone: ${one.height} at ${degrees(one.angle_rad)}, ${place(one.line)}; its neighbours give ${number(one.expected, 3)}`);
  if (survey.outlier_count > SAID) lines.push(`${survey.outlier_count} such outliers in total`);
  for (const gap of survey.gaps.slice(0, SAID)) lines.push(`no points from ${degrees(gap.from_rad)} to ${degrees(gap.to_rad)}`);
  if (filled > 0) lines.push(`${filled} missing heights, interpolated from the curve through the others`);
  if (survey.overshoot) lines.push(`the curve overshoots all points by ${number(survey.overshoot.by, 3)} at ${degrees(survey.overshoot.angle_rad)}`);
  return lines;
}
