import type uPlot from "uplot";
import { h } from "../../dom";
import { formatValue } from "../../state/monitor/field-text";
import { tabulatePlot } from "../../state/monitor/plot-table";
import type { Plot, PlotsState } from "../../state/monitor/plots";

const COLOR_COUNT = 8;
const AXIS_FONT = "10.5px system-ui, sans-serif";
const Y_AXIS_WIDTH_PX = 58;
/** s; greater times are calendar times, smaller ones are counted from the start of a simulation. */
const MIN_CALENDAR_TIME_S = 1e8;

/** Returns the color of a plot's series, as a CSS variable. */
export function seriesColorOf(index: number): string {
  return `var(--plot-${(index % COLOR_COUNT) + 1})`;
}

/** One plot, drawn by uPlot, which is fetched when the first plot becomes visible. */
export class PlotChart {
  readonly element = h("div", { class: "plot-canvas" });
  /** The values at the pointer, by series; null while the pointer is elsewhere. */
  valuesAtCursor: readonly (number | null)[] | null = null;
  private library: typeof uPlot | null = null;
  private isFetching = false;
  private chart: uPlot | null = null;
  private seriesCount = -1;

  constructor(
    private readonly state: PlotsState,
    private readonly plot: Plot,
    private readonly onCursorMoved: () => void,
  ) {
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  /** Draws the data in the current time window. */
  draw(): void {
    const { plot, state } = this;
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    if (width === 0 || height === 0) return;
    if (!this.library) {
      this.fetchLibrary();
      return;
    }
    if (this.seriesCount !== plot.series.length) this.rebuild(this.library, width, height);
    const { chart } = this;
    if (!chart) return;
    const [start, end] = state.window ?? [0, state.seconds];
    const pixelColumns = Math.max(16, Math.round(width - Y_AXIS_WIDTH_PX));
    const table = tabulatePlot(plot.series.map((series) => series.buffer), state.source, start, end, pixelColumns);
    chart.batch(() => {
      chart.setData(table, false);
      chart.setScale("x", { min: start, max: end });
      const [low, high] = plot.range ?? computeRange(table);
      chart.setScale("y", { min: low, max: high });
    });
  }

  dispose(): void {
    this.chart?.destroy();
    this.chart = null;
    this.seriesCount = -1;
  }

  private resize(): void {
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    if (width === 0 || height === 0) return;
    this.chart?.setSize({ width, height });
    this.draw();
  }

  private fetchLibrary(): void {
    if (this.isFetching) return;
    this.isFetching = true;
    import("./plot-library").then(
      ({ UPlot }) => {
        this.library = UPlot;
        this.draw();
      },
      // The server is gone. Once it is back, the next values trigger another attempt.
      () => (this.isFetching = false),
    );
  }

  private rebuild(Chart: typeof uPlot, width: number, height: number): void {
    this.dispose();
    this.seriesCount = this.plot.series.length;
    const readColor = (name: string) => () => getComputedStyle(this.element).getPropertyValue(name).trim();
    const axis: uPlot.Axis = {
      stroke: readColor("--text-faint"),
      font: AXIS_FONT,
      grid: { stroke: readColor("--line"), width: 1 },
      ticks: { show: false },
    };
    this.chart = new Chart(
      {
        width,
        height,
        legend: { show: false },
        padding: [8, 28, 0, 0],
        cursor: { sync: { key: "plots" }, drag: { x: true, y: false, setScale: false }, points: { size: 5 } },
        scales: { x: { time: false, auto: false }, y: { auto: false } },
        series: [
          {},
          ...this.plot.series.map((_, index) => ({
            stroke: readColor(`--plot-${(index % COLOR_COUNT) + 1}`),
            width: 1.4,
            points: { show: false },
            // A gap is an absent value of this series, not a column that only another series has.
            spanGaps: false,
          })),
        ],
        axes: [
          { ...axis, size: 24, space: 70, values: (_, times) => times.map(formatAxisTime) },
          { ...axis, size: Y_AXIS_WIDTH_PX, values: (_, values) => values.map((value) => formatValue(value)) },
        ],
        hooks: {
          setCursor: [(chart) => this.readCursor(chart)],
          setSelect: [(chart) => this.zoomToSelection(chart)],
        },
      },
      undefined,
      this.element,
    );
  }

  private readCursor(chart: uPlot): void {
    const { left } = chart.cursor;
    if (left === undefined || left < 0) {
      this.valuesAtCursor = null;
    } else {
      const time = chart.posToVal(left, "x");
      this.valuesAtCursor = this.plot.series.map(({ buffer }) => {
        const index = buffer.indexFrom(this.state.source, time);
        return buffer.values[Math.max(0, index - 1)] ?? null;
      });
    }
    this.onCursorMoved();
  }

  private zoomToSelection(chart: uPlot): void {
    const { left, width } = chart.select;
    if (width < 4) return;
    this.state.freezeAt(chart.posToVal(left, "x"), chart.posToVal(left + width, "x"));
    chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }
}

/** Returns the minimum and maximum of a table, with a margin; equal values are centered. */
function computeRange([, ...pixelColumns]: ReturnType<typeof tabulatePlot>): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const column of pixelColumns) {
    for (const value of column) {
      if (value === null || value === undefined) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (low > high) return [-1, 1];
  const margin = high > low ? (high - low) * 0.06 : Math.max(1e-3, Math.abs(low) * 0.1);
  return [low - margin, high + margin];
}

/** Returns the label of a time on the axis: the time of day, or seconds if it is not a calendar time. */
function formatAxisTime(time: number): string {
  if (time < MIN_CALENDAR_TIME_S) return `${Number(time.toFixed(3))} s`;
  const date = new Date(time * 1000);
  const parts = [date.getHours(), date.getMinutes(), date.getSeconds()].map((field) => String(field).padStart(2, "0"));
  const fraction = Math.round((time % 1) * 1000) / 1000;
  return parts.join(":") + (fraction > 0 && fraction < 1 ? String(fraction).slice(1) : "");
}
