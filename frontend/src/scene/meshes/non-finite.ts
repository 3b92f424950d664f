import type { BufferAttribute, BufferGeometry, InterleavedBufferAttribute } from "three";
import { strings } from "../../strings";
import { formatCount, MeshError } from "./mesh-error";

/** The number of vertices that are not finite, and of the triangles with such vertices. */
export interface NonFiniteCounts {
  vertices: number;
  /** The triangles with such a vertex. */
  triangles: number;
  /** All triangles of the geometry. */
  totalTriangles: number;
}

type Positions = BufferAttribute | InterleavedBufferAttribute;

/**
 * Collapses triangles with a vertex that is NaN or infinite to a point, so that they are not drawn and bounds are
 * valid. The geometry's groups stay.
 */
export function collapseNonFinite(geometry: BufferGeometry): NonFiniteCounts {
  const positions = geometry.getAttribute("position") as Positions | undefined;
  if (!positions) return { vertices: 0, triangles: 0, totalTriangles: 0 };
  const { index } = geometry;
  const totalTriangles = Math.floor((index ?? positions).count / 3);
  const finiteFlags = new Uint8Array(positions.count);
  for (let i = 0; i < finiteFlags.length; i++) {
    finiteFlags[i] = Number.isFinite(positions.getX(i) + positions.getY(i) + positions.getZ(i)) ? 1 : 0;
  }
  const vertices = finiteFlags.reduce((sumOf, flag) => sumOf + 1 - flag, 0);
  const isIndexBeyond = index !== null && index.array.some((vertex) => vertex >= finiteFlags.length);
  if (vertices === 0 && !isIndexBeyond) return { vertices, triangles: 0, totalTriangles };
  const finiteVertex = Math.max(0, finiteFlags.indexOf(1));
  const replaceNonFinite = (coordinate: number): number => (Number.isFinite(coordinate) ? coordinate : 0);
  const position = [positions.getX(finiteVertex), positions.getY(finiteVertex), positions.getZ(finiteVertex)].map(replaceNonFinite) as [number, number, number];
  let triangles = 0;
  for (let i = 0; i < 3 * totalTriangles; i += 3) {
    const corners = [i, i + 1, i + 2].map((vertex) => index?.getX(vertex) ?? vertex);
    if (corners.every((vertex) => finiteFlags[vertex] === 1)) continue;
    triangles++;
    for (let j = 0; j < 3; j++) {
      if (index) index.setX(i + j, finiteVertex);
      else positions.setXYZ(i + j, ...position);
    }
  }
  for (let i = 0; i < finiteFlags.length; i++) if (finiteFlags[i] === 0) positions.setXYZ(i, ...position);
  return { vertices, triangles, totalTriangles };
}

/**
 * Returns the message about vertices that are not finite, or null.
 *
 * @throws MeshError if no triangle is left.
 */
export function describeNonFinite(counts: readonly NonFiniteCounts[]): string | null {
  const sumOf = (key: keyof NonFiniteCounts): number => counts.reduce((total, meshCounts) => total + meshCounts[key], 0);
  const [vertices, triangles] = [sumOf("vertices"), sumOf("triangles")];
  if (triangles > 0 && triangles === sumOf("totalTriangles")) throw new MeshError(strings.meshes.onlyNotNumbers(formatCount(vertices)));
  return vertices + triangles > 0 ? strings.meshes.notNumbers(formatCount(vertices), formatCount(triangles)) : null;
}
