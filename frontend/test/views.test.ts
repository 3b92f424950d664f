import { describe, expect, it } from "vitest";
import { FIELD_OF_VIEW_RAD, intersectGround, castRay, type Camera } from "../src/state/views/camera";
import { controllerOf } from "../src/state/views/catalog";
import { transformBounds } from "../src/state/views/fit";
import type { Drag, ViewController, ViewValues } from "../src/state/views/view-controller";
import type { Vector } from "../src/state/views/vector";

const SIZE = { width: 800, height: 600 };
const ORBIT = controllerNamed("Orbit");
const GROUND = controllerNamed("XYOrbit");
const FLY = controllerNamed("FPS");
const MAP = controllerNamed("TopDownOrtho");
const FOCUSED: ViewValues = { Distance: 2, Yaw: 5.5, Pitch: 0.33, "Focal Point/X": 1, "Focal Point/Y": 2, "Focal Point/Z": 3 };

function controllerNamed(name: string): ViewController {
  return controllerOf(`rviz_default_plugins/${name}`);
}

function createDrag(part: Partial<Drag>): Drag {
  return { ...SIZE, isLeftDown: false, isMiddleDown: false, isRightDown: false, isShiftDown: false, x: 400, y: 300, dx: 0, dy: 0, ...part };
}

function expectClose(actual: readonly number[], expectedValues: readonly number[], digits = 6): void {
  expectedValues.forEach((value, i) => expect(actual[i]).toBeCloseTo(value, digits));
}

function createSource(cls: string, values: ViewValues): { cls: string; values: ViewValues; camera: Camera } {
  return { cls: `rviz_default_plugins/${cls}`, values, camera: controllerNamed(cls).computeCamera(values) };
}

function forwardOf({ back }: Camera): Vector {
  return [-back[0], -back[1], -back[2]];
}

/** Returns the position of a point on the screen: right and up from the center, per meter of depth. */
function projectPoint(camera: Camera, point: Vector): [number, number] {
  const offset = point.map((value, i) => value - (camera.position[i] ?? 0));
  const componentAlong = (axis: Vector): number => axis.reduce((sum, value, i) => sum + value * (offset[i] ?? 0), 0);
  const depth = -componentAlong(camera.back);
  return [componentAlong(camera.right) / depth, componentAlong(camera.up) / depth];
}

describe("every view", () => {
  it("has right-handed unit axes", () => {
    for (const [name, values] of [["Orbit", FOCUSED], ["XYOrbit", FOCUSED], ["FPS", { Yaw: 1, Pitch: -0.4 }], ["TopDownOrtho", { Angle: 0.7 }]] as const) {
      const { right, up, back } = controllerNamed(name).computeCamera(values);
      for (const axis of [right, up, back]) expect(Math.hypot(...axis)).toBeCloseTo(1);
      expectClose(right, [up[1] * back[2] - up[2] * back[1], up[2] * back[0] - up[0] * back[2], up[0] * back[1] - up[1] * back[0]]);
    }
  });

  it("changes nothing while no button is pressed", () => {
    for (const name of ["Orbit", "XYOrbit", "FPS", "TopDownOrtho"]) {
      for (const isShiftHeld of [false, true]) {
        expect(controllerNamed(name).drag(FOCUSED, createDrag({ dx: 10, dy: 10, isShiftDown: isShiftHeld })), name).toEqual({});
      }
    }
  });
});

