// Views of images that zoom and pan together.
import { select } from 'd3-selection';
import { zoom, zoomIdentity } from 'd3-zoom';
import { element } from './dom.js';

/** Canvases of one size whose views share a zoom. Call `show` with what to draw. */
export class Panels {
  /**
   * @param {{width: number, height: number}} size  of all images
   * @param {(x: number, y: number) => void} onPixel  the pixel under the cursor
   */
  constructor({ width, height }, onPixel) {
    this.width = width;
    this.height = height;
    this.onPixel = onPixel;
    this.transform = undefined; // none yet: fit
    this.views = [];
    this.root = element('div', { class: 'panels' });
    new ResizeObserver(() => this.fit()).observe(this.root);
  }

  /**
   * One view for each stack of layers; the upper layer of a stack of two is cut at a line that can be dragged.
   * @param {{caption: Node|string, name: string, paint: (data: Uint8ClampedArray) => void}[][]} stacks
   */
  show(stacks) {
    this.root.replaceChildren();
    this.root.style.setProperty('--columns', stacks.length === 4 ? 2 : Math.min(stacks.length, 3));
    this.views = stacks.map((layers) => this.makeView(layers));
    this.root.append(...this.views.map((view) => view.figure));
    this.repaint();
    this.place();
  }

  makeView(layers) {
    const canvases = layers.map(() => element('canvas', { width: this.width, height: this.height }));
    const sheets = canvases.map((canvas) => element('div', { class: 'sheet' }, canvas));
    const frame = element('div', { class: 'frame' }, ...sheets);
    frame.style.aspectRatio = `${this.width} / ${this.height}`;
    frame.style.setProperty('--aspect', this.width / this.height);
    const readings = layers.map(() => element('span', { class: 'reading' }));
    const caption = element(
      'figcaption',
      {},
      ...layers.map((layer, i) => element('span', { class: 'layer' }, element('span', {}, layer.caption), readings[i])),
    );
    const view = { figure: element('figure', {}, frame, caption), frame, canvases, layers, readings };
    frame.dataset.name = layers.map((layer) => layer.name).join(' | ');
    frame.addEventListener('pointermove', (event) => this.point(frame, event));
    if (layers.length === 2) this.addDivider(frame, sheets[1]);

    view.zoom = zoom()
      .filter((event) => !event.target.closest?.('.divider') && (!event.ctrlKey || event.type === 'wheel'))
      .on('zoom', (event) => {
        if (!event.sourceEvent) return;
        this.transform = event.transform;
        this.place(view);
      });
    select(frame).call(view.zoom).on('dblclick.zoom', () => this.fit(true));
    return view;
  }

  addDivider(frame, upper) {
    const divider = element('div', { class: 'divider', role: 'separator', 'aria-label': 'split' });
    const cut = (share) => {
      divider.style.left = `${100 * share}%`;
      upper.style.clipPath = `inset(0 0 0 ${100 * share}%)`;
    };
    cut(0.5);
    divider.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      divider.setPointerCapture(event.pointerId);
    });
    divider.addEventListener('pointermove', (event) => {
      if (!divider.hasPointerCapture(event.pointerId)) return;
      const box = frame.getBoundingClientRect();
      cut(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
    });
    frame.append(divider);
  }

  repaint() {
    for (const view of this.views)
      view.layers.forEach((layer, i) => {
        const context = view.canvases[i].getContext('2d');
        const image = context.createImageData(this.width, this.height);
        layer.paint(image.data);
        context.putImageData(image, 0, 0);
      });
  }

  /** Says under each picture what is under the cursor. @param {(name: string) => string} text */
  read(text) {
    for (const view of this.views)
      view.layers.forEach((layer, i) => {
        view.readings[i].textContent = text(layer.name);
      });
  }

  /** The whole image in every view, after a resize only where nobody has zoomed. */
  fit(always = false) {
    if (this.zoomed() && !always) return;
    this.transform = undefined;
    this.place();
  }

  zoomed() {
    return this.transform !== undefined;
  }

  /** Moves all views to the common transform; that which it came from has it already. */
  place(origin) {
    for (const view of this.views) {
      const whole = this.wholeScale(view.frame);
      view.zoom.scaleExtent([whole / 4, Math.max(64, 8 * whole)]);
      const transform = this.transform ?? zoomIdentity.scale(whole);
      if (view !== origin) select(view.frame).call(view.zoom.transform, transform);
      for (const canvas of view.canvases)
        canvas.style.transform = `translate(${transform.x}px, ${transform.y}px) scale(${transform.k})`;
      view.frame.dataset.scale = transform.k;
    }
  }

  /** At which a frame shows the whole image. */
  wholeScale(frame) {
    return frame.clientWidth / this.width || 1;
  }

  point(frame, event) {
    const box = frame.getBoundingClientRect();
    const transform = this.transform ?? zoomIdentity.scale(this.wholeScale(frame));
    const [x, y] = transform.invert([event.clientX - box.left, event.clientY - box.top]).map(Math.floor);
    if (x >= 0 && y >= 0 && x < this.width && y < this.height) this.onPixel(x, y);
  }
}
