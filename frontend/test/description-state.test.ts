import { Ray, Vector3 } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { Description, JointDetails, LinkDetails, PageMessage, ServerMessage } from "../src/protocol";
import { computeSlideDistance, computeTurnAngle } from "../src/scene/joint-drag";
import { AngleUnits } from "../src/state/angle-unit";
import { DescriptionModel } from "../src/state/description-model";
import { layOutDiagram } from "../src/state/diagram-layout";
import { InspectState } from "../src/state/inspect";
import { formatJointCells, sortJoints } from "../src/state/joint-table";
import { listVisibleRows, LinkTreeState } from "../src/state/link-tree";
import { formatGeneral } from "../src/state/number-text";
import { Session } from "../src/state/session";
import { openBrowserStorage } from "../src/storage";
import { createDisplay, createRobotScene, createTree } from "./messages";

const NOWHERE = { expanded: null, origin: null, calls: [] };

function createLink(name: string, parent_joint: string | null = null, lines: readonly [number, number] | null = null): LinkDetails {
  const origin = lines && { file: "m.xacro", line: lines[0], column: 1, end_line: lines[1], end_column: 9 };
  return { name, frame: name, parent_joint, inertia: null, written: { ...NOWHERE, origin } };
}

function createJoint(name: string, parent: string, child: string, part: Partial<JointDetails> = {}): JointDetails {
  return {
    name,
    kind: "revolute",
    parent,
    child,
    xyz: [0, 0, 0.5],
    rpy: [0, -0, 1.5707963267948966],
    quaternion: [0, 0, 0, 1],
    axis: [0, 0, 1],
    lower: -1,
    upper: 2,
    velocity: 3,
    effort: 4,
    damping: null,
    friction: null,
    soft_lower: null,
    soft_upper: null,
    k_position: null,
    k_velocity: null,
    mimic: null,
    written: NOWHERE,
    ...part,
  };
}

function createDescription(part: Partial<Description> = {}): Description {
  return {
    type: "description",
    display: "d1",
    revision: 1,
    name: "arm",
    root: "base",
    links: [createLink("base"), createLink("left", "turn", [3, 6]), createLink("right", "lift", [3, 6]), createLink("tip", "fix")],
    joints: [
      createJoint("turn", "base", "left"),
      createJoint("lift", "base", "right", { kind: "prismatic" }),
      createJoint("fix", "left", "tip", { kind: "fixed" }),
    ],
    files: ["m.xacro"],
    ...part,
  };
}

let sentMessages: PageMessage[];
let session: Session;

beforeEach(() => {
  sentMessages = [];
  vi.stubGlobal("window", { setTimeout });
  const connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  session = new Session(connection);
});

function receive(...messages: ServerMessage[]): void {
  for (const message of messages) session.connection.message.emit(message);
}

function createChange(revision: number, links: string[] = [], joints: string[] = []): ServerMessage {
  return { type: "description_changed", display: "d1", revision, links, joints };
}

describe("the description", () => {
  it("is requested while something uses it, and not again while it is current", () => {
    receive(createChange(1));
    expect(sentMessages).toEqual([]);
    const release = session.description.hold();
    expect(sentMessages).toEqual([{ type: "request_description", display: "d1" }]);
    receive(createDescription());
    expect(session.description.modelOf("d1")?.links.size).toBe(4);
    release();
    session.description.hold()();
    expect(sentMessages).toHaveLength(1);
    receive(createChange(2));
    expect(sentMessages).toHaveLength(1);
    session.description.hold();
    expect(sentMessages).toHaveLength(2);
    receive(createChange(3));
    expect(sentMessages).toHaveLength(3);
  });

  it("reports what an edit has changed", () => {
    const edits: unknown[] = [];
    session.description.edited.on((change) => edits.push(change));
    receive(createChange(1), createChange(2, ["left"], ["turn"]));
    expect(edits).toEqual([{ display: "d1", links: ["left"], joints: ["turn"] }]);
  });

  it("requests a text once, and again when it may have changed", () => {
    const { description: texts } = session;
    expect(texts.textOf("d1", "")).toBeUndefined();
    expect(texts.textOf("d1", "")).toBeUndefined();
    expect(sentMessages).toHaveLength(1);
    receive({ type: "description_text", display: "d1", revision: 1, file: "", text: "<robot/>" });
    expect(texts.textOf("d1", "")).toBe("<robot/>");
    receive({ type: "diagnostics", items: [] });
    expect(texts.textOf("d1", "")).toBeUndefined();
    expect(sentMessages).toHaveLength(2);
  });
});

