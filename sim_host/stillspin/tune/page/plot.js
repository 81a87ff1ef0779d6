// Lines over time on a canvas: axes with round numbers, a reading under the pointer, a mark at zero.

import { meant } from "./dom.js";

const MARGIN = { left: 62, right: 26, top: 20, bottom: 22 };

/** Up to `count` round numbers in low … high. */
export function ticks(low, high, count) {
  const span = high - low;
  if (!(span > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(span / count));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => span / size <= count);
  const found = [];
  for (let at = Math.ceil(low / step - 1e-9); at * step <= high + step * 1e-9; at++) found.push(at * step);
  return found;
}

/** A range around values with some air, never empty. */
export function padded(low, high) {
  if (!Number.isFinite(low) || (low === 0 && high === 0)) return [-1, 1];
  const air = Math.max((high - low) * 0.08, Math.abs(high) * 1e-3, 1e-3);
  return [low - air, high + air];
}

const short = (value) => value === null ? "–" : String(Number(value.toPrecision(6))).replace("-", "−");

export class Plot {
  /** content.series: [{name, x, y, colour}] with colour a CSS variable's name; content.words: see meant(). */
  constructor(canvas) {
    this.canvas = canvas;
    this.pointer = null;
    this.content = null;
    canvas.addEventListener("pointermove", (event) => this.point(event.offsetX));
    canvas.addEventListener("pointerleave", () => this.point(null));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  point(x) {
    this.pointer = x;
    this.draw();
  }

  show(content) {
    this.content = content;
    this.draw();
  }

  colour(name) {
    return getComputedStyle(this.canvas).getPropertyValue(name).trim();
  }

  draw() {
    const { canvas, content } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!content || !height || !width) return;
    const scale = window.devicePixelRatio || 1;
    canvas.width = width * scale;
    canvas.height = height * scale;
    const pen = canvas.getContext("2d");
    pen.scale(scale, scale);
    pen.font = "11px system-ui, sans-serif";
    const [low, high] = this.range(content);
    const x = (value) =>
      MARGIN.left + ((value - content.from) / (content.to - content.from)) * (width - MARGIN.left - MARGIN.right);
    const y = (value) => MARGIN.top + ((high - value) / (high - low)) * (height - MARGIN.top - MARGIN.bottom);
    this.axes(pen, content, [low, high], x, y, width, height);
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN.left, 0, width - MARGIN.left - MARGIN.right, height - MARGIN.bottom + 1);
    pen.clip();
    for (const line of content.series) this.line(pen, line, content, x, y);
    pen.restore();
    if (content.series.every(({ y }) => y.every((value) => value === null))) this.say(pen, "not known", width / 2, height / 2);
    this.read(pen, content, x, y, width, height);
  }

  say(pen, words, x, y) {
    pen.fillStyle = this.colour("--quiet");
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    pen.font = "13px system-ui, sans-serif";
    pen.fillText(words, x, y - 6);
  }

  range(content) {
    let [low, high] = [Infinity, -Infinity];
    for (const { x, y } of content.series) {
      for (let at = 0; at < y.length; at++) {
        if (x[at] < content.from || y[at] === null) continue;
        if (y[at] < low) low = y[at];
        if (y[at] > high) high = y[at];
      }
    }
    return padded(low, high);
  }

  axes(pen, content, [low, high], x, y, width, height) {
    pen.strokeStyle = this.colour("--grid");
    pen.fillStyle = this.colour("--quiet");
    pen.lineWidth = 1;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const value of ticks(low, high, Math.max(2, Math.floor(height / 32)))) {
      this.stroke(pen, MARGIN.left, y(value), width - MARGIN.right, y(value));
      pen.fillText(short(value), MARGIN.left - 6, y(value));
    }
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (const value of ticks(content.from, content.to, Math.max(2, Math.floor(width / 90)))) {
      this.stroke(pen, x(value), MARGIN.top, x(value), height - MARGIN.bottom);
      pen.fillText(short(value), x(value), height - MARGIN.bottom + 6);
    }
    pen.textAlign = "left";
    pen.fillText(content.timeUnit, width - MARGIN.right + 8, height - MARGIN.bottom + 6);
    pen.textAlign = "right";
    pen.fillText(content.unit || "(number)", MARGIN.left - 6, 2);
    if (content.mark === undefined) return;
    pen.strokeStyle = this.colour("--quiet");
    this.stroke(pen, x(content.mark), MARGIN.top, x(content.mark), height - MARGIN.bottom);
  }

  stroke(pen, x0, y0, x1, y1) {
    pen.beginPath();
    pen.moveTo(Math.round(x0) + 0.5, Math.round(y0) + 0.5);
    pen.lineTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
    pen.stroke();
  }

  line(pen, { x: times, y: values, colour }, content, x, y) {
    pen.strokeStyle = this.colour(colour);
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    pen.beginPath();
    let lifted = true; // what is not known leaves a gap
    for (let at = 0; at < values.length; at++) {
      if (values[at] !== null) pen[lifted ? "moveTo" : "lineTo"](x(times[at]), y(values[at]));
      lifted = values[at] === null;
    }
    pen.stroke();
  }

  /** The values under the pointer. */
  read(pen, content, x, y, width, height) {
    if (this.pointer === null || this.pointer < MARGIN.left) return;
    const part = (this.pointer - MARGIN.left) / (width - MARGIN.left - MARGIN.right);
    const time = content.from + part * (content.to - content.from);
    pen.strokeStyle = this.colour("--quiet");
    this.stroke(pen, this.pointer, MARGIN.top, this.pointer, height - MARGIN.bottom);
    pen.textBaseline = "top";
    pen.textAlign = part > 0.6 ? "right" : "left";
    let row = MARGIN.top;
    for (const line of content.series) {
      const at = nearest(line.x, time);
      if (at < 0) continue;
      pen.fillStyle = this.colour("--ink");
      const value = line.y[at];
      const reading = (value !== null && meant(value, line.name, content.words)) || `${short(value)} ${content.unit}`;
      pen.fillText(`${line.name} ${reading}`, this.pointer + (part > 0.6 ? -8 : 8), row);
      row += 14;
    }
  }
}

