import { BoxGeometry, Mesh, OrthographicCamera, PerspectiveCamera, SphereGeometry, Vector2 } from "three";
import { describe, expect, it } from "vitest";
import { ScreenBox } from "../src/scene/selection-box";

/** A depth map in which nothing is hidden. */
const open = (): boolean => true;
const ALL = [new Vector2(-0.95, -0.95), new Vector2(0.95, 0.95)] as const;

function camera(): PerspectiveCamera {
  const made = new PerspectiveCamera(45, 1, 0.01, 1000);
  made.position.set(0, 0, 10);
  made.updateMatrixWorld(true);
  return made;
}

function ball(x: number): Mesh {
  const mesh = new Mesh(new SphereGeometry(0.1, 16, 12));
  mesh.position.set(x, 0, 0);
  mesh.updateMatrixWorld(true);
  return mesh;
}

describe("a rectangle on the screen", () => {
  it("contains the objects that are visible in it", () => {
    const box = new ScreenBox(camera(), ...ALL, open);
    expect(box.hasPoint(0, 0, 0)).toBe(true);
    expect(box.hasPoint(3.5, 0, 0)).toBe(true);
    expect(box.hasPoint(5, 0, 0)).toBe(false);
    expect(box.hasPoint(0, 0, 11)).toBe(false);
    expect(box.hasObject(ball(3))).toBe(true);
    expect(box.hasObject(ball(6))).toBe(false);
  });

  it("excludes objects next to it", () => {
    const right = new ScreenBox(camera(), new Vector2(0.1, -1), new Vector2(1, 1), open);
    expect(right.hasObject(ball(2))).toBe(true);
    expect(right.hasObject(ball(-2))).toBe(false);
  });

  it("within a face contains the object, although it contains none of the corners", () => {
    const small = new ScreenBox(camera(), new Vector2(-0.02, -0.02), new Vector2(0.02, 0.02), open);
    const wall = new Mesh(new BoxGeometry(4, 4, 0.1));
    wall.updateMatrixWorld(true);
    expect(small.hasObject(wall)).toBe(true);
  });

  it("excludes hidden objects", () => {
    const seen: number[] = [];
    const box = new ScreenBox(camera(), ...ALL, (x, _, z) => {
      seen.push(z);
      return x > 0;
    });
    expect(box.hasPoint(1, 0, 0)).toBe(true);
    expect(box.hasPoint(-1, 0, 0)).toBe(false);
    expect(box.hasObject(ball(2))).toBe(true);
    expect(box.hasObject(ball(-2))).toBe(false);
    expect(seen.every((z) => z > 0.99 && z < 1)).toBe(true);
  });

  it("works without perspective", () => {
    const flat = new OrthographicCamera(-4, 4, 4, -4, 0.01, 1000);
    flat.position.set(0, 0, 500);
    flat.updateMatrixWorld(true);
    const box = new ScreenBox(flat, new Vector2(0, 0), new Vector2(1, 1), open);
    expect([box.hasPoint(2, 2, 0), box.hasPoint(-2, 2, 0)]).toEqual([true, false]);
  });
});
