/** An element with attributes (functions become listeners) and children (nodes or texts). */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') made.addEventListener(name, value);
    else if (value !== undefined && value !== false) made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.filter((child) => child !== undefined && child !== null));
  return made;
}

/** A drop-down of names. */
export function choice(label, names, value, change) {
  const select = element(
    'select',
    { change: () => change(select.value), 'aria-label': label },
    ...names.map((name) => element('option', { value: name, selected: name === value }, name)),
  );
  return element('label', { class: 'control' }, label, select);
}

/** A slider that says its value. */
export function slider(label, { min, max, step, value, format }, change) {
  const output = element('output', {}, format(value));
  const input = element('input', {
    type: 'range',
    min,
    max,
    step,
    value,
    'aria-label': label,
    input: () => {
      output.textContent = format(Number(input.value));
      change(Number(input.value));
    },
  });
  return element('label', { class: 'control' }, label, input, output);
}

/** A number and its uncertainty, that to two digits and the number as far; without an uncertainty as `brief`. */
export function withError(value, error) {
  if (!Number.isFinite(error) || !(error > 0) || !Number.isFinite(value)) return brief(value);
  const digits = Math.floor(Math.log10(error)) - 1; // of the last place that is shown
  const size = Math.floor(Math.log10(Math.max(Math.abs(value), error)));
  if (size < -3 || size >= 5)
    return `${value.toExponential(Math.min(6, Math.max(0, size - digits)))} ± ${error.toExponential(1)}`;
  const places = Math.min(8, Math.max(0, -digits));
  return `${value.toFixed(places)} ± ${error.toFixed(places)}`;
}

/** A number of four digits, short. */
export function brief(value) {
  if (value === null || value === undefined) return '';
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}
