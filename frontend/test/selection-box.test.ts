import { BoxGeometry, Mesh, OrthographicCamera, PerspectiveCamera, SphereGeometry, Vector2 } from "three";
import { describe, expect, it } from "vitest";
import { ScreenBox } from "../src/scene/selection-box";

/** A depth map in which nothing is hidden. */
const isOpen = (): boolean => true;
const ALL = [new Vector2(-0.95, -0.95), new Vector2(0.95, 0.95)] as const;

function createCamera(): PerspectiveCamera {
  const camera = new PerspectiveCamera(45, 1, 0.01, 1000);
  camera.position.set(0, 0, 10);
  camera.updateMatrixWorld(true);
  return camera;
}

function createBall(x: number): Mesh {
  const mesh = new Mesh(new SphereGeometry(0.1, 16, 12));
  mesh.position.set(x, 0, 0);
  mesh.updateMatrixWorld(true);
  return mesh;
}

describe("a rectangle on the screen", () => {
  it("contains the objects that are visible in it", () => {
    const box = new ScreenBox(createCamera(), ...ALL, isOpen);
    expect(box.hasPoint(0, 0, 0)).toBe(true);
    expect(box.hasPoint(3.5, 0, 0)).toBe(true);
    expect(box.hasPoint(5, 0, 0)).toBe(false);
    expect(box.hasPoint(0, 0, 11)).toBe(false);
    expect(box.hasObject(createBall(3))).toBe(true);
    expect(box.hasObject(createBall(6))).toBe(false);
  });

  it("excludes objects next to it", () => {
    const rightBox = new ScreenBox(createCamera(), new Vector2(0.1, -1), new Vector2(1, 1), isOpen);
    expect(rightBox.hasObject(createBall(2))).toBe(true);
    expect(rightBox.hasObject(createBall(-2))).toBe(false);
  });

  it("within a face contains the object, although it contains none of the corners", () => {
    const smallBox = new ScreenBox(createCamera(), new Vector2(-0.02, -0.02), new Vector2(0.02, 0.02), isOpen);
    const wall = new Mesh(new BoxGeometry(4, 4, 0.1));
    wall.updateMatrixWorld(true);
    expect(smallBox.hasObject(wall)).toBe(true);
  });

  it("excludes hidden objects", () => {
    const depths: number[] = [];
    const box = new ScreenBox(createCamera(), ...ALL, (x, _, z) => {
      depths.push(z);
      return x > 0;
    });
    expect(box.hasPoint(1, 0, 0)).toBe(true);
    expect(box.hasPoint(-1, 0, 0)).toBe(false);
    expect(box.hasObject(createBall(2))).toBe(true);
    expect(box.hasObject(createBall(-2))).toBe(false);
    expect(depths.every((z) => z > 0.99 && z < 1)).toBe(true);
  });

  it("works without perspective", () => {
    const orthographicCamera = new OrthographicCamera(-4, 4, 4, -4, 0.01, 1000);
    orthographicCamera.position.set(0, 0, 500);
    orthographicCamera.updateMatrixWorld(true);
    const box = new ScreenBox(orthographicCamera, new Vector2(0, 0), new Vector2(1, 1), isOpen);
    expect([box.hasPoint(2, 2, 0), box.hasPoint(-2, 2, 0)]).toEqual([true, false]);
  });
});
