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
interface Words {
  readonly kinds: Readonly<Record<JointDetails["kind"], string>>;
  readonly table: { readonly damping: (value: string) => string; readonly friction: (value: string) => string };
}

/** Returns the texts of a joint's row. */
export function cellTexts(joint: JointDetails, angles: AngleUnits, words: Words): Record<Column, string> {
  const scale = angles.scale(joint.kind);
  const unit = joint.kind === "prismatic" ? "m" : angles.current;
  const moves = joint.kind !== "fixed";
  const amount = (value: number | null, of: string): string => (value === null ? "" : `${rounded(value)} ${of}`.trim());
  const scaled = (value: number | null, per = ""): string => (value === null ? "" : amount(value * scale, unit + per));
  const { mimic, damping, friction, soft_lower, soft_upper } = joint;
  return {
    name: joint.name,
    kind: words.kinds[joint.kind],
    parent: joint.parent,
    child: joint.child,
    axis: moves && joint.kind !== "floating" ? joint.axis.map(rounded).join(" ") : "",
    lower: scaled(joint.lower),
    upper: scaled(joint.upper),
    velocity: scaled(joint.velocity, "/s"),
    effort: amount(joint.effort, joint.kind === "prismatic" ? "N" : "N m"),
    mimic: mimic ? mimicText(mimic.joint, mimic.multiplier, mimic.offset * scale, unit) : "",
    dynamics: [
      damping === null ? "" : words.table.damping(rounded(damping)),
      friction === null ? "" : words.table.friction(rounded(friction)),
    ]
      .filter((text) => text !== "")
      .join(", "),
    safety:
      soft_lower === null || soft_upper === null
        ? ""
        : `${rounded(soft_lower * scale)} … ${scaled(soft_upper)}, k ${rounded(joint.k_position ?? 0)}, ${rounded(joint.k_velocity ?? 0)}`,
  };
}

/** Returns `2 × elbow + 0.1 rad`. */
export function mimicText(joint: string, multiplier: number, offset: number, unit: string): string {
  const product = multiplier === 1 ? joint : multiplier === -1 ? `−${joint}` : `${rounded(multiplier)} × ${joint}`;
  if (offset === 0) return product;
  return `${product} ${offset < 0 ? "−" : "+"} ${rounded(Math.abs(offset))} ${unit}`;
}

/** Returns joints sorted by a column: numbers by their value, joints without one last. */
export function sortJoints(joints: readonly JointDetails[], column: Column, descending: boolean): JointDetails[] {
  const way = descending ? -1 : 1;
  return [...joints].sort((a, b) => {
    const [x, y] = [value(a, column), value(b, column)];
    if (x === null || y === null) return Number(x === null) - Number(y === null);
    const order = typeof x === "number" && typeof y === "number" ? x - y : COLLATOR.compare(String(x), String(y));
    return order * way;
  });
}

const COLLATOR = new Intl.Collator("en", { numeric: true });

function value(joint: JointDetails, column: Column): number | string | null {
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
function rounded(value: number): string {
  return formatGeneral(Number(value.toPrecision(4)));
}
