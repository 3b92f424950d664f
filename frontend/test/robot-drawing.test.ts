import { Box3, PerspectiveCamera, Raycaster, Vector3 } from "three";
import { describe, expect, it, vi } from "vitest";
import type { LinkScene, Shape } from "../src/protocol";
import { PICKABLE } from "../src/scene/layers";
import { MeshLibrary } from "../src/scene/meshes/mesh-library";
import { framePose } from "../src/scene/pose";
import { RobotDrawing } from "../src/scene/robot/robot-drawing";
import { FrameStore } from "../src/state/frames";
import { MeshProgress } from "../src/state/mesh-progress";
import { PropertyNode, PropertyRows } from "../src/state/properties";
import { createProperty } from "./messages";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

const meshes = new MeshLibrary(new MeshProgress());

function shape(part: Partial<Shape> & Pick<Shape, "kind" | "size">): Shape {
  return {
    position: [0, 0, 0],
    quaternion: [0, 0, 0, 1],
    color: [0, 0, 1, 1],
    texture: null,
    url: null,
    format: null,
    name: "",
    repaints: false,
    submesh: null,
    outlines: [],
    heights: null,
    columns: 0,
    surface: null,
    ...part,
  };
}

function link(name: string, ...visuals: Shape[]): LinkScene {
  return { name, frame: name, parent_joint: null, visuals, collisions: [], place: null, inertia: null };
}

/** Returns a robot whose links are in a row along y, one meter apart. */
function robot(links: LinkScene[]): { drawing: RobotDrawing; frames: FrameStore } {
  const frames = new FrameStore();
  const names = links.map(({ name }) => name);
  frames.setTable({ type: "frame_table", revision: 1, names, parents: names.map(() => -1) });
  const poses = new Float32Array(links.flatMap((_, row) => [0, row, 0, 0, 0, 0, 1]));
  frames.setTransforms({ revision: 1, stamp: 0, poses, ages: new Float32Array(links.length) });
  const scene = { type: "robot_scene" as const, display: "1", revision: 1, name: "row", links, joints: [] };
  const drawing = new RobotDrawing(scene, meshes, () => undefined, () => undefined);
  return { drawing, frames };
}

function draw({ drawing, frames }: ReturnType<typeof robot>, rows = new PropertyRows([])): Record<string, unknown> {
  drawing.applyStyle(rows, false);
  drawing.updatePoses((each, matrix) => framePose(frames, frames.rowOf(each.frame), matrix));
  drawing.chooseDetail(from(5));
  return drawing.inspect() as Record<string, unknown>;
}

/** Returns a camera that looks at the row from this many meters in front of it. */
function from(distance: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(45, 1, 0.01, 100);
  camera.position.set(distance, 0, 0);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld(true);
  return camera;
}

const ROW = [
  link("box", shape({ kind: "box", size: [0.2, 0.4, 0.6], position: [1, 0, 0] })),
  link("glass", shape({ kind: "box", size: [1, 1, 1], color: [1, 1, 1, 0.5] })),
  link("can", shape({ kind: "cylinder", size: [0.1, 0.5] }), shape({ kind: "sphere", size: [0.3] })),
  link("pill", shape({ kind: "capsule", size: [0.1, 0.5] })),
];

describe("RobotDrawing", () => {
  it("batches solid shapes at the poses of their links", () => {
    const row = robot(ROW);
    expect(draw(row)["drawnTogether"]).toBe(3);
    const box = new Box3();
    row.drawing.root.traverse((object) => {
      if (object.parent === row.drawing.root && "computeBoundingBox" in object) box.union(new Box3().setFromObject(object));
    });
    const round = (vector: Vector3): number[] => vector.toArray().map((each) => Math.round(each * 100) / 100);
    expect(round(box.min)).toEqual([-0.3, -0.2, -0.3]);
    expect(round(box.max)).toEqual([1.1, 2.3, 0.3]);
  });

  it("draws spheres with few vertices while they look small", () => {
    const row = robot([link("balls", shape({ kind: "sphere", size: [0.3] }), shape({ kind: "sphere", size: [3] }))]);
    const small = (distance: number): unknown => {
      row.drawing.chooseDetail(from(distance));
      return (row.drawing.inspect() as Record<string, unknown>)["smallSpheres"];
    };
    draw(row);
    expect([2, 20, 90, 20, 0.1].map(small)).toEqual([0, 1, 2, 1, 0]);
    expect(draw(row)["drawnTogether"]).toBe(2);
  });

  it("does not batch shapes that are translucent, lack a transform or are switched off", () => {
    const row = robot(ROW);
    const rows = (name: string, value: number | boolean): PropertyRows => {
      return new PropertyRows([new PropertyNode(createProperty({ id: name, name, value }))]);
    };
    expect(draw(row, rows("Alpha", 0.5))["drawnTogether"]).toBe(0);
    expect(draw(row, rows("Visual Enabled", false))["drawnTogether"]).toBe(0);
    expect(draw(row)["drawnTogether"]).toBe(3);
    row.frames.setTable({ type: "frame_table", revision: 2, names: ["can"], parents: [-1] });
    expect(draw(row)["drawnTogether"]).toBe(2);
  });

  it("measures its visible parts, or the extent of its links if nothing is visible", () => {
    const row = robot(ROW);
    draw(row);
    expect(row.drawing.progress).toEqual({ posed: 4, loading: 0 });
    expect(row.drawing.bounds().max.toArray()).toEqual([1.1, expect.closeTo(3.1), 0.5]);
    draw(row, new PropertyRows([new PropertyNode(createProperty({ id: "v", name: "Visual Enabled", value: false }))]));
    expect(row.drawing.bounds().max.toArray()).toEqual([0, 3, 0]);
  });

  it("has a pose with that of a link with visuals, or of any link if none has visuals or none is visible", () => {
    const bare = robot([link("base"), link("tip")]);
    expect(bare.drawing.hasPose).toBe(false);
    draw(bare);
    expect(bare.drawing.hasPose).toBe(true);

    const hidden = robot(ROW);
    draw(hidden, new PropertyRows([new PropertyNode(createProperty({ id: "v", name: "Visual Enabled", value: false }))]));
    expect(hidden.drawing.hasPose).toBe(true);

    const { drawing, frames } = robot([link("footprint"), ...ROW]);
    frames.setTable({ type: "frame_table", revision: 2, names: ["footprint"], parents: [-1] });
    frames.setTransforms({ revision: 2, stamp: 0, poses: new Float32Array([0, 0, 0, 0, 0, 0, 1]), ages: new Float32Array(1) });
    draw({ drawing, frames });
    expect(drawing.progress.posed).toBe(1);
    expect(drawing.hasPose).toBe(false);
  });

  it("is hit by rays in its batches, and is seen by cameras once", () => {
    const row = robot(ROW);
    draw(row);
    row.drawing.root.updateMatrixWorld(true);
    const ray = new Raycaster(new Vector3(5, 0, 0), new Vector3(-1, 0, 0));
    expect(row.drawing.pick(ray)).toBeNull();
    ray.layers.enable(PICKABLE);
    const hit = row.drawing.pick(ray);
    expect(hit?.key).toBe("box");
    expect(hit?.point.x).toBeCloseTo(1.1);
    const [mesh] = row.drawing.objectsOf("box");
    expect(mesh?.layers.isEnabled(0)).toBe(false);
    expect(row.drawing.objectsOf("pill")[0]?.layers.isEnabled(0)).toBe(true);
  });
});
