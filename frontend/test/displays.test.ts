import { describe, expect, it } from "vitest";
import { fadeForAge } from "../src/scene/displays/fade";
import { createGridLines, type GridShape, splitLines } from "../src/scene/displays/grid-lines";

const GRID: GridShape = { cells: 10, normalCells: 0, cellSize: 1, plane: "XY" };

function computeBounds(points: Float32Array): number[][] {
  return [0, 1, 2].map((axis) => {
    const values = [...points].filter((_, i) => i % 3 === axis);
    return [Math.min(...values), Math.max(...values)];
  });
}

describe("Grid", () => {
  it("has cells + 1 lines each way around the origin", () => {
    const lines = createGridLines(GRID);
    expect(lines.length / 6).toBe(22);
    expect(computeBounds(lines)).toEqual([
      [-5, 5],
      [-5, 5],
      [0, 0],
    ]);
  });

  it("lies in the selected plane", () => {
    expect(computeBounds(createGridLines({ ...GRID, plane: "XZ" }))[1]).toEqual([0, 0]);
    expect(computeBounds(createGridLines({ ...GRID, plane: "YZ" }))[0]).toEqual([0, 0]);
  });

  it("connects its layers along the normal", () => {
    const lines = createGridLines({ ...GRID, cells: 2, normalCells: 3, cellSize: 0.5 });
    expect(lines.length / 6).toBe(4 * 6 + 9);
    expect(computeBounds(lines)[2]).toEqual([-0.75, 0.75]);
  });

  it("is drawn in pieces that join end to end", () => {
    expect([...splitLines(new Float32Array([0, 0, 0, 2, 4, 0, 1, 1, 1, 1, 1, 5]), 2)]).toEqual(
      [[0, 0, 0, 1, 2, 0], [1, 2, 0, 2, 4, 0], [1, 1, 1, 1, 1, 3], [1, 1, 3, 1, 1, 5]].flat(),
    );
    const wholeLines = createGridLines(GRID);
    expect([...splitLines(wholeLines, 1)]).toEqual([...wholeLines]);
    expect(splitLines(wholeLines, 10).length).toBe(10 * wholeLines.length);
    expect(computeBounds(splitLines(wholeLines, 10))).toEqual(computeBounds(wholeLines));
  });
});

describe("the age of a frame", () => {
  it("is drawn in thirds of the timeout: unchanged, turning gray, fading out", () => {
    expect(fadeForAge(0, 15)).toEqual({ gray: 0, alpha: 1 });
    expect(fadeForAge(5, 15)).toEqual({ gray: 0, alpha: 1 });
    expect(fadeForAge(7.5, 15)).toEqual({ gray: 0.5, alpha: 1 });
    expect(fadeForAge(12.5, 15)).toEqual({ gray: 1, alpha: 0.5 });
    expect(fadeForAge(20, 15)).toEqual({ gray: 1, alpha: 0 });
    expect(fadeForAge(NaN, 15)).toEqual({ gray: 0, alpha: 1 });
  });
});
