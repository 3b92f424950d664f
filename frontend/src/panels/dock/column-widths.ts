import type { DockviewApi, DockviewGroupPanel } from "dockview";
import { formOf } from "./default-layout";

const SCENE_ID = "scene";
/** Pixels; if less would remain for the scene, the dock's own distribution stays. */
const MIN_SCENE_WIDTH_PX = 160;

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
    const columns = this.listColumns();
    const sceneIndex = columns.findIndex((group) => hasScene(group));
    const widths = columns.map(({ id, width }) => this.widths.get(id) ?? width);
    const sceneWidth = this.api.width - widths.reduce((sum, width, i) => (i === sceneIndex ? sum : sum + width), 0);
    if (sceneIndex < 0 || sceneWidth < MIN_SCENE_WIDTH_PX) return;
    widths[sceneIndex] = sceneWidth;
    // Each resized column takes the difference from the last column, so the last column also ends at its own width.
    for (const [i, group] of columns.slice(0, -1).entries()) group.api.setSize({ width: widths[i] ?? group.width });
  }

  /** Returns one group of each column, from the left; for the scene's column, the scene's group. */
  private listColumns(): DockviewGroupPanel[] {
    const groupRects = this.api.groups.map((group) => ({ group, rect: group.element.getBoundingClientRect() }));
    const sceneRect = groupRects.find(({ group }) => hasScene(group))?.rect;
    const columns: typeof groupRects = [];
    for (const candidate of groupRects.sort((a, b) => a.rect.left - b.rect.left)) {
      const { group, rect } = candidate;
      const overlaps = (otherRect: DOMRect): boolean => rect.left < otherRect.right - 1 && otherRect.left < rect.right - 1;
      if (hasScene(group) || !(sceneRect && overlaps(sceneRect)) && !columns.some((column) => overlaps(column.rect))) columns.push(candidate);
    }
    return columns.map(({ group }) => group);
  }
}

function hasScene(group: DockviewGroupPanel): boolean {
  return group.panels.some(({ id }) => id === SCENE_ID);
}
