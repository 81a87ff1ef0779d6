// What is known of the drive just now. Nothing old is shown as if it were new: when no status has come for a moment, the
// state is "not known", the values are dashes, and words say who is silent and what that means for the motor.

import { by, span } from "./dom.js";

const OLD = 400; // ms since the last status; one comes every 100 ms
const WORDS_AFTER = 1000; // ms: a short gap needs no words
const LOOK = 50; // ms
const MOTOR = "A motor that was running stops by itself when the drive has heard nothing for its link_timeout.";

export class Known {
  constructor(link, events) {
    Object.assign(this, { link, events, heard: 0, now: false, cause: null, since: performance.now(), said: "" });
    link.on("status", () => this.fresh());
    link.on("silent", ({ text }) => this.away({ text }));
    link.on("lost", ({ text }) => this.away({ gone: true, text: `${text}. Looking for it …` }));
    link.on("closed", ({ refused }) => this.away({ gone: true, closed: true, refused }));
    by("again").onclick = () => this.retry();
    setInterval(() => this.look(), LOOK);
  }

  fresh() {
    this.heard = performance.now();
    this.cause = null;
    if (!this.now) this.change(true);
  }

  away(cause) {
    this.cause = cause;
    if (cause.gone && this.now) this.change(false);
    this.look();
  }

  look() {
    const now = performance.now();
    if (this.now && now - this.heard > OLD) this.change(false);
    const away = now - Math.max(this.heard, this.since);
    by("lost").hidden = this.now || (away < WORDS_AFTER && !this.cause);
    if (!by("lost").hidden) this.tell(away, now);
  }

  change(now) {
    this.now = now;
    document.body.classList.toggle("unknown", !now);
    if (now) {
      by("lost").hidden = true;
      if (this.said) this.events.add(`known again after ${span((performance.now() - this.since) / 1000)}`);
      this.said = "";
      return;
    }
    this.since = this.heard || performance.now();
    this.link.emit("unknown", {});
  }

  tell(away, now) {
    const words = this.words(now);
    const since = this.heard ? ` Nothing has been known for ${span(away / 1000)}. ${MOTOR}` : "";
    by("lost-words").textContent = words + since;
    by("again").hidden = Boolean(this.cause?.refused);
    if (words === this.said) return;
    this.said = words;
    this.events.add(words);
  }

  words(now) {
    if (this.cause?.refused) return "The server was restarted: open the address that it has printed; then this page comes back, too.";
    if (this.cause?.closed || !this.link.open) return "The server has ended. Start stillspin tune again; this page looks for it every second.";
    if (now - this.link.heard > OLD + 200) return "The server does not answer: it, or its computer, has stalled.";
    return this.cause ? this.cause.text[0].toUpperCase() + this.cause.text.slice(1) : "The drive does not answer.";
  }

  retry() {
    if (this.link.open && performance.now() - this.link.heard < WORDS_AFTER) this.link.ask("look_again").catch(() => {});
    else this.link.connect();
  }
}
