import { Box3, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { JointScene, LinkScene } from "../src/protocol";
import { groundOf } from "../src/scene/robot/ground";

function link(name: string, parent_joint: string | null): LinkScene {
  return { name, frame: name, parent_joint, visuals: [], collisions: [], place: null, inertia: null };
}

function joint(child: string, parent: string, kind: JointScene["kind"]): JointScene {
  return { name: `${child}_joint`, kind, parent, child, position: [0, 0, 0], quaternion: [0, 0, 0, 1], axis: [0, 0, 1], lower: null, upper: null };
}

/** A base that is fixed to the root, and a moving part. */
const ROBOT = {
  links: [link("root", null), link("base", "base_joint"), link("part", "part_joint")],
  joints: [joint("base", "root", "fixed"), joint("part", "base", "continuous")],
};

function ground(base: [number, number] | null, part: [number, number]): number {
  const box = ([low, high]: [number, number]): Box3 => new Box3(new Vector3(-0.5, -0.5, low), new Vector3(0.5, 0.5, high));
  return groundOf(ROBOT, new Map([["root", new Box3()], ["base", base ? box(base) : new Box3()], ["part", box(part)]]));
}

describe("the ground of a robot", () => {
  it("is below wheels that reach lower than their frame", () => {
    expect(ground([-0.1, 0.3], [-0.2, 0.1])).toBe(-0.2);
    expect(ground(null, [-0.9, 0])).toBe(-0.9);
  });

  it("is the plane of the fixed frame for a robot that stands on it", () => {
    expect(ground([0.1, 0.3], [0, 0.1])).toBe(0);
    expect(ground([0.1, 0.3], [-0.002, 0.1])).toBe(0);
  });

  it("is the plane of an arm's base, even if something reaches below it", () => {
    expect(ground([0, 0.3], [-0.6, 0.1])).toBe(0);
    expect(ground([0.001, 0.3], [-0.6, 0.1])).toBe(0);
  });

  it("is at zero if nothing is visible", () => {
    expect(groundOf(ROBOT, new Map())).toBe(0);
  });
});
