import type { SeriesBuffer, TimeSource } from "./series-buffer";

/** Times, and for each series a value for each of them: undefined where it has none, null where the line breaks. */
export type PlotTable = [number[], ...(number | null | undefined)[][]];

/**
 * The samples of some series between two times, as uPlot draws them.
 *
 * Where there are more samples than the plot has columns of pixels, each column shows the least and the greatest value
 * in it: the plot looks the same, and takes as long for a thousand samples a second as for ten. One sample beyond each
 * side is taken along, so that lines reach the edges.
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
  if (total <= 2 * columns) return exact(series, source, spans);
  // Columns stay where they are while the window moves, or the line would flicker. Differences of points in time are not
  // exact, hence the rounding.
  const width = Number(((to - from) / columns).toPrecision(5));
  return condensed(series, source, spans, Math.floor(from / width) * width, width, columns + 1);
}

/** The samples of some series between two times as CSV: a row for each time, blanks where a series has no value. */
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
  const [times, ...columns] = exact(series, source, spans);
  const rows = times.map((time, row) => {
    const cells = columns.map((column) => String(column[row] ?? ""));
    return [time.toFixed(6), ...cells].join(",");
  });
  return ["time", ...names.map(quoted)].join(",") + "\n" + rows.map((row) => row + "\n").join("");
}

type Spans = readonly (readonly [number, number])[];

function exact(series: readonly SeriesBuffer[], source: TimeSource, spans: Spans): PlotTable {
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
    for (let at = start; at < end; at++) column[rows.get(found[at] ?? 0) ?? 0] = drawn(values[at]);
    return column;
  });
  return [times, ...columns];
}

function condensed(
  series: readonly SeriesBuffer[],
  source: TimeSource,
  spans: Spans,
  from: number,
  width: number,
  count: number,
): PlotTable {
  // Two rows a column, and a column at each side for the samples beyond.
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
      column[2 * bucket] = drawn(values[Math.min(least, greatest)]);
      if (least !== greatest) column[2 * bucket + 1] = drawn(values[Math.max(least, greatest)]);
      at = next;
    }
    return column;
  });
  return [times, ...columns];
}

function bucketOf(time: number, from: number, width: number, count: number): number {
  return Math.min(count + 1, Math.max(0, Math.floor((time - from) / width) + 1));
}

function drawn(value: number | undefined): number | null {
  return value === undefined || !Number.isFinite(value) ? null : value;
}

function quoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
