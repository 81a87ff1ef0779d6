// The drive's fault memory, in its own words.

import { by, make, number, span } from "./dom.js";

const COLUMNS = ["When", "What", "While", "Speed", "DC link", "i_d", "i_q"];

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
        make("td", { title: `${fault.time.toFixed(3)} s after it was switched on` }, `${span(Math.max(0, (this.now ?? fault.time) - fault.time))} ago`),
        make("td", {}, make("strong", {}, fault.cause), make("div", { class: "hint" }, fault.remedy)),
        make("td", {}, fault.state),
        make("td", { class: "figure" }, `${number(fault.speed, 0)} rpm`),
        make("td", { class: "figure" }, `${number(fault.link_voltage, 0)} V`),
        make("td", { class: "figure" }, `${number(fault.current_d, 2)} A`),
        make("td", { class: "figure" }, `${number(fault.current_q, 2)} A`),
      ),
    );
    const head = make("tr", {}, ...COLUMNS.map((title, at) => make("th", { class: at > 2 ? "figure" : "" }, title)));
    by("history").replaceChildren(make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows)));
  }
}
