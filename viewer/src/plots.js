// Curves with bands of confidence, by default on logarithmic axes.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { brief, element } from './dom.js';

const colours = ['#4fb3ff', '#ffb454', '#7bd88f', '#ff6b81', '#c49bff', '#5fe0d0', '#e8e36a', '#b0b8c4'];

/** Slope of ln y over ln x by least squares, or undefined. */
export function slopeOf({ x, y }) {
  const points = x.map((value, i) => [Math.log(value), Math.log(y[i])]).filter((p) => p.every(Number.isFinite));
  if (points.length < 2) return undefined;
  const mean = (of) => points.reduce((sum, p) => sum + of(p), 0) / points.length;
  const mx = mean((p) => p[0]);
  const my = mean((p) => p[1]);
  const spread = mean((p) => (p[0] - mx) ** 2);
  return spread > 0 ? mean((p) => (p[0] - mx) * (p[1] - my)) / spread : undefined;
}

/** Series over different x as uPlot wants them: one common x, gaps where a series has none. */
function align(series) {
  const xs = [...new Set(series.flatMap((s) => s.x))].sort((a, b) => a - b);
  const column = (s, values) => {
    const byX = new Map(s.x.map((x, i) => [x, values[i]]));
    return xs.map((x) => byX.get(x) ?? null);
  };
  return { xs, column };
}

/** @param {{title, x_label, y_label, log: boolean, series: {name, x: number[], y: number[], low?, high?}[]}} plot */
export function makePlot(plot) {
  const { xs, column } = align(plot.series);
  const data = [xs];
  const series = [{ label: plot.x_label, value: (_, v) => brief(v) }];
  const bands = [];
  plot.series.forEach((s, i) => {
    const stroke = colours[i % colours.length];
    const slope = plot.log ? slopeOf(s) : undefined;
    const label = slope === undefined ? s.name : `${s.name} (slope ${slope.toFixed(2)})`;
    series.push({ label, stroke, width: 2, spanGaps: true, points: { size: 6 }, value: (_, v) => brief(v) });
    data.push(column(s, s.y));
    if (!s.low) return;
    const edge = { stroke: 'transparent', spanGaps: true, points: { show: false }, class: 'edge', label: '' };
    series.push({ ...edge }, { ...edge });
    data.push(column(s, s.high), column(s, s.low));
    bands.push({ series: [data.length - 2, data.length - 1], fill: `${stroke}33` });
  });
  const axis = (label) => ({
    label,
    stroke: '#c8ccd4',
    grid: { stroke: '#ffffff14' },
    ticks: { stroke: '#ffffff14' },
    values: (_, ticks) => ticks.map(brief),
  });
  const scale = plot.log ? { distr: 3 } : {};
  const holder = element('figure', { class: 'plot' }, element('figcaption', {}, plot.title));
  new uPlot(
    {
      width: 620,
      height: 380,
      scales: { x: { time: false, ...scale }, y: scale },
      axes: [axis(plot.x_label), axis(plot.y_label)],
      series,
      bands,
      legend: { live: true },
    },
    data,
    holder,
  );
  return holder;
}
