import {
  Box3,
  Group,
  Matrix4,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Vector3,
  type BufferGeometry,
  type DataTexture,
  type Mesh,
  type ShaderMaterial,
} from "three";
import { describe, expect, it } from "vitest";
import { rainbowColorOf } from "../src/scene/displays/effort";
import { poseAlongX, ArrowBatch } from "../src/scene/objects/arrow-batch";
import { AxesBatch } from "../src/scene/objects/axes-batch";
import { CopyBatch } from "../src/scene/objects/copy-batch";
import { CovarianceBatch, type CovarianceStyle } from "../src/scene/objects/covariance-batch";
import { computePrincipalAxes } from "../src/scene/objects/eigen";
import { createSphere, createCone, createCube, createRod } from "../src/scene/objects/geometries";
import { createRibbons, splitIntoSegments, splitIntoStrips } from "../src/scene/objects/ribbons";

interface BoundedBatch {
  expandBox(box: Box3): void;
}

/** Returns bounds with two decimals. */
function computeBounds(...batches: BoundedBatch[]): { min: number[]; max: number[] } {
  const box = new Box3();
  for (const batch of batches) batch.expandBox(box);
  const round = (vector: Vector3): number[] => vector.toArray().map((value) => Math.round(value * 100) / 100 + 0);
  return { min: round(box.min), max: round(box.max) };
}

describe("geometries", () => {
  it("have the sizes that batches rely on", () => {
    const boundingBoxOf = (geometry: { computeBoundingBox(): void; boundingBox: Box3 | null }): Box3 => {
      geometry.computeBoundingBox();
      return geometry.boundingBox!;
    };
    expect(boundingBoxOf(createRod(16)).min.toArray().map(Math.fround)).toEqual([0, -0.5, -0.5]);
    expect(boundingBoxOf(createRod(16)).max.toArray().map(Math.fround)).toEqual([1, 0.5, 0.5]);
    expect(boundingBoxOf(createCone(16)).max.x).toBeCloseTo(1);
    expect(boundingBoxOf(createSphere(16)).getSize(new Vector3()).z).toBeCloseTo(1);
    expect(boundingBoxOf(createCube()).getSize(new Vector3()).toArray()).toEqual([1, 1, 1]);
  });
});

describe("CopyBatch", () => {
  it("draws translucent copies from the farthest to the nearest, and still identifies them", () => {
    const parent = new Group();
    const batch = new CopyBatch(parent, createCube());
    batch.begin(3);
    for (const x of [3, 1, 2]) batch.add(new Matrix4().makeTranslation(x, 0, 0), 0, 0.5);
    batch.end();
    const mesh = parent.children[0] as Mesh<BufferGeometry, ShaderMaterial>;
    const camera = new PerspectiveCamera();
    camera.position.set(10, 0, 0);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    (mesh as unknown as { onBeforeRender(...args: unknown[]): void }).onBeforeRender(null, null, camera);
    const { slots } = mesh.material.uniforms as { slots: { value: DataTexture } };
    const data = slots.value.image.data as Float32Array;
    expect([data[3], data[19], data[35]]).toEqual([1, 2, 3]);
    expect(batch.pick(new Raycaster(new Vector3(10, 0, 0), new Vector3(-1, 0, 0)))?.copy).toBe(0);
    expect(batch.pick(new Raycaster(new Vector3(-10, 0, 0), new Vector3(1, 0, 0)))?.copy).toBe(1);
    batch.dispose();
  });

  it("draws what is visible to each camera, and still identifies all copies", () => {
    const parent = new Group();
    const batch = new CopyBatch(parent, createCube());
    batch.begin(3);
    for (const x of [5, -5, 7]) batch.add(new Matrix4().makeTranslation(x, 0, 0));
    batch.end();
    const mesh = parent.children[0] as Mesh<BufferGeometry, ShaderMaterial>;
    const { slots } = mesh.material.uniforms as { slots: { value: DataTexture } };
    const drawToward = (targetX: number): number[] => {
      const camera = new PerspectiveCamera();
      camera.lookAt(targetX, 0, 0);
      camera.updateMatrixWorld();
      (mesh as unknown as { onBeforeRender(...args: unknown[]): void }).onBeforeRender(null, null, camera);
      const count = mesh.geometry.drawRange.count / createCube().index!.count;
      return Array.from({ length: count }, (_, slot) => (slots.value.image.data as Float32Array)[slot * 16 + 3]!);
    };
    expect(drawToward(1)).toEqual([5, 7]);
    expect(drawToward(-1)).toEqual([-5]);
    expect(batch.size).toBe(3);
    expect(computeBounds(batch).max[0]).toBe(7.5);
    expect(batch.pick(new Raycaster(new Vector3(-10, 0, 0), new Vector3(1, 0, 0)))?.copy).toBe(1);
    batch.begin(1);
    batch.add(new Matrix4().makeTranslation(6, 0, 0));
    batch.end();
    expect(drawToward(1)).toEqual([6]);
    batch.dispose();
  });

  it("places copies according to their matrices", () => {
    const parent = new Group();
    const batch = new CopyBatch(parent, createCube());
    batch.begin(3);
    batch.add(new Matrix4().makeTranslation(5, 0, 0));
    batch.add(new Matrix4().makeRotationZ(Math.PI / 2).multiply(new Matrix4().makeScale(4, 1, 1)), 0, 0.5, 0x123456);
    batch.end();
    expect(batch.size).toBe(2);
    expect(computeBounds(batch)).toEqual({ min: [-0.5, -2, -0.5], max: [5.5, 2, 0.5] });
    batch.begin(1);
    batch.end();
    expect(parent.children[0]!.visible).toBe(false);
    batch.dispose();
    expect(parent.children).toHaveLength(0);
  });
});

