import { Color, Matrix4, Quaternion, Vector3 } from "three";
import type { PropertyRows } from "../../state/properties";
import type { ArrowShape } from "../objects/arrow-batch";
import type { CovarianceStyle } from "../objects/covariance-batch";

/** Reads properties that several displays share into the parameters of drawing objects. */

/** Returns a color property as 0xrrggbb. */
export function colorOf(rows: PropertyRows, fallback: string, ...path: string[]): number {
  return new Color(rows.text(fallback, ...path)).getHex();
}

/** Returns the arrow of Pose, PoseWithCovariance and Odometry; RViz's radius is a thickness, see `createAxes`. */
export function readArrowShape(rows: PropertyRows, parentPath: readonly string[]): ArrowShape {
  return {
    shaftLength: rows.number(1, ...parentPath, "Shaft Length"),
    shaftDiameter: rows.number(0.05, ...parentPath, "Shaft Radius"),
    headLength: rows.number(0.3, ...parentPath, "Head Length"),
    headDiameter: rows.number(0.1, ...parentPath, "Head Radius"),
  };
}

/** Returns the style of the Covariance property; null if it is off or the display has none. */
export function readCovarianceStyle(rows: PropertyRows): CovarianceStyle | null {
  if (!rows.bool(false, "Covariance")) return null;
  const pathOf = (name: string): string[] => ["Covariance", name];
  const position = rows.bool(true, ...pathOf("Position")) && {
    color: colorOf(rows, "#cc33cc", ...pathOf("Position"), "Color"),
    alpha: rows.number(0.3, ...pathOf("Position"), "Alpha"),
    scale: rows.number(1, ...pathOf("Position"), "Scale"),
  };
  const uniqueColor = colorOf(rows, "#ffff7f", ...pathOf("Orientation"), "Color");
  const isRgb = rows.text("Unique", ...pathOf("Orientation"), "Color Style") === "RGB";
  const orientation = rows.bool(true, ...pathOf("Orientation")) && {
    isLocal: rows.text("Local", ...pathOf("Orientation"), "Frame") === "Local",
    colors: isRgb ? ([0xff0000, 0x00ff00, 0x0000ff] as const) : ([uniqueColor, uniqueColor, uniqueColor] as const),
    alpha: rows.number(0.5, ...pathOf("Orientation"), "Alpha"),
    offset: rows.number(1, ...pathOf("Orientation"), "Offset"),
    scale: rows.number(1, ...pathOf("Orientation"), "Scale"),
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
