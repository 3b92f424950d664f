import type { PointFields } from "../../protocol";
import type { DescriptionRow } from "../picking";

const DIGIT_COUNT = 6;

/**
 * Returns the rows of RViz's Selection panel for a point: its position in the message's frame, then its other fields,
 * numbered.
 */
export function describePoint(
  index: number,
  cloud: string,
  position: Float32Array,
  fields: PointFields["fields"] | null,
): DescriptionRow {
  const coordinates = [...position].map((coordinate) => String(Number(coordinate.toPrecision(DIGIT_COUNT))));
  const children: DescriptionRow[] = [
    {
      name: "Position",
      value: coordinates.join("; "),
      children: ["X", "Y", "Z"].map((name, axis) => ({ name, value: coordinates[axis] ?? "" })),
    },
  ];
  Object.entries(fields ?? {}).forEach(([name, value], number) => {
    const row = `${number + coordinates.length}: ${name}`;
    if (typeof value === "number") {
      children.push({ name: row, value: String(Number(value.toPrecision(DIGIT_COUNT))) });
    } else if (value.startsWith("#")) {
      const channels = [1, 3, 5, 7].map((start) => parseInt(value.slice(start, start + 2), 16));
      children.push({ name: row, value: channels.slice(0, 3).join("; ") });
      children.push({ name: "alpha", value: String(Number(((channels[3] ?? 0) / 255).toPrecision(DIGIT_COUNT))) });
    } else {
      children.push({ name: row, value });
    }
  });
  return { name: cloud === "" ? `Point ${index}` : `Point ${index} [cloud ${cloud}]`, children };
}
