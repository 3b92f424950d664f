import type { SeriesBuffer, TimeSource } from "./series-buffer";

/** Times, and a column of values for each series: undefined for no value, null where the line breaks. */
export type PlotTable = [number[], ...(number | null | undefined)[][]];

/**
 * Returns the samples of several series between two times, in uPlot's format.
 *
 * Where there are more samples than columns of pixels, each column shows its minimum and maximum: the plot looks the
 * same, and a thousand samples a second take no longer than ten. One sample beyond each side is included so that lines
 * reach the edges.
 */
export function plotTable(
  series: readonly SeriesBuffer[],
  source: TimeSource,
  from: number,
  to: number,
  columns: number,
): PlotTable {
  const spans = series.map((buffer) => {
    const end = Math.min(buffer.length, buffer.indexFrom(source, to) + 1);
    return [Math.max(0, buffer.indexFrom(source, from) - 1), end] as const;
  });
  const total = spans.reduce((sum, [start, end]) => sum + end - start, 0);
  if (total <= 2 * columns) return allSamples(series, source, spans);
  // Columns must not shift while the window moves, or the line would flicker. The width is rounded, because differences
  // of times are not exact.
  const width = Number(((to - from) / columns).toPrecision(5));
  return minMaxSamples(series, source, spans, Math.floor(from / width) * width, width, columns + 1);
}

/**
 * Returns the samples of several series between two times as CSV: one row for each time, empty cells for series without
 * a value.
 */
export function csvText(
  names: readonly string[],
  series: readonly SeriesBuffer[],
  source: TimeSource,
  from: number,
  to: number,
): string {
  const spans = series.map((buffer) => {
    const times = buffer.times(source);
    let end = buffer.indexFrom(source, to);
    while (end < times.length && times[end] === to) end++;
    return [buffer.indexFrom(source, from), end] as const;
  });
  const [times, ...columns] = allSamples(series, source, spans);
  const rows = times.map((time, row) => {
    const cells = columns.map((column) => String(column[row] ?? ""));
    return [time.toFixed(6), ...cells].join(",");
  });
  return ["time", ...names.map(csvQuoted)].join(",") + "\n" + rows.map((row) => row + "\n").join("");
}

type Spans = readonly (readonly [number, number])[];

function allSamples(series: readonly SeriesBuffer[], source: TimeSource, spans: Spans): PlotTable {
  const all = new Set<number>();
  spans.forEach(([start, end], index) => {
    for (const time of series[index]?.times(source).subarray(start, end) ?? []) all.add(time);
  });
  const times = [...all].sort((a, b) => a - b);
  const rows = new Map(times.map((time, row) => [time, row]));
  const columns = series.map((buffer, index) => {
    const column = new Array<number | null | undefined>(times.length);
    const [start, end] = spans[index] ?? [0, 0];
    const [found, values] = [buffer.times(source), buffer.values];
    for (let at = start; at < end; at++) column[rows.get(found[at] ?? 0) ?? 0] = drawnValue(values[at]);
    return column;
  });
  return [times, ...columns];
}

function minMaxSamples(
  series: readonly SeriesBuffer[],
  source: TimeSource,
  spans: Spans,
  from: number,
  width: number,
  count: number,
): PlotTable {
  // Two rows for each column, and one more column on each side for the samples beyond.
  const times = Array.from({ length: 2 * (count + 2) }, (_, row) => from + ((row >> 1) - 1 + (row % 2 ? 0.75 : 0.25)) * width);
  const columns = series.map((buffer, index) => {
    const column = new Array<number | null | undefined>(times.length);
    const [start, end] = spans[index] ?? [0, 0];
    const [found, values] = [buffer.times(source), buffer.values];
    let at = start;
    while (at < end) {
      const bucket = bucketOf(found[at] ?? 0, from, width, count);
      let [least, greatest] = [at, at];
      let next = at;
      for (; next < end && bucketOf(found[next] ?? 0, from, width, count) === bucket; next++) {
        const value = values[next] ?? NaN;
        if (!(value >= (values[least] ?? NaN))) least = next;
        if (!(value <= (values[greatest] ?? NaN))) greatest = next;
      }
      column[2 * bucket] = drawnValue(values[Math.min(least, greatest)]);
      if (least !== greatest) column[2 * bucket + 1] = drawnValue(values[Math.max(least, greatest)]);
      at = next;
    }
    return column;
  });
  return [times, ...columns];
}

function bucketOf(time: number, from: number, width: number, count: number): number {
  return Math.min(count + 1, Math.max(0, Math.floor((time - from) / width) + 1));
}

function drawnValue(value: number | undefined): number | null {
  return value === undefined || !Number.isFinite(value) ? null : value;
}

function csvQuoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
