import type { Vector } from "../../state/views/vector";

/** Returns a point as in RViz's status line: `[1.2,0,-3.4]`, m. */
export function formatPoint(point: Vector): string {
  return `[${point.map((coordinate) => String(Number(coordinate.toPrecision(3)))).join(",")}]`;
}
