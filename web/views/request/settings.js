// Settings in whose place a request may name an accuracy.

/** Accuracies to choose from: errors as shares of the response. */
export const TARGETS = [0.1, 0.03, 0.01, 0.003, 0.001];

/** Settings of a request, and of its integration, that an accuracy stands in the place of. */
const OWN = ['budget', 'modes_per_speed'];
const OF_INTEGRATION = ['scheme', 'kept_modes', 'steps_per_revolution'];

const only = (value, names) => Object.fromEntries(Object.entries(value).filter(([name]) => names.includes(name)));
const without = (value, names) => Object.fromEntries(Object.entries(value).filter(([name]) => !names.includes(name)));

/** The settings of a request that an accuracy replaces. */
export function settingsOf(request) {
  return { ...only(request, OWN), integration: only(request.integration ?? {}, OF_INTEGRATION) };
}

/** A request with an accuracy in the place of settings. */
export function withAccuracy({ accuracy, ...request }, target) {
  const { integration = {}, ...rest } = without(request, OWN);
  const kept = without(integration, OF_INTEGRATION);
  return { ...rest, modes_per_speed: 'auto', ...(Object.keys(kept).length > 0 && { integration: kept }), accuracy: { ...accuracy, target } };
}

/** A request with settings in the place of an accuracy. */
export function withSettings({ accuracy, ...request }, { integration: own = {}, ...settings }) {
  const integration = { ...request.integration, ...own };
  return { ...without(request, [...OWN, 'integration']), ...settings, ...(Object.keys(integration).length > 0 && { integration }) };
}
