import { describe, expect, it } from "vitest";
import type { Display, FrameTable, JointControl, JointScene, LinkScene, Property, RobotScene, Tree } from "../src/protocol";
import { computeJointPose, MovingRobot } from "../src/export/moving-robot";
import { RecordedConnection } from "../src/export/recorded-connection";
import { RecordedFiles } from "../src/export/recorded-files";
import { formatDuration } from "../src/scene/video";

const HALF = Math.SQRT1_2;

function createJoint(name: string, kind: JointScene["kind"], parent: string, child: string, overrides: Partial<JointScene> = {}): JointScene {
  return { name, kind, parent, child, position: [0, 0, 0], quaternion: [0, 0, 0, 1], axis: [0, 0, 1], lower: null, upper: null, ...overrides };
}

function createLink(name: string): LinkScene {
  return { name, frame: name, parent_joint: null, visuals: [], collisions: [], place: null, inertia: null };
}

function createControl(name: string, mimic: string | null = null, multiplier = 1, offset = 0): JointControl {
  return { name, kind: "revolute", lower: -4, upper: 4, zero: 0, mimic, multiplier, offset };
}

const ROBOT: RobotScene = {
  type: "robot_scene",
  display: "d",
  revision: 1,
  name: "arm",
  links: ["base", "arm", "hand"].map(createLink),
  joints: [
    createJoint("turn", "revolute", "base", "arm", { position: [1, 0, 0] }),
    createJoint("slide", "prismatic", "arm", "hand", { axis: [2, 0, 0] }),
  ],
};
const TABLE: FrameTable = { type: "frame_table", revision: 3, names: ["hand", "arm", "base", "cup"], parents: [1, 2, -1, 0] };
/** All links at zero; the cup is half a meter above the hand. */
const AT_ZERO = { revision: 3, stamp: 0, ages: new Float32Array(4), poses: packRows([1, 0, 0], [1, 0, 0], [0, 0, 0], [1, 0, 0.5]) };

function packRows(...positions: number[][]): Float32Array {
  return new Float32Array(positions.flatMap((position) => [...position, 0, 0, 0, 1]));
}

function poseOfLink(robot: MovingRobot, positions: Record<string, number>, name: string): number[] {
  const row = TABLE.names.indexOf(name);
  return [...robot.computeTransforms(positions).poses.subarray(row * 7, row * 7 + 7)].map((value) => Math.round(value * 1e5) / 1e5 + 0);
}

describe("the robot of an exported page", () => {
  const controls = [createControl("turn"), createControl("slide", "turn", 0.5, 0.25)];
  const robot = new MovingRobot(TABLE, AT_ZERO, ROBOT, controls);

  it("rotates and translates links with everything attached to them", () => {
    const quarterTurn = { turn: Math.PI / 2 };
    const slideLength = 0.5 * (Math.PI / 2) + 0.25;
    const expectedPose = [1, slideLength, 0, 0, 0, HALF, HALF].map((value) => Math.round(value * 1e5) / 1e5);
    expect(poseOfLink(robot, quarterTurn, "hand")).toEqual(expectedPose);
    expect(poseOfLink(robot, quarterTurn, "cup").slice(0, 3)).toEqual([1, expectedPose[1], 0.5]);
    expect(poseOfLink(robot, quarterTurn, "base")).toEqual([0, 0, 0, 0, 0, 0, 1]);
  });

  it("moves another robot whose joints follow its own, and leaves independent joints of it alone", () => {
    const names = [...TABLE.names, "old/base", "old/arm", "old/hand"];
    const table: FrameTable = { ...TABLE, names, parents: [...TABLE.parents, 2, 4, 5] };
    const oldRobot: RobotScene = {
      ...ROBOT,
      display: "o",
      links: ["base", "arm", "hand"].map((name) => ({ ...createLink(name), frame: `old/${name}` })),
      joints: [createJoint("spin", "revolute", "base", "arm", { position: [1, 0, 0] }), createJoint("gone", "revolute", "arm", "hand")],
    };
    const poseAtZero = { ...AT_ZERO, poses: packRows([1, 0, 0], [1, 0, 0], [0, 0, 0], [1, 0, 0.5], [0, 0, 0], [1, 0, 0], [1, 2, 0]) };
    const robots = new MovingRobot(table, poseAtZero, ROBOT, controls, [{ robot: oldRobot, joints: { spin: "turn" } }]);
    const { poses } = robots.computeTransforms({ turn: Math.PI / 2 });
    const poseOf = (name: string): number[] => {
      const start = names.indexOf(name) * 7;
      return [...poses.subarray(start, start + 7)].map((value) => Math.round(value * 1e5) / 1e5 + 0);
    };
    const half = Math.round(HALF * 1e5) / 1e5;
    expect(poseOf("old/arm")).toEqual([1, 0, 0, 0, 0, half, half]);
    expect(poseOf("old/hand")).toEqual([-1, 0, 0, 0, 0, half, half]);
  });

  it("keeps the fixed frame in place even if it is not the root", () => {
    const transforms = { ...AT_ZERO, poses: packRows([0, 0, 0], [0, 0, 0], [-1, 0, 0], [0, 0, 0.5]) };
    const turnedTransforms = new MovingRobot(TABLE, transforms, ROBOT, [createControl("turn")]).computeTransforms({ turn: Math.PI });
    expect([...turnedTransforms.poses.subarray(0, 3)].map(Math.round)).toEqual([0, 0, 0]);
    expect(turnedTransforms.poses[14]).toBeCloseTo(1);
  });

  it("resolves chains of mimic joints, and stops at cycles", () => {
    const chain = new MovingRobot(TABLE, AT_ZERO, ROBOT, [createControl("a"), createControl("b", "a", 2, 1), createControl("c", "b", -1, 0.5)]);
    expect(chain.computePosition("c", { a: 3 })).toBeCloseTo(-6.5);
    const circle = new MovingRobot(TABLE, AT_ZERO, ROBOT, [createControl("a", "b"), createControl("b", "a")]);
    expect(circle.computePosition("a", {})).toBe(0);
  });

  it("does not move fixed joints and joints without an axis", () => {
    expect(computeJointPose(createJoint("j", "revolute", "a", "b", { axis: [0, 0, 0], position: [1, 2, 3] }), 1).elements[12]).toBe(1);
    expect(computeJointPose(createJoint("j", "fixed", "a", "b"), 1).elements[0]).toBe(1);
  });
});

