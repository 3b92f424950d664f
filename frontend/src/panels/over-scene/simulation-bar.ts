import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { Modeling } from "../../state/modeling/modeling";
import type { SimulationState } from "../../state/simulation";
import { strings } from "../../strings";
import { ModelingBar } from "../modeling/modeling-bar";
import type { WorldCommands } from "../modeling/world-commands";
import { SpawnDialog } from "./spawn-dialog";

const NOTICE_DURATION_MS = 8000;

/** The toolbar over the scene while there is a simulation: play, pause, step, reset, and the real-time factor. */
export class SimulationBar {
  readonly element: HTMLElement;
  private readonly playButton: HTMLButtonElement;
  private readonly stepButton: HTMLButtonElement;
  private readonly factorText = h("output", { class: "simulation-figure", title: strings.simulation.factorHint });
  private readonly timeText = h("output", { class: "simulation-figure wide", title: strings.simulation.timeHint });
  private readonly notice = h("div", { class: "simulation-notice", role: "status" });
  private readonly modelButton: HTMLButtonElement;
  private timer = 0;
  private spawnDialog: SpawnDialog | null = null;

  constructor(
    private readonly simulation: SimulationState,
    private readonly modeling: Modeling,
    commands: WorldCommands,
  ) {
    const texts = strings.simulation;
    this.playButton = createButton(texts.pause, () => simulation.sendControl(simulation.isPaused ? "play" : "pause"), "scene-tool small", createIcon("pause"));
    this.stepButton = createButton(texts.step, () => simulation.sendControl("step"), "scene-tool small", createIcon("step"));
    const resetButton = createButton(texts.reset, () => simulation.sendControl("reset"), "scene-tool small", createIcon("reset"));
    const addButton = createButton(texts.spawn, () => this.openSpawnDialog(simulation.findFreePosition()), "scene-tool small", createIcon("plus"));
    this.modelButton = createButton(strings.modeling.startEditing, () => modeling.setActive(!modeling.isActive), "scene-tool small", createIcon("build"));
    const children = [this.playButton, this.stepButton, resetButton, addButton, this.modelButton, this.factorText, this.timeText];
    const bar = h("div", { class: "simulation-tools", role: "toolbar", aria: { label: texts.label } }, ...children);
    this.element = h("div", { class: "simulation-bar" }, bar, new ModelingBar(modeling, commands).element, this.notice);
    simulation.changed.on(() => this.show());
    modeling.changed.on(() => this.show());
    simulation.refused.on((text) => this.showNotice(text));
    simulation.spawnRequested.on((position) => this.openSpawnDialog(position));
    this.show();
  }

  private show(): void {
    const { isPresent, isPaused, time, realTimeFactor } = this.simulation;
    const texts = strings.simulation;
    this.element.hidden = !isPresent;
    const label = isPaused ? texts.play : texts.pause;
    if (this.playButton.title !== label) {
      this.playButton.title = label;
      this.playButton.setAttribute("aria-label", label);
      this.playButton.replaceChildren(createIcon(isPaused ? "play" : "pause"));
    }
    this.stepButton.disabled = !isPaused;
    this.showModeling();
    this.factorText.textContent = realTimeFactor === null ? "–" : `${realTimeFactor.toFixed(2)}×`;
    this.timeText.textContent = time === null ? "–" : `${time.toFixed(1)} s`;
  }

  private showModeling(): void {
    const { isAvailable, isActive } = this.modeling;
    const label = isActive ? strings.modeling.stopEditing : strings.modeling.startEditing;
    this.modelButton.hidden = !isAvailable;
    this.modelButton.title = label;
    this.modelButton.setAttribute("aria-label", label);
    this.modelButton.setAttribute("aria-pressed", String(isActive));
    this.modelButton.classList.toggle("active", isActive);
  }

  private showNotice(text: string): void {
    if (this.spawnDialog !== null) return; // the dialog shows the answer
    clearTimeout(this.timer);
    this.notice.textContent = text;
    this.timer = window.setTimeout(() => (this.notice.textContent = ""), NOTICE_DURATION_MS);
  }

  private openSpawnDialog(position: readonly number[]): void {
    this.spawnDialog = new SpawnDialog(this.simulation, this.modeling, position, () => (this.spawnDialog = null));
  }
}
