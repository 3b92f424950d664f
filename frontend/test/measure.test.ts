import { describe, expect, it } from "vitest";
import { FIELD_OF_VIEW_RAD, computePixelSize, type Camera } from "../src/state/views/camera";

const CAMERA_ABOVE: Camera = { position: [0, 0, 10], right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1], scale: null, focal: null };
const SIZE = { width: 800, height: 600 };

describe("the size of a pixel", () => {
  it("grows with the distance along the line of sight", () => {
    const pixelSize = computePixelSize(CAMERA_ABOVE, [5, 5, 5], SIZE);
    expect(pixelSize * 600).toBeCloseTo(2 * 5 * Math.tan(FIELD_OF_VIEW_RAD / 2));
    expect(computePixelSize(CAMERA_ABOVE, [0, 0, 0], SIZE)).toBeCloseTo(2 * pixelSize);
    expect(computePixelSize(CAMERA_ABOVE, [0, 0, 20], SIZE)).toBeGreaterThan(0);
  });

  it("is the same everywhere for an orthographic camera", () => {
    expect(computePixelSize({ ...CAMERA_ABOVE, scale: 50 }, [3, 4, 5], SIZE)).toBeCloseTo(0.02);
  });
});