describe("Orbit", () => {
  it("has the pose of RViz's formula, and is upside down with Invert Z", () => {
    const [x, y, z] = ORBIT.computeCamera(FOCUSED).position;
    expectClose([x, y, z], [1 + 2 * Math.cos(5.5) * Math.cos(0.33), 2 + 2 * Math.sin(5.5) * Math.cos(0.33), 3 + 2 * Math.sin(0.33)]);
    const inverted = ORBIT.computeCamera({ ...FOCUSED, "Invert Z Axis": true });
    expect(inverted.position[2]).toBeCloseTo(3 - 2 * Math.sin(0.33));
    expect(inverted.up[2]).toBeLessThan(0);
  });

  it("rotates 0.005 rad per pixel, wraps the yaw and stops the pitch before the pole", () => {
    const rotated = ORBIT.drag(FOCUSED, createDrag({ isLeftDown: true, dx: 10, dy: 4 }));
    expectClose([Number(rotated["Yaw"]), Number(rotated["Pitch"])], [5.45, 0.35]);
    expect(ORBIT.drag({ ...FOCUSED, Yaw: 0.01 }, createDrag({ isLeftDown: true, dx: 4 }))["Yaw"]).toBeCloseTo(2 * Math.PI - 0.01);
    const limit = Math.PI / 2 - 0.001;
    expect(ORBIT.drag(FOCUSED, createDrag({ isLeftDown: true, dy: 10_000 }))["Pitch"]).toBeCloseTo(limit);
    expect(ORBIT.drag(FOCUSED, createDrag({ isLeftDown: true, dy: -10_000 }))["Pitch"]).toBeCloseTo(-limit);
  });

  it("pans so that the focal plane follows the pointer", () => {
    const change = ORBIT.drag(FOCUSED, createDrag({ isMiddleDown: true, dy: SIZE.height }));
    const motion = ["X", "Y", "Z"].map((axis) => Number(change[`Focal Point/${axis}`]) - Number(FOCUSED[`Focal Point/${axis}`]));
    expect(Math.hypot(...motion)).toBeCloseTo(2 * 2 * Math.tan(FIELD_OF_VIEW_RAD / 2));
    expect(ORBIT.drag(FOCUSED, createDrag({ isLeftDown: true, isShiftDown: true, dy: SIZE.height }))).toEqual(change);
  });

  it("zooms 12 % per notch, and a hundredth of the distance per pixel with the right button", () => {
    expect(ORBIT.applyWheel(FOCUSED, 120, false)["Distance"]).toBeCloseTo(2 * 0.88);
    expect(ORBIT.drag(FOCUSED, createDrag({ isRightDown: true, dy: 10 }))["Distance"]).toBeCloseTo(2 * 1.1);
    expect(ORBIT.applyWheel(FOCUSED, 1e6, false)["Distance"]).toBeGreaterThan(0);
  });

  it("moves along the line of sight with Shift", () => {
    const change = ORBIT.applyWheel(FOCUSED, 120, true);
    const { back } = ORBIT.computeCamera(FOCUSED);
    ["X", "Y", "Z"].forEach((axis, i) => {
      expect(change[`Focal Point/${axis}`]).toBeCloseTo(Number(FOCUSED[`Focal Point/${axis}`]) - 0.24 * (back[i] ?? 0));
    });
    expect(change["Distance"]).toBeUndefined();
  });

  it("looks at a point without moving", () => {
    const camera = ORBIT.computeCamera({ ...FOCUSED, ...ORBIT.lookAt(FOCUSED, [0, 0, 1]) });
    expectClose(camera.position, ORBIT.computeCamera(FOCUSED).position);
    expectClose(projectPoint(camera, [0, 0, 1]), [0, 0]);
  });
});

