import { brief, element, withError } from './dom.js';

const cell = (value) => (typeof value === 'number' ? brief(value) : (value ?? ''));

/** @param {{title: string, columns: string[], rows: (string|number|null)[][]}} table */
export function makeTable({ title, columns, rows }) {
  return element(
    'figure',
    { class: 'table' },
    element('figcaption', {}, title),
    element(
      'table',
      {},
      element('thead', {}, element('tr', {}, ...columns.map((name) => element('th', {}, name)))),
      element(
        'tbody',
        {},
        ...rows.map((row) =>
          element('tr', {}, ...row.map((v) => element('td', { class: typeof v === 'number' && 'number' }, cell(v)))),
        ),
      ),
    ),
  );
}

/** Errors of images, the smallest of each column marked. */
const measures = [
  { key: 'seconds', name: 'time, s' },
  { key: 'samples', name: 'samples' },
  { key: 'rmse', name: 'RMSE', least: true },
  { key: 'psnr', name: 'PSNR, dB', most: true },
  { key: 'rel_mse', name: 'relMSE', least: true },
  { key: 'mean_ratio', name: 'mean ratio' },
  { key: 'cost', name: 'RMSE² × time', least: true },
];

/** The method with the least error, by RMSE² × time where times are known. */
export function bestOf(images) {
  const rated = images.filter((image) => image.metrics);
  const key = rated.every((image) => image.metrics.cost !== undefined) ? 'cost' : 'rmse';
  return { key, image: rated.reduce((a, b) => (!a || b.metrics[key] < a.metrics[key] ? b : a), undefined) };
}

export function makeMetrics(images) {
  const rated = images.filter((image) => image.metrics);
  const shown = measures.filter(({ key }) => rated.some((image) => image.metrics[key] !== undefined));
  const best = Object.fromEntries(
    shown
      .filter((m) => m.least || m.most)
      .map(({ key, most }) => {
        const values = rated.map((image) => image.metrics[key]).filter(Number.isFinite);
        return [key, most ? Math.max(...values) : Math.min(...values)];
      }),
  );
  const body = rated.map((image) =>
    element(
      'tr',
      {},
      element('td', {}, image.name),
      ...shown.map(({ key }) => {
        const value = image.metrics[key];
        const text = withError(value, image.metrics[`${key}_error`]);
        return element('td', { class: value === best[key] && rated.length > 1 ? 'number best' : 'number' }, text);
      }),
    ),
  );
  return element(
    'table',
    { class: 'metrics' },
    element('thead', {}, element('tr', {}, element('th'), ...shown.map(({ name }) => element('th', {}, name)))),
    element('tbody', {}, ...body),
  );
}