describe("ArrowBatch", () => {
  it("points along x, with the head after the shaft", () => {
    const arrows = new ArrowBatch(new Group(), 16);
    arrows.begin(1);
    const shape = { shaftLength: 1, shaftDiameter: 0.1, headLength: 0.3, headDiameter: 0.2 };
    arrows.add(new Matrix4().makeTranslation(0, 0, 2), shape, { color: 0xff0000 });
    arrows.end();
    expect(computeBounds(arrows)).toEqual({ min: [0, -0.1, 1.9], max: [1.3, 0.1, 2.1] });
  });

  it("points in any direction", () => {
    const pose = poseAlongX(new Vector3(1, 2, 3), new Vector3(0, 0, -7), new Matrix4());
    expect(new Vector3(1, 0, 0).applyMatrix4(pose).distanceTo(new Vector3(1, 2, 2))).toBeLessThan(1e-6);
    const backwardPose = poseAlongX(new Vector3(), new Vector3(-1, 0, 0), new Matrix4());
    expect(new Vector3(1, 0, 0).applyMatrix4(backwardPose).x).toBeCloseTo(-1);
  });
});

describe("AxesBatch", () => {
  it("has the thickness that RViz draws for a radius", () => {
    const axes = new AxesBatch(new Group());
    axes.setShape(2, 0.5, 16);
    axes.begin(1);
    axes.add(new Matrix4());
    axes.end();
    expect(computeBounds(axes)).toEqual({ min: [-0.25, -0.25, -0.25], max: [2, 2, 2] });
  });
});

describe("ribbons", () => {
  it("share the vertices of a corner, along the bisector of both directions", () => {
    const ribbons = createRibbons([new Float32Array([0, 0, 0, 1, 0, 0, 1, 3, 0])]);
    expect(ribbons.positions).toHaveLength(18);
    expect([...ribbons.sides]).toEqual([-0.5, 0.5, -0.5, 0.5, -0.5, 0.5]);
    expect([...ribbons.directions.subarray(6, 9)]).toEqual([1, 1, 0]);
    expect([...ribbons.directions.subarray(12, 15)]).toEqual([0, 1, 0]);
    expect([...ribbons.indices]).toEqual([0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4]);
  });

  it("do not connect strips", () => {
    const line = new Float32Array([0, 0, 0, 1, 0, 0]);
    const ribbons = createRibbons([line, line], [new Float32Array(8).fill(1), new Float32Array(8).fill(0.5)]);
    expect([...ribbons.indices]).toEqual([0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6]);
    expect([...ribbons.colors!.subarray(16, 20)]).toEqual([0.5, 0.5, 0.5, 0.5]);
  });

  it("handle lines that reverse, and strips of one point", () => {
    const ribbons = createRibbons([new Float32Array([0, 0, 0, 1, 0, 0, 0, 0, 0]), new Float32Array([5, 5, 5])]);
    expect([...ribbons.directions.subarray(6, 9)]).toEqual([-1, 0, 0]);
    expect(ribbons.indices).toHaveLength(12);
  });

  it("convert from segments and back", () => {
    const strip = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0]);
    expect([...splitIntoSegments(strip)]).toEqual([0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0]);
    expect(splitIntoStrips(splitIntoSegments(strip))).toHaveLength(2);
  });
});

describe("principal axes", () => {
  it("reproduce the matrix", () => {
    const m = [4, 1, -2, 1, 3, 0.5, -2, 0.5, 6] as const;
    const { values, axes } = computePrincipalAxes(m);
    const [x, y, z] = [new Vector3(), new Vector3(), new Vector3()];
    axes.extractBasis(x, y, z);
    expect(axes.determinant()).toBeCloseTo(1);
    [x, y, z].forEach((axis, i) => {
      const image = new Vector3(
        m[0] * axis.x + m[1] * axis.y + m[2] * axis.z,
        m[3] * axis.x + m[4] * axis.y + m[5] * axis.z,
        m[6] * axis.x + m[7] * axis.y + m[8] * axis.z,
      );
      expect(image.distanceTo(axis.clone().multiplyScalar(values[i]!))).toBeLessThan(1e-9);
    });
  });
});

