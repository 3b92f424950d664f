import { TRANSFORMS_KIND } from "../protocol";

const HEADER_BYTES = 24;
const FLOATS_PER_POSE = 7;

/** The poses of all frames of a table in the fixed frame, from one binary frame. */
export interface Transforms {
  /** The revision of the frame table that names the rows. */
  revision: number;
  /** The time of the newest transform, s. */
  stamp: number;
  /** One row of seven numbers a frame: x y z (m), qx qy qz qw; NaN for a frame without a transform. */
  poses: Float32Array;
  /** The seconds since the last transform of each frame; 0 for static frames. */
  ages: Float32Array;
}

/** Unpacks the bytes that `pack_transforms` of `page/protocol/message.py` wrote; returns null for any other bytes. */
export function unpackTransforms(buffer: ArrayBuffer): Transforms | null {
  if (buffer.byteLength < HEADER_BYTES) return null;
  const header = new DataView(buffer);
  const count = header.getUint32(8, true);
  const posesBytes = count * FLOATS_PER_POSE * 4;
  if (header.getUint32(0, true) !== TRANSFORMS_KIND) return null;
  if (buffer.byteLength !== HEADER_BYTES + posesBytes + count * 4) return null;
  return {
    revision: header.getUint32(4, true),
    stamp: header.getFloat64(16, true),
    poses: new Float32Array(buffer, HEADER_BYTES, count * FLOATS_PER_POSE),
    ages: new Float32Array(buffer, HEADER_BYTES + posesBytes, count),
  };
}
