import { Matrix4 } from "three";

/** The eigenvalues of a symmetric matrix, and its eigenvectors as columns of a rotation. */
export interface PrincipalAxes {
  values: [number, number, number];
  /** The axes, right-handed. */
  axes: Matrix4;
}

const SWEEP_COUNT = 12;
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
export function computePrincipalAxes(m: readonly [number, number, number, number, number, number, number, number, number]): PrincipalAxes {
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
  const elementAt = (matrix: number[][], row: number, column: number): number => matrix[row]?.[column] ?? 0;
  const rotate = (matrix: number[][], row: number, p: number, q: number, c: number, s: number): void => {
    const elements = matrix[row] ?? [];
    const [x = 0, y = 0] = [elements[p], elements[q]];
    elements[p] = c * x - s * y;
    elements[q] = s * x + c * y;
  };
  for (let sweep = 0; sweep < SWEEP_COUNT; sweep++) {
    for (const [p, q] of PLANES) {
      if (elementAt(a, p, q) === 0) continue;
      const theta = (elementAt(a, q, q) - elementAt(a, p, p)) / (2 * elementAt(a, p, q));
      const t = Math.sign(theta || 1) / (Math.abs(theta) + Math.hypot(theta, 1));
      const c = 1 / Math.hypot(t, 1);
      const s = t * c;
      for (let row = 0; row < 3; row++) {
        rotate(a, row, p, q, c, s);
        rotate(v, row, p, q, c, s);
      }
      const [rowP = [], rowQ = []] = [a[p], a[q]];
      for (let column = 0; column < 3; column++) {
        const [x = 0, y = 0] = [rowP[column], rowQ[column]];
        rowP[column] = c * x - s * y;
        rowQ[column] = s * x + c * y;
      }
    }
  }
  const axes = new Matrix4().set(
    elementAt(v, 0, 0), elementAt(v, 0, 1), elementAt(v, 0, 2), 0,
    elementAt(v, 1, 0), elementAt(v, 1, 1), elementAt(v, 1, 2), 0,
    elementAt(v, 2, 0), elementAt(v, 2, 1), elementAt(v, 2, 2), 0,
    0, 0, 0, 1,
  );
  return { values: [elementAt(a, 0, 0), elementAt(a, 1, 1), elementAt(a, 2, 2)], axes };
}
