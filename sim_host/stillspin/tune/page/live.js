// Live signals: a rolling window, one panel for each unit.

import { by, make, told } from "./dom.js";
import { panels } from "./plot.js";

const MOST = 8;
const KEPT = 90; // s

export class Live {
  constructor(link, fail) {
    this.link = link;
    this.fail = fail;
    this.frozen = false;
    this.dirty = false;
    link.on("hello", (hello) => this.choices(hello));
    link.on("again", ({ plotted }) => plotted.join() !== this.names.join() && this.choose());
    link.on("unknown", () => this.age());
    link.on("plotted", ({ signals }) => this.begin(signals));
    link.on("samples", (message) => this.add(message));
    by("freeze").onclick = () => this.freeze();
    by("window").onchange = () => this.time && this.draw(); // frozen or idle, too
    const draw = () => {
      if (this.dirty && !this.frozen && !by("live").hidden) this.draw();
      requestAnimationFrame(draw);
    };
    draw();
  }

  choices({ signals, derived, plotted, words }) {
    this.table = [...signals, ...derived];
    this.words = words;
    this.names = null;
    by("signals").replaceChildren(
      ...this.table.map(({ name, unit, meaning }) => {
        const box = make("input", { type: "checkbox", value: name });
        box.onchange = () => this.choose();
        return make("label", { class: "check", title: meaning }, box, ` ${name} `, make("em", {}, unit));
      }),
    );
    this.begin(plotted);
  }

  get boxes() {
    return [...by("signals").querySelectorAll("input")];
  }

  choose() {
    const names = this.boxes.filter((box) => box.checked).map((box) => box.value);
    this.mark(names);
    if (!names.length) return;
    this.link.ask("plot", { signals: names }).catch((error) => {
      this.mark(this.names);
      this.fail(error);
    });
  }

  mark(names) {
    for (const box of this.boxes) {
      box.checked = names.includes(box.value);
      box.disabled = !box.checked && names.length >= MOST;
    }
  }

  /** Old values are no values. */
  age() {
    for (const panel of this.panels ?? []) for (const value of panel.values) value.textContent = "–";
    this.dirty = false;
  }

  begin(names) {
    if (this.names?.join() === names.join()) return;
    this.names = names;
    this.mark(names);
    this.forget();
    const signals = names.map((name) => this.table.find((signal) => signal.name === name));
    this.panels = panels(by("plots"), signals, make);
  }

  forget() {
    this.time = [];
    this.values = this.names.map(() => []);
  }

  add({ time, values, lost }) {
    if (!this.panels || values.length !== this.values.length) return;
    if (time[0] < this.time[this.time.length - 1]) this.forget(); // the drive was switched off and on
    this.time.push(...time);
    values.forEach((column, at) => this.values[at].push(...column));
    const old = this.time.findIndex((at) => at > this.time[this.time.length - 1] - KEPT);
    if (old > 500) {
      this.time.splice(0, old);
      for (const column of this.values) column.splice(0, old);
    }
    by("stream-lost").textContent = lost;
    this.dirty = true;
  }

  freeze() {
    this.frozen = !this.frozen;
    by("freeze").textContent = this.frozen ? "Go on" : "Freeze";
  }

  draw() {
    this.dirty = false;
    const last = this.time.length - 1;
    if (last < 0) return;
    const now = this.time[last];
    const from = -Number(by("window").value);
    const first = Math.max(0, this.time.findIndex((time) => time - now >= from) - 1);
    const x = this.time.slice(first).map((time) => time - now);
    for (const panel of this.panels) {
      const series = panel.members.map(({ name, at, colour }) => ({ name, colour, x, y: this.values[at].slice(first) }));
      panel.plot.show({ from, to: 0, series, unit: panel.unit, timeUnit: "s", words: this.words });
      panel.members.forEach((signal, place) => {
        panel.values[place].textContent = told(this.values[signal.at][last], signal, this.words);
      });
    }
  }
}
