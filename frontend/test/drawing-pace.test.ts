import { describe, expect, it } from "vitest";
import { DrawingPace } from "../src/state/drawing-pace";

function frames(pace: DrawingPace, count: number, late: boolean): void {
  for (let i = 0; i < count; i++) pace.countFrame(late);
}

describe("the pace of drawing", () => {
  it("is slow once most frames of two seconds were late, and not before", () => {
    const pace = new DrawingPace();
    let changes = 0;
    pace.changed.on(() => changes++);
    frames(pace, 44, true);
    expect(pace.isSlow).toBe(false);
    pace.countFrame(true);
    expect([pace.isSlow, changes]).toEqual([true, 1]);
    frames(pace, 44, false);
    expect(pace.isSlow).toBe(true);
    frames(pace, 1, false);
    expect([pace.isSlow, changes]).toEqual([false, 2]);
  });

  it("is not slow if a few frames are late, as while a mesh is read", () => {
    const pace = new DrawingPace();
    for (let i = 0; i < 50; i++) {
      frames(pace, 1, true);
      frames(pace, 1, false);
    }
    expect(pace.isSlow).toBe(false);
  });
});
