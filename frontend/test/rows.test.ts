import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { createDetailRows } from "../src/panels/displays/detail-rows";
import { createDisplayRows, findLinkOfRow, findLinkRowPath } from "../src/panels/displays/robot-rows";
import type { JointScene, Property, ServerMessage } from "../src/protocol";
import { composePoses, computeRelativePose } from "../src/state/pose-numbers";
import { Session } from "../src/state/session";
import { formatPoint } from "../src/tree/numbers";
import type { TreeItem } from "../src/tree/tree-item";
import { createDisplay, createProperty, createRobotScene, createTree } from "./messages";

// The page's texts read the browser's language when they are imported.
vi.hoisted(() => vi.stubGlobal("localStorage", { getItem: () => "en" }));

const HALF = Math.SQRT1_2;

let session: Session;

function receive(...messages: ServerMessage[]): void {
  for (const message of messages) session.connection.message.emit(message);
}

function receiveFrames(poses: Record<string, { parent: string | null; pose: number[] }>): void {
  const names = Object.keys(poses);
  const parents = names.map((name) => names.indexOf(poses[name]!.parent ?? ""));
  receive({ type: "frame_table", revision: 1, names, parents });
  session.frames.setTransforms({
    revision: 1,
    stamp: 1,
    poses: new Float32Array(names.flatMap((name) => poses[name]!.pose)),
    ages: new Float32Array(names.length),
  });
}

function createJoint(name: string, parent: string, child: string, part: Partial<JointScene> = {}): JointScene {
  return {
    name,
    kind: "revolute",
    parent,
    child,
    position: [0, 0, 0],
    quaternion: [0, 0, 0, 1],
    axis: [0, 0, 1],
    lower: null,
    upper: null,
    ...part,
  };
}

function createRow(group: string, name: string, details: "link" | "joint"): Property {
  const extras = [createProperty({ id: `d0/${group}/${name}/Show Axes`, name: "Show Axes", kind: "bool", value: false })];
  return createProperty({ id: `d0/${group}/${name}`, name, kind: "bool", value: true, details, children: extras });
}

/** A robot of three links in a row: the root base, arm, and hand. */
function showRobot(style: string, open: readonly string[] = []): void {
  const createOption = (name: string, value: string | boolean): Property =>
    createProperty({ id: `d0/Links/${name}`, name, kind: typeof value === "string" ? "enum" : "bool", value });
  const links = createProperty({
    id: "d0/Links",
    name: "Links",
    kind: "group",
    children: [
      createOption("Link Tree Style", style),
      ...["Expand Tree", "Expand Link Details", "Expand Joint Details"].map((name) => createOption(name, open.includes(name))),
      createOption("All Links Enabled", true),
      ...["arm", "base", "hand"].map((name) => createRow("Links", name, "link")),
    ],
  });
  const joints = createProperty({
    id: "d0/Joints",
    name: "Joints",
    kind: "group",
    children: ["elbow", "grip"].map((name) => createRow("Joints", name, "joint")),
  });
  const scene = {
    ...createRobotScene("d0", "base", "arm", "hand"),
    joints: [createJoint("elbow", "base", "arm", { position: [1, 0, 0], lower: -1 }), createJoint("grip", "arm", "hand", { kind: "fixed" })],
  };
  receive(createTree(createDisplay({ id: "d0", cls: "rviz_default_plugins/RobotModel", properties: [links, joints] })), scene);
}

function outline(items: readonly TreeItem[], depth = 0): string[] {
  return items.flatMap((item) => [
    `${"  ".repeat(depth)}${item.name}${item.isExpanded ? "*" : ""}`,
    ...outline(item.children?.() ?? [], depth + 1),
  ]);
}

/** Returns the rows without options and details of links. */
function outlineArrangement(): string[] {
  const detailPattern = /Show|Position|Orientation|^ *[XYZW]$|Type|Limit|Axis|Style|Expand|All/;
  return outline(createDisplayRows(session.displays.displays[0]!, session, () => undefined)).filter((line) => !detailPattern.test(line));
}

beforeEach(() => {
  vi.stubGlobal("window", { setTimeout });
  session = new Session(new Connection("ws://localhost/ws"));
});

afterEach(() => vi.unstubAllGlobals());

describe("a robot's rows", () => {
  it("list its links", () => {
    showRobot("Links in Alphabetic Order");
    expect(outlineArrangement()).toEqual(["Links", "  arm", "  base", "  hand"]);
  });

  it("list its joints", () => {
    showRobot("Joints in Alphabetic Order", ["Expand Joint Details"]);
    expect(outlineArrangement()).toEqual(["Joints", "  elbow*", "  grip*"]);
  });

  it("form a tree of links", () => {
    showRobot("Tree of links", ["Expand Tree"]);
    expect(outlineArrangement()).toEqual([
      "Link Tree",
      "  base*",
      "    Details",
      "    arm*",
      "      Details",
      "      hand*",
      "        Details",
    ]);
  });

  it("form a tree of links and joints", () => {
    showRobot("Tree of links and joints", ["Expand Link Details"]);
    expect(outlineArrangement()).toEqual([
      "Link/Joint Tree",
      "  base",
      "    Details*",
      "    elbow",
      "      Details",
      "      arm",
      "        Details*",
      "        grip",
      "          Details",
      "          hand",
      "            Details*",
    ]);
  });

  it("can be unfolded if they have children", () => {
    const outlineExpandOptions = (): string[] =>
      outline(createDisplayRows(session.displays.displays[0]!, session, () => undefined)).filter((line) => /Expand/.test(line));
    showRobot("Links in Alphabetic Order");
    expect(outlineExpandOptions()).toEqual(["  Expand Link Details"]);
    showRobot("Joints in Alphabetic Order");
    expect(outlineExpandOptions()).toEqual(["  Expand Joint Details"]);
    showRobot("Tree of links");
    expect(outlineExpandOptions()).toEqual(["  Expand Tree", "  Expand Link Details"]);
  });

  it("are found by their link", () => {
    showRobot("Tree of links and joints");
    const [model] = session.displays.displays;
    expect(findLinkRowPath(model!, session, "arm")).toEqual(["d0", "d0/Links", "d0/Links/base", "d0/Joints/elbow", "d0/Links/arm"]);
    expect(findLinkOfRow(session, "d0/Links/arm")).toEqual({ display: model, link: "arm" });
    expect(findLinkOfRow(session, "d0/Links/All Links Enabled")).toBeNull();
    showRobot("Joints in Alphabetic Order");
    expect(findLinkRowPath(model!, session, "arm")).toEqual(["d0", "d0/Links", "d0/Joints/elbow"]);
    expect(findLinkRowPath(model!, session, "base")).toBeNull();
    showRobot("Links in Alphabetic Order");
    expect(findLinkRowPath(model!, session, "arm")).toEqual(["d0", "d0/Links", "d0/Links/arm"]);
  });
});