describe("CovarianceBatch", () => {
  const POSITION: CovarianceStyle = { position: { color: 0xffffff, alpha: 1, scale: 1 }, orientation: null };
  const ORIENTATION: CovarianceStyle = {
    position: null,
    orientation: { isLocal: true, colors: [1, 2, 3], alpha: 1, offset: 2, scale: 1 },
  };

  function drawCovariance(diagonal: number[], style: CovarianceStyle, pose = [0, 0, 0, 0, 0, 0, 1]): ReturnType<typeof computeBounds> {
    const covariance = new Float32Array(36);
    diagonal.forEach((value, i) => (covariance[i * 7] = value));
    const batch = new CovarianceBatch(new Group());
    batch.begin(1);
    batch.add(new Matrix4(), new Float32Array(pose), covariance, style);
    batch.end();
    return computeBounds(batch);
  }

  it("draws one standard deviation of the position in each direction", () => {
    expect(drawCovariance([4, 1, 0.25, 1, 1, 1], POSITION)).toEqual({ min: [-2, -1, -0.5], max: [2, 1, 0.5] });
  });

  it("does not rotate the position with the pose", () => {
    const quarterTurn = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), Math.PI / 2).toArray();
    expect(drawCovariance([4, 1, 0.25, 1, 1, 1], POSITION, [1, 0, 0, ...quarterTurn]).max).toEqual([3, 1, 0.5]);
  });

  it("draws an ellipse and a triangle for a planar pose", () => {
    expect(drawCovariance([4, 1, 0, 0, 0, 0.01], POSITION)).toEqual({ min: [-2, -1, 0], max: [2, 1, 0] });
    const { min, max } = drawCovariance([4, 1, 0, 0, 0, 0.01], ORIENTATION);
    expect([min[0], max[0], max[1]]).toEqual([0, 2, 0.2]);
  });

  it("tilts each axis by the rotations about the others", () => {
    const { min, max } = drawCovariance([1, 1, 1, 0.01, 0.04, 0.0001], ORIENTATION);
    // Pitch moves x along z and z along x, roll moves y along z and z along y, yaw has almost no effect.
    expect(max).toEqual([2, 2, 2]);
    expect(min[2]).toBeCloseTo(-0.41, 1);
    expect(min[0]).toBeCloseTo(-0.41, 1);
    expect(min[1]).toBeCloseTo(-0.2, 1);
  });

  it("draws nothing for an invalid covariance", () => {
    expect(drawCovariance([-1, 1, 1, 1, 1, 1], POSITION).min).toEqual([Infinity, Infinity, Infinity]);
  });
});

describe("colors of efforts", () => {
  it("range from violet to red", () => {
    expect([0, 0.2, 0.4, 0.6, 0.8, 1].map((value) => rainbowColorOf(value).map((part) => Math.round(part)))).toEqual([
      [1, 0, 1],
      [0, 0, 1],
      [0, 1, 1],
      [0, 1, 0],
      [1, 1, 0],
      [1, 0, 0],
    ]);
  });
});

describe("picking", () => {
  const createRay = (x: number, y: number): Raycaster => new Raycaster(new Vector3(x, y, 10), new Vector3(0, 0, -1));

  it("finds the nearest copy, and three.js the bounds of all", () => {
    const parent = new Group();
    const batch = new CopyBatch(parent, createCube());
    batch.begin(3);
    batch.add(new Matrix4());
    batch.add(new Matrix4().makeTranslation(0, 0, 2));
    batch.add(new Matrix4().makeTranslation(5, 0, 0));
    batch.end();
    expect(batch.pick(createRay(0, 0))).toMatchObject({ copy: 1, distance: 7.5 });
    expect(batch.pick(createRay(5, 0.2))?.copy).toBe(2);
    expect(batch.pick(createRay(2, 0))).toBeNull();
    expect(new Box3().setFromObject(parent).max.toArray()).toEqual([5.5, 0.5, 2.5]);
  });

  it("hits an arrow by its shaft and by its head", () => {
    const arrows = new ArrowBatch(new Group());
    const shape = { shaftLength: 1, shaftDiameter: 0.1, headLength: 0.3, headDiameter: 0.2 };
    arrows.begin(2);
    arrows.add(new Matrix4(), { ...shape, shaftLength: 0 }, { color: 0 });
    arrows.add(new Matrix4().makeTranslation(0, 3, 0), shape, { color: 0 });
    arrows.end();
    expect([createRay(0.1, 0.01), createRay(0.5, 3), createRay(1.1, 3.01)].map((ray) => arrows.pick(ray)?.copy)).toEqual([0, 1, 1]);
  });
});
