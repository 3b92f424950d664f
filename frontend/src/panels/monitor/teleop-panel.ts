import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { TwistKind } from "../../protocol";
import { formatValue } from "../../state/monitor/field-text";
import type { TeleopState } from "../../state/monitor/teleop";
import { strings } from "../../strings";
import { createSelect, createNumberField, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { TeleopGamepad } from "./teleop-gamepad";
import { TeleopPad } from "./teleop-pad";

const RATES = [10, 15, 20];
const FASTEST = 1000;

/** Drives a robot by keyboard, touch or gamepad. */
export class TeleopPanel implements Panel {
  readonly id = "teleop";
  readonly icon = "teleop";
  readonly element: HTMLElement;
  private readonly pad: TeleopPad;
  private readonly gamepad: TeleopGamepad;
  private readonly aim = h("div", { class: "teleop-aim", aria: { live: "polite" } });
  private readonly velocity = h("output", { class: "teleop-velocity numeric" });
  /** Both texts are laid out and one is visible, so that a click on the pad does not move the pad. */
  private readonly focus = {
    active: h("span", {}, strings.monitor.teleop.active),
    inactive: h("span", {}, strings.monitor.teleop.inactive),
  };
  private readonly gamepadName = h("span", { class: "note" });
  private readonly limits: Record<"linear" | "angular", HTMLInputElement>;
  private readonly topic = h("input", { class: "field", aria: { label: strings.monitor.teleop.topic } });
  private kind!: HTMLSelectElement;
  private isVisible = false;

  constructor(private readonly state: TeleopState) {
    const texts = strings.monitor.teleop;
    const { settings } = state;
    this.pad = new TeleopPad(state);
    this.gamepad = new TeleopGamepad(state, (name) => (this.gamepadName.textContent = name ?? texts.noGamepad));
    this.limits = {
      linear: createNumberField(texts.linearHint, settings.linear, [0, FASTEST], (linear) => state.configure({ linear })),
      angular: createNumberField(texts.angularHint, settings.angular, [0, FASTEST], (angular) => state.configure({ angular })),
    };
    const stop = button(texts.stopHint, () => this.pad.release(), "tool stop", icon("stop"), texts.stop);
    const focus = h("div", { class: "note teleop-focus" }, this.focus.active, this.focus.inactive);
    const side = h("div", { class: "teleop-side" }, this.velocity, stop, focus);
    this.element = h(
      "div",
      { class: "panel monitor" },
      h(
        "div",
        { class: "scroll teleop" },
        h("div", { class: "teleop-main" }, this.pad.element, side),
        h("p", { class: "note" }, texts.keys),
        this.aim,
        this.createForm(),
      ),
    );
    for (const event of ["focus", "blur"]) this.pad.element.addEventListener(event, () => this.showFocus());
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => {
      this.isVisible = isVisible;
      if (!isVisible) this.pad.release();
      state.setOpen(isVisible);
      this.gamepad.run(isVisible && state.settings.gamepad);
    });
    this.show();
    this.showFocus();
  }

  private createForm(): HTMLElement {
    const texts = strings.monitor.teleop;
    const { settings } = this.state;
    const { topic } = this;
    const frame = h("input", { class: "field", title: texts.frameHint, aria: { label: texts.frameHint } });
    frame.value = settings.frameId;
    topic.addEventListener("change", () => this.state.configure({ topic: topic.value.trim() }));
    frame.addEventListener("change", () => this.state.configure({ frameId: frame.value.trim() }));
    const kinds = (["auto", "Twist", "TwistStamped"] as const).map((kind) => [kind, texts.types[kind]] as const);
    this.kind = createSelect<TwistKind>(texts.type, kinds, (kind) => this.state.configure({ kind }));
    const rates = RATES.map((rate) => [String(rate), texts.hertz(rate)] as const);
    const rate = createSelect(texts.rateHint, rates, (rateText) => this.state.configure({ rate: Number(rateText) }));
    rate.value = String(settings.rate);
    const gamepad = createTickBox(texts.gamepad, texts.gamepadHint, (isTicked) => {
      this.state.configure({ gamepad: isTicked });
      this.gamepad.run(isTicked && this.isVisible);
      if (!isTicked) this.gamepadName.textContent = "";
    });
    gamepad.box.checked = settings.gamepad;
    const createRow = (text: string, ...parts: readonly (HTMLElement | string)[]): HTMLElement =>
      h("label", { class: "teleop-row" }, h("span", { class: "toolbar-label" }, text), h("span", {}, ...parts));
    return h(
      "div",
      { class: "teleop-form" },
      createRow(texts.linear, this.limits.linear, h("span", { class: "unit" }, texts.linearUnit)),
      createRow(texts.angular, this.limits.angular, h("span", { class: "unit" }, texts.angularUnit)),
      createRow(texts.topic, topic),
      createRow(texts.type, this.kind),
      createRow(texts.frame, frame),
      createRow(texts.rate, rate),
      h("div", { class: "teleop-row" }, gamepad, this.gamepadName),
    );
  }

  private show(): void {
    const texts = strings.monitor.teleop;
    const { aim, settings, motion } = this.state;
    const { linear, angular } = settings;
    if (document.activeElement !== this.limits.linear) this.limits.linear.value = String(linear);
    if (document.activeElement !== this.limits.angular) this.limits.angular.value = String(angular);
    if (document.activeElement !== this.topic) this.topic.value = settings.topic;
    this.kind.value = settings.kind;
    this.aim.textContent = aim === null ? "" : (aim.error ?? `${aim.topic}: ${texts.listeners(aim.subscribers, aim.kind)}`);
    this.aim.classList.toggle("wrong", (aim?.error ?? null) !== null);
    const parts = [`${formatValue(motion.x * linear)} m/s`];
    if (motion.y !== 0) parts.push(`y ${formatValue(motion.y * linear)} m/s`);
    if (motion.z !== 0) parts.push(`z ${formatValue(motion.z * linear)} m/s`);
    this.velocity.replaceChildren(...[...parts, `${formatValue(motion.turn * angular)} rad/s`].map((text) => h("div", {}, text)));
  }

  private showFocus(): void {
    const hasFocus = document.activeElement === this.pad.element;
    this.focus.active.classList.toggle("unseen", !hasFocus);
    this.focus.inactive.classList.toggle("unseen", hasFocus);
  }
}
