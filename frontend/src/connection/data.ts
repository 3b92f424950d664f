import { DATA_KIND, type DataContent } from "../protocol";

const HEADER_BYTES = 16;
const ALIGNMENT = 8;

/** One content of a display, from one binary frame. */
export interface DisplayData {
  display: string;
  /** The key of this content within the display; it replaces the previous content with the same key. */
  key: string;
  /** The frame that the content is in; empty for the fixed frame. */
  frame: string;
  /** The time of the content, s. */
  stamp: number;
  /**
   * The pose of `frame` in the fixed frame at the time of the content, m and xyzw; null if the content follows `frame`.
   */
  pose: number[] | null;
  content: DataContent;
}

/** Unpacks the bytes that `pack_data` of `page/protocol/message.py` wrote; returns null for any other bytes. */
export function unpackData(buffer: ArrayBuffer): DisplayData | null {
  if (buffer.byteLength < HEADER_BYTES) return null;
  const header = new DataView(buffer);
  if (header.getUint32(0, true) !== DATA_KIND) return null;
  const length = header.getUint32(4, true);
  const text = new TextDecoder().decode(new Uint8Array(buffer, HEADER_BYTES, length));
  const arraysOffset = Math.ceil((HEADER_BYTES + length) / ALIGNMENT) * ALIGNMENT;
  return restoreArrays(JSON.parse(text), (reference) => createView(buffer, arraysOffset, reference)) as DisplayData;
}

type ArrayReference = readonly ["f4" | "u1", number, number];

type RestoreArray = (reference: ArrayReference) => ArrayBufferView;

/**
 * Replaces references with the arrays that they refer to. This is faster than a reviver of `JSON.parse`, which would
 * visit every number of the thousands of markers that a frame may contain.
 */
function restoreArrays(value: unknown, restore: RestoreArray): unknown {
  if (typeof value !== "object" || value === null) return value;
  if (Array.isArray(value)) {
    // All items of a list have the same kind, so the first item decides.
    if (typeof value[0] === "object") value.forEach((item, index) => (value[index] = restoreArrays(item, restore)));
    return value;
  }
  if (isReference(value)) return restore(value.$);
  const object = value as Record<string, unknown>;
  for (const name in object) {
    const item = object[name];
    if (typeof item === "object") object[name] = restoreArrays(item, restore);
  }
  return value;
}

function isReference(value: object): value is { $: ArrayReference } {
  return "$" in value;
}

function createView(buffer: ArrayBuffer, arraysOffset: number, [type, offset, count]: ArrayReference): ArrayBufferView {
  switch (type) {
    case "f4":
      return new Float32Array(buffer, arraysOffset + offset, count);
    case "u1":
      return new Uint8Array(buffer, arraysOffset + offset, count);
  }
}
