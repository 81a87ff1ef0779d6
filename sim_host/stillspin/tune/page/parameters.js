// The parameter tree: headings, values with unit and range, errors in the drive's words.

import { by, counted, make } from "./dom.js";

/** Where a parameter's value is entered: a list of words where its numbers stand for something. */
function field({ name, choices, minimum }) {
  if (!choices.length) return make("input", { type: "text", inputMode: "decimal", spellcheck: false, "aria-label": name });
  const options = choices.map((words, at) => make("option", { value: String(minimum + at) }, `${minimum + at} ${words}`));
  return make("select", { "aria-label": name }, ...options);
}

export class Parameters {
  constructor(link, fail) {
    this.link = link;
    this.fail = fail;
    link.on("hello", (hello) => this.build(hello));
    link.on("again", ({ values }) => this.take(values));
    by("search").oninput = () => this.filter();
    by("changed").onchange = () => this.filter();
    by("save").onclick = () => this.save();
    by("load").onclick = () => by("load-file").click();
    by("load-file").onchange = () => this.load(by("load-file").files[0]);
    by("defaults").onclick = () => this.defaults();
  }

  build({ parameters, values, left_out: leftOut }) {
    this.kept = leftOut.includes("store") ? "last until the drive is switched off" : "are kept when they are saved";
    this.rows = new Map();
    const groups = [...new Set(parameters.map((parameter) => parameter.group))];
    by("tree").replaceChildren(
      ...groups.map((group) => {
        const own = parameters.filter((parameter) => parameter.group === group);
        const count = make("small");
        const rows = own.map((parameter) => this.row(parameter));
        return make("details", { open: true, class: "group" }, make("summary", {}, group, " ", count), ...rows);
      }),
    );
    this.take(values);
  }

  row(parameter) {
    const { name, unit, range, meaning, always, initial, decimals } = parameter;
    const input = field(parameter);
    if (!always) input.setAttribute("data-stopped", "");
    const error = make("div", { class: "error", hidden: true });
    const back = make("button", { class: "back", title: `Default: ${initial.toFixed(decimals)} ${unit}` }, "↺");
    back.setAttribute("aria-label", `${name} to its default`);
    if (!always) back.setAttribute("data-stopped", "");
    const title = "What one sees when it changes. Opens another tab: a motor that runs from here stops";
    const guide = make("a", { href: `/book/parameters.md#${name}`, target: "stillspin-book", title }, name);
    const element = make(
      "div",
      { class: "parameter", "data-name": name },
      make("div", { class: "name" }, guide, always ? null : make("i", { title: "Not while the motor is energised" }, " ◦")),
      make("div", { class: "value" }, input, make("em", {}, unit), back),
      make("div", { class: "range" }, range),
      make("div", { class: "meaning" }, meaning, error),
    );
    const row = { parameter, input, error, element, value: initial };
    input.onkeydown = (event) => {
      if (event.key === "Enter") this.change(row, input.value);
      if (event.key === "Escape") this.put(row, row.value);
    };
    input.onchange = () => this.change(row, input.value);
    back.onclick = () => this.change(row, String(initial));
    this.rows.set(name, row);
    return element;
  }

  take(values) {
    for (const [name, value] of Object.entries(values)) this.put(this.rows.get(name), value);
    this.filter();
  }

  put(row, value) {
    row.value = value;
    row.input.value = value.toFixed(row.parameter.decimals);
    row.error.hidden = true;
    row.element.classList.toggle("changed", value !== row.parameter.initial);
  }

  /** Changes it; words when the drive does not like it. */
  async change(row, text) {
    if (text === row.value.toFixed(row.parameter.decimals)) {
      this.put(row, row.value);
      return "";
    }
    try {
      const { value, conflict } = await this.link.ask("set", { name: row.parameter.name, value: text });
      this.put(row, value);
      this.complain(row, conflict);
      by("store-note").textContent = `Changes are in effect; they ${this.kept}.`;
      return conflict;
    } catch (error) {
      this.complain(row, error.message);
      return error.message;
    }
  }

  complain(row, words) {
    row.error.textContent = words;
    row.error.hidden = !words;
  }

  filter() {
    const word = by("search").value.trim().toLowerCase();
    for (const { element, parameter } of this.rows.values()) {
      const fits = `${parameter.name} ${parameter.meaning}`.toLowerCase().includes(word);
      element.hidden = !fits || (by("changed").checked && !element.classList.contains("changed"));
    }
    for (const group of by("tree").children) {
      const shown = [...group.querySelectorAll(".parameter")].filter((element) => !element.hidden).length;
      group.hidden = shown === 0;
      group.querySelector("small").textContent = shown;
    }
  }

  async save() {
    by("store-note").textContent = "saving …";
    try {
      by("store-note").textContent = await this.link.ask("save");
    } catch (error) {
      by("store-note").textContent = "";
      this.fail(error);
    }
  }

  /** The values of a file, as `stillspin params dump` writes it. */
  async load(file) {
    by("load-file").value = "";
    try {
      const { values, named, different, complaints } = await this.link.ask("load", { name: file.name, text: await file.text() });
      this.take(values);
      by("store-note").textContent = `${file.name} names ${counted(named, "parameter")}, of which ${different} had another value here. They ${this.kept}.`;
      if (complaints.length) this.fail(new Error(complaints.join("; ")));
    } catch (error) {
      this.fail(error);
    }
  }

  async defaults() {
    if (!confirm("Put every parameter to its default? What is saved in the drive stays until you save.")) return;
    try {
      this.take(await this.link.ask("defaults"));
    } catch (error) {
      this.fail(error);
    }
  }

  async refresh() {
    this.take(await this.link.ask("values"));
  }
}
