import type { DockviewApi, DockviewGroupPanel } from "dockview";
import { formOf } from "./default-layout";

const SCENE = "scene";
/** Pixels; if less would remain for the scene, the dock's own distribution stays. */
const MIN_SCENE_WIDTH = 160;

/**
 * Keeps the widths of the columns beside the scene when panels are opened and closed: the scene gets or gives the
 * difference.
 *
 * The dock alone would distribute the width again, and give most of it to the last column when a panel across the
 * window is closed.
 */
export class ColumnWidths {
  private widths = new Map<string, number>();

  constructor(private readonly api: DockviewApi) {}

  /** Remembers the current widths as the ones to keep. */
  remember(): void {
    this.widths = new Map(this.api.groups.map(({ id, width }) => [id, width]));
  }

  /** Restores the widths of the remaining columns after columns were added or removed. */
  restoreAfterChange(): void {
    const { groups } = this.api;
    const isSame = groups.length === this.widths.size && groups.every(({ id }) => this.widths.has(id));
    if (!isSame && this.widths.size > 0 && formOf(this.api) === "wide") this.restore();
    this.remember();
  }

  private restore(): void {
    const columns = this.columns();
    const scene = columns.findIndex((group) => hasScene(group));
    const widths = columns.map(({ id, width }) => this.widths.get(id) ?? width);
    const rest = this.api.width - widths.reduce((sum, width, i) => (i === scene ? sum : sum + width), 0);
    if (scene < 0 || rest < MIN_SCENE_WIDTH) return;
    widths[scene] = rest;
    // Each column takes its width from the last one, which therefore ends with its own width, too.
    for (const [i, group] of columns.slice(0, -1).entries()) group.api.setSize({ width: widths[i] ?? group.width });
  }

  /** Returns one group of each column, from the left; for the scene's column, the scene's group. */
  private columns(): DockviewGroupPanel[] {
    const boxes = this.api.groups.map((group) => ({ group, box: group.element.getBoundingClientRect() }));
    const scene = boxes.find(({ group }) => hasScene(group))?.box;
    const found: typeof boxes = [];
    for (const each of boxes.sort((a, b) => a.box.left - b.box.left)) {
      const { group, box } = each;
      const isOver = (other: DOMRect): boolean => box.left < other.right - 1 && other.left < box.right - 1;
      if (hasScene(group) || !(scene && isOver(scene)) && !found.some((other) => isOver(other.box))) found.push(each);
    }
    return found.map(({ group }) => group);
  }
}

function hasScene(group: DockviewGroupPanel): boolean {
  return group.panels.some(({ id }) => id === SCENE);
}
