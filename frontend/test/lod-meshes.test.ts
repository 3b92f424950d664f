import { BoxGeometry, BufferGeometry, Matrix4, Mesh, MeshLambertMaterial, Object3D, PerspectiveCamera, SphereGeometry } from "three";
import { MeshoptSimplifier } from "meshoptimizer/simplifier";
import { beforeAll, describe, expect, it } from "vitest";
import { PICKABLE_LAYER } from "../src/scene/layers";
import { createLodMesh, type LodMesh, type Triangles } from "../src/scene/meshes/lod-mesh";
import type { LodMeshResponse, LodMeshRequest } from "../src/scene/meshes/lod-mesh-worker";
import { LodMeshes, type LodMeshWorker } from "../src/scene/meshes/lod-meshes";
import { chooseLevels, MovingMeshes, type MovingPiece } from "../src/scene/robot/moving-meshes";

beforeAll(() => MeshoptSimplifier.ready);

function toTriangles(geometry: BufferGeometry): Triangles {
  const arrayOf = (name: string): Float32Array => geometry.getAttribute(name).array as Float32Array;
  return { positions: arrayOf("position"), normals: arrayOf("normal"), index: geometry.index ? Uint32Array.from(geometry.index.array) : null };
}

/** Returns a geometry like that of an STL: separate, flat triangles. */
function separateTriangles(geometry: BufferGeometry): Triangles {
  const flatGeometry = geometry.toNonIndexed();
  flatGeometry.computeVertexNormals();
  return toTriangles(flatGeometry);
}

function createDefaultLodMesh(mesh: Triangles): LodMesh {
  return createLodMesh(mesh, MeshoptSimplifier);
}

function viewpointAt(distance: number): { camera: PerspectiveCamera; height: number } {
  const camera = new PerspectiveCamera(45, 1, 0.01, 1000);
  camera.position.set(0, 0, distance);
  camera.updateMatrixWorld();
  return { camera, height: 600 };
}

/** A worker that answers when the test tells it to. */
function createWorker(): { worker: LodMeshWorker; requests: LodMeshRequest[]; answer: (lodMeshes: LodMeshResponse["lodMeshes"]) => void } {
  const requests: LodMeshRequest[] = [];
  const worker: LodMeshWorker = { onmessage: null, onerror: null, postMessage: (request) => void requests.push(request) };
  const answer = (lodMeshes: LodMeshResponse["lodMeshes"]): void => {
    worker.onmessage?.({ data: { id: requests.at(-1)!.id, lodMeshes } } as MessageEvent<LodMeshResponse>);
  };
  return { worker, requests, answer };
}

describe("an LOD mesh", () => {
  it("has fewer triangles at each level, and stays within the error", () => {
    const { positions, levels } = createDefaultLodMesh(separateTriangles(new SphereGeometry(1, 48, 32)));
    expect(levels.length).toBeGreaterThan(3);
    expect(levels[0]?.error).toBe(0);
    for (let i = 1; i < levels.length; i++) {
      expect(levels[i]!.error).toBeGreaterThan(levels[i - 1]!.error);
      expect(levels[i]!.index.length).toBeLessThan(0.81 * levels[i - 1]!.index.length);
    }
    for (const { error, index } of levels) {
      let largestError = 0;
      for (let i = 0; i < index.length; i += 3) {
        // The center of a flat triangle is the farthest from the sphere.
        const center = [0, 1, 2].map((axis) => [0, 1, 2].reduce((sum, k) => sum + positions[3 * index[i + k]! + axis]! / 3, 0));
        largestError = Math.max(largestError, 1 - Math.hypot(...center));
      }
      expect(largestError).toBeLessThan(1.3 * error + 0.005);
    }
  });

  it("merges the vertices of separate triangles, but not across edges", () => {
    const box = createDefaultLodMesh(separateTriangles(new BoxGeometry(1, 1, 1)));
    expect(box.positions.length / 3).toBe(24);
    expect(box.levels[0]?.index.length).toBe(36);
    const round = createDefaultLodMesh(separateTriangles(new SphereGeometry(1, 24, 16)));
    expect(round.positions.length / 3).toBeLessThan(25 * 17);
  });

  it("does not exist for a mesh without area", () => {
    const { levels, boundingSphere } = createDefaultLodMesh({ positions: new Float32Array(9), normals: new Float32Array(9), index: null });
    expect(levels).toEqual([{ error: 0, index: new Uint32Array(0) }]);
    expect(boundingSphere[3]).toBe(0);
  });
});

