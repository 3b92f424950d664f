import type { Connection } from "../connection/connection";
import type { ComparedDescriptions, ComparedItem, ComparedRobot } from "../protocol";
import { Signal } from "../signal";
import type { ElementName } from "./description-model";

export type MarkName = "added" | "changed" | "removed" | "old";

/** Distinguishable with red-green or blue-yellow colour blindness; `comparison.test.ts` computes how well. */
export const MARK_COLORS: Readonly<Record<MarkName, string>> = {
  added: "#56b4e9",
  changed: "#f0c020",
  removed: "#cc3377",
  old: "#c4ccd6",
};

/** The look of a link in place of its description's. */
export interface Instead {
  /** r g b, from 0 to 1 */
  readonly color: readonly [number, number, number];
  /** Objects in the same place are drawn over it. */
  readonly behind?: boolean;
  /** It is seen through less than the rest of the robot. */
  readonly firm?: boolean;
}

/** Two descriptions in one scene: how they differ, and how their links are drawn. */
export class ComparisonState {
  readonly changed = new Signal();
  private descriptions: ComparedDescriptions | null = null;
  private marking = true;

  constructor(connection: Connection) {
    connection.on("hello", () => this.take(null));
    connection.on("compared_descriptions", (message) => this.take(message));
  }

  /** Null where one description is shown. */
  get compared(): ComparedDescriptions | null {
    return this.descriptions;
  }

  /** Whether links that differ are coloured by their difference. */
  get marks(): boolean {
    return this.marking;
  }

  set marks(marks: boolean) {
    this.marking = marks;
    this.changed.emit();
  }

  /** The look of a link in a display; null for that of its description. */
  instead(display: string, link: string): Instead | null {
    const { descriptions } = this;
    if (!descriptions || display === "") return null;
    const isOld = display === descriptions.old.display;
    if (!isOld && display !== descriptions.new.display) return null;
    const mark = this.marking ? (isOld ? descriptions.old : descriptions.new).marks[link] : undefined;
    if (isOld) return { color: rgb(MARK_COLORS[mark ?? "old"]), behind: true, firm: mark !== undefined };
    return mark ? { color: rgb(MARK_COLORS[mark]) } : null;
  }

  /** Whether a display shows the old description. */
  isOld(display: string): boolean {
    return this.descriptions !== null && display !== "" && this.descriptions.old.display === display;
  }

  /**
   * The link of the new robot that is drawn in place of one of a display, where both are in one place; undefined for
   * one that has other shapes, or of another display than that of the old robot.
   */
  twinOf(display: string, link: string): string | undefined {
    return this.isOld(display) ? this.descriptions?.shapes[link] : undefined;
  }

  /** The link or joint that shows a difference; null for one that nothing shows. */
  elementOf(item: ComparedItem): ElementName | null {
    const display = item.in_old ? this.descriptions?.old.display : this.descriptions?.new.display;
    return display && item.element !== "" ? { display, kind: item.element_kind, name: item.element } : null;
  }

  private take(message: ComparedDescriptions | null): void {
    if (this.descriptions === null && message === null) return;
    this.descriptions = message;
    this.changed.emit();
  }
}

/** The differences of one object, shown together. */
export interface DifferenceGroup {
  readonly items: readonly ComparedItem[];
  /** The change of the whole object. */
  readonly kind: ComparedItem["kind"];
}

export function grouped(items: readonly ComparedItem[]): DifferenceGroup[] {
  const groups: ComparedItem[][] = [];
  for (const item of items) {
    const last = groups.at(-1);
    const [first] = last ?? [];
    if (last && first?.subject === item.subject && first.name === item.name) last.push(item);
    else groups.push([item]);
  }
  return groups.map((each) => ({ items: each, kind: each.length === 1 ? (each[0]?.kind ?? "changed") : "changed" }));
}

/** The marks among the links, in the order of a legend. */
export function marksIn(robots: readonly ComparedRobot[]): MarkName[] {
  const found = new Set<MarkName>(robots.flatMap(({ marks }) => Object.values(marks)));
  return [...(["added", "changed", "removed"] as const).filter((mark) => found.has(mark)), "old"];
}

function rgb(hex: string): [number, number, number] {
  const part = (from: number): number => parseInt(hex.slice(from, from + 2), 16) / 255;
  return [part(1), part(3), part(5)];
}
