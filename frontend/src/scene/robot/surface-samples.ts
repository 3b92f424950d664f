import { Triangle, Vector3, type BufferGeometry, type Mesh } from "three";
import type { Vector } from "../../state/views/vector";

/** The number of sample points of a surface. */
const POINT_COUNT = 320;
/** To frame a robot, every n-th sample is enough. */
const FRAMING_STRIDE = 4;
/** The steps of the R2 sequence, which fills a triangle evenly. */
const [STEP_A, STEP_B] = [0.7548776662, 0.5698402909];

/** Points distributed evenly over a surface. */
export interface SurfaceSamples {
  /** x y z of each point, m. */
  readonly points: Float32Array;
  /** The area that each point represents, m^2. */
  readonly area: number;
}

const cache = new WeakMap<BufferGeometry, SurfaceSamples>();

/** Returns the samples of a geometry in its own frame; they are computed once. */
export function getSamples(geometry: BufferGeometry): SurfaceSamples {
  let samples = cache.get(geometry);
  if (!samples) cache.set(geometry, (samples = sampleSurface(geometry)));
  return samples;
}

/** Returns some points on the surface of a mesh, whose world matrix must be current, in the fixed frame. */
export function listFramingPoints({ geometry, matrixWorld }: Mesh): Vector[] {
  const { points } = getSamples(geometry);
  const samples: Vector[] = [];
  for (let i = 0; i < points.length; i += 3 * FRAMING_STRIDE) samples.push(new Vector3().fromArray(points, i).applyMatrix4(matrixWorld).toArray());
  return samples;
}

function sampleSurface(geometry: BufferGeometry): SurfaceSamples {
  const { index } = geometry;
  const positions = geometry.getAttribute("position");
  const count = Math.floor((index ?? positions).count / 3);
  const cumulativeAreas = new Float64Array(count);
  const triangle = new Triangle();
  const triangleAt = (i: number): Triangle => {
    const [a, b, c] = [3 * i, 3 * i + 1, 3 * i + 2].map((vertex) => index?.getX(vertex) ?? vertex) as [number, number, number];
    triangle.setFromAttributeAndIndices(positions, a, b, c);
    return triangle;
  };
  let area = 0;
  for (let i = 0; i < count; i++) cumulativeAreas[i] = area += triangleAt(i).getArea() || 0;
  const points = new Float32Array(area > 0 ? 3 * POINT_COUNT : 0);
  const [point, side] = [new Vector3(), new Vector3()];
  for (let n = 0, i = 0; 3 * n < points.length; n++) {
    const target = ((n + 0.5) / POINT_COUNT) * area;
    while (i < count - 1 && (cumulativeAreas[i] ?? area) < target) i++;
    const { a, b, c } = triangleAt(i);
    const [u, v] = [(n * STEP_A) % 1, (n * STEP_B) % 1];
    const isOutsideTriangle = u + v > 1;
    point.copy(a).addScaledVector(side.subVectors(b, a), isOutsideTriangle ? 1 - u : u);
    point.addScaledVector(side.subVectors(c, a), isOutsideTriangle ? 1 - v : v).toArray(points, 3 * n);
  }
  return { points, area: area / POINT_COUNT };
}
