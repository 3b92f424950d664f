import { Quaternion, Vector3, type Matrix4 } from "three";
import type { DescriptionRow } from "./picking";

/** Returns the rows `Position` and `Orientation` of RViz's Selection panel. */
export function describePose(pose: Matrix4): DescriptionRow[] {
  const [position, orientation] = [new Vector3(), new Quaternion()];
  pose.decompose(position, orientation, new Vector3());
  const { x, y, z } = position;
  return [
    describeNumbers("Position", { X: x, Y: y, Z: z }),
    describeNumbers("Orientation", { X: orientation.x, Y: orientation.y, Z: orientation.z, W: orientation.w }),
  ];
}

/** Returns a row whose value lists all numbers, with one row for each number below it. */
export function describeNumbers(name: string, numbers: Readonly<Record<string, number>>): DescriptionRow {
  const children = Object.entries(numbers).map(([key, value]) => ({ name: key, value: String(Number(value.toPrecision(6))) }));
  return { name, value: children.map(({ value }) => value).join("; "), children };
}
