// The page as a person uses it, in headless Chromium from a file: clicks, zoom, exposure, pixel values.
import assert from 'node:assert/strict';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { after, before, beforeEach, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const kSize = 8;

/** The half float nearest to a number of ordinary size, rounded down. */
function half(value) {
  if (value === 0) return 0;
  const exponent = Math.floor(Math.log2(value));
  return ((exponent + 15) << 10) | Math.floor((value / 2 ** exponent - 1) * 1024);
}

/** An image of one grey, but for a white pixel at (1, 2). */
function image(name, grey, more = {}) {
  const bytes = Buffer.alloc(kSize * kSize * 6);
  for (let i = 0; i < kSize * kSize; ++i)
    for (let c = 0; c < 3; ++c) bytes.writeUInt16LE(half(i === 2 * kSize + 1 ? 1 : grey), 6 * i + 2 * c);
  return { name, width: kSize, height: kSize, scale: 1, reference: false, pixels: bytes.toString('base64'), ...more };
}

const report = {
  title: 'three greys',
  subtitle: '</b>',
  groups: [
    {
      title: 'greys',
      exposure: 0,
      images: [
        image('dark', 0.25, { metrics: { rmse: 0.2, seconds: 1, cost: 0.04 } }),
        image('bright', 0.75, { metrics: { rmse: 0.1, rmse_error: 0.01, seconds: 2, cost: 0.02 } }),
        image('truth', 0.5, { reference: true }),
      ],
    },
  ],
  plots: [
    {
      title: 'error',
      x_label: 's',
      y_label: 'RMSE',
      log: true,
      series: [{ name: 'a', x: [1, 10, 100], y: [1, 0.1, 0.01], low: [0.9, 0.09, 0.009], high: [1.1, 0.11, 0.011] }],
    },
  ],
  overview: [{ title: 'against a', columns: ['method', 'greys'], rows: [['b', '7 ×']] }],
  glossary: [{ name: 'a', text: 'a method' }],
  tables: [{ title: 'figures', columns: ['method', 'ours'], rows: [['a', 1.25]] }],
  facts: { command: 'turbid <compare>' },
};

let browser;
let page;
let folder;
let file;
const problems = [];

async function write(shown) {
  const viewer = await readFile(resolve(import.meta.dirname ?? '.', '../viewer.html'), 'utf8');
  const json = JSON.stringify(shown).replaceAll('<', '\\u003c');
  await writeFile(file, viewer.replace('<!--report-->', () => json));
}

before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'viewer-'));
  file = join(folder, 'report.html');
  await write(report);
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-gpu'],
  });
});

after(async () => {
  await browser?.close();
  await rm(folder, { recursive: true });
});

beforeEach(async () => {
  await page?.close();
  problems.length = 0;
  page = await browser.newPage({ viewport: { width: 1400, height: 1000 } });
  page.on('pageerror', (error) => problems.push(error.message));
  page.on('request', (request) => request.url().startsWith('file:') || problems.push(request.url()));
  await page.goto(pathToFileURL(file).href);
});

/** RGBA of a pixel of the canvas in a view. */
const colour = (name, x, y) =>
  page.evaluate(
    ([n, px, py]) => [
      ...document
        .querySelector(`.frame[data-name="${n}"] canvas`)
        .getContext('2d')
        .getImageData(px, py, 1, 1).data,
    ],
    [name, x, y],
  );
const scales = () => page.$$eval('.frame', (frames) => frames.map((frame) => Number(frame.dataset.scale)));

test('shows all images, says which is best, and asks the network for nothing', async () => {
  assert.deepEqual(await page.$$eval('.frame', (frames) => frames.map((f) => f.dataset.name)), ['dark', 'bright', 'truth']);
  assert.match(await page.textContent('.summary'), /bright has the least RMSE² × time, by a factor of 2 to dark/);
  assert.match(await page.textContent('.metrics'), /0\.100 ± 0\.010/);
  assert.deepEqual(await colour('dark', 0, 0), [137, 137, 137, 255]); // sRGB of 0.25
  assert.deepEqual(await colour('dark', 1, 2), [255, 255, 255, 255]);
  assert.deepEqual(problems, []);
});

test('zooms and pans all views together', async () => {
  const before = await scales();
  const frame = page.locator('.frame').first();
  await frame.hover();
  await page.mouse.wheel(0, -400);
  await page.waitForFunction((k) => Number(document.querySelector('.frame').dataset.scale) > 1.2 * k, before[0]);
  const zoomed = await scales();
  assert.ok(zoomed.every((k) => k === zoomed[0]), String(zoomed));
  const transforms = () => page.$$eval('.frame canvas', (all) => all.map((canvas) => canvas.style.transform));
  const held = await transforms();
  await page.mouse.down();
  await page.mouse.move(300, 400, { steps: 4 });
  await page.mouse.up();
  const moved = await transforms();
  assert.notEqual(moved[0], held[0]);
  assert.ok(moved.every((t) => t === moved[0]));
  await page.getByRole('button', { name: 'whole image' }).click();
  assert.deepEqual(await scales(), before);
});

