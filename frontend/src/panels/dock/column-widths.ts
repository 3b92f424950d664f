import type { DockviewApi, DockviewGroupPanel } from "dockview";
import { formOf } from "./default-layout";

const SCENE = "scene";
/** Pixels: with less the scene takes what the dock gives it. */
const LEAST_SCENE = 160;

/**
 * Keeps the columns beside the scene as wide as they were while panels come and go: what is freed or taken is the scene's.
 *
 * The dock itself distributes the width again, and gives most of it to the last column when a panel across the window goes.
 */
export class ColumnWidths {
  private known = new Map<string, number>();

  constructor(private readonly api: DockviewApi) {}

  /** The arrangement is as it should be. */
  take(): void {
    this.known = new Map(this.api.groups.map(({ id, width }) => [id, width]));
  }

  /** The arrangement is another: gives columns that were there their widths when others came or went. */
  follow(): void {
    const { groups } = this.api;
    const isSame = groups.length === this.known.size && groups.every(({ id }) => this.known.has(id));
    if (!isSame && this.known.size > 0 && formOf(this.api) === "wide") this.restore();
    this.take();
  }

  private restore(): void {
    const columns = this.columns();
    const scene = columns.findIndex((group) => holdsScene(group));
    const widths = columns.map(({ id, width }) => this.known.get(id) ?? width);
    const rest = this.api.width - widths.reduce((sum, width, i) => (i === scene ? sum : sum + width), 0);
    if (scene < 0 || rest < LEAST_SCENE) return;
    widths[scene] = rest;
    // What one is given the last one loses: in the end that has its width, too.
    for (const [i, group] of columns.slice(0, -1).entries()) group.api.setSize({ width: widths[i] ?? group.width });
  }

  /** One group of each column, from the left: the scene's is that of the scene. */
  private columns(): DockviewGroupPanel[] {
    const boxes = this.api.groups.map((group) => ({ group, box: group.element.getBoundingClientRect() }));
    const scene = boxes.find(({ group }) => holdsScene(group))?.box;
    const found: typeof boxes = [];
    for (const each of boxes.sort((a, b) => a.box.left - b.box.left)) {
      const { group, box } = each;
      const isOver = (other: DOMRect): boolean => box.left < other.right - 1 && other.left < box.right - 1;
      if (holdsScene(group) || !(scene && isOver(scene)) && !found.some((other) => isOver(other.box))) found.push(each);
    }
    return found.map(({ group }) => group);
  }
}

function holdsScene(group: DockviewGroupPanel): boolean {
  return group.panels.some(({ id }) => id === SCENE);
}
