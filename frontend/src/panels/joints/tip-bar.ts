import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { Session } from "../../state/session";
import { strings } from "../../strings";

/** Returns the switch for dragging the selected link. Further controls are loaded when it is first turned on. */
export function createTipBar(session: Session): HTMLElement {
  const texts = strings.description.tip;
  const { tipSwitch } = session;
  const button = createButton(texts.hint, () => (tipSwitch.isOn = !tipSwitch.isOn), "tool", createIcon("axes"), texts.switch);
  const row = h("div", { class: "bar-row" }, h("span", { class: "bar-label", title: texts.hint }, texts.label), button);
  const element = h("div", { class: "joint-bar tip", role: "group", aria: { label: texts.label } }, row);
  let hasControls = false;
  const show = (): void => {
    button.classList.toggle("on", tipSwitch.isOn);
    button.setAttribute("aria-pressed", String(tipSwitch.isOn));
    const { drag } = tipSwitch;
    if (!drag || hasControls) return;
    hasControls = true;
    void import("./tip-controls").then(({ TipControls }) => {
      const controls = new TipControls(drag, session.selection);
      row.append(controls.baseSelect);
      element.append(controls.steps, controls.notice);
    });
  };
  tipSwitch.changed.on(show);
  show();
  return element;
}
