import { beforeAll, describe, expect, it, vi } from "vitest";
import type { DisplayData } from "../src/connection/data";
import { Connection } from "../src/connection/connection";
import type { MarkerShape, MotionPlanningState } from "../src/protocol";
import type { DrawingContext } from "../src/scene/displays/drawing";
import type { MotionPlanningDrawing } from "../src/scene/displays/motion-planning";
import { DisplayDataStore } from "../src/state/display-data";
import { DisplaysState } from "../src/state/displays";
import { MotionPlanning } from "../src/state/motion-planning";
import { createDisplay, createTree } from "./messages";

function createContent(key: string, content: object, display = "display-1"): DisplayData {
  return { display, key, frame: "", stamp: 0, pose: null, content } as unknown as DisplayData;
}

function createMarker(id: string, shape: string): MarkerShape {
  const marker = { id, namespace: "", frame: "", shape, pose: [0, 0, 0, 0, 0, 0, 1], scale: [1, 1, 1], color: [1, 0.5, 0, 1], points: new Float32Array(0), colors: new Float32Array(0), mesh: null };
  return marker as unknown as MarkerShape;
}

function createHandle(name: string): DisplayData {
  const control = { name: "ball", description: "", mode: "move_3d", orientation_mode: "inherit", orientation: [0, 0, 0, 1], always_visible: false, independent_orientation: false, markers: [createMarker(`${name}/ball/0`, "sphere")] };
  return createContent(`marker ${name}`, { kind: "interactive_marker", name, description: "", pose: [0, 0, 0, 0, 0, 0, 1], scale: 1, controls: [control], menu: [] });
}

interface Inspected {
  markers: Record<string, string>;
  handles: Record<string, { wrong: boolean }>;
}

let createFor: (context: DrawingContext) => MotionPlanningDrawing;

beforeAll(async () => {
  vi.stubGlobal("navigator", { language: "en", languages: ["en"] }); // the texts of the page choose its language when they are loaded
  const { MotionPlanningDrawing: DrawingClass } = await import("../src/scene/displays/motion-planning");
  createFor = (context) => new DrawingClass(context);
});

function createDrawing(): MotionPlanningDrawing {
  const rows = { find: () => null, bool: (value: boolean) => value };
  return createFor({ display: { id: "display-1", rows }, invalidate: () => undefined } as unknown as DrawingContext);
}

describe("the drawing of MotionPlanning", () => {
  const inspect = (drawing: MotionPlanningDrawing): Inspected => drawing.inspect() as Inspected;

  it("keeps the markers when a handle is removed", () => {
    const drawing = createDrawing();
    drawing.onDataChanged(createContent("", { kind: "markers_changed", everything: false, removed_ids: [], markers: [createMarker("Goal State/hand", "cube")] }));
    drawing.onDataChanged(createHandle("goal tip"));
    expect(Object.keys(inspect(drawing).handles)).toEqual(["goal tip"]);
    drawing.onDataRemoved("pose goal tip");
    drawing.onDataRemoved("marker goal tip");
    expect(inspect(drawing)).toMatchObject({ markers: { "Goal State/hand": "cube" }, handles: {} });
    drawing.onDataRemoved(null);
    expect(inspect(drawing).markers).toEqual({});
    drawing.dispose();
  });

  it("marks handles at poses that cannot be reached", () => {
    const drawing = createDrawing();
    drawing.onDataChanged(createHandle("goal tip"));
    drawing.onDataChanged(createContent("planning", { kind: "motion_planning_state", unreachable: ["goal tip"] }));
    expect(inspect(drawing).handles["goal tip"]?.wrong).toBe(true);
    drawing.onDataChanged(createContent("planning", { kind: "motion_planning_state", unreachable: [] }));
    expect(inspect(drawing).handles["goal tip"]?.wrong).toBe(false);
    drawing.dispose();
  });
});

describe("the state of the MotionPlanning panel", () => {
  it("is that of the first enabled display with planning groups", () => {
    const connection = new Connection("ws://localhost/ws");
    const send = vi.spyOn(connection, "send").mockImplementation(() => undefined);
    const displays = new DisplaysState();
    const planning = new MotionPlanning(connection, new DisplayDataStore(connection), displays);
    let announcedCount = 0;
    planning.availabilityChanged.on(() => (announcedCount += 1));
    const receive = (display: string, group: string): void => connection.data.emit(createContent("planning", { kind: "motion_planning_state", group, links: [] }, display));
    displays.setTree(createTree(createDisplay({ id: "display-1", enabled: true }), createDisplay({ id: "display-2", enabled: true })));
    receive("display-1", "");
    planning.send({ type: "command_motion", command: "plan" });
    expect([planning.isAvailable, announcedCount, send.mock.calls.length]).toEqual([false, 0, 0]);
    receive("display-2", "arm");
    receive("display-2", "gripper");
    expect([planning.displayId, (planning.current as MotionPlanningState).group, announcedCount]).toEqual(["display-2", "gripper", 1]);
    planning.send({ type: "command_motion", command: "plan" });
    planning.setProperty("MoveIt_Planning_Time", 2);
    expect(send.mock.calls).toEqual([
      [{ type: "command_motion", command: "plan", display: "display-2" }],
      [{ type: "set_property", id: "display-2/MoveIt_Planning_Time", value: 2 }],
    ]);
    displays.setTree(createTree(createDisplay({ id: "display-1", enabled: true })));
    expect([planning.isAvailable, announcedCount]).toEqual([false, 2]);
  });

  it("names the robot whose motions are planned", () => {
    const connection = new Connection("ws://localhost/ws");
    const displays = new DisplaysState();
    const planning = new MotionPlanning(connection, new DisplayDataStore(connection), displays);
    const seen: unknown[] = [];
    planning.robotChanged.on(() => seen.push(planning.robot));
    const receive = (robot: string, links: string[], goal: string): void =>
      connection.data.emit(createContent("planning", { kind: "motion_planning_state", group: "", robot, links, goal }));
    displays.setTree(createTree(createDisplay({ id: "display-1", enabled: true })));
    receive("", [], "");
    receive("crane", ["base", "hook"], "");
    receive("crane", ["base", "hook"], "home");
    displays.setTree(createTree());
    expect(seen.slice(-2)).toEqual([{ name: "crane", linkCount: 2 }, null]);
    expect(seen.filter((robot) => robot !== null)).toHaveLength(1);
  });
});
