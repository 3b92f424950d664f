import type { MeshoptSimplifier } from "meshoptimizer/simplifier";

/** The part of meshoptimizer that is used. */
export type Simplifier = Pick<typeof MeshoptSimplifier, "generatePositionRemap" | "simplifyWithAttributes" | "compactMesh" | "getScale">;

/** Triangles with a normal at each corner: three consecutive corners each, or by index. */
export interface Triangles {
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  readonly index: Uint32Array | null;
}

/** A level of detail; it differs from the mesh by about `error` at most, m. */
export interface LodLevel {
  readonly error: number;
  readonly index: Uint32Array;
}

/** A mesh at several levels of detail, which share their vertices. */
export interface LodMesh {
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  /** The levels from the finest, which has all triangles, to the coarsest. */
  readonly levels: readonly LodLevel[];
  /** The bounding sphere: x y z of its center, radius. */
  readonly boundingSphere: readonly [number, number, number, number];
}

/** The maximum errors of the levels, as shares of the mesh's size. */
const ERROR_STEPS = [0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1];
/** The minimum share of triangles that a level saves over the previous level. */
const MIN_SAVING = 0.2;
/** The weight of errors in normals, as a share of the mesh's size. */
const NORMAL_WEIGHT = 0.2;
/** Corners at one position share a vertex if the cosine between their normals is at least this: 30 degrees. */
const MIN_COSINE = 0.866;
const COMPONENT_COUNT = 3;

/** Simplifies a mesh repeatedly, each time as far as an error permits. */
export function createLodMesh(mesh: Triangles, simplifier: Simplifier): LodMesh {
  const { positions, normals, index } = weldCorners(mesh, simplifier);
  const scale = positions.length > 0 ? simplifier.getScale(positions, COMPONENT_COUNT) : 0;
  const levels: LodLevel[] = [{ error: 0, index }];
  const weights = [NORMAL_WEIGHT, NORMAL_WEIGHT, NORMAL_WEIGHT];
  let previousIndex = index;
  let error = 0;
  for (const maxError of ERROR_STEPS) {
    if (previousIndex.length === 0) break;
    const [reducedIndex, deviation] = simplifier.simplifyWithAttributes(
      previousIndex, positions, COMPONENT_COUNT, normals, COMPONENT_COUNT, weights, null, 0, maxError, ["Prune"],
    );
    if (reducedIndex.length > (1 - MIN_SAVING) * previousIndex.length) continue;
    error += deviation * scale; // each level simplifies the previous one, so errors add up
    levels.push({ error, index: reducedIndex });
    previousIndex = reducedIndex;
  }
  return { positions, normals, levels, boundingSphere: computeBoundingSphere(positions) };
}

/**
 * Merges corners at the same position with similar normals. Exporters write each triangle separately, but simplification
 * needs triangles that share vertices.
 */
function weldCorners({ positions, normals, index }: Triangles, simplifier: Simplifier): { positions: Float32Array; normals: Float32Array; index: Uint32Array } {
  const weldedVertices = simplifier.generatePositionRemap(positions, COMPONENT_COUNT);
  const cornerCount = index?.length ?? positions.length / COMPONENT_COUNT;
  const weldedIndex = new Uint32Array(cornerCount);
  /**
   * The newest vertex at each position, and for each vertex the previous one at the same position; numbers plus one, 0
   * for none.
   */
  const [newestVertices, previousVertices] = [new Uint32Array(weldedVertices.length), new Uint32Array(cornerCount)];
  const [positionSums, normalSums] = [new Float32Array(cornerCount * COMPONENT_COUNT), new Float32Array(cornerCount * COMPONENT_COUNT)];
  const firstNormals = new Float32Array(cornerCount * COMPONENT_COUNT);
  let count = 0;
  for (let corner = 0; corner < cornerCount; corner++) {
    const vertex = index?.[corner] ?? corner;
    const [x, y, z] = [normals[3 * vertex] ?? 0, normals[3 * vertex + 1] ?? 0, normals[3 * vertex + 2] ?? 0];
    const weldedVertex = weldedVertices[vertex] ?? vertex;
    let candidate = newestVertices[weldedVertex] ?? 0;
    const hasNoNormal = x === 0 && y === 0 && z === 0;
    while (candidate > 0 && !hasNoNormal) {
      const i = 3 * (candidate - 1);
      if (x * (firstNormals[i] ?? 0) + y * (firstNormals[i + 1] ?? 0) + z * (firstNormals[i + 2] ?? 0) >= MIN_COSINE) break;
      candidate = previousVertices[candidate - 1] ?? 0;
    }
    if (candidate === 0) {
      previousVertices[count] = newestVertices[weldedVertex] ?? 0;
      positionSums.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * count);
      firstNormals.set([x, y, z], 3 * count);
      count += 1;
      candidate = newestVertices[weldedVertex] = count;
    }
    const i = 3 * (candidate - 1);
    normalSums[i] = (normalSums[i] ?? 0) + x;
    normalSums[i + 1] = (normalSums[i + 1] ?? 0) + y;
    normalSums[i + 2] = (normalSums[i + 2] ?? 0) + z;
    weldedIndex[corner] = candidate - 1;
  }
  for (let i = 0; i < 3 * count; i += 3) {
    const length = Math.hypot(normalSums[i] ?? 0, normalSums[i + 1] ?? 0, normalSums[i + 2] ?? 0) || 1;
    for (let j = i; j < i + 3; j++) normalSums[j] = (normalSums[j] ?? 0) / length;
  }
  return { positions: positionSums.slice(0, 3 * count), normals: normalSums.slice(0, 3 * count), index: removeDegenerate(weldedIndex) };
}

/** Returns the triangles without those that have two equal corners. */
function removeDegenerate(index: Uint32Array): Uint32Array {
  let length = 0;
  for (let i = 0; i + 2 < index.length; i += 3) {
    const [a = 0, b = 0, c = 0] = index.subarray(i, i + 3);
    if (a === b || b === c || c === a) continue;
    index.set([a, b, c], length);
    length += 3;
  }
  return index.slice(0, length);
}

function computeBoundingSphere(positions: Float32Array): [number, number, number, number] {
  const [minimum, maximum] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  positions.forEach((position, i) => {
    minimum[i % 3] = Math.min(minimum[i % 3] ?? position, position);
    maximum[i % 3] = Math.max(maximum[i % 3] ?? position, position);
  });
  const centerOf = (axis: number): number => ((minimum[axis] ?? 0) + (maximum[axis] ?? 0)) / 2;
  const [x, y, z] = [centerOf(0), centerOf(1), centerOf(2)];
  let radius = 0;
  for (let i = 0; i < positions.length; i += 3) {
    radius = Math.max(radius, Math.hypot((positions[i] ?? 0) - x, (positions[i + 1] ?? 0) - y, (positions[i + 2] ?? 0) - z));
  }
  return positions.length > 0 ? [x, y, z, radius] : [0, 0, 0, 0];
}