function nearest(times, time) {
  let [low, high] = [0, times.length - 1];
  if (high < 0) return -1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low > 0 && time - times[low - 1] < times[low] - time ? low - 1 : low;
}

const COLOURS = 8;
const colours = new Map(); // of each signal that was plotted: the same in every plot, as far as they reach

function colourOf(name, taken) {
  const free = (at) => !taken.has(at);
  const all = [...Array(COLOURS).keys()];
  const used = new Set(colours.values());
  const own = colours.get(name);
  const at = own !== undefined && free(own) ? own : (all.find((at) => free(at) && !used.has(at)) ?? all.find(free) ?? 0);
  if (own === undefined) colours.set(name, at);
  taken.add(at);
  return `--line-${at + 1}`;
}

/** Panels that share a time axis, one for each unit, in `home`. Signals: [{name, unit}]. */
export function panels(home, signals, make) {
  const units = [...new Set(signals.map((signal) => signal.unit))];
  home.replaceChildren();
  const taken = new Set();
  const members = signals.map((signal, at) => ({ ...signal, at, colour: colourOf(signal.name, taken) }));
  return units.map((unit) => {
    const own = members.filter((signal) => signal.unit === unit);
    const values = own.map((signal) => {
      const key = make("i", { class: "key" });
      key.style.background = `var(${signal.colour})`;
      const value = make("b", { "data-value": signal.name });
      return { value, item: make("span", { class: "legend" }, key, `${signal.name} `, value) };
    });
    const canvas = make("canvas", { role: "img", "aria-label": `${own.map(({ name }) => name).join(", ")} over time` });
    const head = make("div", { class: "legends" }, ...values.map(({ item }) => item));
    home.append(make("div", { class: "panel" }, head, canvas));
    return { unit, members: own, values: values.map(({ value }) => value), plot: new Plot(canvas) };
  });
}
