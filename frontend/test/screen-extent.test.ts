import { OrthographicCamera, PerspectiveCamera } from "three";
import { expect, test } from "vitest";
import { computeExtent } from "../src/scene/screen-extent";

const CANVAS = { width: 800, height: 400 };
const BOX = { min: [-1, -1, -1], max: [1, 1, 1] } as const;

function cameraAt(distance: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(90, 2, 0.1, 100);
  camera.position.z = distance;
  camera.updateMatrixWorld();
  return camera;
}

test("the nearest corners determine the extent", () => {
  // The front is at 1 m, where the canvas is 4 m wide.
  expect(computeExtent(BOX, cameraAt(2), CANVAS).right).toBeCloseTo(600);
  expect(computeExtent(BOX, cameraAt(5), CANVAS).right).toBeCloseTo(450);
});

test("the extent is computed from where a box is visible", () => {
  expect(computeExtent(BOX, cameraAt(2), CANVAS).left).toBeCloseTo(200);
  expect(computeExtent(BOX, cameraAt(0.5), CANVAS).left).toBe(-Infinity);
});

test("shifting the canvas reduces the extent", () => {
  const camera = cameraAt(2);
  camera.setViewOffset(800, 400, 100, 0, 800, 400);
  expect(computeExtent(BOX, camera, CANVAS).right).toBeCloseTo(500);
});

test("an object that is partly behind the camera extends everywhere", () => {
  expect(computeExtent(BOX, cameraAt(0.5), CANVAS).right).toBe(Infinity);
});

test("without perspective only the box matters", () => {
  const camera = new OrthographicCamera(-2, 2, 1, -1, 0, 100);
  camera.position.z = 50;
  camera.updateMatrixWorld();
  expect(computeExtent(BOX, camera, CANVAS).right).toBeCloseTo(600);
});

test("the vertical extent is computed", () => {
  const { top, bottom } = computeExtent(BOX, cameraAt(2), CANVAS);
  expect([top, bottom]).toEqual([expect.closeTo(0), expect.closeTo(400)]);
  const camera = cameraAt(5);
  const topAbove = computeExtent(BOX, camera, CANVAS).top;
  camera.setViewOffset(800, 400, 0, -50, 800, 400);
  expect(computeExtent(BOX, camera, CANVAS).top).toBeCloseTo(topAbove + 50);
});
