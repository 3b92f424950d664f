import { describe, expect, it } from "vitest";
import type { LidarScene } from "../src/protocol";
import { RayFan } from "../src/scene/objects/ray-fan";

const LIDAR: LidarScene = {
  name: "m::l::laser",
  link: "m::l",
  position: [0, 0, 0],
  quaternion: [0, 0, 0, 1],
  visualized: true,
  horizontal: { first: -0.01, step: 0.02, count: 2 },
  vertical: { first: 0, step: 0, count: 1 },
  nearest: 1,
  farthest: 10,
};

describe("the rays of a lidar", () => {
  const corner = (fan: RayFan, at: number): number[] => {
    const { position, color } = fan.root.geometry.attributes;
    return [position!.getX(at), position!.getY(at), position!.getZ(at), color!.getW(at)];
  };

  it("fill what is between them, from the nearest distance to what they met", () => {
    const fan = new RayFan(LIDAR);
    expect([fan.count, fan.root.visible]).toEqual([0, false]);
    fan.set(new Float32Array([4, Infinity]));
    expect([fan.count, fan.root.visible]).toEqual([2, true]);
    const [left, right] = [corner(fan, 2), corner(fan, 3)];
    expect(Math.hypot(left[0]!, left[1]!)).toBeCloseTo(4);
    expect([left[1], right[1]]).toEqual([expect.closeTo(0, 5), expect.closeTo(-0.08, 4)]);
    expect(Math.hypot(...corner(fan, 0).slice(0, 3))).toBeCloseTo(1);
    expect(corner(fan, 0)[3]).toBeGreaterThan(left[3]!);
  });

  it("fade away as far as they measure where they met nothing", () => {
    const fan = new RayFan(LIDAR);
    fan.set(new Float32Array([4, Infinity]));
    const far = corner(fan, 6);
    expect(Math.hypot(far[0]!, far[1]!)).toBeCloseTo(10);
    expect(far[3]).toBe(0);
    fan.set(new Float32Array(0));
    expect([fan.count, fan.root.visible]).toEqual([0, false]);
  });

  it("are drawn narrow where there are few, and the fainter the more rows there are", () => {
    const few = new RayFan({ ...LIDAR, horizontal: { first: 0, step: 1, count: 1 } });
    few.set(new Float32Array([4]));
    expect(corner(few, 2)[1]! - corner(few, 3)[1]!).toBeLessThan(0.15);
    const rows = new RayFan({ ...LIDAR, horizontal: { first: 0, step: 1, count: 1 }, vertical: { first: 0, step: 0.1, count: 16 } });
    rows.set(new Float32Array(16).fill(4));
    expect(corner(rows, 2)[3]).toBeCloseTo(corner(few, 2)[3]! / 8);
  });
});
