import { composePoses, computeRelativePose, type PoseNumbers } from "../pose-numbers";
import type { Chain, TipMotion } from "./chain";

const MAX_STEPS = 40;
/** The initial damping, relative to the largest diagonal element. */
const INITIAL_DAMPING = 1e-3;
const MAX_DAMPING = 1e8;
/** A step that lowers the squared error by less than this share ends the search. */
const MIN_GAIN = 1e-6;
/** The length at which an error of orientation counts as much as one of position, m/rad. */
const LENGTH_PER_RAD = 0.3;
/** Chains with fewer variables cannot take every pose, so that moving the tip leaves its orientation free. */
const FREE_VARIABLE_COUNT = 6;
/** Errors below which the target counts as reached, m and rad. */
const REACHED_M = 1e-3;
const REACHED_RAD = 0.01;
/** How far the joints are moved away from a straightened or folded pose, in which no joint brings the tip closer. */
const NUDGES_RAD = [0.1, -0.1, 0.4, -0.4] as const;

/** What the user does with the tip: move it, or turn it. */
export type TipTask = "move" | "turn";

/** The joint positions nearest to a target, and the remaining distance. */
export interface TipSolution {
  readonly positions: readonly number[];
  readonly distanceM: number;
  readonly angleRad: number;
  readonly isReached: boolean;
}

/** Returns the joint positions that bring the tip closest to a target, by damped least squares within the limits. */
export function solveTip(chain: Chain, start: readonly number[], target: PoseNumbers, task: TipTask): TipSolution {
  const isOrientationFree = task === "move" && chain.variables.length < FREE_VARIABLE_COUNT;
  const weight = isOrientationFree ? 0 : LENGTH_PER_RAD;
  const clamped = clampPositions(chain, start);
  let best = descend(chain, clamped, target, weight);
  for (const nudge of NUDGES_RAD) {
    if (judge(chain, best, target, isOrientationFree).isReached) break;
    const nudged = clampPositions(chain, best.map((position, i) => position + (i % 2 === 0 ? nudge : -nudge)));
    const candidate = descend(chain, nudged, target, weight);
    const [oldCost, newCost] = [best, candidate].map((positions) => costOf(computeError(chain.computeMotion(positions), target, weight)));
    if ((newCost ?? 0) < 0.99 * (oldCost ?? 0)) best = candidate;
  }
  return judge(chain, best, target, isOrientationFree);
}

function judge(chain: Chain, positions: readonly number[], target: PoseNumbers, isOrientationFree: boolean): TipSolution {
  const [x = 0, y = 0, z = 0, a = 0, b = 0, c = 0] = computeError(chain.computeMotion(positions), target, 1);
  const [distanceM, angleRad] = [Math.hypot(x, y, z), isOrientationFree ? 0 : Math.hypot(a, b, c)];
  return { positions: positions.map((position, i) => wrap(chain, position, i)), distanceM, angleRad, isReached: distanceM < REACHED_M && angleRad < REACHED_RAD };
}

/** Returns a minimum of the error near the start (Levenberg and Marquardt); joints stay within their limits. */
function descend(chain: Chain, start: readonly number[], target: PoseNumbers, weight: number): readonly number[] {
  let positions = start;
  let motion = chain.computeMotion(positions);
  let error = computeError(motion, target, weight);
  let damping = INITIAL_DAMPING;
  for (let i = 0; i < MAX_STEPS && damping < MAX_DAMPING && costOf(error) > 1e-14; i++) {
    const step = computeStep(chain, positions, motion, error, weight, damping);
    const next = clampPositions(chain, positions.map((position, k) => position + (step[k] ?? 0)));
    const nextMotion = chain.computeMotion(next);
    const nextError = computeError(nextMotion, target, weight);
    const gain = costOf(error) - costOf(nextError);
    if (gain <= 0) {
      damping *= 8;
      continue;
    }
    const isDone = gain < MIN_GAIN * costOf(error);
    [positions, motion, error, damping] = [next, nextMotion, nextError, Math.max(damping / 5, 1e-9)];
    if (isDone) break;
  }
  return positions;
}

