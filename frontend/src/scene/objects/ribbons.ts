/** The vertices of lines drawn as ribbons: two at each point, one on each side. */
export interface Ribbons {
  positions: Float32Array;
  /** The direction of the line at each vertex; the ribbon extends perpendicular to it and to the line of sight. */
  directions: Float32Array;
  /** The side of each vertex, -0.5 or 0.5. */
  sides: Float32Array;
  /** r g b a for each vertex; null without colors. */
  colors: Float32Array | null;
  indices: Uint32Array;
}

/**
 * Returns ribbons along line strips. At a corner, both parts of the line share vertices perpendicular to the mean of
 * the two directions, so that there is no gap.
 *
 * @param strips - x y z of the points of each strip.
 * @param colors - r g b a, 0 to 1, of the points of each strip.
 */
export function createRibbons(strips: readonly Float32Array[], colors: readonly Float32Array[] | null = null): Ribbons {
  const pointCount = strips.reduce((sum, strip) => sum + strip.length / 3, 0);
  const segmentCount = strips.reduce((sum, strip) => sum + Math.max(0, strip.length / 3 - 1), 0);
  const ribbons: Ribbons = {
    positions: new Float32Array(pointCount * 6),
    directions: new Float32Array(pointCount * 6),
    sides: new Float32Array(pointCount * 2),
    colors: colors && new Float32Array(pointCount * 8),
    indices: new Uint32Array(segmentCount * 6),
  };
  let [vertex, index] = [0, 0];
  strips.forEach((strip, stripIndex) => {
    const count = strip.length / 3;
    for (let i = 0; i < count; i++) {
      const point = strip.subarray(i * 3, i * 3 + 3);
      const tangent = computeTangent(strip, i);
      const color = colors?.[stripIndex]?.subarray(i * 4, i * 4 + 4);
      for (const side of [-0.5, 0.5]) {
        ribbons.positions.set(point, vertex * 3);
        ribbons.directions.set(tangent, vertex * 3);
        ribbons.sides[vertex] = side;
        if (color) ribbons.colors?.set(color, vertex * 4);
        vertex += 1;
      }
      if (i === 0) continue;
      ribbons.indices.set([vertex - 4, vertex - 3, vertex - 1, vertex - 4, vertex - 1, vertex - 2], index);
      index += 6;
    }
  });
  return ribbons;
}

/** Returns both ends of every segment of a line strip. */
export function splitIntoSegments(strip: Float32Array, itemSize = 3): Float32Array {
  const count = Math.max(0, strip.length / itemSize - 1);
  const segments = new Float32Array(count * 2 * itemSize);
  for (let i = 0; i < count; i++) {
    segments.set(strip.subarray(i * itemSize, (i + 2) * itemSize), i * 2 * itemSize);
  }
  return segments;
}

/** Returns a strip of two points for each segment (x y z, x y z). */
export function splitIntoStrips(segments: Float32Array, itemSize = 3): Float32Array[] {
  const size = 2 * itemSize;
  return Array.from({ length: Math.floor(segments.length / size) }, (_, i) => segments.subarray(i * size, (i + 1) * size));
}

function computeTangent(strip: Float32Array, i: number): [number, number, number] {
  const incoming = computeSegmentDirection(strip, i - 1);
  const outgoing = computeSegmentDirection(strip, i);
  const sum: [number, number, number] = [incoming[0] + outgoing[0], incoming[1] + outgoing[1], incoming[2] + outgoing[2]];
  // Where the line reverses, the mean of both directions is zero.
  return Math.hypot(...sum) > 1e-6 ? sum : outgoing;
}

/** Returns the unit vector from point `i` to the next; zero beyond the ends and between equal points. */
function computeSegmentDirection(strip: Float32Array, i: number): [number, number, number] {
  if (i < 0 || (i + 2) * 3 > strip.length) return [0, 0, 0];
  const differenceAlong = (axis: number): number => (strip[i * 3 + 3 + axis] ?? 0) - (strip[i * 3 + axis] ?? 0);
  const [x, y, z] = [differenceAlong(0), differenceAlong(1), differenceAlong(2)];
  const length = Math.hypot(x, y, z);
  return length > 0 ? [x / length, y / length, z / length] : [0, 0, 0];
}
