import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { SyncMode, TimeControlState, Times } from "../../state/time";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

/**
 * The interval at which the times are updated. Without a GPU, each change of text costs as much as half a frame of the
 * scene.
 */
const REFRESH_INTERVAL_MS = 1000;
const MODES: readonly SyncMode[] = ["Off", "Exact", "Approximate"];
const TIME_FIELDS: readonly (keyof Times)[] = ["ros", "rosElapsed", "wall", "wallElapsed"];

/** RViz's Time panel. */
export class TimePanel implements Panel {
  readonly id = "time";
  readonly icon = "clock";
  readonly element: HTMLElement;
  private readonly pauseButton: HTMLButtonElement;
  private readonly modeSelect = h("select", { class: "choice", title: strings.time.syncHint });
  private readonly sourceSelect = h("select", { class: "choice", title: strings.time.sourceHint });
  private readonly timeOutputs = TIME_FIELDS.map((name) => ({ name, output: h("output", { class: "figure" }) }));

  private timer = 0;

  /** @param close - closes the panel while it is a strip without a tab below the scene. */
  constructor(
    private readonly time: TimeControlState,
    close: () => void,
  ) {
    const texts = strings.time;
    this.pauseButton = createButton(texts.pauseHint, () => time.set({ paused: !time.isPaused }), "tool", createIcon("pause"), texts.pause);
    this.modeSelect.append(...MODES.map((mode) => new Option(texts.modes[mode], mode)));
    this.modeSelect.setAttribute("aria-label", texts.sync);
    this.sourceSelect.setAttribute("aria-label", texts.source);
    this.modeSelect.addEventListener("change", () => time.set({ mode: this.modeSelect.value as SyncMode }));
    this.sourceSelect.addEventListener("change", () => time.set({ source: this.sourceSelect.value }));
    this.element = h(
      "div",
      { class: "panel time-panel" },
      this.pauseButton,
      createLabel(texts.sync, this.modeSelect),
      createLabel(texts.source, this.sourceSelect),
      ...this.timeOutputs.map(({ name, output }) => createLabel(texts[name], output, name)),
      h("span", { class: "spacer" }),
      createButton(texts.resetHint, () => time.reset(), "tool", createIcon("reset"), texts.reset),
      createButton(strings.close, close, "tool bare strip-close", createIcon("close")),
    );
    time.changed.on(() => this.update());
    this.update();
    // Request times only while they are visible.
    onVisibilityChange(this.element, (isVisible) => {
      time.watch(isVisible);
      clearInterval(this.timer);
      if (isVisible) this.timer = window.setInterval(() => this.updateTimes(), REFRESH_INTERVAL_MS);
      if (isVisible) this.updateTimes();
    });
  }

  private update(): void {
    const { isPaused, mode, source, sources } = this.time;
    this.pauseButton.setAttribute("aria-pressed", String(isPaused));
    this.pauseButton.classList.toggle("active", isPaused);
    this.modeSelect.value = mode;
    const names = source === "" || sources.includes(source) ? sources : [...sources, source];
    this.sourceSelect.replaceChildren(...["", ...names].map((name) => new Option(name)));
    this.sourceSelect.value = source;
    this.sourceSelect.disabled = mode === "Off";
    this.updateTimes();
  }

  private updateTimes(): void {
    const times = document.hidden ? null : this.time.computeTimes();
    if (!times) return;
    for (const { name, output } of this.timeOutputs) {
      const text = times[name].toFixed(2);
      if (output.textContent !== text) output.textContent = text;
    }
  }
}

function createLabel(text: string, element: HTMLElement, name = ""): HTMLElement {
  return h("label", { class: `labeled-row ${name}` }, h("span", {}, text), element);
}
