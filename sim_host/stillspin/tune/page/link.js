// The connection to the server: questions with answers, and what the drive says unasked.

export class Link {
  constructor() {
    this.waiting = new Map();
    this.listeners = new Map();
    this.next = 1;
    this.socket = null;
  }

  open() {
    this.socket = new WebSocket(`ws://${location.host}/live`);
    this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
    this.socket.onclose = () => {
      for (const { reject } of this.waiting.values()) reject(new Error("the server has ended"));
      this.waiting.clear();
      this.emit("closed", {});
    };
  }

  take(message) {
    if (message.t !== "reply") {
      this.emit(message.t, message);
      return;
    }
    const pending = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (!pending) return;
    if (message.error) pending.reject(new Error(message.error));
    else pending.resolve(message.result);
  }

  on(kind, listener) {
    this.listeners.set(kind, [...(this.listeners.get(kind) ?? []), listener]);
  }

  emit(kind, message) {
    for (const listener of this.listeners.get(kind) ?? []) listener(message);
  }

  say(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Asks the server; rejects with words. */
  ask(what, given = {}) {
    if (this.socket?.readyState !== WebSocket.OPEN) return Promise.reject(new Error("the server has ended"));
    const id = this.next++;
    this.say({ t: "ask", id, what, given });
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }
}
