import { Box3, BoxGeometry, Matrix4, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { findFreePosition } from "../src/scene/displays/free-position";
import type { MeshPart } from "../src/scene/meshes/mesh-template";
import { extrudePolygons, createHeightmap, selectSubmesh } from "../src/scene/objects/world-geometries";

const SQUARE = [0, 0, 4, 0, 4, 4, 0, 4];
const HOLE = [1, 1, 3, 1, 3, 3, 1, 3];

/** Returns the area of the faces that face up, m2. */
function computeTopArea(outlines: number[][]): number {
  const geometry = extrudePolygons(outlines, 2);
  const points = geometry.getAttribute("position");
  let sum = 0;
  for (let i = 0; i < points.count; i += 3) {
    if ([0, 1, 2].some((k) => points.getZ(i + k) < 2)) continue;
    const [ax, ay] = [points.getX(i + 1) - points.getX(i), points.getY(i + 1) - points.getY(i)];
    const [bx, by] = [points.getX(i + 2) - points.getX(i), points.getY(i + 2) - points.getY(i)];
    sum += (ax * by - ay * bx) / 2;
  }
  return sum;
}

describe("extrusion", () => {
  it("raises polygons, and cuts inner ones out as holes", () => {
    expect(computeTopArea([SQUARE])).toBeCloseTo(16);
    expect(computeTopArea([SQUARE, HOLE])).toBeCloseTo(12);
    expect(computeTopArea([HOLE, SQUARE])).toBeCloseTo(12);
    expect(computeTopArea([SQUARE, HOLE, [1.5, 1.5, 2.5, 1.5, 2.5, 2.5, 1.5, 2.5]])).toBeCloseTo(13);
  });

  it("skips invalid polygons", () => {
    expect(computeTopArea([[0, 0, 1, 1]])).toBe(0);
  });
});

describe("submesh", () => {
  const createPart = (name: string, x: number): MeshPart => ({
    geometry: new BoxGeometry(1, 1, 1).translate(x, 0, 0),
    materials: [null],
    names: [name, "scene"],
  });
  const parts = [createPart("wheel", 2), createPart("body", 5)];

  it("is the whole mesh, or the parts with the name", () => {
    expect(selectSubmesh(parts, null).parts).toEqual(parts);
    expect(selectSubmesh(parts, { name: "body", center: false }).parts).toEqual([parts[1]]);
    expect(selectSubmesh(parts, { name: "scene", center: false }).parts).toEqual(parts);
    expect(() => selectSubmesh(parts, { name: "door", center: false })).toThrow("no part 'door'");
  });

  it("can be moved to the origin", () => {
    expect(selectSubmesh(parts, { name: "body", center: true }).offset.toArray().map(Math.abs)).toEqual([5, 0, 0]);
  });
});

describe("ground", () => {
  it("has the heights at their positions, the first row at minimum y", () => {
    const geometry = createHeightmap(new Float32Array([0, 0, 1, 1]), 2, [10, 20, 3, 1, 2, 0.5, 5]);
    geometry.computeBoundingBox();
    const box = geometry.boundingBox ?? new Box3();
    expect([...box.min.toArray(), ...box.max.toArray()]).toEqual([-4, -8, 0.5, 6, 12, 3.5]);
    const points = geometry.getAttribute("position");
    expect([points.getY(0), points.getZ(0)]).toEqual([12, 3.5]);
    expect(geometry.getAttribute("uv").getX(1)).toBe(2);
  });
});

describe("the position proposed for a model", () => {
  const createBox = (x: number, y: number, side: number): Box3 => new Box3().setFromCenterAndSize(new Vector3(x, y, 0.2), new Vector3(side, side, 0.4));
  const origin = new Matrix4();

  it("is the origin, or the nearest free meter", () => {
    expect(findFreePosition([], origin)).toEqual([0, 0, 0]);
    expect(findFreePosition([createBox(5, 0, 1)], origin)).toEqual([0, 0, 0]);
    expect(findFreePosition([createBox(0, 0, 0.4)], origin)).toEqual([1, 0, 0]);
    expect(findFreePosition([createBox(0, 0, 0.4), createBox(1, 0, 0.2)], origin)).toEqual([0, 1, 0]);
    expect(findFreePosition([createBox(0, 0, 3.2)], origin)).toEqual([3, 0, 0]);
  });

  it("is in the world's frame, whatever the fixed frame is", () => {
    expect(findFreePosition([createBox(10, 0, 0.4)], new Matrix4().makeTranslation(10, 0, 0))).toEqual([1, 0, 0]);
    expect(findFreePosition([createBox(0, 0, 0.4)], new Matrix4().makeTranslation(10, 0, 0))).toEqual([0, 0, 0]);
  });

  it("is beyond all objects if nothing near is free", () => {
    expect(findFreePosition([createBox(0, 0, 60)], origin)).toEqual([31, 0, 0]);
  });
});
