// The page: joins the parts.

import { Commissioning } from "./commissioning.js";
import { by } from "./dom.js";
import { Faults } from "./faults.js";
import { Link } from "./link.js";
import { Live } from "./live.js";
import { Parameters } from "./parameters.js";
import { Run } from "./run.js";
import { Scope } from "./scope.js";

history.replaceState(null, "", location.pathname); // the token does not stay in the address line

let hiding = 0;
function note(text) {
  if (!text) return;
  by("note").textContent = text;
  by("note").hidden = false;
  clearTimeout(hiding);
  hiding = setTimeout(() => (by("note").hidden = true), 8000);
}

function lost(text) {
  by("lost").textContent = `${text}. Start stillspin tune again when it is back.`;
  by("lost").hidden = false;
  by("state").textContent = "no connection";
  by("state").className = "pill bad";
}

function tabs() {
  const buttons = [...document.querySelectorAll("[role=tab]")];
  for (const button of buttons) {
    button.onclick = () => {
      for (const other of buttons) {
        other.setAttribute("aria-selected", other === button);
        by(other.dataset.tab).hidden = other !== button;
      }
    };
  }
}

const fail = (error) => note(error.message);
const link = new Link();
link.on("hello", ({ version, where }) => (by("where").textContent = `${version} · ${where}`));
link.on("note", ({ text }) => note(text));
link.on("lost", ({ text }) => lost(text));
link.on("closed", () => by("lost").hidden && lost("The server has ended"));

tabs();
const run = new Run(link, fail);
const parameters = new Parameters(link, fail);
new Live(link);
new Scope(link, fail);
new Faults(link, fail);
new Commissioning(link, run, parameters, fail);
link.open();