describe("rows of details", () => {
  const valuesByName = (items: readonly TreeItem[]): Record<string, unknown> =>
    Object.fromEntries(items.map((item) => [item.name, item.value]));

  it("show the position and properties of a joint", () => {
    showRobot("Joints in Alphabetic Order");
    receiveFrames({ base: { parent: null, pose: [0, 0, 2, 0, 0, HALF, HALF] } });
    const [model] = session.displays.displays;
    const [elbow, grip] = model!.rows.find("Joints")!.children;
    const rows = createDetailRows(elbow!, model!, session);
    expect(valuesByName(rows)).toEqual({
      Position: "0; 1; 2",
      Orientation: "0; 0; 0.707107; 0.707107",
      Type: "revolute",
      "Lower Limit": "-1",
      "Joint Axis": "0; 0; 1",
    });
    expect(valuesByName(createDetailRows(grip!, model!, session))["Type"]).toBe("fixed");
    expect(valuesByName(rows[0]!.children!())).toEqual({ X: "0", Y: "1", Z: "2" });
  });

  it("show the pose of a frame, also relative to its parent, and follow it", () => {
    const box = createProperty({ id: "d1/Frames/tip", name: "tip", kind: "bool", value: true, details: "frame" });
    receive(createTree(createDisplay({ id: "d1", properties: [box] })));
    const placeTip = (x: number): void =>
      receiveFrames({
        base: { parent: null, pose: [1, 0, 0, 0, 0, HALF, HALF] },
        tip: { parent: "base", pose: [x, 0, 0, 0, 0, 0, 1] },
      });
    placeTip(3);
    const [tf] = session.displays.displays;
    const rows = createDetailRows(tf!.rows.nodes[0]!, tf!, session);
    expect(valuesByName(rows)).toEqual({
      Parent: "base",
      Position: "3; 0; 0",
      Orientation: "0; 0; 0; 1",
      "Relative Position": "0; -2; 0",
      "Relative Orientation": "0; 0; -0.707107; 0.707107",
    });
    placeTip(5);
    expect(rows[1]!.value).toBe("5; 0; 0");
  });

  it("are empty for a frame without a pose", () => {
    const box = createProperty({ id: "d1/Frames/gone", name: "gone", kind: "bool", value: true, details: "frame" });
    receive(createTree(createDisplay({ id: "d1", properties: [box] })));
    const [tf] = session.displays.displays;
    expect(Object.values(valuesByName(createDetailRows(tf!.rows.nodes[0]!, tf!, session)))).toEqual(["", "", "", "", ""]);
  });

  it("show a joint's last effort", () => {
    const box = createProperty({ id: "d2/Joints/elbow", name: "elbow", kind: "bool", value: true, details: "effort" });
    receive(createTree(createDisplay({ id: "d2", properties: [box] })));
    const receiveRings = (effort: number, stamp: number): void =>
      session.connection.data.emit({
        display: "d2",
        key: String(stamp % 2),
        frame: "",
        stamp,
        pose: null,
        content: {
          kind: "effort_rings",
          joints: ["elbow"],
          poses: new Float32Array(7),
          efforts: new Float32Array([effort]),
          limits: new Float32Array([10]),
        },
      });
    receiveRings(1, 1);
    receiveRings(2, 2);
    receiveRings(3, 3);
    const [effort] = session.displays.displays;
    expect(valuesByName(createDetailRows(effort!.rows.nodes[0]!, effort!, session))).toEqual({ Effort: "3", "Max Effort": "10" });
  });
});

describe("poses", () => {
  it("are the same after composing and decomposing", () => {
    const a = [1, 2, 3, 0, HALF, 0, HALF] as const;
    const b = [-1, 0.5, 2, HALF, 0, 0, HALF] as const;
    computeRelativePose(a, composePoses(a, b)).forEach((part, i) => expect(part).toBeCloseTo(b[i]!));
  });
});

describe("a point in one line", () => {
  it("has five digits for its largest number, and the same resolution for the others", () => {
    expect(formatPoint([1.5, 0.00002399, 0.3])).toBe("1.5; 0; 0.3");
    expect(formatPoint([0, 0, -20050.26])).toBe("0; 0; -20050");
    expect(formatPoint([0.000123456, 0, -0.00002])).toBe("0.00012346; 0; -0.00002");
    expect(formatPoint([0, -0, 0])).toBe("0; 0; 0");
  });
});
