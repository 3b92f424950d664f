import { describe, expect, it } from "vitest";
import { FIELD_OF_VIEW, computePixelSize, type Camera } from "../src/state/views/camera";

const above: Camera = { position: [0, 0, 10], right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1], scale: null, focal: null };
const size = { width: 800, height: 600 };

describe("the size of a pixel", () => {
  it("grows with the distance along the line of sight", () => {
    const near = computePixelSize(above, [5, 5, 5], size);
    expect(near * 600).toBeCloseTo(2 * 5 * Math.tan(FIELD_OF_VIEW / 2));
    expect(computePixelSize(above, [0, 0, 0], size)).toBeCloseTo(2 * near);
    expect(computePixelSize(above, [0, 0, 20], size)).toBeGreaterThan(0);
  });

  it("is the same everywhere for an orthographic camera", () => {
    expect(computePixelSize({ ...above, scale: 50 }, [3, 4, 5], size)).toBeCloseTo(0.02);
  });
});
