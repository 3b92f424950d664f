import type { Vector } from "../../state/views/vector";

/** A point as RViz's status line shows it: `[1.2,0,-3.4]`, metres. */
export function shown(point: Vector): string {
  return `[${point.map((each) => String(Number(each.toPrecision(3)))).join(",")}]`;
}
