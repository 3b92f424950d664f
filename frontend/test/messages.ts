import type { Display, Property, RobotScene, Tree } from "../src/protocol";

/** Messages of the server, with defaults for the fields that a test does not need. */
export function createProperty(part: Partial<Property> & Pick<Property, "id" | "name">): Property {
  return {
    kind: "float",
    value: null,
    description: "",
    options: [],
    minimum: null,
    maximum: null,
    read_only: false,
    expanded: false,
    children: [],
    details: null,
    topics: null,
    ...part,
  };
}

export function createDisplay(part: Partial<Display> & Pick<Display, "id">): Display {
  return {
    cls: "rviz_default_plugins/Grid",
    drawing: part.cls ?? "rviz_default_plugins/Grid",
    name: "Grid",
    group: null,
    enabled: true,
    supported: true,
    level: "ok",
    status: [],
    properties: [],
    ...part,
  };
}

export function createTree(...displays: Display[]): Tree {
  return {
    type: "tree",
    global_options: [
      createProperty({ id: "global/Fixed Frame", name: "Fixed Frame", kind: "frame", value: "base_link" }),
      createProperty({ id: "global/Frame Rate", name: "Frame Rate", kind: "int", value: 30 }),
    ],
    global_status: [],
    global_level: "ok",
    displays,
  };
}

export function createRobotScene(displayId: string, ...links: string[]): RobotScene {
  return {
    type: "robot_scene",
    display: displayId,
    revision: 1,
    name: "mbot",
    joints: [],
    links: links.map((name) => ({
      name,
      frame: name,
      parent_joint: null,
      visuals: [],
      collisions: [],
      inertia: null,
      place: { file: "mbot.urdf", line: 3, column: 5, trail: [] },
    })),
  };
}

/** Packs a binary frame like `pack_transforms` of page/protocol/message.py. */
export function packTransforms(revision: number, poses: readonly (readonly number[])[], ages: readonly number[]): ArrayBuffer {
  const buffer = new ArrayBuffer(24 + poses.length * 32);
  const view = new DataView(buffer);
  view.setUint32(0, 1, true);
  view.setUint32(4, revision, true);
  view.setUint32(8, poses.length, true);
  view.setFloat64(16, 12.5, true);
  poses.flat().forEach((value, i) => view.setFloat32(24 + i * 4, value, true));
  ages.forEach((value, i) => view.setFloat32(24 + poses.length * 28 + i * 4, value, true));
  return buffer;
}
