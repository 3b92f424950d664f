import type { Connection } from "../../connection/connection";
import type { SeriesSamples } from "../../connection/samples";
import type { TopicFields } from "../../protocol";
import { Signal } from "../../signal";
import { formatField, type FieldName } from "./field-text";
import { SeriesBuffer, type TimeSource } from "./series-buffer";

/** A line of a plot. */
export interface Series extends FieldName {
  readonly id: number;
  readonly buffer: SeriesBuffer;
  /** Why there are no values; null if there are, or if they are pending. */
  error: string | null;
}

/** A plot; `range` is a fixed range of values, or null to fit the samples shown. */
export interface Plot {
  readonly id: number;
  readonly series: Series[];
  range: readonly [number, number] | null;
}

interface SavedPlots {
  seconds: number;
  source: TimeSource;
  plots: { series: FieldName[]; range: readonly [number, number] | null }[];
}

const STORAGE_KEY = "linkwright.plots.1";
const DEFAULT_WINDOW_S = 30;

/** The plots and their samples, which the server sends only while the panel is open. */
export class PlotsState {
  /** Plots, series, errors or settings changed. */
  readonly changed = new Signal();
  /** Samples arrived, or the window moved. */
  readonly moved = new Signal();
  readonly fieldsArrived = new Signal<TopicFields>();
  readonly plots: Plot[] = [];
  /** The length of the window, s. */
  seconds = DEFAULT_WINDOW_S;
  source: TimeSource = "received";
  private frozenWindow: readonly [number, number] | null = null;
  private isOpen = false;
  private isLive = true;
  private nextId = 1;

  constructor(
    private readonly connection: Connection,
    private readonly storage: Pick<Storage, "getItem" | "setItem">,
  ) {
    this.restore();
    connection.on("hello", () => {
      if (this.isOpen) this.sendWatch();
    });
    connection.on("series_states", ({ states }) => {
      for (const { id, error } of states) {
        const series = this.series.find((candidate) => candidate.id === id);
        if (series) series.error = error;
      }
      this.changed.emit();
    });
    connection.on("topic_fields", (fields) => this.fieldsArrived.emit(fields));
    connection.on("playhead", ({ live }) => (this.isLive = live));
    // The samples are from another time than the one shown now.
    connection.on("time_reset", () => {
      if (!this.isLive) this.clear();
    });
    connection.samples.on((samples) => this.addSamples(samples));
  }

  get series(): Series[] {
    return this.plots.flatMap((plot) => plot.series);
  }

  get isPaused(): boolean {
    return this.frozenWindow !== null;
  }

  /** The time span of the plots, s; null if there is nothing to show. */
  get window(): readonly [number, number] | null {
    if (this.frozenWindow) return this.frozenWindow;
    const times = this.series.map((series) => series.buffer.latestTimeOf(this.source)).filter((time) => time !== null);
    if (times.length === 0) return null;
    const end = Math.max(...times);
    return [end - this.seconds, end];
  }

  /** Starts or stops receiving samples, when the panel is opened or closed. */
  setOpen(isOpen: boolean): void {
    this.isOpen = isOpen;
    this.sendWatch();
  }

  addPlot(): Plot {
    const plot = { id: this.nextId++, series: [], range: null };
    this.plots.push(plot);
    this.store();
    return plot;
  }

  removePlot(plot: Plot): void {
    this.plots.splice(this.plots.indexOf(plot), 1);
    this.store();
  }

  addSeries(plot: Plot, field: FieldName): void {
    if (plot.series.some((series) => formatField(series) === formatField(field))) return;
    plot.series.push({ ...field, id: this.nextId++, buffer: new SeriesBuffer(), error: null });
    this.store();
  }

  removeSeries(plot: Plot, series: Series): void {
    plot.series.splice(plot.series.indexOf(series), 1);
    this.store();
  }

  setRange(plot: Plot, range: readonly [number, number] | null): void {
    plot.range = range;
    this.store();
  }

  setSeconds(seconds: number): void {
    this.seconds = seconds;
    this.frozenWindow = null;
    this.store();
  }

  setSource(source: TimeSource): void {
    this.source = source;
    this.frozenWindow = null;
    this.store();
  }

  /** Freezes or resumes the plots; samples are received in both cases. */
  setPaused(isPaused: boolean): void {
    this.frozenWindow = isPaused ? this.window : null;
    this.changed.emit();
    this.moved.emit();
  }

  /** Freezes the plots at a time span. */
  freezeAt(start: number, end: number): void {
    this.frozenWindow = [start, end];
    this.changed.emit();
    this.moved.emit();
  }

  clear(): void {
    for (const { buffer } of this.series) buffer.clear();
    this.frozenWindow = null;
    this.changed.emit();
    this.moved.emit();
  }

  /** Requests the fields of a topic that can be plotted; null cancels the request. */
  requestFields(topic: string | null): void {
    this.connection.send({ type: "request_fields", topic });
  }

  private addSamples(samples: readonly SeriesSamples[]): void {
    const series = new Map(this.series.map((series) => [series.id, series]));
    for (const { id, received, stamps, values } of samples) series.get(id)?.buffer.append(received, stamps, values);
    if (!this.isPaused) this.moved.emit();
  }

  private store(): void {
    const savedState: SavedPlots = {
      seconds: this.seconds,
      source: this.source,
      plots: this.plots.map(({ series, range }) => ({
        series: series.map(({ topic, path }) => ({ topic, path })),
        range,
      })),
    };
    this.storage.setItem(STORAGE_KEY, JSON.stringify(savedState));
    if (this.isOpen) this.sendWatch();
    this.changed.emit();
    this.moved.emit();
  }

  private restore(): void {
    const text = this.storage.getItem(STORAGE_KEY);
    if (text === null) return;
    try {
      const savedState = JSON.parse(text) as SavedPlots;
      for (const { series, range } of savedState.plots) {
        const plot = series.map(({ topic, path }) => ({
          topic,
          path,
          id: this.nextId++,
          buffer: new SeriesBuffer(),
          error: null,
        }));
        this.plots.push({ id: this.nextId++, series: plot, range });
      }
      this.seconds = savedState.seconds;
      this.source = savedState.source;
    } catch {
      // The stored plots are from another version of the page: start without any.
      this.plots.length = 0;
    }
  }

  private sendWatch(): void {
    const series = this.isOpen ? this.series.map(({ id, topic, path }) => ({ id, topic, path })) : [];
    this.connection.send({ type: "watch_series", series, seconds: this.seconds });
  }
}
