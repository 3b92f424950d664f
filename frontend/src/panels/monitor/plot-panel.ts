import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { Plot, PlotsState } from "../../state/monitor/plots";
import type { TimeSource } from "../../state/monitor/series-buffer";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";
import { createSelect } from "../../widgets/controls";
import type { Panel } from "../panel";
import { PlotBox } from "./plot-box";

const WINDOW_LENGTHS_S = [5, 10, 30, 60, 120, 300, 600];

/** Plots of numeric fields of any topic. */
export class PlotPanel implements Panel {
  readonly id = "plot";
  readonly icon = "plot";
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "plots" });
  private readonly plotBoxes = new Map<Plot, PlotBox>();
  private readonly pauseButton: HTMLButtonElement;
  private readonly windowSelect: HTMLSelectElement;
  private readonly sourceSelect: HTMLSelectElement;

  constructor(
    private readonly state: PlotsState,
    private readonly topics: TopicsState,
  ) {
    const texts = strings.monitor.plot;
    this.pauseButton = createButton(texts.pauseHint, () => state.setPaused(!state.isPaused), "tool", strings.monitor.pause);
    const windowOptions = WINDOW_LENGTHS_S.map((count) => [String(count), texts.seconds(count)] as const);
    this.windowSelect = createSelect(texts.windowHint, windowOptions, (count) => state.setSeconds(Number(count)));
    const sourceOptions: [TimeSource, string][] = [
      ["received", texts.sources.received],
      ["stamp", texts.sources.stamp],
    ];
    this.sourceSelect = createSelect(texts.sourceHint, sourceOptions, (source) => state.setSource(source));
    const toolbar = h(
      "div",
      { class: "toolbar" },
      createButton(texts.addPlotHint, () => this.addPlot(), "tool", createIcon("plus"), texts.addPlot),
      this.pauseButton,
      createButton(texts.clearHint, () => state.clear(), "tool", createIcon("clear"), strings.monitor.clear),
      h("span", { class: "spacer" }),
      h("label", { class: "named" }, texts.window, this.windowSelect),
      h("label", { class: "named" }, texts.source, this.sourceSelect),
    );
    this.element = h("div", { class: "panel monitor" }, toolbar, this.list);
    state.changed.on(() => this.show());
    const draw = coalesce(() => this.draw());
    state.moved.on(draw);
    // The colors on the canvas must follow the theme even while no values arrive.
    new MutationObserver(draw).observe(document.documentElement, { attributeFilter: ["data-theme"] });
    this.show();
  }

  onOpened(): void {
    if (this.state.plots.length === 0) this.state.addPlot();
    this.state.setOpen(true);
  }

  onClosed(): void {
    this.state.setOpen(false);
  }

  private addPlot(): void {
    const plot = this.state.addPlot();
    this.plotBoxes.get(plot)?.openPicker();
  }

  private show(): void {
    const { plots, isPaused } = this.state;
    for (const [plot, box] of this.plotBoxes) {
      if (plots.includes(plot)) {
        box.show();
        continue;
      }
      box.dispose();
      box.element.remove();
      this.plotBoxes.delete(plot);
    }
    for (const plot of plots) {
      if (this.plotBoxes.has(plot)) continue;
      const box = new PlotBox(this.state, this.topics, plot);
      this.plotBoxes.set(plot, box);
      this.list.append(box.element);
    }
    const texts = strings.monitor;
    this.pauseButton.replaceChildren(createIcon(isPaused ? "play" : "pause"), isPaused ? texts.resume : texts.pause);
    this.pauseButton.title = isPaused ? texts.plot.resumeHint : texts.plot.pauseHint;
    this.pauseButton.classList.toggle("on", isPaused);
    this.windowSelect.value = String(this.state.seconds);
    this.sourceSelect.value = this.state.source;
  }

  private draw(): void {
    for (const box of this.plotBoxes.values()) box.draw();
  }
}
