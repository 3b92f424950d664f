import { describe, expect, it } from "vitest";
import { computeLegibleView } from "../src/widgets/legible-view";

describe("the first view", () => {
  it("shows the whole drawing, centered, if its texts are legible", () => {
    expect(computeLegibleView([400, 100], [832, 332], 12, [0, 0])).toEqual({ x: 216, y: 116, scale: 1 });
    expect(computeLegibleView([880, 100], [832, 332], 11, [0, 0])).toEqual({ x: 16, y: (332 - 100 * (800 / 880)) / 2, scale: 800 / 880 });
  });

  it("otherwise has texts of ten pixels, with its point in the middle", () => {
    const { x, y, scale } = computeLegibleView([4000, 100], [800, 300], 12.5, [2000, 50]);
    expect(scale).toBe(0.8);
    expect(x + 2000 * scale).toBe(400);
    expect(y).toBe((300 - 80) / 2);
  });

  it("leaves no empty space beyond its edges", () => {
    expect(computeLegibleView([4000, 3000], [800, 300], 10, [0, 0])).toEqual({ x: 16, y: 16, scale: 1 });
    expect(computeLegibleView([4000, 3000], [800, 300], 10, [4000, 3000])).toEqual({ x: 800 - 16 - 4000, y: 300 - 16 - 3000, scale: 1 });
  });
});
