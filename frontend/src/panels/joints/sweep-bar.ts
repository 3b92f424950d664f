import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { JointsState } from "../../state/joints";
import { Sweep, type SweepOrder } from "../../state/sweep";
import { strings } from "../../strings";

const SPEEDS = [0.25, 0.5, 1, 2, 4] as const;
/** The longest step of the sweep: a page that was suspended continues where it was. */
const LONGEST_STEP_S = 0.1;

/** Moves the joints through their ranges until the user stops it or the joints change. */
export class SweepBar {
  readonly element: HTMLElement;
  private readonly order = h("select", { class: "choice" });
  private readonly speed = h("select", { class: "choice" });
  private readonly start: HTMLButtonElement;
  private sweep: Sweep | null = null;
  private seconds = 0;
  private lastMs = 0;
  private sent: Readonly<Record<string, number>> = {};

  constructor(private readonly joints: JointsState) {
    const texts = strings.description.sweep;
    fill(this.order, texts.order, [
      ["one", texts.one],
      ["all", texts.all],
    ]);
    fill(this.speed, texts.speed, SPEEDS.map((speed) => [String(speed), `${speed}×`]));
    this.speed.value = "1";
    this.order.addEventListener("change", () => this.sweep && this.begin());
    this.start = button(texts.start, () => (this.sweep ? this.end() : this.begin()), "tool bare", icon("play"));
    const row = h(
      "div",
      { class: "bar-row" },
      h("span", { class: "bar-label", title: texts.hint }, texts.label),
      this.order,
      this.speed,
      h("span", { class: "bar-buttons" }, dragSwitch(joints), this.start),
    );
    this.element = h("div", { class: "joint-bar sweep", role: "group", aria: { label: texts.label } }, row);
    joints.controlsChanged.on(() => this.end());
  }

  private begin(): void {
    this.sweep = new Sweep(this.joints.controls ?? [], this.joints.positions, this.order.value as SweepOrder);
    this.seconds = 0;
    this.sent = this.joints.positions;
    this.lastMs = performance.now();
    this.showState();
    requestAnimationFrame(this.tick);
  }

  private end(): void {
    this.sweep = null;
    this.showState();
  }

  private readonly tick = (): void => {
    if (!this.sweep) return;
    const now = performance.now();
    this.seconds += Math.min((now - this.lastMs) / 1000, LONGEST_STEP_S) * Number(this.speed.value);
    this.lastMs = now;
    const positions = this.sweep.positionsAt(this.seconds);
    const moved = Object.entries(positions).filter(([name, position]) => this.sent[name] !== position);
    this.sent = positions;
    this.joints.move(Object.fromEntries(moved));
    requestAnimationFrame(this.tick);
  };

  private showState(): void {
    const texts = strings.description.sweep;
    const running = this.sweep !== null;
    this.start.replaceChildren(icon(running ? "stop" : "play"));
    this.start.title = running ? texts.stop : texts.start;
    this.start.setAttribute("aria-label", this.start.title);
    this.start.classList.toggle("on", running);
  }
}

/** Returns the switch for dragging links without Alt, for touch screens and for frequent use. */
function dragSwitch(joints: JointsState): HTMLElement {
  const toggle = (): void => {
    joints.dragsWithoutAlt = !joints.dragsWithoutAlt;
    show();
  };
  const element = button(strings.description.handsOn, toggle, "tool bare", icon("hand"));
  const show = (): void => {
    element.classList.toggle("on", joints.dragsWithoutAlt);
    element.setAttribute("aria-pressed", String(joints.dragsWithoutAlt));
  };
  show();
  return element;
}

function fill(select: HTMLSelectElement, label: string, options: readonly (readonly [string, string])[]): void {
  select.setAttribute("aria-label", label);
  select.title = label;
  select.append(
    ...options.map(([value, text]) => {
      const option = h("option", {}, text);
      option.value = value;
      return option;
    }),
  );
}