test('exposure and tone map act on the light', async () => {
  await page.getByLabel('exposure').fill('1');
  assert.deepEqual(await colour('dark', 0, 0), [188, 188, 188, 255]); // sRGB of 0.5
  await page.getByLabel('tone map').selectOption('Reinhard');
  assert.deepEqual(await colour('dark', 0, 0), [156, 156, 156, 255]); // of 1/3
  await page.getByLabel('tone map').selectOption('false colour');
  const [r, g, b] = await colour('dark', 0, 0);
  assert.ok(r > g && r > b, `${r} ${g} ${b}`);
});

test('shows differences with their sign', async () => {
  await page.getByRole('button', { name: 'differences' }).click();
  const dark = await colour('dark', 0, 0);
  const bright = await colour('bright', 0, 0);
  assert.ok(dark[2] > dark[0], `too dark is blue, found ${dark}`);
  assert.ok(bright[0] > bright[2], `too bright is red, found ${bright}`);
  assert.match(await page.textContent('.bar-labels'), /-50 % to 50 %/);
  await page.getByLabel('difference').selectOption('absolute');
  assert.deepEqual(await colour('dark', 0, 0), await colour('bright', 0, 0));
});

test('splits two images at a line that can be dragged', async () => {
  await page.getByRole('button', { name: 'split' }).click();
  const divider = page.locator('.divider');
  const box = await divider.boundingBox();
  const cut = () => page.$eval('.sheet:nth-child(2)', (sheet) => sheet.style.clipPath);
  const middle = await cut();
  await page.mouse.move(box.x + box.width / 2, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 200, box.y + 60, { steps: 3 });
  await page.mouse.up();
  assert.notEqual(await cut(), middle);
});

test('reads pixel values under the cursor, and flips by number', async () => {
  await page.keyboard.press('2');
  assert.deepEqual(await page.$$eval('.frame', (frames) => frames.map((f) => f.dataset.name)), ['bright']);
  const box = await page.locator('.frame').boundingBox();
  const step = (await scales())[0];
  await page.mouse.move(box.x + 1.5 * step, box.y + 2.5 * step);
  assert.match(await page.textContent('.pixel'), /pixel 1, 2.*bright111.*truth111/s);
  await page.mouse.move(box.x + 3.5 * step, box.y + 2.5 * step);
  assert.match(await page.textContent('.pixel'), /dark0\.250\.250\.25-50 %bright0\.750\.750\.7550 %/s);
});

test('says under each picture what is under the cursor', async () => {
  const frame = page.locator('.frame').first();
  const box = await frame.boundingBox();
  const step = (await scales())[0];
  await page.mouse.move(box.x + 3.5 * step, box.y + 2.5 * step);
  const readings = await page.$$eval('.reading', (all) => all.map((r) => r.textContent));
  assert.deepEqual(readings, ['3, 2: 0.25  0.25  0.25 (-50 %)', '3, 2: 0.75  0.75  0.75 (+50 %)', '3, 2: 0.5  0.5  0.5']);
});

test('fits every view into the window', async () => {
  for (const mode of ['side by side', 'split', 'flip']) {
    await page.getByRole('button', { name: mode, exact: true }).click();
    const frame = await page.locator('.frame').first().boundingBox();
    const controls = await page.locator('.controls').boundingBox();
    const caption = await page.locator('figcaption').first().boundingBox();
    assert.ok(controls.height + frame.height + caption.height <= 1000, `${mode}: ${frame.height}`);
    assert.ok(Math.abs(frame.width - frame.height) < 1, `${mode}: the whole image is seen`);
    assert.ok(Math.abs((await scales())[0] * kSize - frame.width) < 1, `${mode}: it fills its frame`);
  }
});

test('explains names and shows tables that stand before the images', async () => {
  assert.match(await page.textContent('.overview'), /against a.*b7 ×/s);
  const text = page.getByText('a method');
  assert.equal(await text.isVisible(), false);
  await page.getByText('what the names mean').click();
  assert.equal(await text.isVisible(), true);
});

test('plots curves with their slopes', async () => {
  assert.match(await page.textContent('.plot'), /a \(slope -1\.00\)/);
  assert.match(await page.textContent('.tables:not(.overview)'), /a1\.25/);
  assert.deepEqual(problems, []);
});

test('begins with the verdicts of an experiment', async () => {
  const verdicts = [{ place: 'greys', winner: 'dark', text: 'least error. bright 2 ×.' }];
  const images = report.groups[0].images.map((image) => ({
    ...image,
    metrics: image.metrics && { ...image.metrics, psnr: 20, psnr_error: 0.5 },
  }));
  await write({ ...report, verdicts, groups: [{ ...report.groups[0], images }] });
  await page.goto(pathToFileURL(file).href);
  assert.equal(await page.textContent('.summary'), 'greys: dark: least error. bright 2 ×.');
  assert.match(await page.textContent('.metrics'), /20\.00 ± 0\.50/);
  await write(report);
  assert.deepEqual(problems, []);
});
