// Bundles the viewer into one HTML file. Usage: node build.mjs [OUT.html]. The program puts a report's data in the place
// of the marker.
import { readFile, writeFile, mkdir } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? `${here}/dist/viewer.html`);

const bundle = await build({
  entryPoints: [`${here}/src/main.js`],
  bundle: true,
  minify: true,
  write: false,
  outdir: 'unused',
  format: 'iife',
  target: 'es2022',
  legalComments: 'inline',
});
const text = (extension) => bundle.outputFiles.find((file) => file.path.endsWith(extension)).text;
const page = (await readFile(`${here}/src/page.html`, 'utf8'))
  .replace('/* style */', () => text('.css'))
  .replace('/* script */', () => text('.js').replaceAll('</script', '<\\/script'));
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page);