describe("XYOrbit", () => {
  const values: ViewValues = { Distance: 10, Yaw: 0.5, Pitch: 0.6, "Focal Point/X": 1, "Focal Point/Y": 2, "Focal Point/Z": 0 };

  it("is raised by a fifth of the distance", () => {
    const [orbit, ground] = [ORBIT.computeCamera(values), GROUND.computeCamera(values)];
    expectClose(ground.position, orbit.position.map((value, i) => value + 2 * (orbit.up[i] ?? 0)));
  });

  it("keeps the ground under the pointer, at most one meter per step", () => {
    const drag = createDrag({ isMiddleDown: true, dx: 12, dy: -7 });
    const pointBefore = intersectGround(castRay(GROUND.computeCamera(values), drag.x, drag.y, SIZE));
    const valuesAfter = { ...values, ...GROUND.drag(values, drag) };
    expectClose(intersectGround(castRay(GROUND.computeCamera(valuesAfter), drag.x + 12, drag.y - 7, SIZE)) ?? [], pointBefore ?? [NaN]);
    expect(valuesAfter["Focal Point/Z"]).toBe(0);
    const limitedChange = GROUND.drag(values, createDrag({ isMiddleDown: true, dy: -300 }));
    expect(Math.hypot(Number(limitedChange["Focal Point/X"]) - 1, Number(limitedChange["Focal Point/Y"]) - 2)).toBeLessThanOrEqual(1 + 1e-9);
  });

  it("zooms with the wheel and the right button, also with Shift", () => {
    expect(GROUND.applyWheel(values, 120, true)["Distance"]).toBeCloseTo(8.8);
    expect(GROUND.drag(values, createDrag({ isRightDown: true, isShiftDown: true, dy: 10 }))["Distance"]).toBeCloseTo(11);
  });

  it("focuses on the ground below a point", () => {
    expect(GROUND.lookAt(values, [3, 4, 5])).toMatchObject({ "Focal Point/X": 3, "Focal Point/Y": 4, "Focal Point/Z": 0 });
  });
});

describe("FPS", () => {
  it("looks along yaw, tilted down by pitch", () => {
    expectClose(forwardOf(FLY.computeCamera({ Yaw: 0, Pitch: 0 })), [1, 0, 0]);
    expectClose(forwardOf(FLY.computeCamera({ Yaw: Math.PI / 2, Pitch: 0.5 })), [0, Math.cos(0.5), -Math.sin(0.5)]);
  });

  it("rotates, moves sideways, and flies forward", () => {
    const values: ViewValues = { Yaw: 1, Pitch: 0, "Position/X": 0, "Position/Y": 0, "Position/Z": 1 };
    const rotated = FLY.drag(values, createDrag({ isLeftDown: true, dx: 10, dy: 10 }));
    expectClose([Number(rotated["Yaw"]), Number(rotated["Pitch"])], [0.95, 0.05]);
    const { right } = FLY.computeCamera(values);
    const sideways = FLY.drag(values, createDrag({ isMiddleDown: true, dx: 100 }));
    expectClose([Number(sideways["Position/X"]), Number(sideways["Position/Y"])], [right[0], right[1]]);
    const forward = FLY.applyWheel(values, 120, false);
    expectClose([Number(forward["Position/X"]), Number(forward["Position/Y"])], [1.2 * Math.cos(1), 1.2 * Math.sin(1)]);
    expect(FLY.drag(values, createDrag({ isRightDown: true, dy: 10 }))["Position/Z"]).toBeCloseTo(1);
  });

  it("starts above and looks at the origin", () => {
    const camera = FLY.computeCamera(FLY.zero());
    expectClose(camera.position, [5, 5, 10]);
    expectClose(projectPoint(camera, [0, 0, 0]), [0, 0]);
  });
});

