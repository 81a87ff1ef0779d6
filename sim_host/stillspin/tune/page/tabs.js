// The tabs, also by the arrow keys.

import { by } from "./dom.js";

const STEP = { ArrowRight: 1, ArrowLeft: -1 };

export function tabs() {
  const buttons = [...document.querySelectorAll("[role=tab]")];
  const show = (chosen) => {
    for (const button of buttons) {
      button.setAttribute("aria-selected", button === chosen);
      button.tabIndex = button === chosen ? 0 : -1;
      by(button.dataset.tab).hidden = button !== chosen;
    }
  };
  buttons.forEach((button) => {
    const panel = by(button.dataset.tab);
    button.id = `tab-${button.dataset.tab}`;
    button.setAttribute("aria-controls", panel.id);
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", button.id);
    button.onclick = () => show(button);
    button.onkeydown = ({ key }) => {
      if (!STEP[key]) return;
      const shown = buttons.filter((other) => !other.hidden);
      const next = shown[(shown.indexOf(button) + STEP[key] + shown.length) % shown.length];
      next.focus();
      show(next);
    };
  });
  show(buttons[0]);
}
