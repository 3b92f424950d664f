import { Box3, PerspectiveCamera, Raycaster, Vector3 } from "three";
import { describe, expect, it, vi } from "vitest";
import type { LinkScene, Shape } from "../src/protocol";
import { PICKABLE_LAYER } from "../src/scene/layers";
import { MeshLibrary } from "../src/scene/meshes/mesh-library";
import { readFramePose } from "../src/scene/pose";
import { RobotDrawing } from "../src/scene/robot/robot-drawing";
import { FrameStore } from "../src/state/frames";
import { MeshProgress } from "../src/state/mesh-progress";
import { PropertyNode, PropertyRows } from "../src/state/properties";
import { createProperty } from "./messages";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

const meshes = new MeshLibrary(new MeshProgress());

function createShape(part: Partial<Shape> & Pick<Shape, "kind" | "size">): Shape {
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

function createLink(name: string, ...visuals: Shape[]): LinkScene {
  return { name, frame: name, parent_joint: null, visuals, collisions: [], place: null, inertia: null };
}

/** Returns a robot whose links are in a row along y, one meter apart. */
function createRobot(links: LinkScene[]): { drawing: RobotDrawing; frames: FrameStore } {
  const frames = new FrameStore();
  const names = links.map(({ name }) => name);
  frames.setTable({ type: "frame_table", revision: 1, names, parents: names.map(() => -1) });
  const poses = new Float32Array(links.flatMap((_, row) => [0, row, 0, 0, 0, 0, 1]));
  frames.setTransforms({ revision: 1, stamp: 0, poses, ages: new Float32Array(links.length) });
  const scene = { type: "robot_scene" as const, display: "1", revision: 1, name: "row", links, joints: [] };
  const drawing = new RobotDrawing(scene, meshes, () => undefined, () => undefined);
  return { drawing, frames };
}

function draw({ drawing, frames }: ReturnType<typeof createRobot>, rows = new PropertyRows([])): Record<string, unknown> {
  drawing.applyStyle(rows, false);
  drawing.updatePoses((link, matrix) => readFramePose(frames, frames.rowOf(link.frame), matrix));
  drawing.chooseDetail(cameraAt(5));
  return drawing.inspect() as Record<string, unknown>;
}

/** Returns a camera that looks at the row from this many meters in front of it. */
function cameraAt(distance: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(45, 1, 0.01, 100);
  camera.position.set(distance, 0, 0);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld(true);
  return camera;
}

const ROW = [
  createLink("box", createShape({ kind: "box", size: [0.2, 0.4, 0.6], position: [1, 0, 0] })),
  createLink("glass", createShape({ kind: "box", size: [1, 1, 1], color: [1, 1, 1, 0.5] })),
  createLink("can", createShape({ kind: "cylinder", size: [0.1, 0.5] }), createShape({ kind: "sphere", size: [0.3] })),
  createLink("pill", createShape({ kind: "capsule", size: [0.1, 0.5] })),
];

describe("RobotDrawing", () => {
  it("batches solid shapes at the poses of their links", () => {
    const row = createRobot(ROW);
    expect(draw(row)["drawnTogether"]).toBe(3);
    const box = new Box3();
    row.drawing.root.traverse((object) => {
      if (object.parent === row.drawing.root && "computeBoundingBox" in object) box.union(new Box3().setFromObject(object));
    });
    const round = (vector: Vector3): number[] => vector.toArray().map((value) => Math.round(value * 100) / 100);
    expect(round(box.min)).toEqual([-0.3, -0.2, -0.3]);
    expect(round(box.max)).toEqual([1.1, 2.3, 0.3]);
  });

  it("draws spheres with few vertices while they look small", () => {
    const row = createRobot([createLink("balls", createShape({ kind: "sphere", size: [0.3] }), createShape({ kind: "sphere", size: [3] }))]);
    const countSmallSpheres = (distance: number): unknown => {
      row.drawing.chooseDetail(cameraAt(distance));
      return (row.drawing.inspect() as Record<string, unknown>)["smallSpheres"];
    };
    draw(row);
    expect([2, 20, 90, 20, 0.1].map(countSmallSpheres)).toEqual([0, 1, 2, 1, 0]);
    expect(draw(row)["drawnTogether"]).toBe(2);
  });

  it("does not batch shapes that are translucent, lack a transform or are switched off", () => {
    const row = createRobot(ROW);
    const createRows = (name: string, value: number | boolean): PropertyRows => {
      return new PropertyRows([new PropertyNode(createProperty({ id: name, name, value }))]);
    };
    expect(draw(row, createRows("Alpha", 0.5))["drawnTogether"]).toBe(0);
    expect(draw(row, createRows("Visual Enabled", false))["drawnTogether"]).toBe(0);
    expect(draw(row)["drawnTogether"]).toBe(3);
    row.frames.setTable({ type: "frame_table", revision: 2, names: ["can"], parents: [-1] });
    expect(draw(row)["drawnTogether"]).toBe(2);
  });

  it("measures its visible parts, or the extent of its links if nothing is visible", () => {
    const row = createRobot(ROW);
    draw(row);
    expect(row.drawing.progress).toEqual({ posed: 4, loading: 0 });
    expect(row.drawing.computeBounds().max.toArray()).toEqual([1.1, expect.closeTo(3.1), 0.5]);
    draw(row, new PropertyRows([new PropertyNode(createProperty({ id: "v", name: "Visual Enabled", value: false }))]));
    expect(row.drawing.computeBounds().max.toArray()).toEqual([0, 3, 0]);
  });

  it("has a pose with that of a link with visuals, or of any link if none has visuals or none is visible", () => {
    const bareRobot = createRobot([createLink("base"), createLink("tip")]);
    expect(bareRobot.drawing.hasPose).toBe(false);
    draw(bareRobot);
    expect(bareRobot.drawing.hasPose).toBe(true);

    const hiddenRobot = createRobot(ROW);
    draw(hiddenRobot, new PropertyRows([new PropertyNode(createProperty({ id: "v", name: "Visual Enabled", value: false }))]));
    expect(hiddenRobot.drawing.hasPose).toBe(true);

    const { drawing, frames } = createRobot([createLink("footprint"), ...ROW]);
    frames.setTable({ type: "frame_table", revision: 2, names: ["footprint"], parents: [-1] });
    frames.setTransforms({ revision: 2, stamp: 0, poses: new Float32Array([0, 0, 0, 0, 0, 0, 1]), ages: new Float32Array(1) });
    draw({ drawing, frames });
    expect(drawing.progress.posed).toBe(1);
    expect(drawing.hasPose).toBe(false);
  });

  it("is hit by rays in its batches, and is seen by cameras once", () => {
    const row = createRobot(ROW);
    draw(row);
    row.drawing.root.updateMatrixWorld(true);
    const ray = new Raycaster(new Vector3(5, 0, 0), new Vector3(-1, 0, 0));
    expect(row.drawing.pick(ray)).toBeNull();
    ray.layers.enable(PICKABLE_LAYER);
    const hit = row.drawing.pick(ray);
    expect(hit?.key).toBe("box");
    expect(hit?.point.x).toBeCloseTo(1.1);
    const [mesh] = row.drawing.objectsOf("box");
    expect(mesh?.layers.isEnabled(0)).toBe(false);
    expect(row.drawing.objectsOf("pill")[0]?.layers.isEnabled(0)).toBe(true);
  });
});
