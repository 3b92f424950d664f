import { describe, expect, it } from "vitest";
import * as orbit from "../src/state/orbit";
import { ZERO_ORBIT, type Orbit } from "../src/state/orbit";

const START: Orbit = { distance: 2, yaw: 5.5, pitch: 0.33, focal: [1, 2, 3], invertZ: false };

describe("the Orbit view", () => {
  it("stands where RViz's formula says", () => {
    const [x, y, z] = orbit.eye(START);
    expect(x).toBeCloseTo(1 + 2 * Math.cos(5.5) * Math.cos(0.33));
    expect(y).toBeCloseTo(2 + 2 * Math.sin(5.5) * Math.cos(0.33));
    expect(z).toBeCloseTo(3 + 2 * Math.sin(0.33));
  });

  it("has right-handed camera axes with up towards z", () => {
    const { right, up, back } = orbit.cameraAxes(START);
    for (const axis of [right, up, back]) expect(Math.hypot(...axis)).toBeCloseTo(1);
    const cross = [
      up[1] * back[2] - up[2] * back[1],
      up[2] * back[0] - up[0] * back[2],
      up[0] * back[1] - up[1] * back[0],
    ];
    right.forEach((value, i) => expect(cross[i]).toBeCloseTo(value));
    expect(up[2]).toBeGreaterThan(0);
  });

  it("turns upside down with Invert Z", () => {
    const inverted = { ...START, invertZ: true };
    expect(orbit.eye(inverted)[2]).toBeCloseTo(3 - 2 * Math.sin(0.33));
    expect(orbit.cameraAxes(inverted).up[2]).toBeLessThan(0);
  });

  it("rotates 0.005 rad a pixel, wraps the yaw and stops the pitch below the pole", () => {
    const rotated = orbit.rotate(START, 10, 4);
    expect(rotated.yaw).toBeCloseTo(5.45);
    expect(rotated.pitch).toBeCloseTo(0.35);
    expect(orbit.rotate({ ...START, yaw: 0.01 }, 4, 0).yaw).toBeCloseTo(2 * Math.PI - 0.01);
    expect(orbit.rotate(START, 0, 10_000).pitch).toBeCloseTo(Math.PI / 2 - 0.001);
    expect(orbit.rotate(START, 0, -10_000).pitch).toBeCloseTo(-Math.PI / 2 + 0.001);
  });

  it("pans so that the focal plane follows the pointer", () => {
    const height = 700;
    const moved = orbit.pan(START, 0, height, height);
    const wholeView = 2 * START.distance * Math.tan(Math.PI / 8);
    const distance = Math.hypot(...moved.focal.map((value, i) => value - (START.focal[i] ?? 0)));
    expect(distance).toBeCloseTo(wholeView);
    expect(moved.focal[2]).toBeGreaterThan(START.focal[2]);
  });

  it("zooms 12 % a notch with the wheel and a hundredth of the distance a pixel with the right button", () => {
    expect(orbit.zoomWheel(START, 120).distance).toBeCloseTo(2 * 0.88);
    expect(orbit.zoomDrag(START, 10).distance).toBeCloseTo(2 * 1.1);
    expect(orbit.zoomWheel(START, 1e6).distance).toBeGreaterThan(0);
  });

  it("moves along the line of sight with Shift", () => {
    const moved = orbit.dollyWheel(START, 120);
    const { back } = orbit.cameraAxes(START);
    moved.focal.forEach((value, i) => expect(value).toBeCloseTo((START.focal[i] ?? 0) - 0.24 * (back[i] ?? 0)));
    expect(moved.distance).toBe(START.distance);
  });

  it("looks straight down without losing its axes", () => {
    const { right } = orbit.cameraAxes(orbit.rotate(ZERO_ORBIT, 0, 10_000));
    expect(Math.hypot(...right)).toBeCloseTo(1);
  });
});