describe("the files of an exported page", () => {
  const files = new RecordedFiles({ "/mesh/arm-1/meshes/a.stl": btoa("solid a") });

  it("are found wherever the page was opened from", async () => {
    for (const url of ["/mesh/arm-1/meshes/a.stl?v=1", "file:///C:/mesh/arm-1/meshes/a.stl", "file:///mesh/arm-1/meshes/a.stl"]) {
      const response = await files.fetch(url);
      expect(await response.text()).toBe("solid a");
    }
    expect((await files.fetch("/mesh/arm-1/meshes/b.stl")).status).toBe(404);
    expect(files.addressOf("blob:something")).toBe("blob:something");
  });
});

describe("grid and axes of an exported page", () => {
  /** Returns the properties sent after a page has measured a robot, with the grid at a height. */
  function measureRobot(height: number, ground: number, awaitsSize = false, diagonal = 2, spacing: number | null = null): [string, unknown][] {
    const row: Omit<Property, "id" | "value" | "options" | "children"> = { name: "Z", kind: "float", description: "", minimum: null, maximum: null, read_only: false, expanded: false, details: null, topics: null };
    const offset: Property = { ...row, id: "g/Offset", name: "Offset", kind: "group", value: "", options: [], children: [{ ...row, id: "g/Offset/Z", value: height, options: [], children: [] }] };
    const cell: Property = { ...row, id: "g/Cell Size", name: "Cell Size", value: 1, options: [], children: [] };
    const grid: Display = { id: "g", cls: "rviz_default_plugins/Grid", drawing: "rviz_default_plugins/Grid", name: "Grid", group: null, enabled: true, supported: true, level: "ok", status: [], properties: [cell, offset] };
    const scale: Property = { ...row, id: "t/Marker Scale", name: "Marker Scale", value: 1, options: [], children: [] };
    const tf: Display = { ...grid, id: "t", cls: "rviz_default_plugins/TF", drawing: "rviz_default_plugins/TF", name: "TF", properties: [scale] };
    const tree: Tree = { type: "tree", global_options: [], global_status: [], global_level: "ok", displays: [grid, tf] };
    const connection = new RecordedConnection({ program: "", display: "d", awaits_size: awaitsSize, spacing, messages: [tree], frames: [], files: {} });
    const values: [string, unknown][] = [];
    connection.on("property_changed", ({ id, value }) => values.push([id, value]));
    connection.send({ type: "robot_measured", diagonal, ground });
    return values;
  }

  it("places the grid below the robot once that is drawn, unless a user has moved the grid", () => {
    expect(measureRobot(0, -0.25)).toEqual([["g/Offset/Z", -0.25]]);
    expect(measureRobot(0, 0)).toEqual([]);
    expect(measureRobot(0.5, -0.25)).toEqual([]);
  });

  it("scales axes to the distances between links", () => {
    expect(measureRobot(0, 0, true, 2, 0.1)[1]).toEqual(["t/Marker Scale", 0.25]);
    expect(measureRobot(0, 0, true, 2, 0.2)[1]).toEqual(["t/Marker Scale", 0.5]);
  });

  it("scales the cells to the robot, unless a user has chosen or measured a size before", () => {
    expect(measureRobot(0, 0, true, 0.05)).toEqual([["g/Cell Size", 0.01], ["t/Marker Scale", 0.025]]);
    expect(measureRobot(0, 0, true, 2)).toEqual([["g/Cell Size", 1], ["t/Marker Scale", 1]]);
    expect(measureRobot(0, 0, false, 0.05)).toEqual([]);
  });
});

it("shows the time of a recording", () => {
  expect([0, 9, 60, 3725].map(formatDuration)).toEqual(["0:00", "0:09", "1:00", "62:05"]);
});
