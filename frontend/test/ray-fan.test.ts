import type { BufferAttribute } from "three";
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
    const { position, color } = fan.root.geometry.attributes as Record<string, BufferAttribute>;
    return [position!.getX(at), position!.getY(at), position!.getZ(at), color!.getW(at)];
  };

  it("glow where they begin, and have a rim where they hit something", () => {
    const fan = new RayFan(LIDAR);
    expect([fan.count, fan.root.visible]).toEqual([0, false]);
    fan.set(new Float32Array([4, Infinity]));
    expect([fan.count, fan.root.visible]).toEqual([2, true]);
    const far = (at: number): number => Math.hypot(...corner(fan, at).slice(0, 3));
    expect([0, 2, 4, 6].map(far)).toEqual([1, 2.2, 3.8, 4].map((each): unknown => expect.closeTo(each, 5)));
    expect([0, 2, 4, 6].map((at) => corner(fan, at)[3]! > 0)).toEqual([true, false, false, true]);
    expect([corner(fan, 6)[1], corner(fan, 7)[1]]).toEqual([expect.closeTo(0, 5), expect.closeTo(-0.08, 4)]);
  });

  it("have no rim where they met nothing", () => {
    const fan = new RayFan(LIDAR);
    fan.set(new Float32Array([4, Infinity]));
    expect([corner(fan, 8)[3]! > 0, corner(fan, 14)[3]]).toEqual([true, 0]);
    fan.set(new Float32Array(0));
    expect([fan.count, fan.root.visible]).toEqual([0, false]);
  });

  it("are drawn narrow where there are few, and the fainter the more rows there are", () => {
    const few = new RayFan({ ...LIDAR, horizontal: { first: 0, step: 1, count: 1 } });
    few.set(new Float32Array([4]));
    expect(corner(few, 6)[1]! - corner(few, 7)[1]!).toBeLessThan(0.15);
    const rows = new RayFan({ ...LIDAR, horizontal: { first: 0, step: 1, count: 1 }, vertical: { first: 0, step: 0.1, count: 16 } });
    rows.set(new Float32Array(16).fill(4));
    expect(corner(rows, 6)[3]).toBeCloseTo(corner(few, 6)[3]! / 8);
  });
});
