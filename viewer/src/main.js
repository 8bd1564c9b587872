// The page: images of one scene by several methods beside their reference, errors, plots and tables.
import './style.css';
import { brief, choice, element, slider, withError } from './dom.js';
import { Panels } from './panels.js';
import { decodePixels, luminance } from './pixels.js';
import { makePlot } from './plots.js';
import { bestOf, makeMetrics, makeTable } from './tables.js';
import { differences, paintBar, paintDifference, paintPicture, toneMaps } from './tone.js';

const modes = ['side by side', 'split', 'flip', 'differences'];

/** One set of images of equal size, all controls with it. */
class Comparison {
  /** @param {{title: string, images: object[]}} group  images as in the report; `reference: true` marks one */
  constructor(group) {
    this.images = group.images.map((image) => ({ ...image, values: decodePixels(image) }));
    this.reference = this.images.find((image) => image.reference);
    this.methods = this.images.filter((image) => image !== this.reference);
    this.floor = this.reference ? 0.01 * meanLuminance(this.reference.values) : 0;
    this.state = {
      mode: modes[0],
      exposure: group.exposure ?? 0,
      toneMap: toneMaps[0],
      measure: Object.keys(differences)[0],
      range: 0.5,
      left: this.images[0].name,
      right: (this.reference ?? this.images.at(-1)).name,
      flipped: 0,
    };
    this.panels = new Panels(this.images[0], (x, y) => this.readOut(x, y));
    this.controls = element('div', { class: 'controls' });
    this.bar = element('canvas', { class: 'bar', width: 256, height: 10 });
    this.barLabels = element('span', { class: 'bar-labels' });
    this.pixel = element('table', { class: 'pixel' });
    this.root = element(
      'section',
      { class: 'comparison' },
      group.title && element('h2', {}, group.title),
      this.controls,
      this.panels.root,
      element('div', { class: 'below' }, this.pixel, this.reference && makeMetrics(this.images)),
    );
    this.update();
  }

  set(values) {
    Object.assign(this.state, values);
    this.update();
  }

  update() {
    this.makeControls();
    this.panels.show(this.stacks());
  }

  repaint(values) {
    Object.assign(this.state, values);
    this.showBar();
    this.panels.repaint();
  }

  makeControls() {
    const { mode, exposure, toneMap, measure, range, left, right } = this.state;
    const names = this.images.map((image) => image.name);
    const possible = this.reference ? modes : modes.slice(0, 3);
    const tabs = possible.map((name) =>
      element('button', { type: 'button', 'aria-pressed': String(name === mode), click: () => this.set({ mode: name }) }, name),
    );
    const parts = [element('div', { class: 'tabs', role: 'group', 'aria-label': 'view' }, ...tabs)];
    if (mode === 'split')
      parts.push(
        choice('left', names, left, (name) => this.set({ left: name })),
        choice('right', names, right, (name) => this.set({ right: name })),
      );
    if (mode === 'differences')
      parts.push(
        choice('difference', Object.keys(differences), measure, (name) => this.repaint({ measure: name })),
        slider(
          'range',
          { min: -7, max: 4, step: 0.5, value: Math.log2(range), format: (v) => brief(2 ** v) },
          (v) => this.repaint({ range: 2 ** v }),
        ),
        element('span', { class: 'legend' }, this.bar, this.barLabels),
      );
    else
      parts.push(
        slider(
          'exposure',
          { min: -10, max: 10, step: 0.25, value: exposure, format: (v) => `${v > 0 ? '+' : ''}${v} EV` },
          (v) => this.repaint({ exposure: v }),
        ),
        choice('tone map', toneMaps, toneMap, (name) => this.repaint({ toneMap: name })),
      );
    parts.push(element('button', { type: 'button', click: () => this.panels.fit(true) }, 'whole image'));
    this.controls.replaceChildren(...parts);
    this.showBar();
  }

  showBar() {
    const { measure, range } = this.state;
    const { signed, unit } = differences[measure];
    const text = (v) => (unit === '%' ? `${brief(100 * v)} %` : brief(v));
    paintBar(this.bar, measure);
    this.barLabels.textContent = `${signed ? text(-range) : '0'} to ${text(range)} of luminance`;
  }

  stacks() {
    const { mode, left, right, flipped } = this.state;
    const byName = (name) => this.images.find((image) => image.name === name);
    const picture = (image) => ({
      name: image.name,
      caption: this.caption(image),
      paint: (out) => paintPicture(image.values, out, this.state),
    });
    if (mode === 'split') return [[picture(byName(left)), picture(byName(right))]];
    if (mode === 'flip') return [[picture(this.images[flipped % this.images.length])]];
    if (mode === 'differences')
      return this.methods.map((image) => [
        {
          name: image.name,
          caption: this.caption(image),
          paint: (out) => paintDifference(image.values, this.reference.values, this.floor, out, this.state),
        },
      ]);
    return this.images.map((image) => [picture(image)]);
  }

