import { SAMPLES_KIND } from "../protocol";

const HEADER_BYTES = 16;
const SERIES_BYTES = 8;

/** New samples of one series of a plot. */
export interface SeriesSamples {
  /** The ID that the page assigned to the series. */
  id: number;
  /** The times of receipt, seconds since the epoch. */
  received: Float64Array;
  /** The stamps of the headers, s; NaN for messages without a header. */
  stamps: Float64Array;
  values: Float64Array;
}

/** Unpacks the bytes that `pack_samples` of `page/protocol/monitor.py` wrote; returns null for any other bytes. */
export function unpackSamples(buffer: ArrayBuffer): SeriesSamples[] | null {
  if (buffer.byteLength < HEADER_BYTES) return null;
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== SAMPLES_KIND) return null;
  const series: SeriesSamples[] = [];
  let offset = HEADER_BYTES;
  for (let index = view.getUint32(4, true); index > 0; index--) {
    const id = view.getUint32(offset, true);
    const count = view.getUint32(offset + 4, true);
    const start = offset + SERIES_BYTES;
    const readRow = (row: number): Float64Array => new Float64Array(buffer, start + row * count * 8, count);
    series.push({ id, received: readRow(0), stamps: readRow(1), values: readRow(2) });
    offset = start + 3 * count * 8;
  }
  return series;
}