describe("the element that panels show", () => {
  beforeEach(() => {
    const scene = createRobotScene("d1", "base", "left");
    scene.links[1]!.parent_joint = "turn";
    receive(createTree(createDisplay({ id: "d1", cls: "rviz_default_plugins/RobotModel" })), scene);
  });

  it("is a joint until another link is selected; the scene highlights the link that it moves", () => {
    const { focus, selection } = session;
    focus.select({ display: "d1", kind: "joint", name: "turn" });
    expect(selection.selectedLink?.link.name).toBe("left");
    expect(focus.current).toEqual({ display: "d1", kind: "joint", name: "turn" });
    focus.select({ display: "d1", kind: "link", name: "left" });
    expect(focus.current?.kind).toBe("link");
    focus.select({ display: "d1", kind: "joint", name: "turn" });
    selection.select({ display: "d1", link: session.robots.get("d1")!.links[0]! });
    expect(focus.current).toEqual({ display: "d1", kind: "link", name: "base" });
    selection.select(null);
    expect(focus.current).toBeNull();
  });
});

describe("the model", () => {
  const model = new DescriptionModel(createDescription());

  it("is a tree with depths and positions in the source", () => {
    expect(model.childJointsOf("base").map((joint) => joint.name)).toEqual(["lift", "turn"]);
    expect([model.depthOf("base"), model.depthOf("tip"), model.maxDepth]).toEqual([0, 2, 2]);
    expect(model.elementsAt("m.xacro", 4).map((element) => element.name)).toEqual(["left", "right"]);
    expect(model.elementsAt("m.xacro", 7)).toEqual([]);
    expect(model.elementsAt("other", 4)).toEqual([]);
  });

  it("is listed according to folded links and the search text", () => {
    const state = new LinkTreeState();
    const listNames = (search = ""): string[] => listVisibleRows(model, state, search).map((row) => row.link.name);
    expect(listNames()).toEqual(["base", "right", "left", "tip"]);
    state.toggle("left");
    expect(listNames()).toEqual(["base", "right", "left"]);
    expect(listNames("FIX")).toEqual(["base", "left", "tip"]);
    expect(listNames("no such")).toEqual([]);
    state.reveal(model, "tip");
    expect(listNames()).toHaveLength(4);
  });

  it("is drawn as urdf_to_graphviz draws it", () => {
    const { nodes } = layOutDiagram(model, true, (text) => text.length * 7);
    const findNode = (name: string): (typeof nodes)[number] => nodes.find((node) => node.element.name === name)!;
    expect(nodes).toHaveLength(7);
    expect(findNode("turn").origin).toEqual(["xyz: 0 0 0.5", "rpy: 0 -0 1.5708"]);
    expect(findNode("left").parent).toBe(findNode("turn"));
    expect(findNode("turn").parent).toBe(findNode("base"));
    expect(findNode("lift").x).toBeLessThan(findNode("turn").x);
    expect(findNode("base").y).toBeLessThan(findNode("turn").y);
    expect(findNode("turn").y).toBeLessThan(findNode("left").y);
  });

  it("ignores a second joint that moves the same link, as urdfdom does", () => {
    const descriptionWithBoth = createDescription({ joints: [createJoint("a", "base", "left"), createJoint("turn", "base", "left")] });
    expect(new DescriptionModel(descriptionWithBoth).childJointsOf("base").map((joint) => joint.name)).toEqual(["turn"]);
  });
});

describe("numbers", () => {
  it("are formatted like those of C++ streams", () => {
    const values = [0, -0, 1, 0.1, -0.095, 1.5707963267948966, 123456, 1234567, 0.0001, 0.00001234, 1e-20, 1e21, 0.30000000000000004];
    expect(values.map(formatGeneral)).toEqual(
      "0 -0 1 0.1 -0.095 1.5708 123456 1.23457e+06 0.0001 1.234e-05 1e-20 1e+21 0.3".split(" "),
    );
  });
});