describe("TopDownOrtho", () => {
  it("with a negative scale is rotated by half a turn, and is dragged and zoomed accordingly", () => {
    const values = { Scale: -80, Angle: 0 };
    const { right, up, scale } = MAP.computeCamera(values);
    expectClose([...right, ...up, scale ?? 0], [-1, 0, 0, 0, -1, 0, 80]);
    expect(MAP.drag(values, createDrag({ isMiddleDown: true, dx: 8 }))["X"]).toBeCloseTo(0.1);
    expect(MAP.applyWheel(values, 120, false)["Scale"]).toBeCloseTo(-80 * 1.12);
    expect(MAP.drag(values, createDrag({ isRightDown: true, dy: 500 }))["Scale"]).toBeCloseTo(-0.08);
  });

  it("rotates, moves by pixels of its scale, and zooms", () => {
    const values: ViewValues = { Scale: 50, Angle: Math.PI / 2, X: 1, Y: 2 };
    expect(MAP.drag(values, createDrag({ isLeftDown: true, dx: 10 }))["Angle"]).toBeCloseTo(Math.PI / 2 + 0.05);
    const change = MAP.drag(values, createDrag({ isMiddleDown: true, dx: 50 }));
    expectClose([Number(change["X"]), Number(change["Y"])], [1, 1]);
    expect(MAP.drag(values, createDrag({ isRightDown: true, dy: 10 }))["Scale"]).toBeCloseTo(45);
    expect(MAP.applyWheel(values, 120, false)["Scale"]).toBeCloseTo(56);
  });

  it("maps a pixel to the ground", () => {
    const camera = MAP.computeCamera({ Scale: 100, Angle: 0, X: 1, Y: 2 });
    expectClose(intersectGround(castRay(camera, 500, 200, SIZE)) ?? [], [2, 3, 0]);
  });
});

describe("changing the class of a view", () => {
  it("to FPS keeps position and direction of an Orbit, and back", () => {
    const orbitCamera = ORBIT.computeCamera(FOCUSED);
    const flyCamera = FLY.computeCamera(FLY.mimic(createSource("Orbit", FOCUSED)));
    expectClose(flyCamera.position, orbitCamera.position);
    expectClose(flyCamera.back, orbitCamera.back);
    const orbitCameraAgain = ORBIT.computeCamera(ORBIT.mimic(createSource("FPS", FLY.mimic(createSource("Orbit", FOCUSED)))));
    expectClose(orbitCameraAgain.position, orbitCamera.position);
    expectClose(orbitCameraAgain.back, orbitCamera.back);
  });

  it("to Orbit rotates about a point at the distance of the origin", () => {
    const values: ViewValues = { Yaw: 0, Pitch: 0, "Position/X": 3, "Position/Y": 0, "Position/Z": 4 };
    expect(ORBIT.mimic(createSource("FPS", values))).toMatchObject({ Distance: 5, "Focal Point/X": 8, "Focal Point/Z": 4 });
  });

  it("to XYOrbit keeps the view if the camera sees the ground", () => {
    const values: ViewValues = { Yaw: 0.3, Pitch: 0.7, "Position/X": 3, "Position/Y": 1, "Position/Z": 4 };
    const fly = FLY.computeCamera(values);
    const mimicked = GROUND.mimic(createSource("FPS", values));
    expectClose(GROUND.computeCamera(mimicked).position, fly.position);
    expectClose(GROUND.computeCamera(mimicked).back, fly.back);
    expect(mimicked["Focal Point/Z"]).toBeCloseTo(0);
  });

  it("to XYOrbit starts over if the camera looks up", () => {
    expect(GROUND.mimic(createSource("FPS", { Pitch: -0.5, "Position/Z": 1 }))).toEqual(GROUND.zero());
  });

  it("to TopDownOrtho shows the focal point, or the point below the camera", () => {
    expect(MAP.mimic(createSource("Orbit", FOCUSED))).toEqual({ X: 1, Y: 2 });
    expect(MAP.mimic(createSource("FPS", { "Position/X": 7, "Position/Y": 8 }))).toEqual({ X: 7, Y: 8 });
  });

  it("from TopDownOrtho to Orbit looks down from 100 m with the same side up", () => {
    const values = ORBIT.mimic(createSource("TopDownOrtho", { X: 1, Y: 2, Angle: 0 }));
    expect(values["Distance"]).toBeCloseTo(100);
    expect(ORBIT.computeCamera(values).up[1]).toBeGreaterThan(0.99);
  });
});