/** Returns the damped step of the joints; joints at a limit that the error pushes against stay where they are. */
function computeStep(chain: Chain, positions: readonly number[], { jacobian }: TipMotion, error: readonly number[], weight: number, damping: number): number[] {
  const columns = jacobian.map((column) => column.map((component, i) => (i < 3 ? component : component * weight)));
  const gradient = columns.map((column) => dot(column, error));
  const free = columns.flatMap((_, i) => (isPushedOut(chain, positions, gradient, i) ? [] : [i]));
  const matrix = free.map((i) => free.map((k) => dot(columns[i] ?? [], columns[k] ?? [])));
  const scale = Math.max(1e-9, ...matrix.map((row, i) => row[i] ?? 0));
  matrix.forEach((row, i) => (row[i] = (row[i] ?? 0) + damping * scale));
  const solution = solveSymmetric(matrix, free.map((i) => gradient[i] ?? 0));
  const step = columns.map(() => 0);
  free.forEach((variable, i) => (step[variable] = solution[i] ?? 0));
  return step;
}

function isPushedOut(chain: Chain, positions: readonly number[], gradient: readonly number[], i: number): boolean {
  const [variable, position = 0, push = 0] = [chain.variables[i], positions[i], gradient[i]];
  if (!variable || variable.isEndless) return false;
  return (position <= variable.lower && push < 0) || (position >= variable.upper && push > 0);
}

/** Returns the error of the tip in the base: m, and a rotation vector times the weight. */
function computeError({ pose }: TipMotion, target: PoseNumbers, weight: number): number[] {
  const turn = computeRelativePose([0, 0, 0, pose[3], pose[4], pose[5], pose[6]], [0, 0, 0, target[3], target[4], target[5], target[6]]);
  const sign = turn[6] < 0 ? -1 : 1;
  const [x, y, z] = [turn[3] * sign, turn[4] * sign, turn[5] * sign];
  const sine = Math.hypot(x, y, z);
  const factor = weight * (sine < 1e-9 ? 2 : (2 * Math.atan2(sine, turn[6] * sign)) / sine);
  const inBase = composePoses([0, 0, 0, pose[3], pose[4], pose[5], pose[6]], [x * factor, y * factor, z * factor, 0, 0, 0, 1]);
  return [target[0] - pose[0], target[1] - pose[1], target[2] - pose[2], inBase[0], inBase[1], inBase[2]];
}

/** Solves a positive definite system by Cholesky's decomposition. */
function solveSymmetric(matrix: number[][], right: number[]): number[] {
  const size = right.length;
  const at = (row: number, column: number): number => matrix[row]?.[column] ?? 0;
  for (let i = 0; i < size; i++) {
    for (let k = 0; k <= i; k++) {
      let sum = at(i, k);
      for (let n = 0; n < k; n++) sum -= at(i, n) * at(k, n);
      const row = matrix[i];
      if (row) row[k] = i === k ? Math.sqrt(Math.max(sum, 1e-18)) : sum / at(k, k);
    }
  }
  const solution = [...right];
  for (let i = 0; i < size; i++) {
    for (let n = 0; n < i; n++) solution[i] = (solution[i] ?? 0) - at(i, n) * (solution[n] ?? 0);
    solution[i] = (solution[i] ?? 0) / at(i, i);
  }
  for (let i = size - 1; i >= 0; i--) {
    for (let n = i + 1; n < size; n++) solution[i] = (solution[i] ?? 0) - at(n, i) * (solution[n] ?? 0);
    solution[i] = (solution[i] ?? 0) / at(i, i);
  }
  return solution;
}

function clampPositions({ variables }: Chain, positions: readonly number[]): number[] {
  return variables.map(({ lower, upper, isEndless }, i) => (isEndless ? (positions[i] ?? 0) : Math.min(Math.max(positions[i] ?? 0, lower), upper)));
}

/** Returns the position within the slider's range: endless joints have the same pose after a turn. */
function wrap({ variables }: Chain, position: number, i: number): number {
  return variables[i]?.isEndless === true ? Math.atan2(Math.sin(position), Math.cos(position)) : position;
}

function costOf(error: readonly number[]): number {
  return dot(error, error);
}

function dot(a: readonly number[], b: readonly number[]): number {
  return a.reduce((sum, component, i) => sum + component * (b[i] ?? 0), 0);
}
