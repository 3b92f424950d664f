import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TwistKind } from "../../protocol";
import { formatValue } from "../../state/monitor/field-text";
import type { TeleopState } from "../../state/monitor/teleop";
import { strings } from "../../strings";
import { createSelect, createNumberField, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { TeleopGamepad } from "./teleop-gamepad";
import { TeleopPad } from "./teleop-pad";

const RATES_HZ = [10, 15, 20];
const MAX_VELOCITY = 1000;

/** Drives a robot by keyboard, touch or gamepad. */
export class TeleopPanel implements Panel {
  readonly id = "teleop";
  readonly icon = "teleop";
  readonly element: HTMLElement;
  private readonly pad: TeleopPad;
  private readonly gamepad: TeleopGamepad;
  private readonly aimText = h("div", { class: "teleop-aim", aria: { live: "polite" } });
  private readonly velocity = h("output", { class: "teleop-velocity numeric" });
  /** Both texts are laid out and one is visible, so that a click on the pad does not move the pad. */
  private readonly focusTexts = {
    active: h("span", {}, strings.monitor.teleop.active),
    inactive: h("span", {}, strings.monitor.teleop.inactive),
  };
  private readonly gamepadName = h("span", { class: "note" });
  private readonly limitFields: Record<"linear" | "angular", HTMLInputElement>;
  private readonly topicField = h("input", { class: "field", aria: { label: strings.monitor.teleop.topic } });
  private kind!: HTMLSelectElement;
  private isVisible = false;

  constructor(private readonly state: TeleopState) {
    const texts = strings.monitor.teleop;
    const { settings } = state;
    this.pad = new TeleopPad(state);
    this.gamepad = new TeleopGamepad(state, (name) => (this.gamepadName.textContent = name ?? texts.noGamepad));
    this.limitFields = {
      linear: createNumberField(texts.linearHint, settings.linear, [0, MAX_VELOCITY], (linear) => state.configure({ linear })),
      angular: createNumberField(texts.angularHint, settings.angular, [0, MAX_VELOCITY], (angular) => state.configure({ angular })),
    };
    const stop = createButton(texts.stopHint, () => this.pad.release(), "tool stop", createIcon("stop"), texts.stop);
    const focus = h("div", { class: "note teleop-focus" }, this.focusTexts.active, this.focusTexts.inactive);
    const sideColumn = h("div", { class: "teleop-side" }, this.velocity, stop, focus);
    this.element = h(
      "div",
      { class: "panel monitor" },
      h(
        "div",
        { class: "scroll teleop" },
        h("div", { class: "teleop-main" }, this.pad.element, sideColumn),
        h("p", { class: "note" }, texts.keys),
        this.aimText,
        this.createForm(),
      ),
    );
    for (const event of ["focus", "blur"]) this.pad.element.addEventListener(event, () => this.showFocus());
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => {
      this.isVisible = isVisible;
      if (!isVisible) this.pad.release();
      state.setOpen(isVisible);
      this.gamepad.setRunning(isVisible && state.settings.gamepad);
    });
    this.show();
    this.showFocus();
  }

  private createForm(): HTMLElement {
    const texts = strings.monitor.teleop;
    const { settings } = this.state;
    const { topicField } = this;
    const frameField = h("input", { class: "field", title: texts.frameHint, aria: { label: texts.frameHint } });
    frameField.value = settings.frameId;
    topicField.addEventListener("change", () => this.state.configure({ topic: topicField.value.trim() }));
    frameField.addEventListener("change", () => this.state.configure({ frameId: frameField.value.trim() }));
    const kinds = (["auto", "Twist", "TwistStamped"] as const).map((kind) => [kind, texts.types[kind]] as const);
    this.kind = createSelect<TwistKind>(texts.type, kinds, (kind) => this.state.configure({ kind }));
    const rates = RATES_HZ.map((rateSelect) => [String(rateSelect), texts.hertz(rateSelect)] as const);
    const rateSelect = createSelect(texts.rateHint, rates, (rateText) => this.state.configure({ rate: Number(rateText) }));
    rateSelect.value = String(settings.rate);
    const gamepadBox = createTickBox(texts.gamepad, texts.gamepadHint, (isTicked) => {
      this.state.configure({ gamepad: isTicked });
      this.gamepad.setRunning(isTicked && this.isVisible);
      if (!isTicked) this.gamepadName.textContent = "";
    });
    gamepadBox.box.checked = settings.gamepad;
    const createRow = (text: string, ...parts: readonly (HTMLElement | string)[]): HTMLElement =>
      h("label", { class: "teleop-row" }, h("span", { class: "toolbar-label" }, text), h("span", {}, ...parts));
    return h(
      "div",
      { class: "teleop-form" },
      createRow(texts.linear, this.limitFields.linear, h("span", { class: "unit" }, texts.linearUnit)),
      createRow(texts.angular, this.limitFields.angular, h("span", { class: "unit" }, texts.angularUnit)),
      createRow(texts.topic, topicField),
      createRow(texts.type, this.kind),
      createRow(texts.frame, frameField),
      createRow(texts.rate, rateSelect),
      h("div", { class: "teleop-row" }, gamepadBox, this.gamepadName),
    );
  }

  private show(): void {
    const texts = strings.monitor.teleop;
    const { aim, settings, motion } = this.state;
    const { linear, angular } = settings;
    if (document.activeElement !== this.limitFields.linear) this.limitFields.linear.value = String(linear);
    if (document.activeElement !== this.limitFields.angular) this.limitFields.angular.value = String(angular);
    if (document.activeElement !== this.topicField) this.topicField.value = settings.topic;
    this.kind.value = settings.kind;
    this.aimText.textContent = aim === null ? "" : (aim.error ?? `${aim.topic}: ${texts.listeners(aim.subscribers, aim.kind)}`);
    this.aimText.classList.toggle("wrong", (aim?.error ?? null) !== null);
    const parts = [`${formatValue(motion.x * linear)} m/s`];
    if (motion.y !== 0) parts.push(`y ${formatValue(motion.y * linear)} m/s`);
    if (motion.z !== 0) parts.push(`z ${formatValue(motion.z * linear)} m/s`);
    this.velocity.replaceChildren(...[...parts, `${formatValue(motion.turn * angular)} rad/s`].map((text) => h("div", {}, text)));
  }

  private showFocus(): void {
    const hasFocus = document.activeElement === this.pad.element;
    this.focusTexts.active.classList.toggle("unseen", !hasFocus);
    this.focusTexts.inactive.classList.toggle("unseen", hasFocus);
  }
}
