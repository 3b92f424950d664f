import { Matrix4 } from "three";

/** The eigenvalues of a symmetric matrix, and its eigenvectors as columns of a rotation. */
export interface PrincipalAxes {
  values: [number, number, number];
  /** The axes, right-handed. */
  axes: Matrix4;
}

const SWEEPS = 12;
const PLANES = [
  [0, 1],
  [0, 2],
  [1, 2],
] as const;

/**
 * Computes principal axes by Jacobi rotations.
 *
 * @param m - row by row; only the upper triangle is read.
 */
export function principalAxes(m: readonly [number, number, number, number, number, number, number, number, number]): PrincipalAxes {
  const a = [
    [m[0], m[1], m[2]],
    [m[1], m[4], m[5]],
    [m[2], m[5], m[8]],
  ];
  const v = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  const at = (matrix: number[][], row: number, column: number): number => matrix[row]?.[column] ?? 0;
  const turn = (matrix: number[][], row: number, p: number, q: number, c: number, s: number): void => {
    const line = matrix[row] ?? [];
    const [x = 0, y = 0] = [line[p], line[q]];
    line[p] = c * x - s * y;
    line[q] = s * x + c * y;
  };
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    for (const [p, q] of PLANES) {
      if (at(a, p, q) === 0) continue;
      const theta = (at(a, q, q) - at(a, p, p)) / (2 * at(a, p, q));
      const t = Math.sign(theta || 1) / (Math.abs(theta) + Math.hypot(theta, 1));
      const c = 1 / Math.hypot(t, 1);
      const s = t * c;
      for (let row = 0; row < 3; row++) {
        turn(a, row, p, q, c, s);
        turn(v, row, p, q, c, s);
      }
      const [high = [], low = []] = [a[p], a[q]];
      for (let column = 0; column < 3; column++) {
        const [x = 0, y = 0] = [high[column], low[column]];
        high[column] = c * x - s * y;
        low[column] = s * x + c * y;
      }
    }
  }
  const axes = new Matrix4().set(
    at(v, 0, 0), at(v, 0, 1), at(v, 0, 2), 0,
    at(v, 1, 0), at(v, 1, 1), at(v, 1, 2), 0,
    at(v, 2, 0), at(v, 2, 1), at(v, 2, 2), 0,
    0, 0, 0, 1,
  );
  return { values: [at(a, 0, 0), at(a, 1, 1), at(a, 2, 2)], axes };
}
