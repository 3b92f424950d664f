import { Quaternion, Ray, Vector3 } from "three";
import { describe, expect, test } from "vitest";
import { computeDistanceAlongAxis, Drag, computeRotationBetween, type DragEvent } from "../src/scene/interactive/dragging";

const START = { position: new Vector3(1, 2, 3), orientation: new Quaternion() };
const NO_ROTATION = new Quaternion();
/** The control's axis, x, rotated to z. */
const TO_Z = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -Math.PI / 2);

/** Returns a ray from high above straight down to a point of the ground. */
function createEvent(x: number, y: number, part: Partial<DragEvent> = {}): DragEvent {
  return {
    ray: new Ray(new Vector3(x, y, 10), new Vector3(0, 0, -1)),
    dx: 0,
    dy: 0,
    isShiftDown: false,
    isCtrlDown: false,
    right: new Vector3(1, 0, 0),
    up: new Vector3(0, 1, 0),
    forward: new Vector3(0, 0, -1),
    ...part,
  };
}

function expectPosition(drag: Drag, event: DragEvent, ...expectedPosition: [number, number, number]): void {
  const pose = drag.followPointer(event);
  expect(pose?.position.toArray().map((value) => Number(value.toFixed(6)) + 0)).toEqual(expectedPosition);
}

describe("moving", () => {
  test("along an axis follows the component of the mouse motion along it", () => {
    const drag = new Drag("move_axis", START, new Vector3(1.5, 2, 3), NO_ROTATION);
    expectPosition(drag, createEvent(4.5, 7), 4, 2, 3);
    expectPosition(drag, createEvent(1.5, -7), 1, 2, 3);
  });

  test("along an axis in the line of sight has no result", () => {
    expect(new Drag("move_axis", START, START.position, TO_Z).followPointer(createEvent(5, 5))).toBeNull();
  });

  test("in a plane keeps the grabbed point under the mouse", () => {
    const drag = new Drag("move_plane", START, new Vector3(2, 2, 3), TO_Z);
    expectPosition(drag, createEvent(5, 1), 4, 1, 3);
  });

  test("in a plane seen edge-on has no result", () => {
    expect(new Drag("move_plane", START, START.position, NO_ROTATION).followPointer(createEvent(5, 5))).toBeNull();
  });

  test("without constraint moves in the plane that faces the viewer, or with Shift along the line of sight", () => {
    const drag = new Drag("move_3d", START, START.position, NO_ROTATION);
    expectPosition(drag, createEvent(3, 3), 3, 3, 3);
    const pose = drag.followPointer(createEvent(3, 3, { isShiftDown: true, dy: 10 }));
    expect(pose?.position.x).toBeCloseTo(3);
    expect(pose?.position.z).toBeGreaterThan(3);
  });
});

describe("rotating", () => {
  test("about an axis follows the mouse around it", () => {
    const drag = new Drag("rotate_axis", START, new Vector3(2, 2, 3), TO_Z);
    const pose = drag.followPointer(createEvent(1, 5));
    expect(pose?.position).toEqual(START.position);
    const direction = new Vector3(1, 0, 0).applyQuaternion(pose?.orientation ?? NO_ROTATION);
    expect(direction.toArray().map((value) => Math.round(value * 1e6) / 1e6 + 0)).toEqual([0, 1, 0]);
  });

  test("combined with moving follows like a cart, with the grabbed point under the mouse", () => {
    const drag = new Drag("move_rotate", START, new Vector3(2, 2, 3), TO_Z);
    expectPosition(drag, createEvent(4, 2), 3, 2, 3);
    expectPosition(drag, createEvent(3, 4), 3, 3, 3);
  });

  test("without constraint makes a full turn per 300 pixels", () => {
    const drag = new Drag("rotate_3d", START, START.position, NO_ROTATION);
    const pose = drag.followPointer(createEvent(0, 0, { dx: 75 }));
    const direction = new Vector3(0, 0, 1).applyQuaternion(pose?.orientation ?? NO_ROTATION);
    expect(direction.x).toBeCloseTo(1);
  });
});

test("buttons and menus do not move", () => {
  for (const mode of ["none", "button", "menu"] as const) {
    expect(new Drag(mode, START, START.position, NO_ROTATION).followPointer(createEvent(5, 5))).toBeNull();
  }
});

test("the nearest point of an axis to a line", () => {
  const ray = new Ray(new Vector3(3, -5, 1), new Vector3(0, 1, 0));
  expect(computeDistanceAlongAxis(ray, new Vector3(1, 0, 0), new Vector3(1, 0, 0))).toBeCloseTo(2);
});

test("the rotation between two directions keeps the sign of the axis", () => {
  const rotation = computeRotationBetween(new Vector3(1, 0, 5), new Vector3(0, -1, 2), new Vector3(0, 0, 1));
  expect(new Vector3(1, 0, 0).applyQuaternion(rotation).y).toBeCloseTo(-1);
});
