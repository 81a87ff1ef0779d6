// The connection to the server: questions with answers, what the drive says unasked, and coming back by itself.

const AGAIN = 1000; // ms

export class Link {
  constructor() {
    this.waiting = new Map();
    this.listeners = new Map();
    this.next = 1;
    this.socket = null;
    this.retry = 0;
    this.heard = 0; // when the server said something, ms
    this.table = null; // of the drive that was connected last
  }

  get open() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Connects now, and again whenever the connection has ended. */
  connect() {
    clearTimeout(this.retry);
    if (this.socket) this.socket.onclose = null;
    this.socket?.close();
    this.socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
    this.socket.onclose = () => this.closed();
  }

  async closed() {
    for (const { reject } of this.waiting.values()) reject(new Error("the server has ended"));
    this.waiting.clear();
    this.retry = setTimeout(() => this.connect(), AGAIN);
    const answer = await fetch("/", { method: "HEAD" }).catch(() => null);
    if (!this.open) this.emit("closed", { refused: answer?.status === 403 });
  }

  take(message) {
    this.heard = performance.now();
    if (message.t === "reply") this.reply(message);
    else if (message.t === "hello" && message.crc === this.table) this.emit("again", message);
    else this.emit(message.t, message);
    if (message.t === "hello") this.table = message.crc;
  }

  reply(message) {
    const pending = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (!pending) return;
    if (message.error) pending.reject(new Error(message.error));
    else pending.resolve(message.result);
  }

  on(kind, listener) {
    for (const one of [kind].flat()) this.listeners.set(one, [...(this.listeners.get(one) ?? []), listener]);
  }

  emit(kind, message) {
    for (const listener of this.listeners.get(kind) ?? []) listener(message);
  }

  say(message) {
    if (this.open) this.socket.send(JSON.stringify(message));
  }

  /** Asks the server; rejects with words. */
  ask(what, given = {}) {
    if (!this.open) return Promise.reject(new Error("the server has ended"));
    const id = this.next++;
    this.say({ t: "ask", id, what, given });
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }
}
