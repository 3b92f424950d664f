import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { JointsState } from "../../state/joints";
import { Sweep, type SweepOrder } from "../../state/sweep";
import { strings } from "../../strings";

const SPEEDS = [0.25, 0.5, 1, 2, 4] as const;
/** The longest step of the sweep: after the page was suspended, the sweep continues from the same position. */
const MAX_STEP_S = 0.1;

/** Moves the joints through their ranges until the user stops it or the joints change. */
export class SweepBar {
  readonly element: HTMLElement;
  private readonly orderSelect = h("select", { class: "choice" });
  private readonly speedSelect = h("select", { class: "choice" });
  private readonly startButton: HTMLButtonElement;
  private sweep: Sweep | null = null;
  private sweepSeconds = 0;
  private lastTickMs = 0;
  private sentPositions: Readonly<Record<string, number>> = {};

  constructor(private readonly joints: JointsState) {
    const texts = strings.description.sweep;
    fillSelect(this.orderSelect, texts.order, [
      ["one", texts.one],
      ["all", texts.all],
    ]);
    fillSelect(this.speedSelect, texts.speed, SPEEDS.map((speed) => [String(speed), `${speed}×`]));
    this.speedSelect.value = "1";
    this.orderSelect.addEventListener("change", () => this.sweep && this.startSweep());
    this.startButton = createButton(texts.start, () => (this.sweep ? this.stopSweep() : this.startSweep()), "tool bare", createIcon("play"));
    const row = h(
      "div",
      { class: "bar-row" },
      h("span", { class: "bar-label", title: texts.hint }, texts.label),
      this.orderSelect,
      this.speedSelect,
      h("span", { class: "bar-buttons" }, createDragSwitch(joints), this.startButton),
    );
    this.element = h("div", { class: "joint-bar sweep", role: "group", aria: { label: texts.label } }, row);
    joints.controlsChanged.on(() => this.stopSweep());
  }

  private startSweep(): void {
    this.sweep = new Sweep(this.joints.controls ?? [], this.joints.positions, this.orderSelect.value as SweepOrder);
    this.sweepSeconds = 0;
    this.sentPositions = this.joints.positions;
    this.lastTickMs = performance.now();
    this.showState();
    requestAnimationFrame(this.tick);
  }

  private stopSweep(): void {
    this.sweep = null;
    this.showState();
  }

  private readonly tick = (): void => {
    if (!this.sweep) return;
    const now = performance.now();
    this.sweepSeconds += Math.min((now - this.lastTickMs) / 1000, MAX_STEP_S) * Number(this.speedSelect.value);
    this.lastTickMs = now;
    const positions = this.sweep.positionsAt(this.sweepSeconds);
    const movedJoints = Object.entries(positions).filter(([name, position]) => this.sentPositions[name] !== position);
    this.sentPositions = positions;
    this.joints.move(Object.fromEntries(movedJoints));
    requestAnimationFrame(this.tick);
  };

  private showState(): void {
    const texts = strings.description.sweep;
    const isRunning = this.sweep !== null;
    this.startButton.replaceChildren(createIcon(isRunning ? "stop" : "play"));
    this.startButton.title = isRunning ? texts.stop : texts.start;
    this.startButton.setAttribute("aria-label", this.startButton.title);
    this.startButton.classList.toggle("on", isRunning);
  }
}

/** Returns the switch for dragging links without Alt, for touch screens and for frequent use. */
function createDragSwitch(joints: JointsState): HTMLElement {
  const toggle = (): void => {
    joints.dragsWithoutAlt = !joints.dragsWithoutAlt;
    show();
  };
  const element = createButton(strings.description.handsOn, toggle, "tool bare", createIcon("hand"));
  const show = (): void => {
    element.classList.toggle("on", joints.dragsWithoutAlt);
    element.setAttribute("aria-pressed", String(joints.dragsWithoutAlt));
  };
  show();
  return element;
}

function fillSelect(select: HTMLSelectElement, label: string, options: readonly (readonly [string, string])[]): void {
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
