import type { LinkScene, RobotScene } from "../protocol";
import { Signal } from "../signal";
import type { PageMemory } from "./page-memory";

/** An object of a display: a link, a marker, a point; `key` identifies it in the display's drawing. */
export interface SelectedItem {
  readonly display: string;
  readonly key: string;
}

/** A link of a RobotModel display. */
export interface SelectedLink {
  display: string;
  link: LinkScene;
}

/** How a new selection is combined with the current one. */
export type SelectionMode = "replace" | "add" | "remove";

/**
 * The selection in the scene and the panels; selected links stay selected when the robot is reloaded and still has
 * them.
 */
export class SelectionState {
  readonly changed = new Signal<SelectedLink | null>();
  private current: readonly SelectedItem[] = [];
  private link: SelectedLink | null = null;

  constructor(private readonly robots: ReadonlyMap<string, RobotScene>) {}

  /** Preserves the selection across reloads of the page. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("selection", () => this.current, (items) => (this.current = items));
  }

  get items(): readonly SelectedItem[] {
    return this.current;
  }

  /** The first selected link. */
  get selectedLink(): SelectedLink | null {
    return this.link;
  }

  select(link: SelectedLink | null): void {
    this.pick(link ? [{ display: link.display, key: link.link.name }] : [], "replace");
  }

  pick(items: readonly SelectedItem[], mode: SelectionMode): void {
    const next = new Map((mode === "replace" ? [] : this.current).map((item) => [createItemKey(item), item]));
    for (const item of items) {
      if (mode === "remove") next.delete(createItemKey(item));
      else next.set(createItemKey(item), item);
    }
    const isUnchanged = next.size === this.current.length && this.current.every((item) => next.has(createItemKey(item)));
    if (!isUnchanged) this.setItems([...next.values()]);
  }

  /** Deselects objects that their display no longer shows. */
  keepIf(exists: (item: SelectedItem) => boolean): void {
    const remainingItems = this.current.filter(exists);
    if (remainingItems.length < this.current.length) this.setItems(remainingItems);
  }

  onRobotChanged(robot: RobotScene): void {
    const items = this.current.filter((item) => item.display === robot.display);
    if (items.length === 0) return;
    const links = new Set(robot.links.map((link) => link.name));
    this.setItems(this.current.filter((item) => item.display !== robot.display || links.has(item.key)));
  }

  private setItems(items: readonly SelectedItem[]): void {
    this.current = items;
    this.link = null;
    for (const { display, key } of items) {
      const link = this.robots.get(display)?.links.find((candidate) => candidate.name === key);
      if (link) {
        this.link = { display, link };
        break;
      }
    }
    this.changed.emit(this.link);
  }
}

function createItemKey({ display, key }: SelectedItem): string {
  return `${display} ${key}`;
}
