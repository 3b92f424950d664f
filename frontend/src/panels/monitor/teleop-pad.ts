import { h } from "../../dom";
import type { TeleopState } from "../../state/monitor/teleop";
import { motionOfKey, NO_MOTION, sumMotions, type Motion } from "../../state/monitor/teleop-keys";
import { strings } from "../../strings";

/** The factor by which a key changes the speeds. */
const SPEED_FACTOR = 1.1;
/** The distance of the knob from the center at full deflection, as a share of the pad's side. */
const KNOB_RANGE = 0.42;
/** Smaller deflections count as none: pressing the middle must not move the robot yet. */
const DEAD_ZONE = 0.06;

/** The square for driving: up is forward, left turns to the left. Keys drive while it has the focus. */
export class TeleopPad {
  readonly element: HTMLElement;
  private readonly knob = h("div", { class: "pad-knob" });
  private readonly heldKeys = new Map<string, Motion>();
  private pointer: number | null = null;

  constructor(private readonly state: TeleopState) {
    const texts = strings.monitor.teleop;
    this.element = h(
      "div",
      { class: "pad", tabIndex: 0, role: "application", title: texts.keys, aria: { label: texts.pad } },
      h("div", { class: "pad-cross" }),
      this.knob,
    );
    const { element } = this;
    element.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    element.addEventListener("pointermove", (event) => this.onPointerMove(event));
    for (const endEvent of ["pointerup", "pointercancel", "lostpointercapture"]) {
      element.addEventListener(endEvent, () => this.onPointerUp());
    }
    element.addEventListener("keydown", (event) => this.onKeyDown(event));
    element.addEventListener("keyup", (event) => {
      if (this.heldKeys.delete(event.code)) this.updateKeyMotion();
    });
    // Losing the focus must stop the robot.
    element.addEventListener("blur", () => this.release());
    window.addEventListener("blur", () => this.release());
    window.addEventListener("pagehide", () => this.release());
    document.addEventListener("visibilitychange", () => {
      if (document.hidden) this.release();
    });
    state.changed.on(() => this.show());
    this.show();
  }

  release(): void {
    this.heldKeys.clear();
    this.pointer = null;
    this.state.stop();
  }

  private show(): void {
    const { x, turn, y } = this.state.motion;
    const sideways = turn !== 0 ? turn : y;
    this.knob.style.left = `${50 - 100 * KNOB_RANGE * sideways}%`;
    this.knob.style.top = `${50 - 100 * KNOB_RANGE * x}%`;
    this.element.classList.toggle("driving", x !== 0 || sideways !== 0);
  }

  private onPointerDown(event: PointerEvent): void {
    if (event.button !== 0 || this.pointer !== null) return;
    this.element.focus();
    this.element.setPointerCapture(event.pointerId);
    this.pointer = event.pointerId;
    this.onPointerMove(event);
    event.preventDefault();
  }

  private onPointerMove(event: PointerEvent): void {
    if (event.pointerId !== this.pointer) return;
    const padRect = this.element.getBoundingClientRect();
    const deflectionAt = (value: number, start: number, length: number): number =>
      Math.min(1, Math.max(-1, (0.5 - (value - start) / length) / KNOB_RANGE));
    const forward = deflectionAt(event.clientY, padRect.top, padRect.height);
    const left = deflectionAt(event.clientX, padRect.left, padRect.width);
    const motion = { ...NO_MOTION, x: applyDeadZone(forward), [event.shiftKey ? "y" : "turn"]: applyDeadZone(left) };
    this.state.move("pad", motion);
  }

  private onPointerUp(): void {
    if (this.pointer === null) return;
    this.pointer = null;
    this.state.move("pad", NO_MOTION);
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const motion = motionOfKey(event.key, event.shiftKey);
    if (motion) {
      if (!event.repeat) {
        this.heldKeys.set(event.code, motion);
        this.updateKeyMotion();
      }
    } else if (event.key === " " || event.key === "k" || event.key === "K") this.release();
    else if (event.key === "q" || event.key === "Q") this.scaleSpeeds(SPEED_FACTOR);
    else if (event.key === "z" || event.key === "Z") this.scaleSpeeds(1 / SPEED_FACTOR);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private updateKeyMotion(): void {
    this.state.move("keys", sumMotions(this.heldKeys.values()));
  }

  private scaleSpeeds(factor: number): void {
    const { linear, angular } = this.state.settings;
    const scaleSpeed = (value: number): number => Number((value * factor).toPrecision(3));
    this.state.configure({ linear: scaleSpeed(linear), angular: scaleSpeed(angular) });
  }
}

function applyDeadZone(value: number): number {
  return Math.abs(value) < DEAD_ZONE ? 0 : value;
}
