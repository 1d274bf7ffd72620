// What a schema of the contract says, in the few shapes that a form knows.

/**
 * A schema without references and without `null`, which for a form is nothing.
 * @param {any} schema
 * @param {Record<string, any>} definitions
 */
export function resolve(schema, definitions) {
  let { description } = schema;
  let found = schema;
  for (;;) {
    if (found.$ref) {
      found = definitions[found.$ref.split('/').pop()];
    } else if (found.oneOf && found.oneOf.filter((one) => one.type !== 'null').length === 1) {
      found = { ...found.oneOf.find((one) => one.type !== 'null'), nullable: true };
    } else if (found.allOf?.length === 1) {
      [found] = found.allOf;
    } else {
      break;
    }
    description ??= found.description;
  }
  const type = Array.isArray(found.type) ? found.type.find((one) => one !== 'null') : found.type;
  const nullable = found.nullable || (Array.isArray(found.type) && found.type.includes('null'));
  return { ...found, type, nullable, description: description ?? found.description };
}

/** What kind of field a resolved schema gets. */
export function kindOf(schema, definitions) {
  if (schema.oneOf) {
    const ones = schema.oneOf.map((one) => resolve(one, definitions));
    if (ones.some((one) => one.enum) && ones.some((one) => one.type === 'integer')) return 'number_or_word';
    return 'json';
  }
  if (schema.enum) return 'word';
  if (schema.type === 'boolean') return 'switch';
  if (schema.type === 'number' || schema.type === 'integer') return 'number';
  if (schema.type === 'string') return 'text';
  if (schema.type === 'array') {
    const items = resolve(schema.items, definitions);
    if (items.type === 'number' || items.type === 'integer') return 'numbers';
    if (items.type === 'object' && items.properties) return 'list';
    if (items.type === 'string') return 'words';
    return 'json';
  }
  if (schema.properties) return 'object';
  return schema.type === 'object' ? 'object' : 'json';
}

/** Whether a field of this kind can show a value; one written by hand may be anything. */
export function fits(value, kind) {
  if (value === undefined || value === null || kind === 'json') return true;
  const whole = (one) => typeof one === 'object' && one !== null && !Array.isArray(one);
  switch (kind) {
    case 'object': return whole(value);
    case 'list': return Array.isArray(value) && value.every(whole);
    case 'numbers':
    case 'words': return Array.isArray(value) && value.every((one) => typeof one !== 'object');
    case 'switch': return typeof value === 'boolean';
    default: return typeof value !== 'object';
  }
}

/** A value with the objects that a schema requires, empty where they are not there yet. */
export function completed(value, schema, definitions) {
  const { properties = {}, required = [] } = resolve(schema, definitions);
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return value;
  const whole = { ...value };
  for (const [name, one] of Object.entries(properties)) {
    const is = resolve(one, definitions);
    if (required.includes(name) && kindOf(is, definitions) === 'object') whole[name] ??= {};
    if (is.type === 'array' && Array.isArray(whole[name])) whole[name] = whole[name].map((each) => completed(each, is.items, definitions));
    else if (whole[name] !== undefined) whole[name] = completed(whole[name], one, definitions);
  }
  return whole;
}

/** The name of a field in words. */
export function label(name) {
  const words = name.replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** The first sentence of a description; all of it is in the contract. */
export function help(schema) {
  const text = (schema.description ?? '').replace(/\s+/g, ' ').replaceAll('`', '');
  const end = text.search(/[.;:] [A-Z]|\. /);
  return end > 0 && text.length > 160 ? text.slice(0, end + 1) : text;
}

/** A help with what a number may be, where it does not say that already. */
export function withRange(text, schema) {
  const { exclusiveMinimum: above, minimum: least, exclusiveMaximum: below, maximum: most } = schema;
  // That a length is above 0 and a count at least 1 needs no word.
  const low = above ? `above ${above}` : least > 1 || least < 0 ? `at least ${least}` : null;
  const high = below !== undefined ? `below ${below}` : most < 100 ? `at most ${most}` : null;
  const limits = [low, high].filter((one) => one && !text.includes(one)).join(', ');
  return limits ? `${text} ${limits.charAt(0).toUpperCase()}${limits.slice(1)}.`.trim() : text;
}
