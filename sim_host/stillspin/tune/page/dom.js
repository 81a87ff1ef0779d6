// Small helpers for the page.

export const by = (id) => document.getElementById(id);

/** An element: make("p", {class: "x", onclick: f}, "text", child, …). */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "class") element.className = value;
    else if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key.startsWith("data-") || key.startsWith("aria-") || key === "role") element.setAttribute(key, value);
    else element[key] = value;
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** A number for people: four digits, a real minus sign; a dash for one that is not known. */
export function number(value, decimals = null) {
  if (value === null) return "–";
  const text = decimals === null ? String(Number(value.toPrecision(4))) : value.toFixed(decimals);
  return text.replace("-", "−");
}

/** A number of things: 1 sample, 2 samples. */
export function counted(number, what) {
  return `${number} ${what}${number === 1 ? "" : "s"}`;
}

/** Seconds in words that a person says. */
export function span(seconds) {
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

const DECIMALS = { rpm: 1, A: 2, V: 1, "N m": 2, W: 0, "%": 1, turn: 3, "°C": 1 };

/** A value that comes again and again: always with as many decimals, so that nothing jumps. */
export function quantity(value, unit) {
  return value === null ? "–" : withUnit(number(value, DECIMALS[unit] ?? null), unit);
}

export const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);

/** What a signal's value stands for, in words; undefined where it is a quantity. */
export function meant(value, name, words = {}) {
  const list = words[name];
  if (name === "limit" && list) return list.filter((_, bit) => (value >> bit) & 1).join(", ") || "nothing";
  return list?.[value];
}

/** A signal's value for people. */
export function told(value, { name, unit }, words) {
  if (value === null) return "–"; // not known
  return meant(value, name, words) ?? quantity(value, unit);
}
