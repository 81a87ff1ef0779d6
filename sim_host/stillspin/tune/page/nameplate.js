// Questions as a nameplate puts them, and the parameters that follow from the answers.

import { make } from "./dom.js";

const SPEED = (1000 * 2 * Math.PI) / 60; // rad/s at 1000 rpm

export const PLATE = ["pole_pairs", "current_limit", "rated_current", "speed_limit", "stator_resistance", "inductance_d",
  "inductance_q", "magnet_flux", "inertia"];

const QUESTIONS = [
  { text: "Rated current", unit: "A rms", parameter: "rated_current", from: (answer) => answer * Math.SQRT2 },
  { text: "Voltage constant, between two wires", unit: "V rms at 1000 rpm", parameter: "magnet_flux",
    from: (answer, value) => (answer * Math.sqrt(2 / 3)) / (value("pole_pairs") * SPEED) },
  { text: "Resistance between two wires", unit: "ohm", parameter: "stator_resistance", from: (answer) => answer / 2 },
];

/** Fields for those questions: each sets its parameter, whose field shows what came of it. */
export function questions(parameters) {
  const rows = parameters.rows;
  const known = QUESTIONS.filter(({ parameter }) => rows.has(parameter) && rows.has("pole_pairs"));
  return known.map(({ text, unit, parameter, from }) => {
    const input = make("input", { type: "text", inputMode: "decimal", "aria-label": text, "data-stopped": "" });
    input.onchange = async () => {
      const row = rows.get(parameter);
      const answer = Number(input.value.replace(/^\s+|\s+$/g, "") || NaN);
      const words = Number.isFinite(answer)
        ? await parameters.change(row, from(answer, (name) => rows.get(name).value).toFixed(row.parameter.decimals))
        : `${text}: '${input.value}' is no number`;
      if (words) parameters.fail(new Error(words));
    };
    return make("tr", {}, make("td", {}, text), make("td", { class: "figure" }, input), make("td", {}, unit),
      make("td", { class: "hint" }, `sets ${parameter}`));
  });
}
