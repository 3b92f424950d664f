import type { DisplayState } from "../../state/displays";

/** The part of a display's row on which the dragged display is dropped. */
export type DropPart = "before" | "inside" | "after";

export interface DropPlace {
  group: string | null;
  nextSibling: string | null;
}

/** Returns the new place of a display that is dropped on another; null where it cannot go. */
export function computeDropPlace(
  displays: readonly DisplayState[],
  draggedDisplay: DisplayState,
  target: DisplayState,
  part: DropPart,
): DropPlace | null {
  if (target === draggedDisplay || target.isWithin(draggedDisplay)) return null;
  if (part === "inside") {
    const first = displays.find((display) => display.group === target && display !== draggedDisplay);
    return target.isGroup ? { group: target.id, nextSibling: first?.id ?? null } : null;
  }
  const group = target.group?.id ?? null;
  if (part === "before") return { group, nextSibling: target.id };
  const siblings = displays.filter((display) => display.group === target.group && display !== draggedDisplay);
  return { group, nextSibling: siblings[siblings.indexOf(target) + 1]?.id ?? null };
}

/** Returns the part of a row under the pointer; the middle of a group's row means into the group. */
export function computeDropPart(offset: number, height: number, isGroup: boolean): DropPart {
  const share = offset / height;
  if (isGroup && share > 0.3 && share < 0.7) return "inside";
  return share < 0.5 ? "before" : "after";
}

interface DisplayTree {
  readonly element: HTMLElement;
  /** Returns the display that an element belongs to, and its row if the element is in the display's own row. */
  displayAt(target: EventTarget | null): { display: DisplayState; row: HTMLElement | null } | null;
  listDisplays(): readonly DisplayState[];
  move(display: DisplayState, computeDropPlace: DropPlace): void;
}

/** Makes the rows of displays draggable. */
export class DisplayDrag {
  private draggedDisplay: DisplayState | null = null;
  private markedRow: HTMLElement | null = null;

  constructor(private readonly tree: DisplayTree) {
    const { element } = tree;
    element.addEventListener("pointerdown", (event) => {
      const item = tree.displayAt(event.target);
      // Fields and boxes in the row handle the mouse themselves.
      const isDraggable = event.target instanceof Element && event.target.closest(".row-value, .twist") === null;
      if (item?.row) item.row.draggable = isDraggable;
    });
    element.addEventListener("dragstart", (event) => {
      this.draggedDisplay = tree.displayAt(event.target)?.display ?? null;
      if (!this.draggedDisplay || !event.dataTransfer) return;
      event.dataTransfer.effectAllowed = "move";
      event.dataTransfer.setData("text/plain", this.draggedDisplay.name);
    });
    element.addEventListener("dragover", (event) => this.onDragOver(event));
    element.addEventListener("dragleave", (event) => {
      if (!element.contains(event.relatedTarget as Node | null)) this.mark(null);
    });
    element.addEventListener("drop", (event) => {
      const place = this.findDrop(event);
      if (this.draggedDisplay && place) tree.move(this.draggedDisplay, place.place);
      if (this.draggedDisplay) event.preventDefault();
      this.endDrag();
    });
    element.addEventListener("dragend", () => this.endDrag());
  }

  private onDragOver(event: DragEvent): void {
    const place = this.findDrop(event);
    this.mark(place?.row ?? null, place?.part);
    if (!place) return;
    event.preventDefault();
    if (event.dataTransfer) event.dataTransfer.dropEffect = "move";
  }

  private findDrop(event: DragEvent): { place: DropPlace; part: DropPart; row: HTMLElement | null } | null {
    const item = this.tree.displayAt(event.target);
    if (!this.draggedDisplay || !item) return null;
    const { display, row } = item;
    const rowRect = row?.getBoundingClientRect();
    const part = rowRect ? computeDropPart(event.clientY - rowRect.top, rowRect.height, display.isGroup) : "after";
    const place = computeDropPlace(this.tree.listDisplays(), this.draggedDisplay, display, part);
    return place && { place, part, row };
  }

  private mark(row: HTMLElement | null, part?: DropPart): void {
    if (this.markedRow && this.markedRow !== row) delete this.markedRow.dataset["drop"];
    this.markedRow = row;
    if (row && part) row.dataset["drop"] = part;
  }

  private endDrag(): void {
    this.mark(null);
    this.draggedDisplay = null;
  }
}
