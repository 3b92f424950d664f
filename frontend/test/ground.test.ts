import { Box3, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { JointScene, LinkScene } from "../src/protocol";
import { computeGroundHeight } from "../src/scene/robot/ground";

function createLink(name: string, parent_joint: string | null): LinkScene {
  return { name, frame: name, parent_joint, visuals: [], collisions: [], place: null, inertia: null };
}

function createJoint(child: string, parent: string, kind: JointScene["kind"]): JointScene {
  return { name: `${child}_joint`, kind, parent, child, position: [0, 0, 0], quaternion: [0, 0, 0, 1], axis: [0, 0, 1], lower: null, upper: null };
}

/** A base that is fixed to the root, and a moving part. */
const ROBOT = {
  links: [createLink("root", null), createLink("base", "base_joint"), createLink("part", "part_joint")],
  joints: [createJoint("base", "root", "fixed"), createJoint("part", "base", "continuous")],
};

function computeGround(base: [number, number] | null, part: [number, number]): number {
  const createBox = ([low, high]: [number, number]): Box3 => new Box3(new Vector3(-0.5, -0.5, low), new Vector3(0.5, 0.5, high));
  return computeGroundHeight(ROBOT, new Map([["root", new Box3()], ["base", base ? createBox(base) : new Box3()], ["part", createBox(part)]]));
}

describe("the ground of a robot", () => {
  it("is below wheels that reach lower than their frame", () => {
    expect(computeGround([-0.1, 0.3], [-0.2, 0.1])).toBe(-0.2);
    expect(computeGround(null, [-0.9, 0])).toBe(-0.9);
  });

  it("is the plane of the fixed frame for a robot that stands on it", () => {
    expect(computeGround([0.1, 0.3], [0, 0.1])).toBe(0);
    expect(computeGround([0.1, 0.3], [-0.002, 0.1])).toBe(0);
  });

  it("is the plane of an arm's base, even if something reaches below it", () => {
    expect(computeGround([0, 0.3], [-0.6, 0.1])).toBe(0);
    expect(computeGround([0.001, 0.3], [-0.6, 0.1])).toBe(0);
  });

  it("is at zero if nothing is visible", () => {
    expect(computeGroundHeight(ROBOT, new Map())).toBe(0);
  });
});
