import { button, coalesce, h } from "../../dom";
import { icon } from "../../icons";
import type { Plot, PlotsState } from "../../state/monitor/plots";
import type { TimeSource } from "../../state/monitor/series-buffer";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";
import { createSelect } from "../../widgets/controls";
import type { Panel } from "../panel";
import { PlotBox } from "./plot-box";

const WINDOWS = [5, 10, 30, 60, 120, 300, 600];

/** Plots of numeric fields of any topic. */
export class PlotPanel implements Panel {
  readonly id = "plot";
  readonly icon = "plot";
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "plots" });
  private readonly boxes = new Map<Plot, PlotBox>();
  private readonly pause: HTMLButtonElement;
  private readonly seconds: HTMLSelectElement;
  private readonly source: HTMLSelectElement;

  constructor(
    private readonly state: PlotsState,
    private readonly topics: TopicsState,
  ) {
    const texts = strings.monitor.plot;
    this.pause = button(texts.pauseHint, () => state.setPaused(!state.isPaused), "tool", strings.monitor.pause);
    const seconds = WINDOWS.map((count) => [String(count), texts.seconds(count)] as const);
    this.seconds = createSelect(texts.windowHint, seconds, (count) => state.setSeconds(Number(count)));
    const sources: [TimeSource, string][] = [
      ["received", texts.sources.received],
      ["stamp", texts.sources.stamp],
    ];
    this.source = createSelect(texts.sourceHint, sources, (source) => state.setSource(source));
    const bar = h(
      "div",
      { class: "toolbar" },
      button(texts.addPlotHint, () => this.add(), "tool", icon("plus"), texts.addPlot),
      this.pause,
      button(texts.clearHint, () => state.clear(), "tool", icon("clear"), strings.monitor.clear),
      h("span", { class: "spacer" }),
      h("label", { class: "named" }, texts.window, this.seconds),
      h("label", { class: "named" }, texts.source, this.source),
    );
    this.element = h("div", { class: "panel monitor" }, bar, this.list);
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

  private add(): void {
    const plot = this.state.addPlot();
    this.boxes.get(plot)?.openPicker();
  }

  private show(): void {
    const { plots, isPaused } = this.state;
    for (const [plot, box] of this.boxes) {
      if (plots.includes(plot)) {
        box.show();
        continue;
      }
      box.dispose();
      box.element.remove();
      this.boxes.delete(plot);
    }
    for (const plot of plots) {
      if (this.boxes.has(plot)) continue;
      const box = new PlotBox(this.state, this.topics, plot);
      this.boxes.set(plot, box);
      this.list.append(box.element);
    }
    const texts = strings.monitor;
    this.pause.replaceChildren(icon(isPaused ? "play" : "pause"), isPaused ? texts.resume : texts.pause);
    this.pause.title = isPaused ? texts.plot.resumeHint : texts.plot.pauseHint;
    this.pause.classList.toggle("on", isPaused);
    this.seconds.value = String(this.state.seconds);
    this.source.value = this.state.source;
  }

  private draw(): void {
    for (const box of this.boxes.values()) box.draw();
  }
}
