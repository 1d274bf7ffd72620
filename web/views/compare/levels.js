// Levels of several sweeps over speed.

import { rpm } from '../../lib/format.js';
import { plain } from '../../lib/plot.js';
import { unitOf } from '../../lib/units.js';

/** Steady level of the first sensor over speed, with error bars where they are known; and what was measured. */
export function levels(jobs, measured) {
  const unit = unitOf(jobs[0].map.sensor, jobs[0].map.units);
  const data = jobs.map(({ name, map, sensor }) => {
    const errors = new Map((map.errors?.points ?? []).map((point) => [point.index, point.estimated_error]));
    const { points } = map;
    // A speed without a result is a gap.
    const y = points.map((point) => point.responses[sensor]?.half_peak_to_peak ?? null);
    return {
      type: 'scatter', mode: 'lines+markers', name: plain(name), x: points.map((point) => rpm(point.speed_rad_s)), y,
      connectgaps: false, marker: { size: 6 },
      hovertemplate: `%{x:.0f} rpm: %{y:.4g} ${unit}<extra>%{fullData.name}</extra>`,
      error_y: errors.size > 0 ? { type: 'data', array: points.map((point, k) => (y[k] === null ? null : y[k] * (errors.get(point.index) ?? 0))) } : undefined,
    };
  });
  if (measured?.some((point) => point.amplitude !== null)) {
    data.push({
      type: 'scatter', mode: 'markers', name: 'measured', marker: { symbol: 'x', size: 9 },
      x: measured.map((point) => point.rpm), y: measured.map((point) => point.amplitude),
      hovertemplate: `%{x:.0f} rpm: %{y:.4g}<extra>measured</extra>`,
    });
  }
  return {
    data,
    layout: {
      title: { text: 'Half peak to peak' }, xaxis: { title: { text: 'rotational speed Ω, rpm' } },
      yaxis: { title: { text: `half peak to peak, ${unit}` }, rangemode: 'tozero' }, showlegend: true,
    },
  };
}