describe("the joint table", () => {
  const texts = {
    kinds: { revolute: "revolute", continuous: "", prismatic: "", fixed: "", floating: "", planar: "" },
    table: { damping: (value: string) => `d ${value}`, friction: (value: string) => `f ${value}` },
  };

  it("has units, with degrees on request", () => {
    const angles = new AngleUnits(openBrowserStorage());
    const joint = createJoint("a", "b", "c", { damping: 0.5, mimic: { joint: "m", multiplier: -1, offset: Math.PI / 2 } });
    expect(formatJointCells(joint, angles, texts)).toMatchObject({ lower: "-1 rad", effort: "4 N m", dynamics: "d 0.5", mimic: "−m + 1.571 rad" });
    angles.current = "deg";
    expect(formatJointCells(joint, angles, texts)).toMatchObject({ upper: "114.6 deg", velocity: "171.9 deg/s", mimic: "−m + 90 deg" });
    expect(formatJointCells({ ...joint, kind: "prismatic" }, angles, texts)).toMatchObject({ lower: "-1 m", effort: "4 N" });
  });

  it("sorts by number or name, with empty values last", () => {
    const joints = [
      createJoint("j10", "b", "c", { upper: null }),
      createJoint("j2", "b", "c", { upper: 1 }),
      createJoint("j1", "b", "c", { upper: 10 }),
    ];
    const listSortedNames = (column: "name" | "upper", isDescending = false): string[] =>
      sortJoints(joints, column, isDescending).map((joint) => joint.name);
    expect(listSortedNames("name")).toEqual(["j1", "j2", "j10"]);
    expect(listSortedNames("upper")).toEqual(["j2", "j1", "j10"]);
    expect(listSortedNames("upper", true)).toEqual(["j1", "j2", "j10"]);
  });
});

describe("the switches of invisible properties", () => {
  it("are stored, and invalid stored values are ignored", () => {
    const storage = openBrowserStorage();
    const state = new InspectState(storage);
    expect(state.isActive).toBe(false);
    state.set("joints", true);
    state.scale = 2;
    const again = new InspectState(storage);
    expect([again.current.joints, again.current.boxes, again.scale]).toEqual([true, false, 2]);
    storage.setItem("linkwright.inspect", '{"joints": 5, "scale": -1');
    expect(new InspectState(storage).isActive).toBe(false);
  });
});

describe("dragging a link", () => {
  const rayBetween = (start: Vector3, end: Vector3): Ray => new Ray(start, end.clone().sub(start).normalize());
  const z = new Vector3(0, 0, 1);

  it("rotates it so that the grabbed point stays under the pointer", () => {
    const eye = new Vector3(0, 0, 5);
    const grabbedPoint = new Vector3(1, 0, 0);
    for (const angle of [0.3, -0.7, 1.2]) {
      const ray = rayBetween(eye, new Vector3(Math.cos(angle), Math.sin(angle), 0));
      expect(computeTurnAngle(ray, z, new Vector3(), grabbedPoint, 0)).toBeCloseTo(angle, 4);
    }
  });

  it("continues over full turns, and works if the circle is seen edge-on", () => {
    const eye = new Vector3(0, 0, 5);
    let angle = 0;
    for (let i = 1; i <= 60; i++) {
      const pointerAngle = i * 0.2;
      const ray = rayBetween(eye, new Vector3(Math.cos(pointerAngle), Math.sin(pointerAngle), 0));
      angle = computeTurnAngle(ray, z, new Vector3(), new Vector3(1, 0, 0), angle);
    }
    expect(angle).toBeCloseTo(12, 3);
    const side = new Vector3(0, -5, 0);
    const edgeOnAngle = computeTurnAngle(rayBetween(side, new Vector3(0.5, 0, 0)), z, new Vector3(), new Vector3(0, -1, 0), 0);
    expect(edgeOnAngle).toBeGreaterThan(0.3);
    expect(edgeOnAngle).toBeLessThan(0.7);
  });

  it("moves it along its axis, and not at all where the pointer does not determine a position", () => {
    const x = new Vector3(1, 0, 0);
    const ray = rayBetween(new Vector3(0.4, -3, 2), new Vector3(0.4, 0, 0));
    expect(computeSlideDistance(ray, x, new Vector3(0.1, 0, 0))).toBeCloseTo(0.3, 6);
    expect(computeSlideDistance(new Ray(new Vector3(-5, 0, 0.1), x), x, new Vector3())).toBe(0);
  });
});
