import { describe, expect, it } from "vitest";
import { DrawingPace } from "../src/state/drawing-pace";

function countFrames(pace: DrawingPace, count: number, isLate: boolean): void {
  for (let i = 0; i < count; i++) pace.countFrame(isLate);
}

describe("the pace of drawing", () => {
  it("is slow once most frames of two seconds were late, and not before", () => {
    const pace = new DrawingPace();
    let changes = 0;
    pace.changed.on(() => changes++);
    countFrames(pace, 44, true);
    expect(pace.isSlow).toBe(false);
    pace.countFrame(true);
    expect([pace.isSlow, changes]).toEqual([true, 1]);
    countFrames(pace, 44, false);
    expect(pace.isSlow).toBe(true);
    countFrames(pace, 1, false);
    expect([pace.isSlow, changes]).toEqual([false, 2]);
  });

  it("is not slow if a few frames are late, as while a mesh is read", () => {
    const pace = new DrawingPace();
    for (let i = 0; i < 50; i++) {
      countFrames(pace, 1, true);
      countFrames(pace, 1, false);
    }
    expect(pace.isSlow).toBe(false);
  });
});
