import { Box3, Matrix4, Vector3, type Raycaster } from "three";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { setInitialView, type InitialViewWorld } from "../src/scene/initial-view";
import { Session } from "../src/state/session";
import type { ViewState } from "../src/state/view";
import { distanceBetween, type Vector } from "../src/state/views/vector";

const VALUES = { Distance: 5, Yaw: 0.785398, Pitch: 0.5, "Focal Point/X": 0, "Focal Point/Y": 0, "Focal Point/Z": 0 };
const SIZE = { width: 800, height: 600 };
const ROBOT = new Box3(new Vector3(4, -0.2, 0), new Vector3(4.4, 0.2, 0.3));
const HALL = new Box3(new Vector3(-20, -10, 0), new Vector3(20, 10, 3));

/** The view of a page whose server says whether a user has placed the camera. */
function viewOf(isFree: boolean): ViewState {
  const connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation(() => true);
  const { view } = new Session(connection);
  const state = { cls: "rviz_default_plugins/Orbit", name: "Current View", values: { ...VALUES } };
  connection.message.emit({ type: "view_state", view: state, revision: 1, whole_robot: isFree });
  return view;
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("window", { setTimeout });
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

/** A hall with or without a robot; at each of these x is a wall of this height, infinite along y. */
class Hall implements InitialViewWorld {
  camera: Matrix4 | null = null;
  constructor(
    public hasRobots: boolean,
    private readonly walls: readonly (readonly [x: number, height: number])[] = [],
  ) {}

  hasFallen = false;

  computeBoundsByKind(): { robots: Box3; world: Box3 } {
    return { robots: this.hasRobots && !this.hasFallen ? ROBOT : new Box3(), world: HALL };
  }

  readCameraOfFile(): Matrix4 | null {
    return this.camera;
  }

  isClear({ ray: { origin, direction }, far }: Raycaster): boolean {
    return !this.walls.some(([x, height]) => {
      const distance = (x - origin.x) / direction.x;
      return distance > 0 && distance < far && origin.z + distance * direction.z < height;
    });
  }

  pick({ ray }: Raycaster): { distance: number } | null {
    return ray.direction.x > 0.9 ? { distance: 3 } : null;
  }
}

describe("the initial view of a world", () => {
  it("shows the whole world until there is a robot, then the robot with its surroundings, and stays there", () => {
    const view = viewOf(true);
    const hall = new Hall(false);
    setInitialView(hall, view, SIZE);
    expect(view.camera.focal).toEqual([0, 0, 1.5]);
    expect(view.values["Distance"]).toBeGreaterThan(40);
    hall.hasRobots = true;
    setInitialView(hall, view, SIZE);
    expect(view.camera.focal?.[0]).toBeCloseTo(4.2);
    expect(view.values["Distance"]).toBeGreaterThan(3);
    expect(view.values["Distance"]).toBeLessThan(6);
    expect(view.values["Pitch"]).toBe(0.5);
    view.update({ Distance: 1 });
    setInitialView(hall, view, SIZE);
    expect(view.values["Distance"]).toBe(1);
  });

  it("shows the whole world, once, if the robot has fallen out of it", () => {
    const view = viewOf(true);
    const hall = new Hall(true);
    hall.hasFallen = true;
    setInitialView(hall, view, SIZE);
    expect(view.camera.focal).toEqual([0, 0, 1.5]);
    hall.hasFallen = false;
    setInitialView(hall, view, SIZE);
    expect(view.camera.focal).toEqual([0, 0, 1.5]);
  });

  it("does not move a camera that a file or user has placed", () => {
    const fileView = viewOf(false);
    setInitialView(new Hall(true), fileView, SIZE);
    expect(fileView.values).toEqual(VALUES);
    const userView = viewOf(true);
    userView.update({ Yaw: 3 });
    setInitialView(new Hall(true), userView, SIZE);
    expect(userView.values).toEqual({ ...VALUES, Yaw: 3 });
  });

  it("chooses another side, a higher or a nearer viewpoint if walls hide the robot", () => {
    const chooseViewpoint = (walls: readonly (readonly [number, number])[]): Vector => {
      const view = viewOf(true);
      setInitialView(new Hall(true, walls), view, SIZE);
      return view.camera.position;
    };
    const freePosition = chooseViewpoint([]);
    expect(freePosition[0]).toBeGreaterThan(5);
    expect(chooseViewpoint([[5.5, 9]])[0]).toBeLessThan(4.2);
    expect(chooseViewpoint([[5.5, 2], [3, 2]])[2]).toBeGreaterThan(freePosition[2] + 1);
    const positionBetween = chooseViewpoint([[4.7, 99], [3.7, 99]]);
    expect(distanceBetween(positionBetween, [4.2, 0, 0.15])).toBeLessThan(distanceBetween(freePosition, [4.2, 0, 0.15]));
    expect(positionBetween[0]).toBeGreaterThan(3.7);
    expect(positionBetween[0]).toBeLessThan(4.7);
  });

  it("is the camera of the world's file, with or without robots", () => {
    const view = viewOf(true);
    const hall = new Hall(true);
    hall.camera = new Matrix4().setPosition(1, 2, 3);
    setInitialView(hall, view, SIZE);
    expect(view.camera.position.map((value) => Math.round(value * 1e6) / 1e6)).toEqual([1, 2, 3]);
    expect(view.camera.focal?.map((value) => Math.round(value * 1e6) / 1e6)).toEqual([4, 2, 3]);
  });
});
