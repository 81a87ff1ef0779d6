// The wizard, in four steps: the motor's nameplate, what to see to, measuring, what was found.

import { by, make, number, span, withUnit } from "./dom.js";
import { Nameplate } from "./nameplate.js";

const [RUNNING, DONE, PARTLY, ABORTED] = [1, 2, 3, 4];

export class Commissioning {
  constructor(link, run, parameters, fail) {
    Object.assign(this, { link, run, parameters, fail, outcome: 0, phase: null });
    this.plate = new Nameplate(link, parameters, fail);
    link.on("hello", (hello) => this.begin(hello));
    link.on("status", (status) => this.follow(status));
  }

  begin({ parameters, values }) {
    this.table = parameters;
    this.values = values;
    this.nameplate();
  }

  async nameplate() {
    const content = await this.plate.ask(() => this.prepare()).catch(() => null);
    if (content) this.steps(0, ...content);
    else this.prepare();
  }

  steps(active, ...content) {
    const titles = ["Motor", "Before", "Measuring", "Result"];
    const list = make("ol", { class: "steps" }, ...titles.map((title, at) => make("li", { class: at === active ? "now" : "" }, title)));
    by("wizard").replaceChildren(list, ...content);
  }

  prepare() {
    const spin = this.table.find((parameter) => parameter.name === "spin_speed");
    const speed = spin ? ` It turns at up to ${number(this.value("spin_speed"), 0)} ${spin.unit}.` : "";
    const boxes = [
      "The shaft is free to turn, nothing is coupled to it, nobody can touch it.",
      "The drive has this motor's nameplate.",
      "I can switch the power off by hand.",
    ].map((text) => make("label", { class: "check" }, make("input", { type: "checkbox" }), ` ${text}`));
    const start = make("button", { id: "commission", disabled: true, onclick: () => this.start() }, "Measure");
    const look = () => (start.disabled = !boxes.every((label) => label.firstChild.checked));
    for (const box of boxes) box.onchange = look;
    this.steps(1,
      make("p", {}, `The drive measures machine and inverter by itself, in about a minute and a half.${speed} `,
        "The motor runs only while this page is open and in front."),
      make("div", { class: "list" }, ...boxes),
      make("div", { class: "bar" }, start, make("button", { class: "plain", onclick: () => this.nameplate() }, "Back to the motor")),
    );
  }

  value(name) {
    return this.parameters.rows?.get(name)?.value ?? this.values[name];
  }

  start() {
    by("keep").checked = true;
    this.bar = make("progress", { max: 1, value: 0 });
    this.words = make("p", { class: "calm" }, "starting");
    this.left = make("p", { class: "calm", id: "time-left" });
    this.begun = null;
    this.phase = null;
    this.steps(2, this.words, this.bar, this.left,
      make("div", { class: "bar" }, make("button", { id: "abort", onclick: () => this.run.stop("stop") }, "Stop measuring")));
    this.measuring = true;
    this.run.hold("commission");
  }

  async follow({ commissioning, fault, time }) {
    const before = this.outcome;
    this.outcome = commissioning.outcome;
    if (this.measuring && commissioning.outcome === RUNNING) this.progress(commissioning, time);
    if (before !== RUNNING || commissioning.outcome === RUNNING || !this.measuring) return;
    this.measuring = false;
    by("keep").checked = false;
    if ([DONE, PARTLY].includes(commissioning.outcome)) await this.result(commissioning.outcome);
    else if (commissioning.outcome === ABORTED) this.broken("It was stopped; the parameters are as before.");
    else this.broken(fault ? `It ended in a fault: ${fault}` : "The drive was switched off meanwhile: nothing was measured.");
  }

  async progress({ progress, phase }, time) {
    this.bar.value = progress;
    this.begun ??= { time, progress, seen: progress };
    const [took, done] = [time - this.begun.time, progress - this.begun.progress];
    if (progress > this.begun.seen) this.end = time + (took / done) * (1 - progress); // and counts down until it is better known
    this.begun.seen = progress;
    this.left.textContent = done > 0.03 ? `about ${span(Math.max(0, this.end - time))} left` : "";
    if (phase === this.phase) return;
    this.phase = phase;
    const words = await this.link.ask("phase", { phase }).catch(() => "");
    this.words.textContent = words;
  }

  broken(words) {
    this.steps(3, make("p", {}, words), make("div", { class: "bar" }, make("button", { onclick: () => this.prepare() }, "Measure again")));
  }

  async result(outcome) {
    const values = await this.link.ask("results").catch(() => []);
    const rows = values.map((value) => {
      const decimals = (this.table.find((parameter) => parameter.name === value.name)?.decimals ?? 2) + 1;
      const show = (figure) => withUnit(number(figure, decimals), value.unit);
      return make("tr", { class: value.used ? "" : "refused" }, make("td", {}, value.name), make("td", { class: "figure", "data-title": "Before" }, show(value.before)),
        make("td", { class: "figure", "data-title": "Found" }, show(value.value)), make("td", {}, value.words));
    });
    const head = make("tr", {}, ...["Parameter", "Before", "Found", ""].map((title, at) => make("th", { class: at === 1 || at === 2 ? "figure" : "" }, title)));
    const words = outcome === DONE ? "Every value is plausible and in use." : "Some values are not plausible; those keep their old value.";
    this.steps(3, make("p", {}, `${words} They are kept when they are saved.`),
      make("table", { class: "stack" }, make("thead", {}, head), make("tbody", {}, ...rows)),
      make("div", { class: "bar" }, make("button", { id: "keep-results", onclick: () => this.parameters.save() }, "Save in the drive"),
        make("button", { class: "plain", onclick: () => this.prepare() }, "Measure again")));
    this.parameters.refresh().catch(this.fail);
  }
}
