import { Color, Matrix4, Quaternion, Vector3 } from "three";
import type { PropertyRows } from "../../state/properties";
import type { ArrowShape } from "../objects/arrow-batch";
import type { CovarianceStyle } from "../objects/covariance-batch";

/** Reads properties that several displays share into the parameters of drawing objects. */

/** Returns a color property as 0xrrggbb. */
export function colorOf(rows: PropertyRows, fallback: string, ...path: string[]): number {
  return new Color(rows.text(fallback, ...path)).getHex();
}

/** Returns the arrow of Pose, PoseWithCovariance and Odometry; RViz's radius is a thickness, see `axesGeometry`. */
export function poseArrow(rows: PropertyRows, below: readonly string[]): ArrowShape {
  return {
    shaftLength: rows.number(1, ...below, "Shaft Length"),
    shaftDiameter: rows.number(0.05, ...below, "Shaft Radius"),
    headLength: rows.number(0.3, ...below, "Head Length"),
    headDiameter: rows.number(0.1, ...below, "Head Radius"),
  };
}

/** Returns the style of the Covariance property; null if it is off or the display has none. */
export function covarianceStyle(rows: PropertyRows): CovarianceStyle | null {
  if (!rows.bool(false, "Covariance")) return null;
  const top = (name: string): string[] => ["Covariance", name];
  const position = rows.bool(true, ...top("Position")) && {
    color: colorOf(rows, "#cc33cc", ...top("Position"), "Color"),
    alpha: rows.number(0.3, ...top("Position"), "Alpha"),
    scale: rows.number(1, ...top("Position"), "Scale"),
  };
  const unique = colorOf(rows, "#ffff7f", ...top("Orientation"), "Color");
  const rgb = rows.text("Unique", ...top("Orientation"), "Color Style") === "RGB";
  const orientation = rows.bool(true, ...top("Orientation")) && {
    local: rows.text("Local", ...top("Orientation"), "Frame") === "Local",
    colors: rgb ? ([0xff0000, 0x00ff00, 0x0000ff] as const) : ([unique, unique, unique] as const),
    alpha: rows.number(0.5, ...top("Orientation"), "Alpha"),
    offset: rows.number(1, ...top("Orientation"), "Offset"),
    scale: rows.number(1, ...top("Orientation"), "Scale"),
  };
  return { position: position || null, orientation: orientation || null };
}

const position = new Vector3();
const orientation = new Quaternion();
const ONE = new Vector3(1, 1, 1);

/**
 * Computes the `i`-th of several poses (x y z qx qy qz qw each), in their own frame. A zero quaternion means no
 * rotation.
 */
export function poseAt(poses: Float32Array, i: number, matrix: Matrix4): Matrix4 {
  position.fromArray(poses, i * 7);
  orientation.fromArray(poses, i * 7 + 3).normalize();
  return matrix.compose(position, orientation, ONE);
}