  caption(image) {
    const index = this.images.indexOf(image) + 1;
    const facts = [];
    if (image.metrics?.rmse !== undefined) facts.push(`RMSE ${withError(image.metrics.rmse, image.metrics.rmse_error)}`);
    if (image.metrics?.seconds !== undefined) facts.push(`${brief(image.metrics.seconds)} s`);
    if (image === this.reference) facts.push('reference');
    return [`${index} ${image.name}`, ...facts].join(' · ');
  }

  readOut(x, y) {
    const at = 3 * (y * this.images[0].width + x);
    const rgb = (image) => [0, 1, 2].map((c) => image.values[at + c]);
    const truth = this.reference && luminance(...rgb(this.reference));
    this.panels.read((name) => {
      const values = rgb(this.images.find((image) => image.name === name));
      const off = truth && name !== this.reference.name && luminance(...values) / truth - 1;
      const share = Number.isFinite(off) && off !== false ? ` (${off > 0 ? '+' : ''}${brief(100 * off)} %)` : '';
      return `${x}, ${y}: ${values.map(brief).join('  ')}${share}`;
    });
    this.pixel.replaceChildren(
      element('caption', {}, `pixel ${x}, ${y}`),
      element('tr', {}, ...['', 'R', 'G', 'B', this.reference ? 'against reference' : ''].map((t) => element('th', {}, t))),
      ...this.images.map((image) => {
        const values = rgb(image);
        const off =
          truth && image !== this.reference ? `${brief(100 * (luminance(...values) / truth - 1))} %` : '';
        return element(
          'tr',
          {},
          element('td', {}, image.name),
          ...values.map((v) => element('td', { class: 'number' }, brief(v))),
          element('td', { class: 'number' }, off),
        );
      }),
    );
  }

  /** 1 to 9 flip through the images. */
  key(event) {
    const index = Number(event.key) - 1;
    if (index >= 0 && index < this.images.length) this.set({ mode: 'flip', flipped: index });
  }
}

function meanLuminance(values) {
  let sum = 0;
  for (let i = 0; i < values.length; i += 3) sum += luminance(values[i], values[i + 1], values[i + 2]);
  return (3 * sum) / values.length;
}

/** The verdicts of the report, or what can be said from the metrics. */
function summary({ verdicts, groups = [] }) {
  if (verdicts?.length)
    return verdicts.map(({ place, winner, text }) =>
      element('p', { class: 'summary' }, `${place}: `, element('strong', {}, winner), winner ? ': ' : '', text),
    );
  const lines = groups.flatMap(({ title, images }) => {
    const { key, image } = bestOf(images);
    if (!image || images.filter((i) => i.metrics).length < 2) return [];
    const measure = key === 'cost' ? 'RMSE² × time' : 'RMSE';
    const others = images.filter((i) => i.metrics && i !== image);
    const factors = others.map((i) => i.metrics[key] / image.metrics[key]);
    const range = [...new Set([Math.min(...factors), Math.max(...factors)].map(brief))].join(' to ');
    const text = ` has the least ${measure}, by a factor of ${range} to ${others.map((i) => i.name).join(', ')}.`;
    return [element('p', { class: 'summary' }, title ? `${title}: ` : '', element('strong', {}, image.name), text)];
  });
  return lines;
}

/** What the names on the page mean, folded. */
function glossary({ glossary: terms }) {
  if (!terms?.length) return undefined;
  return element(
    'details',
    { class: 'glossary' },
    element('summary', {}, 'what the names mean'),
    element('dl', {}, ...terms.flatMap(({ name, text }) => [element('dt', {}, name), element('dd', {}, text)])),
  );
}

function facts(report) {
  const rows = Object.entries(report.facts ?? {});
  if (rows.length === 0) return undefined;
  return element(
    'details',
    { open: true },
    element('summary', {}, 'how it was made'),
    element('dl', {}, ...rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, String(value))])),
  );
}

function main() {
  const report = JSON.parse(document.getElementById('report').textContent);
  document.title = report.title;
  const groups = report.groups ?? [];
  const comparisons = groups.map((group) => new Comparison(group));
  let active = comparisons[0];
  for (const comparison of comparisons)
    comparison.root.addEventListener('pointerenter', () => {
      active = comparison;
    });
  document.addEventListener('keydown', (event) => {
    if (!event.target.closest('input, select') && !event.ctrlKey && !event.metaKey) active?.key(event);
  });
  document.getElementById('app').append(
    element('header', {}, element('h1', {}, report.title), element('p', {}, report.subtitle ?? ''), ...summary(report)),
    element('div', { class: 'tables overview' }, ...(report.overview ?? []).map(makeTable)),
    glossary(report) ?? '',
    ...comparisons.map((comparison) => comparison.root),
    element('div', { class: 'plots' }, ...(report.plots ?? []).map(makePlot)),
    element('div', { class: 'tables' }, ...(report.tables ?? []).map(makeTable)),
    element('footer', {}, facts(report) ?? ''),
  );
  comparisons.forEach((comparison) => comparison.panels.fit());
}

main();
