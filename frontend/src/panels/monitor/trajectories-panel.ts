import { h } from "../../dom";
import type { TrajectoryJoint } from "../../protocol";
import type { TrajectoriesState } from "../../state/monitor/trajectories";
import { strings } from "../../strings";
import { createSelect, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

/** rad or m; the range of a slider whose joint has no limits. */
const DEFAULT_RANGE = Math.PI;
const DIGITS = 3;

/** Moves the joints of a trajectory controller by sliders, as rqt_joint_trajectory_controller does. */
export class TrajectoriesPanel implements Panel {
  readonly id = "trajectories";
  readonly icon = "trajectories";
  readonly element: HTMLElement;
  private readonly controllers: HTMLSelectElement;
  private readonly onBox: ReturnType<typeof createTickBox>;
  private readonly speed = createSlider(strings.monitor.trajectories.speed, 0.01, 1, 0.01);
  private readonly speedText = h("output", { class: "numeric" });
  private readonly note = h("p", { class: "empty" });
  private readonly rows = h("div", { class: "parameter-rows" });
  private readonly lines = new Map<string, JointLine>();
  private shownController: string | null = null;

  constructor(private readonly state: TrajectoriesState) {
    const texts = strings.monitor.trajectories;
    this.controllers = createSelect(texts.controller, [], (name) => state.choose(name));
    this.onBox = createTickBox(texts.on, texts.onHint, (isOn) => state.turn(isOn));
    this.speed.value = String(state.speed);
    this.speed.addEventListener("input", () => {
      state.speed = Number(this.speed.value);
      this.show();
    });
    const speed = h("label", { class: "named", title: texts.speedHint }, texts.speed, this.speed, this.speedText);
    const toolbar = h("div", { class: "toolbar" }, this.controllers, this.onBox, h("span", { class: "spacer" }), speed);
    this.element = h("div", { class: "panel monitor" }, toolbar, h("div", { class: "scroll" }, this.note, this.rows));
    state.listChanged.on(() => this.showControllers());
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => state.watch(isVisible));
    this.showControllers();
    this.show();
  }

  private showControllers(): void {
    const { controllers, name } = this.state;
    this.controllers.replaceChildren(...controllers.map((controller) => new Option(controller, controller, false, controller === name)));
    this.controllers.hidden = controllers.length === 0;
    this.show();
  }

  private show(): void {
    const texts = strings.monitor.trajectories;
    const { controller, name, isOn, speed } = this.state;
    if (name !== null) this.controllers.value = name;
    this.onBox.box.checked = isOn;
    this.onBox.box.disabled = controller === null || controller.joints.some(({ position }) => position === null);
    this.speedText.textContent = `${Math.round(speed * 100)} %`;
    const joints = controller?.joints ?? [];
    let note = "";
    if (name === null) note = texts.none;
    else if (controller === null) note = texts.waiting;
    else note = controller.error ?? (joints.some(({ position }) => position === null) ? texts.noPositions : "");
    this.note.textContent = note;
    this.note.hidden = note === "";
    const key = JSON.stringify(joints.map(({ name: joint, lower, upper }) => [name, joint, lower, upper]));
    if (key !== this.shownController) {
      this.shownController = key;
      this.lines.clear();
      for (const joint of joints) this.lines.set(joint.name, new JointLine(joint, (position) => this.state.move(joint.name, position)));
      this.rows.replaceChildren(...[...this.lines.values()].map(({ element }) => element));
    }
    for (const joint of joints) this.lines.get(joint.name)?.show(joint.position, this.state.targetOf(joint), isOn);
  }
}

class JointLine {
  readonly element: HTMLElement;
  private readonly slider: HTMLInputElement;
  private readonly field = h("input", { class: "field numeric" });
  private readonly position = h("output", { class: "note numeric" });

  constructor({ name, lower, upper }: TrajectoryJoint, onMoved: (position: number) => void) {
    const [low, high] = [lower ?? -DEFAULT_RANGE, upper ?? DEFAULT_RANGE];
    this.slider = createSlider(name, low, high, (high - low) / 1000);
    this.slider.classList.add("parameter-slider");
    this.slider.addEventListener("input", () => onMoved(Number(this.slider.value)));
    this.field.inputMode = "decimal";
    this.field.setAttribute("aria-label", name);
    this.field.addEventListener("change", () => {
      const value = Number(this.field.value);
      if (this.field.value.trim() !== "" && Number.isFinite(value)) onMoved(Math.min(Math.max(value, low), high));
    });
    const value = h("div", { class: "parameter-value" }, this.slider, this.field, this.position);
    this.element = h("div", { class: "parameter", data: { joint: name } }, h("div", { class: "parameter-name" }, name), value);
  }

  show(position: number | null, target: number, isOn: boolean): void {
    this.slider.disabled = this.field.disabled = !isOn;
    if (document.activeElement !== this.slider || !isOn) this.slider.value = String(target);
    if (document.activeElement !== this.field) this.field.value = target.toFixed(DIGITS);
    this.position.textContent = position === null ? "–" : position.toFixed(DIGITS);
  }
}

function createSlider(label: string, minimum: number, maximum: number, step: number): HTMLInputElement {
  const slider = h("input", { aria: { label } });
  slider.type = "range";
  slider.min = String(minimum);
  slider.max = String(maximum);
  slider.step = String(step);
  return slider;
}
