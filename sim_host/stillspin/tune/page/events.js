// What has happened while this page was open, with the time of day; the newest also as a note that goes away.

import { by, make } from "./dom.js";

const MOST = 100;
const SHOWN = 8000; // ms

export class Events {
  constructor() {
    this.hiding = 0;
    this.fault = "";
    by("note-close").onclick = () => (by("note").hidden = true);
  }

  follow(link) {
    link.on("note", ({ text }) => this.note(text));
    link.on("status", ({ fault, remedy }) => {
      if (fault && fault !== this.fault) this.add(remedy ? `fault: ${fault}; ${remedy}` : `fault: ${fault}`);
      this.fault = fault;
    });
  }

  /** Says it now and keeps it. */
  note(text) {
    if (!text) return;
    by("note-words").textContent = text;
    by("note").hidden = false;
    clearTimeout(this.hiding);
    this.hiding = setTimeout(() => (by("note").hidden = true), SHOWN);
    this.add(text);
  }

  /** Keeps it. */
  add(text) {
    const list = by("events");
    const at = new Date().toLocaleTimeString([], { hour12: false });
    list.prepend(make("li", {}, make("time", {}, at), ` ${text}`));
    while (list.children.length > MOST) list.lastChild.remove();
    by("no-events").hidden = true;
  }
}
