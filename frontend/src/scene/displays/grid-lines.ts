/** The shape of a grid; lengths in m. */
export interface GridShape {
  cells: number;
  normalCells: number;
  cellSize: number;
  plane: string;
}

/**
 * Returns both ends (x y z, x y z) of every line of a grid centered on the origin, as in RViz's Grid: `normalCells` + 1
 * layers of `cells` x `cells` cells, connected by lines along the normal.
 */
export function createGridLines({ cells, normalCells, cellSize, plane }: GridShape): Float32Array {
  const points: number[] = [];
  const extent = (cells * cellSize) / 2;
  const top = (normalCells * cellSize) / 2;
  const addLine = (a: readonly number[], b: readonly number[]): void => {
    points.push(...orientToPlane(a, plane), ...orientToPlane(b, plane));
  };
  for (let layer = 0; layer <= normalCells; layer++) {
    const z = top - layer * cellSize;
    for (let i = 0; i <= cells; i++) {
      const offset = extent - i * cellSize;
      addLine([offset, -extent, z], [offset, extent, z]);
      addLine([-extent, offset, z], [extent, offset, z]);
    }
  }
  if (normalCells > 0) {
    for (let i = 0; i <= cells; i++) {
      for (let j = 0; j <= cells; j++) {
        const [x, y] = [extent - i * cellSize, extent - j * cellSize];
        addLine([x, y, -top], [x, y, top]);
      }
    }
  }
  return new Float32Array(points);
}

/**
 * Splits lines into a number of pieces each. Chromium's software renderer (SwiftShader) drops a line with an end behind
 * the camera, and with it the lines at the viewer's feet; of a split line it drops only the nearest piece.
 */
export function splitLines(lines: Float32Array, pieceCount: number): Float32Array {
  const result = new Float32Array(lines.length * pieceCount);
  let index = 0;
  for (let line = 0; line < lines.length; line += 6) {
    const [ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0] = lines.subarray(line, line + 6);
    for (let end = 0; end < 2 * pieceCount; end++) {
      const pieceIndex = (end + 1) >> 1;
      const ratio = pieceIndex / pieceCount;
      result[index++] = ax + (bx - ax) * ratio;
      result[index++] = ay + (by - ay) * ratio;
      result[index++] = az + (bz - az) * ratio;
    }
  }
  return result;
}

/**
 * Returns the colors (r g b a) of line ends around the origin, which fade out with the distance, as the ground has no
 * edge.
 */
export function createFadedColors(ends: Float32Array): Float32Array {
  const colors = new Float32Array((ends.length / 3) * 4).fill(1);
  const distanceAt = (i: number): number => Math.hypot(ends[i] ?? 0, ends[i + 1] ?? 0, ends[i + 2] ?? 0);
  const maxDistance = ends.reduce((maximum, end) => Math.max(maximum, Math.abs(end)), 0);
  for (let i = 0; i < ends.length; i += 3) colors[(i / 3) * 4 + 3] = Math.max(0, 1 - (distanceAt(i) / maxDistance) ** 2);
  return colors;
}

function orientToPlane([a = 0, b = 0, normal = 0]: readonly number[], plane: string): [number, number, number] {
  if (plane === "XZ") return [a, normal, b];
  if (plane === "YZ") return [normal, a, b];
  return [a, b, normal];
}
