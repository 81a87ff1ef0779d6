// The drive's fault memory, in its own words.

import { by, make, quantity, span } from "./dom.js";

const FIGURES = [["Speed", "speed", "rpm"], ["DC link", "link_voltage", "V"], ["i_d", "current_d", "A"], ["i_q", "current_q", "A"]];
const COLUMNS = ["When", "What", "While", ...FIGURES.map(([title]) => title)];

export class Faults {
  constructor(link, fail) {
    this.link = link;
    this.fail = fail;
    this.last = "";
    link.on(["hello", "again"], () => this.refresh());
    link.on("status", (status) => this.notice(status));
  }

  notice(status) {
    this.now = status.time;
    if (status.fault !== this.last) {
      this.last = status.fault;
      this.refresh();
    }
  }

  async refresh() {
    try {
      this.show(await this.link.ask("faults"));
    } catch (error) {
      this.fail(error);
    }
  }

  show(faults) {
    if (!faults.length) {
      by("history").replaceChildren(make("p", { class: "calm" }, "No fault since the drive was switched on."));
      return;
    }
    const rows = faults.map((fault) =>
      make(
        "tr",
        {},
        make("td", { "data-title": "When", title: `${fault.time.toFixed(3)} s after it was switched on` }, `${span(Math.max(0, (this.now ?? fault.time) - fault.time))} ago`),
        make("td", {}, make("strong", {}, fault.cause), make("div", { class: "hint" }, fault.remedy)),
        make("td", { "data-title": "While" }, fault.state),
        ...FIGURES.map(([title, key, unit]) => make("td", { class: "figure", "data-title": title }, quantity(fault[key], unit))),
      ),
    );
    const head = make("tr", {}, ...COLUMNS.map((title, at) => make("th", { class: at > 2 ? "figure" : "" }, title)));
    by("history").replaceChildren(make("table", { class: "stack" }, make("thead", {}, head), make("tbody", {}, ...rows)));
  }
}
