import { describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { unpackSamples } from "../src/connection/samples";
import type { PageMessage } from "../src/protocol";
import { formatField, parseField, formatValue } from "../src/state/monitor/field-text";
import { formatCsv, tabulatePlot } from "../src/state/monitor/plot-table";
import { PlotsState } from "../src/state/monitor/plots";
import { SeriesBuffer } from "../src/state/monitor/series-buffer";

function createBuffer(...samples: [number, number][]): SeriesBuffer {
  const buffer = new SeriesBuffer();
  for (const [time, value] of samples) buffer.append([time], [NaN], [value]);
  return buffer;
}

function createStorage(): Pick<Storage, "getItem" | "setItem"> {
  const texts = new Map<string, string>();
  return { getItem: (key) => texts.get(key) ?? null, setItem: (key, text) => void texts.set(key, text) };
}

describe("names of fields", () => {
  it("consist of a topic and a path", () => {
    expect(parseField("/joint_states.position[2]")).toEqual({ topic: "/joint_states", path: "position[2]" });
    expect(parseField(" odom.twist.twist.linear.x ")).toEqual({ topic: "/odom", path: "twist.twist.linear.x" });
    expect(parseField("/a/b.c[x.y]")).toEqual({ topic: "/a/b", path: "c[x.y]" });
    expect(formatField({ topic: "/a", path: "b.c" })).toBe("/a.b.c");
  });

  it("require both", () => {
    for (const text of ["", "/odom", "/odom.", ".x", "/a b.c"]) expect(parseField(text)).toBeNull();
  });

  it("are shown next to short values", () => {
    expect([1 / 3, 1e-9, 5, NaN, -Infinity, null].map(formatValue)).toEqual(["0.333333", "1e-9", "5", "nan", "-inf", ""]);
  });
});

describe("frames of samples", () => {
  it("are unpacked", () => {
    const bytes = new ArrayBuffer(16 + 8 + 3 * 8 * 2 + 8);
    const view = new DataView(bytes);
    view.setUint32(0, 3, true);
    view.setUint32(4, 2, true);
    view.setUint32(16, 7, true);
    view.setUint32(20, 2, true);
    [1, 2, NaN, 3, 4, 5].forEach((value, index) => view.setFloat64(24 + index * 8, value, true));
    view.setUint32(72, 9, true);
    const [firstSamples, secondSamples] = unpackSamples(bytes) ?? [];
    expect(firstSamples).toEqual({
      id: 7,
      received: new Float64Array([1, 2]),
      stamps: new Float64Array([NaN, 3]),
      values: new Float64Array([4, 5]),
    });
    expect([secondSamples?.id, secondSamples?.values.length]).toEqual([9, 0]);
  });

  it("are not confused with other frames", () => {
    expect(unpackSamples(new ArrayBuffer(64))).toBeNull();
    expect(unpackSamples(new ArrayBuffer(3))).toBeNull();
  });
});

describe("a series buffer", () => {
  it("grows, and drops the oldest samples when full", () => {
    const buffer = new SeriesBuffer(5000);
    for (let block = 0; block < 100; block++) {
      const times = Array.from({ length: 100 }, (_, index) => block * 100 + index);
      buffer.append(times, times.map(() => NaN), times);
    }
    expect(buffer.length).toBeLessThanOrEqual(5000);
    expect(buffer.length).toBeGreaterThan(2000);
    expect(buffer.lastValue).toBe(9999);
    const times = buffer.timesOf("received");
    expect(times.every((time, index) => index === 0 || time === (times[index - 1] ?? 0) + 1)).toBe(true);
  });

  it("stores both times", () => {
    const buffer = new SeriesBuffer();
    buffer.append([100, 101], [5, NaN], [1, 2]);
    expect([...buffer.timesOf("stamp")]).toEqual([5, 101]);
    expect(buffer.latestTimeOf("received")).toBe(101);
    expect(buffer.indexFrom("received", 100.5)).toBe(1);
  });

  it("restarts when stamps go back", () => {
    const buffer = new SeriesBuffer();
    buffer.append([100, 101, 102], [50, 51, 0], [1, 2, 3]);
    expect([...buffer.values]).toEqual([3]);
  });
});

describe("the drawn samples", () => {
  it("are all samples while there are few, at the times of all series", () => {
    const [times, a, b] = tabulatePlot([createBuffer([1, 10], [2, 20]), createBuffer([2, 5], [3, NaN])], "received", 0, 10, 100);
    expect(times).toEqual([1, 2, 3]);
    expect(a).toEqual([10, 20, undefined]);
    expect(b).toEqual([undefined, 5, null]);
  });

  it("extend beyond both edges", () => {
    const [times] = tabulatePlot([createBuffer([1, 1], [2, 2], [3, 3], [4, 4], [5, 5])], "received", 2.5, 3.5, 100);
    expect(times).toEqual([2, 3, 4]);
  });

  it("keep the extremes of each column if there are many samples", () => {
    const many = new SeriesBuffer();
    const times = Array.from({ length: 20_000 }, (_, index) => index / 1000);
    many.append(times, times, times.map((time, index) => (index === 12_345 ? 99 : Math.sin(time))));
    const [columns, listValues] = tabulatePlot([many], "stamp", 5, 15, 400);
    expect(columns.length).toBeLessThan(820);
    expect(columns.every((time, index) => index === 0 || time > (columns[index - 1] ?? 0))).toBe(true);
    expect(listValues).toContain(99);
    const column = listValues?.indexOf(99) ?? 0;
    expect(Math.abs((columns[column] ?? 0) - 12.345)).toBeLessThan(10 / 400);
  });

  it("do not flicker while the window moves", () => {
    const many = new SeriesBuffer();
    const times = Array.from({ length: 20_000 }, (_, index) => index / 1000);
    many.append(times, times, times.map((time) => Math.sin(40 * time)));
    const [firstTimes, first] = tabulatePlot([many], "stamp", 5, 15, 397);
    const [laterTimes, later] = tabulatePlot([many], "stamp", 5.031, 15.031, 397);
    const firstValues = new Map(firstTimes.map((time, row) => [time.toFixed(6), first?.[row]]));
    const valuePairs = laterTimes.slice(4, -8).map((time, row) => [firstValues.get(time.toFixed(6)), later?.[row + 4]]);
    expect(valuePairs.length).toBeGreaterThan(700);
    // The column at the right edge was still incomplete.
    for (const [earlierValue, laterValue] of valuePairs.slice(0, 780)) expect(earlierValue).toBe(laterValue);
  });

  it("are saved as CSV", () => {
    const text = formatCsv(["/a.x", 'b"y'], [createBuffer([1, 10], [2, 20]), createBuffer([2, 5], [9, 1])], "received", 1, 2);
    expect(text).toBe('time,/a.x,"b""y"\n1.000000,10,\n2.000000,20,5\n');
  });
});

describe("plots", () => {
  function createPlots(texts = createStorage()): { sentMessages: PageMessage[]; plots: PlotsState; connection: Connection } {
    const sentMessages: PageMessage[] = [];
    const connection = new Connection("ws://localhost/ws");
    vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
    return { sentMessages, plots: new PlotsState(connection, texts), connection };
  }

  it("request samples only while the panel is open, and again after the connection was lost", () => {
    const { sentMessages, plots, connection } = createPlots();
    plots.addSeries(plots.addPlot(), { topic: "/a", path: "x" });
    expect(sentMessages).toEqual([]);
    plots.setOpen(true);
    const request = { type: "watch_series", series: [{ id: plots.series[0]?.id, topic: "/a", path: "x" }], seconds: 30 };
    expect(sentMessages.at(-1)).toEqual(request);
    connection.message.emit({ type: "hello", protocol: 3, version: "1", title: "", run: "1" });
    expect(sentMessages.filter((message) => JSON.stringify(message) === JSON.stringify(request))).toHaveLength(2);
    plots.setOpen(false);
    expect(sentMessages.at(-1)).toEqual({ type: "watch_series", series: [], seconds: 30 });
  });

  it("follow the newest value, and freeze when paused", () => {
    const { plots, connection } = createPlots();
    plots.addSeries(plots.addPlot(), { topic: "/a", path: "x" });
    const id = plots.series[0]?.id ?? 0;
    const receiveSamples = (time: number): void =>
      connection.samples.emit([
        { id, received: Float64Array.of(time), stamps: Float64Array.of(NaN), values: Float64Array.of(1) },
      ]);
    expect(plots.window).toBeNull();
    receiveSamples(100);
    expect(plots.window).toEqual([70, 100]);
    plots.setPaused(true);
    receiveSamples(110);
    expect(plots.window).toEqual([70, 100]);
    plots.setPaused(false);
    expect(plots.window).toEqual([80, 110]);
    expect(plots.series[0]?.buffer.length).toBe(2);
  });

  it("restart when the other time is shown, and include earlier samples", () => {
    const { plots, connection } = createPlots();
    plots.addSeries(plots.addPlot(), { topic: "/a", path: "x" });
    const id = plots.series[0]?.id ?? 0;
    const receiveSamples = (...times: number[]): void =>
      connection.samples.emit([{ id, received: Float64Array.from(times), stamps: Float64Array.from(times, () => NaN), values: Float64Array.from(times) }]);
    const listValues = (): number[] => [...(plots.series[0]?.buffer.values ?? [])];
    receiveSamples(100, 101, 102);
    connection.message.emit({ type: "time_reset" });
    expect(listValues()).toEqual([100, 101, 102]);
    receiveSamples(100.5, 100.75);
    expect(listValues()).toEqual([100, 100.5, 100.75]);
    connection.message.emit({ type: "playhead", position: 50, playing: false, speed: 1, loop: false, seeks: 1, problem: "", live: false });
    connection.message.emit({ type: "time_reset" });
    expect(listValues()).toEqual([]);
    receiveSamples(50);
    receiveSamples(48, 49, 50);
    expect(listValues()).toEqual([48, 49, 50]);
  });

  it("are stored", () => {
    const texts = createStorage();
    const { plots } = createPlots(texts);
    plots.addSeries(plots.addPlot(), { topic: "/a", path: "x[1]" });
    plots.setRange(plots.plots[0]!, [-1, 2]);
    plots.setSeconds(60);
    const restoredPlots = createPlots(texts).plots;
    expect(restoredPlots.seconds).toBe(60);
    expect(restoredPlots.plots[0]?.range).toEqual([-1, 2]);
    expect(restoredPlots.series.map(formatField)).toEqual(["/a.x[1]"]);
  });

  it("do not accept a field twice", () => {
    const { plots } = createPlots();
    const plot = plots.addPlot();
    plots.addSeries(plot, { topic: "/a", path: "x" });
    plots.addSeries(plot, { topic: "/a", path: "x" });
    expect(plot.series).toHaveLength(1);
  });
});
