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
export function tabulatePlot(
  series: readonly SeriesBuffer[],
  source: TimeSource,
  startTime: number,
  endTime: number,
  pixelColumns: number,
): PlotTable {
  const spans = series.map((buffer) => {
    const end = Math.min(buffer.length, buffer.indexFrom(source, endTime) + 1);
    return [Math.max(0, buffer.indexFrom(source, startTime) - 1), end] as const;
  });
  const total = spans.reduce((sum, [start, end]) => sum + end - start, 0);
  if (total <= 2 * pixelColumns) return tabulateSamples(series, source, spans);
  // Columns must not shift while the window moves, or the line would flicker. The width is rounded, because differences
  // of times are not exact.
  const columnWidth = Number(((endTime - startTime) / pixelColumns).toPrecision(5));
  return tabulateExtremes(series, source, spans, Math.floor(startTime / columnWidth) * columnWidth, columnWidth, pixelColumns + 1);
}

/**
 * Returns the samples of several series between two times as CSV: one row for each time, empty cells for series without
 * a value.
 */
export function formatCsv(
  names: readonly string[],
  series: readonly SeriesBuffer[],
  source: TimeSource,
  startTime: number,
  endTime: number,
): string {
  const spans = series.map((buffer) => {
    const times = buffer.timesOf(source);
    let end = buffer.indexFrom(source, endTime);
    while (end < times.length && times[end] === endTime) end++;
    return [buffer.indexFrom(source, startTime), end] as const;
  });
  const [times, ...columns] = tabulateSamples(series, source, spans);
  const rows = times.map((time, row) => {
    const cells = columns.map((column) => String(column[row] ?? ""));
    return [time.toFixed(6), ...cells].join(",");
  });
  return ["time", ...names.map(quoteCsv)].join(",") + "\n" + rows.map((row) => row + "\n").join("");
}

type Spans = readonly (readonly [number, number])[];

function tabulateSamples(series: readonly SeriesBuffer[], source: TimeSource, spans: Spans): PlotTable {
  const timeSet = new Set<number>();
  spans.forEach(([start, end], index) => {
    for (const time of series[index]?.timesOf(source).subarray(start, end) ?? []) timeSet.add(time);
  });
  const times = [...timeSet].sort((a, b) => a - b);
  const rows = new Map(times.map((time, row) => [time, row]));
  const columns = series.map((buffer, index) => {
    const column = new Array<number | null | undefined>(times.length);
    const [start, end] = spans[index] ?? [0, 0];
    const [sampleTimes, values] = [buffer.timesOf(source), buffer.values];
    for (let index = start; index < end; index++) column[rows.get(sampleTimes[index] ?? 0) ?? 0] = toDrawnValue(values[index]);
    return column;
  });
  return [times, ...columns];
}

function tabulateExtremes(
  series: readonly SeriesBuffer[],
  source: TimeSource,
  spans: Spans,
  startTime: number,
  columnWidth: number,
  columnCount: number,
): PlotTable {
  // Two rows for each column, and one more column on each side for the samples beyond.
  const times = Array.from({ length: 2 * (columnCount + 2) }, (_, row) => startTime + ((row >> 1) - 1 + (row % 2 ? 0.75 : 0.25)) * columnWidth);
  const columns = series.map((buffer, index) => {
    const column = new Array<number | null | undefined>(times.length);
    const [start, end] = spans[index] ?? [0, 0];
    const [sampleTimes, values] = [buffer.timesOf(source), buffer.values];
    let firstSample = start;
    while (firstSample < end) {
      const bucket = bucketOf(sampleTimes[firstSample] ?? 0, startTime, columnWidth, columnCount);
      let [minimum, maximum] = [firstSample, firstSample];
      let nextSample = firstSample;
      for (; nextSample < end && bucketOf(sampleTimes[nextSample] ?? 0, startTime, columnWidth, columnCount) === bucket; nextSample++) {
        const value = values[nextSample] ?? NaN;
        if (!(value >= (values[minimum] ?? NaN))) minimum = nextSample;
        if (!(value <= (values[maximum] ?? NaN))) maximum = nextSample;
      }
      column[2 * bucket] = toDrawnValue(values[Math.min(minimum, maximum)]);
      if (minimum !== maximum) column[2 * bucket + 1] = toDrawnValue(values[Math.max(minimum, maximum)]);
      firstSample = nextSample;
    }
    return column;
  });
  return [times, ...columns];
}

function bucketOf(time: number, start: number, width: number, count: number): number {
  return Math.min(count + 1, Math.max(0, Math.floor((time - start) / width) + 1));
}

function toDrawnValue(value: number | undefined): number | null {
  return value === undefined || !Number.isFinite(value) ? null : value;
}

function quoteCsv(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
