import type { Connection } from "../connection/connection";
import type { ComparedDescriptions, ComparedItem, ComparedRobot } from "../protocol";
import { Signal } from "../signal";
import type { ElementName } from "./description-model";

export type MarkName = "added" | "changed" | "removed" | "old";

/**
 * Colors that are distinct with red-green or blue-yellow color blindness; `comparison.test.ts` computes how
 * well.
 */
export const MARK_COLORS: Readonly<Record<MarkName, string>> = {
  added: "#56b4e9",
  changed: "#f0c020",
  removed: "#cc3377",
  old: "#c4ccd6",
};

/** Replaces the colors of a link's description. */
export interface LinkOverride {
  /** r g b, 0 to 1. */
  readonly color: readonly [number, number, number];
  /** Whether objects in the same place are drawn over the link. */
  readonly isBehind?: boolean;
  /** Whether the link is less transparent than the rest of the robot. */
  readonly isOpaque?: boolean;
}

/** The comparison of two descriptions in one scene: their differences, and how their links are drawn. */
export class ComparisonState {
  readonly changed = new Signal();
  private descriptions: ComparedDescriptions | null = null;
  private showsMarks = true;

  constructor(connection: Connection) {
    connection.on("hello", () => this.setDescriptions(null));
    connection.on("compared_descriptions", (message) => this.setDescriptions(message));
  }

  /** The compared descriptions; null if only one is shown. */
  get compared(): ComparedDescriptions | null {
    return this.descriptions;
  }

  /** Whether links are colored by their differences. */
  get areMarksShown(): boolean {
    return this.showsMarks;
  }

  set areMarksShown(showsMarks: boolean) {
    this.showsMarks = showsMarks;
    this.changed.emit();
  }

  /** Returns the look that replaces that of a link's description in a display; null to keep it. */
  overrideOf(display: string, link: string): LinkOverride | null {
    const { descriptions } = this;
    if (!descriptions || display === "") return null;
    const isOld = display === descriptions.old.display;
    if (!isOld && display !== descriptions.new.display) return null;
    const mark = this.showsMarks ? (isOld ? descriptions.old : descriptions.new).marks[link] : undefined;
    if (isOld) return { color: parseRgb(MARK_COLORS[mark ?? "old"]), isBehind: true, isOpaque: mark !== undefined };
    return mark ? { color: parseRgb(MARK_COLORS[mark]) } : null;
  }

  /** Whether a display shows the old description. */
  isOld(display: string): boolean {
    return this.descriptions !== null && display !== "" && this.descriptions.old.display === display;
  }

  /**
   * Returns the link of the new robot that looks the same as a link of the old one, and is drawn instead if both have
   * the same pose; undefined if there is none, or if the display is not that of the old robot.
   */
  twinOf(display: string, link: string): string | undefined {
    return this.isOld(display) ? this.descriptions?.shapes[link] : undefined;
  }

  /** Returns the link or joint that shows a difference; null if none does. */
  elementOf(item: ComparedItem): ElementName | null {
    const display = item.in_old ? this.descriptions?.old.display : this.descriptions?.new.display;
    return display && item.element !== "" ? { display, kind: item.element_kind, name: item.element } : null;
  }

  private setDescriptions(message: ComparedDescriptions | null): void {
    if (this.descriptions === null && message === null) return;
    this.descriptions = message;
    this.changed.emit();
  }
}

/** The differences of one object, which are shown together. */
export interface DifferenceGroup {
  readonly items: readonly ComparedItem[];
  /** The kind of change of the whole object. */
  readonly kind: ComparedItem["kind"];
}

export function groupDifferences(items: readonly ComparedItem[]): DifferenceGroup[] {
  const groups: ComparedItem[][] = [];
  for (const item of items) {
    const lastGroup = groups.at(-1);
    const [first] = lastGroup ?? [];
    if (lastGroup && first?.subject === item.subject && first.name === item.name) lastGroup.push(item);
    else groups.push([item]);
  }
  return groups.map((group) => ({ items: group, kind: group.length === 1 ? (group[0]?.kind ?? "changed") : "changed" }));
}

/** Returns the marks among the links, in the order of the legend. */
export function listUsedMarks(robots: readonly ComparedRobot[]): MarkName[] {
  const marks = new Set<MarkName>(robots.flatMap((robot) => Object.values(robot.marks)));
  return [...(["added", "changed", "removed"] as const).filter((mark) => marks.has(mark)), "old"];
}

function parseRgb(hex: string): [number, number, number] {
  const channelAt = (start: number): number => parseInt(hex.slice(start, start + 2), 16) / 255;
  return [channelAt(1), channelAt(3), channelAt(5)];
}
