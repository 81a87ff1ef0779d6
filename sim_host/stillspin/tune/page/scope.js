// The captured scope: set-up, waiting for the trigger, the picture, a file.

import { by, counted, make } from "./dom.js";
import { panels } from "./plot.js";

const CHANNELS = 4;
const PERIOD = 1e-4; // s, of the control interrupt
const FIRST = ["speed", "current_d", "current_q", ""];
const EDGES = {
  now: "at once",
  rising: "it rises through",
  falling: "it falls through",
  either: "it crosses",
  above: "it is at or above",
  below: "it is below",
};

export class Scope {
  constructor(link, fail) {
    this.link = link;
    this.fail = fail;
    this.capture = null;
    link.on("hello", (hello) => this.build(hello));
    link.on("scope", ({ text, armed }) => this.follow(text, armed));
    by("setup").onsubmit = (event) => event.preventDefault();
    by("capture").onclick = () => this.run();
    by("capture-stop").onclick = () => link.ask("scope_stop").catch(fail);
    by("download").onclick = () => this.download();
  }

  build({ signals, edges, depth, words }) {
    this.depth = depth;
    this.words = words;
    this.signals = signals;
    const names = signals.map((signal) => signal.name);
    const options = (list, chosen) => list.map((name) => make("option", { value: name, selected: name === chosen }, name || "–"));
    this.channels = FIRST.slice(0, CHANNELS).map((name, at) =>
      make("select", { "aria-label": `Channel ${at + 1}`, "data-channel": at }, ...options(["", ...names], name)),
    );
    this.trigger = make("select", { id: "trigger" }, ...options(names, "speed"));
    this.edge = make(
      "select",
      { id: "edge" },
      ...edges.map((edge) => make("option", { value: edge, selected: edge === "rising" }, EDGES[edge] ?? edge)),
    );
    this.level = make("input", { id: "level", type: "text", inputMode: "decimal", value: 100 });
    this.unit = make("em");
    this.decimation = make("input", { id: "decimation", type: "text", inputMode: "numeric", value: 4 });
    this.before = make("input", { id: "before", type: "text", inputMode: "decimal", value: 25 });
    this.length = make("span", { class: "hint" });
    const field = (text, ...parts) => make("label", { class: "field" }, text, make("span", { class: "with-unit" }, ...parts));
    by("setup").replaceChildren(
      ...this.channels.map((select, at) => field(`Channel ${at + 1}`, select)),
      field("Trigger on", this.trigger),
      field("When", this.edge),
      field("Level", this.level, this.unit),
      field("A record every", this.decimation, make("em", {}, "× 0.1 ms")),
      field("Before the trigger", this.before, make("em", {}, "%")),
      this.length,
    );
    by("setup").onchange = () => this.explain();
    this.explain();
  }

  explain() {
    const chosen = this.signals.find((signal) => signal.name === this.trigger.value);
    this.unit.textContent = chosen?.unit ?? "";
    const now = this.edge.value === "now";
    this.level.disabled = this.trigger.disabled = now;
    const seconds = this.depth * PERIOD * Number(this.decimation.value);
    const span = Number.isFinite(seconds) ? `, ${Number((seconds * 1e3).toPrecision(4))} ms` : "";
    this.length.textContent = `${counted(this.depth, "record")}${span}`;
  }

  async run() {
    const names = [...new Set(this.channels.map((select) => select.value).filter(Boolean))];
    const given = {
      signals: names,
      trigger: this.trigger.value,
      level: this.level.value,
      edge: this.edge.value,
      decimation: this.decimation.value,
      before: this.before.value,
    };
    const on = this.edge.value === "now" ? "" : `${this.trigger.value}: ${EDGES[this.edge.value]} ${this.level.value} ${this.unit.textContent}`;
    this.waits = on && `waits for ${on.trim()}`;
    this.busy(true, "preparing");
    try {
      this.capture = await this.link.ask("capture", given);
      this.show();
    } catch (error) {
      this.busy(false, "");
      this.fail(error);
    }
  }

  follow(text, armed) {
    if (!by("capture").disabled) return;
    by("scope-note").textContent = armed && this.waits ? `${text}, ${this.waits}` : text;
    by("scope-note").classList.toggle("armed", armed);
  }

  busy(on, words) {
    by("capture").disabled = on;
    by("capture-stop").disabled = !on;
    by("scope-note").textContent = words;
    by("scope-note").classList.remove("armed");
  }

  show() {
    const { time, signals, units, clipped, interval } = this.capture;
    const beyond = clipped.length ? `; beyond full scale: ${clipped.join(", ")}` : "";
    this.busy(false, `${counted(time.length, "record")} every ${Number((interval * 1e3).toPrecision(4))} ms${beyond}`);
    by("download").disabled = false;
    const list = Object.keys(signals).map((name) => ({ name, unit: units[name] }));
    const x = time.map((seconds) => seconds * 1e3);
    const built = panels(by("captured"), list, make);
    for (const panel of built) {
      const series = panel.members.map(({ name, colour }) => ({ name, colour, x, y: signals[name] }));
      panel.plot.show({ from: x[0], to: x[x.length - 1], mark: 0, series, unit: panel.unit, timeUnit: "ms", words: this.words });
    }
    by("captured").append(make("p", { class: "hint" }, "Time in ms from the trigger."));
  }

  download() {
    const { time, signals, units, head: about } = this.capture;
    const names = Object.keys(signals);
    const head = ["time [s]", ...names.map((name) => (units[name] ? `${name} [${units[name]}]` : name))];
    const rows = time.map((seconds, at) => [seconds.toFixed(6), ...names.map((name) => signals[name][at])].join(","));
    const file = new Blob([`${about}${head.join(",")}\n${rows.join("\n")}\n`], { type: "text/csv" });
    const anchor = make("a", { href: URL.createObjectURL(file), download: "capture.csv" });
    anchor.click();
    URL.revokeObjectURL(anchor.href);
  }
}
