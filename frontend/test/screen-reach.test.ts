import { OrthographicCamera, PerspectiveCamera } from "three";
import { expect, test } from "vitest";
import { reachOf } from "../src/scene/screen-reach";

const BOX = { min: [-1, -1, -1], max: [1, 1, 1] } as const;

function from(distance: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(90, 2, 0.1, 100);
  camera.position.z = distance;
  camera.updateMatrixWorld();
  return camera;
}

test("the nearest corners reach farthest", () => {
  // The front is 1 m off, where the canvas is 4 m wide.
  expect(reachOf(BOX, from(2), 800)).toBeCloseTo(600);
  expect(reachOf(BOX, from(5), 800)).toBeCloseTo(450);
});

test("what is shifted on the canvas reaches less far", () => {
  const camera = from(2);
  camera.setViewOffset(800, 400, 100, 0, 800, 400);
  expect(reachOf(BOX, camera, 800)).toBeCloseTo(500);
});

test("what is behind the eye, too, is everywhere", () => {
  expect(reachOf(BOX, from(0.5), 800)).toBe(Infinity);
});

test("without perspective only the box counts", () => {
  const camera = new OrthographicCamera(-2, 2, 1, -1, 0, 100);
  camera.position.z = 50;
  camera.updateMatrixWorld();
  expect(reachOf(BOX, camera, 800)).toBeCloseTo(600);
});
