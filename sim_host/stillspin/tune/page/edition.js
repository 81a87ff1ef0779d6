// What the drive's edition leaves out has no panel: a line says so.

import { by } from "./dom.js";

export function showEdition({ edition, left_out: leftOut }) {
  for (const element of document.querySelectorAll("[data-part]")) element.hidden = leftOut.includes(element.dataset.part);
  by("edition").hidden = !leftOut.length;
  by("edition").textContent = `Edition ${edition} of the firmware leaves out: ${leftOut.join(", ")}.`;
  const tab = document.querySelector("[role=tab][aria-selected=true]");
  if (tab.hidden) document.querySelector("[role=tab]").click();
}