describe("a fitted view", () => {
  /** Returns the distances of a box's corners from the center of the canvas, right and up; 1 is the edge. */
  function extentOnCanvas(values: ViewValues, min: Vector, max: Vector, { width, height }: typeof SIZE): [number, number] {
    const camera = ORBIT.computeCamera(values);
    const edge = Math.tan(FIELD_OF_VIEW_RAD / 2);
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i): Vector => {
      return [(i & 1 ? min : max)[0], (i & 2 ? min : max)[1], (i & 4 ? min : max)[2]];
    });
    const points = corners.map((corner) => projectPoint(camera, corner));
    const largestExtent = (axis: 0 | 1): number => Math.max(...points.map((point) => Math.abs(point[axis])));
    return [(largestExtent(0) / edge) * (height / width), largestExtent(1) / edge];
  }

  it("shows the whole of a box of any size and shape, from any side, in any window, with a margin", () => {
    for (const size of [0.05, 1, 20]) {
      for (const edges of [[1, 1, 1], [0.1, 0.1, 1], [1, 0.2, 0.01]] as Vector[]) {
        for (const canvas of [SIZE, { width: 300, height: 900 }, { width: 1600, height: 200 }]) {
          for (const start of [FOCUSED, { ...FOCUSED, Yaw: 0, Pitch: 0 }, { ...FOCUSED, Pitch: 1.5 }]) {
            const min: Vector = [3, -1, 2];
            const max: Vector = [3 + size * edges[0], -1 + size * edges[1], 2 + size * edges[2]];
            const [sideways, up] = extentOnCanvas({ ...start, ...ORBIT.fit(start, { min, max }, canvas) }, min, max, canvas);
            expect(Math.max(sideways, up)).toBeLessThan(0.85);
            expect(Math.max(sideways, up)).toBeGreaterThan(0.5);
          }
        }
      }
    }
  });

  it("keeps its distance from a single point", () => {
    expect(ORBIT.fit(FOCUSED, { min: [1, 1, 1], max: [1, 1, 1] }, SIZE)).toEqual({
      "Focal Point/X": 1,
      "Focal Point/Y": 1,
      "Focal Point/Z": 1,
    });
  });

  it("shows the whole of a box in every type of view", () => {
    const box = { min: [3, -1, 2], max: [3.4, -0.4, 3] } as const;
    for (const name of ["FPS", "XYOrbit", "ThirdPersonFollower"]) {
      const start = { Yaw: 1, Pitch: 0.6, Distance: 7 };
      const values = { ...start, ...controllerNamed(name).fit(start, box, SIZE) };
      const camera = controllerNamed(name).computeCamera(values);
      expectClose(projectPoint(camera, [3.2, -0.7, 2.5]), [0, 0]);
      expectClose(camera.back, controllerNamed(name).computeCamera(start).back);
      const [, top] = projectPoint(camera, [3, -1, 3]);
      expect(Math.abs(top)).toBeLessThan(Math.tan(FIELD_OF_VIEW_RAD / 2));
    }
    expect(MAP.fit({ Scale: 10, Angle: 0 }, box, SIZE)).toEqual({ X: 3.2, Y: -0.7, Scale: expect.closeTo(600 / 0.6 / 1.2) as number });
  });

  it("does not clip small objects, and keeps the near clip distance for others", () => {
    const smallBox = { min: [0, 0, 0], max: [0.01, 0.004, 0.003] } as const;
    const start = { ...FOCUSED, "Near Clip Distance": 0.01 };
    const nearClipDistance = Number(ORBIT.fit(start, smallBox, SIZE)["Near Clip Distance"]);
    expect(nearClipDistance).toBeGreaterThanOrEqual(0.001);
    expect(nearClipDistance).toBeLessThan(0.01);
    expect(ORBIT.fit(start, { min: [0, 0, 0], max: [1, 1, 1] }, SIZE)).not.toHaveProperty("Near Clip Distance");
  });

  it("looks from a moving frame", () => {
    const { min, max } = transformBounds({ min: [1, 2, 0], max: [3, 3, 1] }, { position: [1, 2, 0], yaw: Math.PI / 2 });
    expectClose(min, [0, -2, 0]);
    expectClose(max, [1, 0, 1]);
  });
});
