// Amplitudes of a map on a linear scale: figures have them on a logarithmic one, and beside every cell the amplitude itself.

/** The same figure with amplitudes as they are. */
export function linear(figure) {
  const { amplitude, units } = figure.layout.meta ?? {};
  if (!amplitude?.range) return figure;
  const data = figure.data.map((trace, index) => {
    if (index !== amplitude.trace || !trace.customdata) return trace;
    return { ...trace, z: trace.customdata.map((row) => row?.map((cell) => cell?.[0] ?? null) ?? null) };
  });
  const bar = figure.layout.coloraxis?.colorbar ?? {};
  const coloraxis = {
    ...figure.layout.coloraxis,
    cmin: 0,
    cmax: amplitude.range[1],
    colorbar: { ...bar, tickmode: 'auto', tickvals: undefined, ticktext: undefined, title: bar.title ?? { text: `amplitude, ${units?.amplitude ?? ''}` } },
  };
  return { data, layout: { ...figure.layout, coloraxis } };
}
