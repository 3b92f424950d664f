import type { JointDetails } from "../protocol";
import type { AngleUnits } from "./angle-unit";
import { formatGeneral } from "./number-text";

export const COLUMNS = [
  "name",
  "kind",
  "parent",
  "child",
  "axis",
  "lower",
  "upper",
  "velocity",
  "effort",
  "mimic",
  "dynamics",
  "safety",
] as const;

export type Column = (typeof COLUMNS)[number];

/** The texts for the cells. */
interface JointTexts {
  readonly kinds: Readonly<Record<JointDetails["kind"], string>>;
  readonly table: { readonly damping: (value: string) => string; readonly friction: (value: string) => string };
}

/** Returns the texts of a joint's row. */
export function formatJointCells(joint: JointDetails, angles: AngleUnits, texts: JointTexts): Record<Column, string> {
  const scale = angles.scaleOf(joint.kind);
  const unit = joint.kind === "prismatic" ? "m" : angles.current;
  const isMovable = joint.kind !== "fixed";
  const formatAmount = (value: number | null, unit: string): string => (value === null ? "" : `${formatRounded(value)} ${unit}`.trim());
  const formatScaled = (value: number | null, perTime = ""): string => (value === null ? "" : formatAmount(value * scale, unit + perTime));
  const { mimic, damping, friction, soft_lower, soft_upper } = joint;
  return {
    name: joint.name,
    kind: texts.kinds[joint.kind],
    parent: joint.parent,
    child: joint.child,
    axis: isMovable && joint.kind !== "floating" ? joint.axis.map(formatRounded).join(" ") : "",
    lower: formatScaled(joint.lower),
    upper: formatScaled(joint.upper),
    velocity: formatScaled(joint.velocity, "/s"),
    effort: formatAmount(joint.effort, joint.kind === "prismatic" ? "N" : "N m"),
    mimic: mimic ? formatMimic(mimic.joint, mimic.multiplier, mimic.offset * scale, unit) : "",
    dynamics: [
      damping === null ? "" : texts.table.damping(formatRounded(damping)),
      friction === null ? "" : texts.table.friction(formatRounded(friction)),
    ]
      .filter((text) => text !== "")
      .join(", "),
    safety:
      soft_lower === null || soft_upper === null
        ? ""
        : `${formatRounded(soft_lower * scale)} … ${formatScaled(soft_upper)}, k ${formatRounded(joint.k_position ?? 0)}, ${formatRounded(joint.k_velocity ?? 0)}`,
  };
}

/** Returns `2 × elbow + 0.1 rad`. */
export function formatMimic(joint: string, multiplier: number, offset: number, unit: string): string {
  const product = multiplier === 1 ? joint : multiplier === -1 ? `−${joint}` : `${formatRounded(multiplier)} × ${joint}`;
  if (offset === 0) return product;
  return `${product} ${offset < 0 ? "−" : "+"} ${formatRounded(Math.abs(offset))} ${unit}`;
}

/** Returns joints sorted by a column: numbers by their value, joints without one last. */
export function sortJoints(joints: readonly JointDetails[], column: Column, isDescending: boolean): JointDetails[] {
  const sign = isDescending ? -1 : 1;
  return [...joints].sort((a, b) => {
    const [x, y] = [sortValueOf(a, column), sortValueOf(b, column)];
    if (x === null || y === null) return Number(x === null) - Number(y === null);
    const order = typeof x === "number" && typeof y === "number" ? x - y : COLLATOR.compare(String(x), String(y));
    return order * sign;
  });
}

const COLLATOR = new Intl.Collator("en", { numeric: true });

function sortValueOf(joint: JointDetails, column: Column): number | string | null {
  switch (column) {
    case "axis":
      return joint.axis.join(" ");
    case "mimic":
      return joint.mimic?.joint ?? null;
    case "dynamics":
      return joint.damping;
    case "safety":
      return joint.soft_lower;
    case "name":
    case "kind":
    case "parent":
    case "child":
    case "lower":
    case "upper":
    case "velocity":
    case "effort":
      return joint[column];
  }
}

/** Rounds to four significant digits, which fit into a table. */
function formatRounded(value: number): string {
  return formatGeneral(Number(value.toPrecision(4)));
}
