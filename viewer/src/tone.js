// From light to colours on a screen.
import { interpolateInferno, interpolateRdBu } from 'd3-scale-chromatic';
import { luminance } from './pixels.js';

const kSteps = 1024;

function tabulate(interpolate) {
  const table = new Uint8ClampedArray(3 * kSteps);
  for (let i = 0; i < kSteps; ++i) {
    const text = interpolate(i / (kSteps - 1));
    const rgb = text.startsWith('#')
      ? [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16))
      : text.match(/\d+/g).map(Number);
    table.set(rgb, 3 * i);
  }
  return table;
}
const inferno = tabulate(interpolateInferno);
const blueToRed = tabulate((t) => interpolateRdBu(1 - t));

const kEncodeSteps = 4096;
const encoded = Uint8ClampedArray.from({ length: kEncodeSteps + 1 }, (_, i) => {
  const x = i / kEncodeSteps;
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
});
/** sRGB code of a linear value. */
const encode = (x) => encoded[Math.round(Math.min(1, Math.max(0, x)) * kEncodeSteps)];

/** Hable's filmic curve, white at 11.2. */
const hable = (x) => (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
const curves = {
  sRGB: (x) => x,
  Reinhard: (x) => x / (1 + x),
  filmic: (x) => hable(2 * x) / hable(11.2),
};
export const toneMaps = [...Object.keys(curves), 'false colour'];

/** What a difference is measured by; each takes (value, reference) in one channel, or luminances. */
export const differences = {
  'signed relative': { of: (v, r, floor) => (v - r) / (Math.abs(r) + floor), signed: true, unit: '%', top: 1 },
  'absolute': { of: (v, r) => Math.abs(v - r), signed: false, unit: '', top: 1 },
  'squared relative': { of: (v, r, floor) => ((v - r) / (Math.abs(r) + floor)) ** 2, signed: false, unit: '', top: 1 },
};

function put(table, t, out, at) {
  const i = 3 * Math.round(Math.min(1, Math.max(0, t)) * (kSteps - 1));
  out[at] = table[i];
  out[at + 1] = table[i + 1];
  out[at + 2] = table[i + 2];
}

/** Where a luminance stands on the false colour scale, 12 stops around 1/16 of white. */
const falseColourStop = (y) => (Math.log2(Math.max(y, 1e-12)) + 10) / 12;

/** Paints values (RGB) into an ImageData's bytes. `exposure` in stops. */
export function paintPicture(values, out, { exposure, toneMap }) {
  const gain = 2 ** exposure;
  const curve = curves[toneMap];
  for (let i = 0, at = 0; i < values.length; i += 3, at += 4) {
    if (curve) {
      for (let c = 0; c < 3; ++c) out[at + c] = encode(curve(gain * values[i + c]));
    } else {
      put(inferno, falseColourStop(gain * luminance(values[i], values[i + 1], values[i + 2])), out, at);
    }
    out[at + 3] = 255;
  }
}

/** Paints how the luminances of `values` differ from those of `reference`; `range` is what the end of the bar means. */
export function paintDifference(values, reference, floor, out, { measure, range }) {
  const { of, signed } = differences[measure];
  for (let i = 0, at = 0; i < values.length; i += 3, at += 4) {
    const value = luminance(values[i], values[i + 1], values[i + 2]);
    const truth = luminance(reference[i], reference[i + 1], reference[i + 2]);
    const t = of(value, truth, floor) / range;
    put(signed ? blueToRed : inferno, signed ? (t + 1) / 2 : t, out, at);
    out[at + 3] = 255;
  }
}

/** Paints a colour bar, left to right. */
export function paintBar(canvas, measure) {
  const { signed } = differences[measure];
  const context = canvas.getContext('2d');
  const row = context.createImageData(canvas.width, 1);
  for (let x = 0; x < canvas.width; ++x) {
    put(signed ? blueToRed : inferno, x / (canvas.width - 1), row.data, 4 * x);
    row.data[4 * x + 3] = 255;
  }
  for (let y = 0; y < canvas.height; ++y) context.putImageData(row, 0, y);
}
