// The motor's nameplate: ten questions, what will work with the answers, the parameters that follow. The server calculates.

import { counted, make, number, withUnit } from "./dom.js";

export class Nameplate {
  constructor(link, parameters, fail) {
    Object.assign(this, { link, parameters, fail, inputs: new Map() });
  }

  /** What to show; `next` is called when the drive has the motor. Null for a drive that lacks the parameters. */
  async ask(next) {
    const questions = await this.link.ask("plate");
    if (!questions.length) return null;
    this.found = make("div", { id: "plate-found" });
    const check = make("button", { id: "plate-check", onclick: () => this.check(check, next) }, "Check");
    return [
      make("p", {}, "What the nameplate and the data sheet say. The fields show what the drive has now; what is not known may be rough: resistance, inductances and inertia are measured afterwards."),
      make("div", { class: "grid plate" }, ...questions.map((question) => this.field(question))),
      make("div", { class: "bar" }, check, make("button", { id: "plate-skip", class: "plain", onclick: next }, "The drive has this motor: go on")),
      this.found,
    ];
  }

  field({ key, text, unit, known }) {
    const input = make("input", { type: "text", inputMode: "decimal", value: known, "data-key": key });
    input.oninput = () => this.found.replaceChildren(); // what was found is of other answers
    this.inputs.set(key, input);
    return make("label", { class: "field" }, text, make("span", { class: "with-unit" }, input, make("em", {}, unit)));
  }

  get answers() {
    return Object.fromEntries([...this.inputs].map(([key, input]) => [key, input.value]));
  }

  async check(button, next) {
    const answers = this.answers;
    button.disabled = true;
    this.found.replaceChildren(make("p", { class: "calm" }, "Looking at it, and trying a start of a virtual drive …"));
    try {
      this.tell(await this.link.ask("plate_check", answers), answers, next);
    } catch (error) {
      this.found.replaceChildren(make("p", { class: "error" }, error.message));
    }
    button.disabled = false;
  }

  tell({ findings, missing, changes }, answers, next) {
    const wrong = findings.filter(({ works }) => !works).length;
    const row = ({ works, title, words }) =>
      make("li", { class: works ? "works" : "wrong" }, make("strong", {}, works ? "works" : "will not work"), make("span", {}, `${title}: ${words}`));
    const use = make("button", { id: "plate-use", "data-stopped": "", onclick: () => this.use(answers, next) }, wrong ? "Set in the drive all the same" : "Set in the drive");
    this.found.replaceChildren(
      make("h2", {}, wrong ? `${wrong} of ${findings.length} will not work` : `No problem found in ${counted(findings.length, "check")}`),
      make("ul", { class: "findings" }, ...findings.map(row), missing ? make("li", {}, make("strong", {}, "not looked at"), make("span", {}, missing)) : null),
      changes.length ? this.changes(changes) : make("p", { class: "calm" }, "The drive has these values already."),
      make("div", { class: "bar" }, changes.length ? use : make("button", { id: "plate-use", onclick: next }, "Go on")),
    );
  }

  changes(changes) {
    const head = make("tr", {}, ...["Parameter", "Now", "Then"].map((title, at) => make("th", { class: at ? "figure" : "" }, title)));
    const rows = changes.map(({ name, unit, decimals, now, then }) =>
      make("tr", {}, make("td", {}, name), ...[now, then].map((value) => make("td", { class: "figure" }, withUnit(number(value, decimals), unit)))));
    return make("table", { class: "narrow" }, make("thead", {}, head), make("tbody", {}, ...rows));
  }

  async use(answers, next) {
    try {
      const { values, complaints } = await this.link.ask("plate_use", answers);
      this.parameters.take(values);
      if (complaints.length) this.found.prepend(make("p", { class: "error" }, complaints.join("; ")));
      else next();
    } catch (error) {
      this.fail(error);
    }
  }
}