describe("LOD meshes of a geometry", () => {
  it("are requested once, one for each group", () => {
    const { worker, requests, answer } = createWorker();
    const lodMeshes = new LodMeshes(() => worker);
    const geometry = new BoxGeometry(1, 1, 1);
    expect(lodMeshes.getOrRequest(geometry)).toBeNull();
    expect(lodMeshes.getOrRequest(geometry)).toBeNull();
    expect(requests).toHaveLength(1);
    expect(requests[0]?.pieces).toHaveLength(6);
    expect(requests[0]?.pieces[0]?.index).toHaveLength(6);
    const pieceLodMeshes = requests[0]!.pieces.map((piece) => createLodMesh(piece, MeshoptSimplifier));
    answer(pieceLodMeshes);
    expect(lodMeshes.getOrRequest(geometry)).toBe(pieceLodMeshes);
  });

  it("do not exist if the worker does not run", () => {
    const { worker } = createWorker();
    const lodMeshes = new LodMeshes(() => worker);
    const geometry = new SphereGeometry();
    lodMeshes.getOrRequest(geometry);
    worker.onerror?.({} as ErrorEvent);
    expect(lodMeshes.getOrRequest(geometry)).toEqual([]);
  });
});

describe("moving meshes", () => {
  const createBall = (): MovingPiece => ({ lodMesh: createDefaultLodMesh(toTriangles(new SphereGeometry(1, 48, 32))), matrix: new Matrix4(), color: 0xff0000 });

  it("are coarser at a greater distance, and absent outside the view", () => {
    const piece = createBall();
    const levels = [2, 5, 50, 500].map((distance) => chooseLevels([piece], viewpointAt(distance))[0]);
    expect(levels).toEqual([...levels].sort((a, b) => a! - b!));
    expect(new Set(levels).size).toBeGreaterThan(2);
    expect(chooseLevels([{ ...piece, matrix: new Matrix4().makeTranslation(100, 0, 0) }], viewpointAt(5))).toEqual([null]);
    // From inside nothing is left out.
    expect(chooseLevels([piece], viewpointAt(0.5))).toEqual([0]);
    // A hundred times as large from a hundred times the distance looks the same.
    expect(chooseLevels([{ ...piece, matrix: new Matrix4().makeScale(100, 100, 100) }], viewpointAt(500))).toEqual(chooseLevels([piece], viewpointAt(5)));
  });

  it("replace the meshes until the frame is drawn", () => {
    const parent = new Object3D();
    const mesh = new Mesh(new SphereGeometry(), new MeshLambertMaterial());
    const moving = new MovingMeshes(parent);
    moving.replaceMeshes([createBall(), createBall()], [mesh], viewpointAt(50));
    expect(moving.drawnCounts.pieces).toBe(2);
    expect(moving.drawnCounts.triangles).toBeLessThan(48 * 32);
    expect(mesh.layers.isEnabled(0)).toBe(false);
    expect(mesh.layers.isEnabled(PICKABLE_LAYER)).toBe(true);
    expect(parent.children).toHaveLength(1);
    moving.restoreMeshes();
    expect(mesh.layers.isEnabled(0)).toBe(true);
    expect(parent.children).toHaveLength(0);
    moving.dispose();
  });
});
