import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { formatField, formatValue } from "../../state/monitor/field-text";
import { formatCsv } from "../../state/monitor/plot-table";
import type { Plot, PlotsState, Series } from "../../state/monitor/plots";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";
import { createNumberField } from "../../widgets/controls";
import { saveText } from "../../widgets/save-file";
import { PlotChart, seriesColorOf } from "./plot-chart";
import { PlotPicker } from "./plot-picker";

/** One plot with its series and their values. */
export class PlotBox {
  readonly element: HTMLElement;
  private readonly legend = h("div", { class: "plot-legend" });
  private readonly pickerBox = h("div", { class: "picker-box" });
  private readonly rangeBox = h("span", { class: "plot-range" });
  private readonly chart: PlotChart;
  private readonly valueOutputs = new Map<Series, HTMLElement>();
  private picker: PlotPicker | null = null;

  constructor(
    private readonly state: PlotsState,
    private readonly topics: TopicsState,
    readonly plot: Plot,
  ) {
    const texts = strings.monitor.plot;
    this.chart = new PlotChart(state, plot, () => this.showValues());
    const head = h(
      "header",
      { class: "plot-head" },
      this.legend,
      h("span", { class: "spacer" }),
      this.rangeBox,
      createButton(texts.addSeries, () => this.openPicker(), "tool bare", createIcon("plus")),
      createButton(texts.csvHintOf, () => this.saveCsv(), "tool bare", createIcon("download")),
      createButton(texts.removePlot, () => state.removePlot(plot), "tool bare", createIcon("close")),
    );
    const ariaLabel = { label: texts.diagram };
    this.element = h("section", { class: "plot", aria: ariaLabel }, head, this.pickerBox, this.chart.element);
    this.element.addEventListener("dblclick", (event) => {
      if (this.chart.element.contains(event.target as Node)) state.setPaused(false);
    });
    this.show();
  }

  /** Updates after series, errors or settings have changed. */
  show(): void {
    const texts = strings.monitor.plot;
    this.valueOutputs.clear();
    const chips = this.plot.series.map((series, index) => {
      const value = h("output", { class: "plot-value" });
      this.valueOutputs.set(series, value);
      const name = formatField(series);
      const colorMark = h("span", { class: "plot-mark" });
      colorMark.style.background = seriesColorOf(index);
      const removeButton = createButton(texts.removeSeries(name), () => this.state.removeSeries(this.plot, series), "tool bare", createIcon("close"));
      const hint = series.error ?? name;
      return h("span", { class: series.error === null ? "chip" : "chip wrong", title: hint }, colorMark, name, value, removeButton);
    });
    if (!this.picker && chips.length === 0) chips.push(h("span", { class: "note" }, texts.empty));
    this.legend.replaceChildren(...chips);
    this.showRange();
    this.draw();
  }

  draw(): void {
    this.chart.draw();
    this.showValues();
  }

  /** Opens the input for adding a series. */
  openPicker(): void {
    if (!this.picker) {
      this.picker = new PlotPicker(
        this.state,
        this.topics,
        (field) => this.state.addSeries(this.plot, field),
        () => {
          this.picker = null;
          this.show();
        },
      );
      this.pickerBox.replaceChildren(this.picker.element);
      this.show();
    }
    this.picker.focus();
  }

  dispose(): void {
    this.picker?.close();
    this.chart.dispose();
  }

  private showValues(): void {
    this.plot.series.forEach((series, index) => {
      const output = this.valueOutputs.get(series);
      const { valuesAtCursor } = this.chart;
      const value = valuesAtCursor ? (valuesAtCursor[index] ?? null) : series.buffer.lastValue;
      const text = series.error ?? formatValue(value);
      if (output && output.textContent !== text) output.textContent = text;
    });
  }

  private showRange(): void {
    const texts = strings.monitor.plot;
    const { range } = this.plot;
    const toggle = createButton(
      texts.rangeHint,
      () => this.state.setRange(this.plot, range ? null : this.readShownRange()),
      range ? "tool on" : "tool",
      range ? texts.fixed : texts.auto,
    );
    toggle.setAttribute("aria-pressed", String(range !== null));
    this.rangeBox.replaceChildren(toggle);
    if (!range) return;
    const [low, high] = range;
    this.rangeBox.append(
      createNumberField(texts.lowest, low, [-Infinity, high], (value) => this.state.setRange(this.plot, [value, high])),
      createNumberField(texts.highest, high, [low, Infinity], (value) => this.state.setRange(this.plot, [low, value])),
    );
  }

  /** Returns the range of the visible values, rounded, as the initial fixed range. */
  private readShownRange(): [number, number] {
    const [startTime, endTime] = this.state.window ?? [0, 0];
    const shownValues = this.plot.series.flatMap(({ buffer }) => {
      const start = buffer.indexFrom(this.state.source, startTime);
      return [...buffer.values.subarray(start, buffer.indexFrom(this.state.source, endTime) + 1)].filter(Number.isFinite);
    });
    if (shownValues.length === 0) return [-1, 1];
    const low = shownValues.reduce((a, b) => Math.min(a, b));
    const high = shownValues.reduce((a, b) => Math.max(a, b));
    return high > low ? [Number(low.toPrecision(3)), Number(high.toPrecision(3))] : [low - 1, high + 1];
  }

  private saveCsv(): void {
    const { window: timeWindow, source } = this.state;
    const { series } = this.plot;
    if (!timeWindow) return;
    const text = formatCsv(series.map(formatField), series.map((plotSeries) => plotSeries.buffer), source, ...timeWindow);
    saveText("plot.csv", text, "text/csv");
  }
}
