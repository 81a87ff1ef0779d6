// Running the motor: only while somebody holds it.
//
// "Hold" is the button, the space bar, or, with the box ticked, the page itself as long as it is in front. While it
// lasts the page says so ten times a second; the server stops the motor when it does not hear that.

import { by, number, span } from "./dom.js";

const BEAT = 100; // ms
const STAYS = 500; // ms
const PATIENCE = 500; // ms, between the answer to a start and the first status with the motor energised
const [READY, FAULT] = [2, 6];

export class Run {
  constructor(link, events) {
    this.link = link;
    this.events = events;
    this.fail = (error) => events.note(error.message);
    this.status = null;
    this.beat = null;
    link.on(["hello", "again"], (hello) => this.limits(hello));
    link.on("status", (status) => this.show(status));
    link.on("closed", () => this.release());
    link.on("unknown", () => this.unknown());
    this.buttons();
    this.keys();
    document.addEventListener("visibilitychange", () => document.hidden && this.release());
    window.addEventListener("pagehide", () => this.release());
    window.addEventListener("blur", () => !by("keep").checked && this.release());
  }

  get held() {
    return this.beat !== null;
  }

  limits({ parameters, values }) {
    const limit = values.speed_limit ?? 3000;
    by("slider").min = -limit;
    by("slider").max = limit;
  }

  buttons() {
    const hold = by("hold");
    hold.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || hold.disabled) return;
      if (by("keep").checked) return this.held ? this.release() : this.start();
      hold.setPointerCapture(event.pointerId);
      this.start();
    });
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) {
      hold.addEventListener(kind, () => !by("keep").checked && this.release());
    }
    hold.addEventListener("contextmenu", (event) => event.preventDefault());
    by("stop").onclick = () => this.stop("stop");
    by("look").onclick = () => this.look();
    by("coast").onclick = () => this.stop("coast");
    by("reset").onclick = () => this.clear();
    by("keep").onchange = () => this.release();
    by("reference").onchange = () => this.refer(by("reference").value);
    by("slider").oninput = () => this.refer(by("slider").value);
  }

  keys() {
    const typing = (event) => event.target.closest("input:not([type=range]):not([type=checkbox]), select, textarea");
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.stop("stop");
      if (event.key !== " " || typing(event)) return;
      event.preventDefault();
      if (!event.repeat && !this.held && this.ready) this.start();
    });
    document.addEventListener("keyup", (event) => {
      if (event.key !== " " || typing(event)) return;
      event.preventDefault();
      if (!by("keep").checked) this.release();
    });
  }

  get ready() {
    return this.status?.number === READY;
  }

  start() {
    this.hold("start", { speed: by("reference").value });
  }

  /** Asks for something that runs the motor, and holds it. */
  hold(what, given = {}) {
    if (this.held || document.hidden) return;
    this.asked = what;
    this.energised = false;
    this.begun = 0;
    this.beat = setInterval(() => this.link.say({ t: "hold" }), BEAT);
    if (this.status) by("hold").textContent = this.offer(this.status);
    document.body.classList.add("held");
    this.link
      .ask(what, given)
      .then(() => (this.begun = Date.now()))
      .catch((error) => {
        this.release();
        this.fail(error);
      });
  }

  release() {
    if (!this.held) return;
    this.letGo();
    this.link.say({ t: "release" });
  }

  letGo() {
    clearInterval(this.beat);
    this.beat = null;
    document.body.classList.remove("held");
  }

  stop(how) {
    if (this.held) this.letGo();
    this.link.ask(how).catch(this.fail);
  }

  refer(speed) {
    by("reference").value = speed;
    by("slider").value = speed;
    this.wanted = speed;
    if (this.referring) return;
    this.referring = this.link
      .ask("ref", { speed })
      .then(() => by("reference").classList.remove("refused"))
      .catch((error) => {
        by("reference").classList.add("refused");
        this.fail(error);
      })
      .finally(() => {
        this.referring = null;
        if (this.wanted !== speed) this.refer(this.wanted);
      });
  }

  /** It has stopped by itself, or never began. */
  ended({ fault, unheard }) {
    this.release();
    if (fault || (this.asked === "commission" && !unheard)) return; // said in the banner, or by the commissioning
    this.events.note(
      unheard
        ? "The drive has stopped the motor by itself: it heard nothing for its link_timeout."
        : "The motor has stopped, and not by this page.",
    );
  }

  /** Whether the shaft turns, by two short pulses. */
  async look() {
    by("look").disabled = true;
    try {
      this.events.note(await this.link.ask("look"));
    } catch (error) {
      this.fail(error);
    }
    by("look").disabled = false;
  }

  async clear() {
    try {
      await this.link.ask("reset");
      setTimeout(() => this.status?.fault && this.events.note(`Still there: ${this.status.fault}. ${this.status.remedy}`), STAYS);
    } catch (error) {
      this.fail(error);
    }
  }

  /** Nothing is known: nothing is shown as if it were. */
  unknown() {
    this.status = null;
    by("state").textContent = "not known";
    by("state").className = "pill unknown";
    for (const id of ["speed", "now-reference", "limits", "now-fault", "store", "time"]) by(id).textContent = "–";
    by("fault").hidden = by("shaft").hidden = true;
    by("hold").disabled = !this.held;
    if (this.held) by("hold").textContent = "Not known whether it runs";
    for (const element of document.querySelectorAll("[data-stopped]")) element.disabled = true;
  }

  /** What the button does, behind what the drive says of the motor: before it begins, only that it was asked to. */
  offer({ energised, state }) {
    const keep = by("keep").checked;
    if (!this.held) return keep ? "Start" : "Hold to run";
    const doing = energised ? state[0].toUpperCase() + state.slice(1) : "Asked to start";
    return `${doing}: ${keep ? "press" : "let go"} to stop`;
  }

  show(status) {
    this.status = status;
    this.energised ||= status.energised;
    const over = this.begun && !status.energised && (this.energised || Date.now() - this.begun > PATIENCE);
    if (this.held && over) this.ended(status);
    const state = by("state");
    state.textContent = status.state;
    state.className = `pill ${status.number === FAULT ? "bad" : status.energised ? "on" : ""}`;
    by("speed").textContent = number(status.speed, 1);
    by("now-reference").textContent = status.reference === null ? "–" : `${number(status.reference, 1)} rpm`;
    by("limits").textContent = status.limits.join(", ") || "nothing";
    by("store").textContent = [status.store, status.unsaved].filter(Boolean).join("; ");
    by("time").textContent = span(status.time);
    by("time").dataset.seconds = status.time;
    by("now-fault").textContent = status.fault || "no fault";
    by("shaft").hidden = status.speed_known;
    by("fault").hidden = !status.fault;
    by("fault-words").textContent = status.remedy ? `${status.fault}:` : status.fault;
    by("fault-remedy").textContent = status.remedy;
    by("hold").disabled = !(this.held || this.ready);
    by("hold").textContent = this.offer(status);
    for (const element of document.querySelectorAll("[data-stopped]")) element.disabled = status.energised;
  }
}
