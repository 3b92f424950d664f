import { coalesce, h } from "../dom";
import { Signal } from "../signal";
import type { PageMemory } from "../state/page-memory";
import { ColumnSplitter } from "./column-splitter";
import type { TreeItem } from "./tree-item";
import { TreeRow } from "./tree-row";

interface VisibleItem {
  item: TreeItem;
  depth: number;
  isExpanded: boolean;
}

/** A property tree with names on the left and values on the right, fully usable by keyboard. */
export class TreeView {
  readonly element: HTMLElement;
  private readonly list: HTMLElement;
  readonly itemSelected = new Signal<TreeItem>();
  /** Redraws before the next paint, reading all items again. */
  readonly refresh = coalesce(() => this.render());
  private readonly rows = new Map<string, TreeRow>();
  private readonly expansion = new Map<string, boolean>();
  private visibleItems: VisibleItem[] = [];
  private selectedKey: string | null = null;
  /** The other selected rows, among those that permit a multiple selection. */
  private readonly otherSelectedKeys = new Set<string>();
  private keyToReveal: string | null = null;
  /**
   * Whether a mouse button is pressed. Rows must not move until its release: a release on a different row would not
   * cause a click.
   */
  private isPressed = false;

  constructor(
    label: string,
    private readonly getItems: () => readonly TreeItem[],
    private readonly getFrames: () => readonly string[],
  ) {
    this.list = h("div", { class: "tree", role: "tree", aria: { label, multiselectable: "true" } });
    this.element = h("div", { class: "tree-box" }, this.list, new ColumnSplitter().element);
    this.list.addEventListener("mousedown", (event) => this.onMouseDown(event));
    this.list.addEventListener("click", (event) => this.onClick(event));
    this.list.addEventListener("dblclick", (event) => this.onDoubleClick(event));
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.list.addEventListener("focusin", (event) => {
      const key = findRowKey(event.target);
      if (key !== null && !this.isSelected(key)) this.select(key);
    });
    this.refresh();
  }

  /** Unfolds the rows of `path`, from the top, and selects and reveals the last one without taking the focus. */
  reveal(path: readonly string[]): void {
    for (const key of path.slice(0, -1)) this.expansion.set(key, true);
    this.selectedKey = path.at(-1) ?? null;
    this.otherSelectedKeys.clear();
    this.keyToReveal = this.selectedKey;
    this.refresh();
  }

  /** Preserves which rows are unfolded and selected across reloads of the page. */
  preserveIn(memory: PageMemory, name: string): void {
    const readState = () => ({ expansion: [...this.expansion], selected: this.selectedKey });
    memory.preserve(`tree ${name}`, readState, ({ expansion, selected }: ReturnType<typeof readState>) => {
      for (const [key, isExpanded] of expansion) this.expansion.set(key, isExpanded);
      this.keyToReveal = this.selectedKey = selected;
    });
  }

  /** Whether a visible row has a value that follows the scene. */
  get hasLiveRows(): boolean {
    return this.visibleItems.some(({ item }) => item.isLive);
  }

  /** Updates the values that follow the scene. */
  updateLiveRows(): void {
    for (const { item } of this.visibleItems) {
      if (item.isLive) this.rows.get(item.key)?.editor.show(item);
    }
  }

  /** Resets the user's folding of some rows to the default. */
  resetExpansion(isAffected: (key: string) => boolean): void {
    for (const key of this.expansion.keys()) if (isAffected(key)) this.expansion.delete(key);
    this.refresh();
  }

  /** Unfolds or folds a row and everything below it. */
  expandAll(item: TreeItem, isExpanded: boolean): void {
    this.expansion.set(item.key, isExpanded);
    for (const child of item.children?.() ?? []) if (child.children) this.expandAll(child, isExpanded);
    this.refresh();
  }

  /** The key of the selected row, if the row exists. */
  get selection(): string | null {
    return this.selectedKey !== null && this.rows.has(this.selectedKey) ? this.selectedKey : null;
  }

  /** The keys of all selected rows, from the top. */
  get selections(): string[] {
    return this.visibleItems.map(({ item }) => item.key).filter((key) => this.isSelected(key));
  }

  /** Returns the row that contains an event's target. */
  itemAt(target: EventTarget | null): { item: TreeItem; element: HTMLElement } | null {
    const row = this.rows.get(findRowKey(target) ?? "");
    return row ? { item: row.item, element: row.element } : null;
  }

  private render(): void {
    const focusedIndex = this.visibleItems.findIndex(({ item }) => this.rows.get(item.key)?.element === document.activeElement);
    this.visibleItems = [];
    this.collectVisibleItems(this.getItems(), 0);
    const visibleKeys = new Set<string>();
    const elements: HTMLElement[] = [];
    for (const { item, depth, isExpanded } of this.visibleItems) {
      let row = this.rows.get(item.key);
      if (!row?.canShow(item, depth)) {
        row = new TreeRow(item, depth, this.getFrames);
        this.rows.set(item.key, row);
      }
      row.show(item, isExpanded);
      row.isSelected = this.isSelected(item.key);
      visibleKeys.add(item.key);
      elements.push(row.element);
    }
    for (const key of this.rows.keys()) if (!visibleKeys.has(key)) this.rows.delete(key);
    setChildren(this.list, elements);
    const [firstElement] = elements;
    if (firstElement && (this.selectedKey === null || !visibleKeys.has(this.selectedKey))) firstElement.tabIndex = 0;
    // If the focused row was removed, the row in its place gets the focus.
    if (focusedIndex >= 0 && !this.list.contains(document.activeElement)) {
      this.focusItem(Math.min(focusedIndex, this.visibleItems.length - 1));
    }
    this.finishReveal();
  }

  private finishReveal(): void {
    if (this.keyToReveal === null) return;
    const row = this.rows.get(this.keyToReveal);
    this.keyToReveal = null;
    if (row) this.itemSelected.emit(row.item);
    // Scroll last: observers of the selection may have reduced the space for rows.
    row?.element.scrollIntoView({ block: "nearest" });
  }

  private collectVisibleItems(items: readonly TreeItem[], depth: number): void {
    for (const item of items) {
      const isExpanded = item.children !== undefined && this.isExpanded(item);
      this.visibleItems.push({ item, depth, isExpanded });
      if (isExpanded) this.collectVisibleItems(item.children(), depth + 1);
    }
  }

  private isExpanded(item: TreeItem): boolean {
    return item.isForcedOpen ?? this.expansion.get(item.key) ?? item.isExpanded ?? false;
  }

  private setExpanded(item: TreeItem, isExpanded: boolean): void {
    if (!item.children) return;
    this.expansion.set(item.key, isExpanded);
    this.refresh();
  }

  private isSelected(key: string): boolean {
    return key === this.selectedKey || this.otherSelectedKeys.has(key);
  }

  private select(key: string, keepsOthers = false): void {
    if (!keepsOthers) this.otherSelectedKeys.clear();
    else if (this.selectedKey !== null && this.isMultiSelectable(this.selectedKey)) this.otherSelectedKeys.add(this.selectedKey);
    this.otherSelectedKeys.delete(key);
    const isNew = key !== this.selectedKey;
    this.selectedKey = key;
    this.showSelection();
    const row = this.rows.get(key);
    if (!row || !isNew) return;
    this.itemSelected.emit(row.item);
    if (!this.isPressed) row.element.scrollIntoView({ block: "nearest" });
  }

  private showSelection(): void {
    for (const [key, row] of this.rows) row.isSelected = this.isSelected(key);
  }

  private isMultiSelectable(key: string): boolean {
    return this.rows.get(key)?.item.isMultiSelectable === true;
  }

  /** Adds a row to the selection, or removes it, on Ctrl+click. */
  private toggleSelection(key: string): void {
    if (key !== this.selectedKey && !this.otherSelectedKeys.delete(key)) this.select(key, true);
    else if (key === this.selectedKey && this.otherSelectedKeys.size > 0) {
      const [nextKey = key] = this.otherSelectedKeys;
      this.otherSelectedKeys.delete(nextKey);
      this.selectedKey = nextKey;
    }
    this.showSelection();
  }

  /** Selects all rows from the selected one to this one, on Shift+click. */
  private extendSelection(key: string): void {
    const [start, end] = [this.selectedKey, key].map((rowKey) => this.visibleItems.findIndex(({ item }) => item.key === rowKey));
    if (start === undefined || end === undefined || start < 0) return;
    this.otherSelectedKeys.clear();
    for (const { item } of this.visibleItems.slice(Math.min(start, end), Math.max(start, end) + 1)) {
      if (item.isMultiSelectable === true && item.key !== this.selectedKey) this.otherSelectedKeys.add(item.key);
    }
    this.showSelection();
  }

  /** Adds the next row to the selection and focuses it, on Shift and an arrow key. */
  private extendByKey(index: number, step: number): void {
    let itemIndex = index + step;
    while (this.visibleItems[itemIndex] && this.visibleItems[itemIndex]?.item.isMultiSelectable !== true) itemIndex += step;
    const key = this.visibleItems[itemIndex]?.item.key;
    if (key === undefined) return;
    this.select(key, true);
    this.rows.get(key)?.element.focus();
  }

  /** Runs a change that reduces the space for rows; while a mouse button is pressed, after its release and click. */
  runAfterRelease(action: () => void): void {
    if (!this.isPressed) action();
    else document.addEventListener("mouseup", () => setTimeout(action), { once: true });
  }

  /**
   * Keeps the focus in place when a press adds to the selection or opens the menu of several rows: moving it would
   * select one row only.
   */
  private onMouseDown(event: MouseEvent): void {
    this.isPressed = true;
    document.addEventListener("mouseup", () => (this.isPressed = false), { once: true });
    const key = findRowKey(event.target);
    if (key === null || !this.isMultiSelectable(key)) return;
    if (addsToSelection(event) || (event.button === 2 && this.otherSelectedKeys.size > 0 && this.isSelected(key))) event.preventDefault();
  }

  private onClick(event: MouseEvent): void {
    const target = event.target as HTMLElement;
    const row = this.rows.get(findRowKey(target) ?? "");
    if (!row) return;
    if (addsToSelection(event) && row.item.isMultiSelectable === true && this.selectedKey !== null && this.isMultiSelectable(this.selectedKey)) {
      if (event.shiftKey) this.extendSelection(row.item.key);
      else this.toggleSelection(row.item.key);
      return;
    }
    this.select(row.item.key);
    if (target.closest(".twist")) this.setExpanded(row.item, !this.isExpanded(row.item));
    if (!target.closest(".row-value")) row.element.focus({ preventScroll: true });
    row.element.scrollIntoView({ block: "nearest" });
  }

  private onDoubleClick(event: MouseEvent): void {
    const target = event.target as HTMLElement;
    const row = this.rows.get(findRowKey(target) ?? "");
    if (!row || !target.closest(".row-name") || target.closest(".twist")) return;
    if (row.item.activate) row.item.activate();
    else {
      this.setExpanded(row.item, !this.isExpanded(row.item));
    }
  }

  private onKeyDown(event: KeyboardEvent): void {
    const index = this.visibleItems.findIndex((line) => line.item.key === this.selectedKey);
    const line = this.visibleItems[index];
    const row = line && this.rows.get(line.item.key);
    if (!row || !(event.target as HTMLElement).matches("[role=treeitem], .check")) return;
    switch (event.key) {
      case "ArrowDown":
      case "ArrowUp":
        if (event.shiftKey) this.extendByKey(index, event.key === "ArrowDown" ? 1 : -1);
        else this.focusItem(index + (event.key === "ArrowDown" ? 1 : -1));
        break;
      case "Home":
        this.focusItem(0);
        break;
      case "End":
        this.focusItem(this.visibleItems.length - 1);
        break;
      case "ArrowRight":
        if (line.isExpanded) this.focusItem(index + 1);
        else this.setExpanded(line.item, true);
        break;
      case "ArrowLeft":
        if (line.isExpanded) this.setExpanded(line.item, false);
        else this.focusItem(this.visibleItems.findLastIndex((candidate, i) => i < index && candidate.depth < line.depth));
        break;
      case " ":
        if (row.editor.toggle) row.editor.toggle();
        else this.setExpanded(line.item, !line.isExpanded);
        break;
      case "Enter":
      case "F2":
        if (event.key === "Enter" && row.item.activate) row.item.activate();
        else if (!row.editor.focus()) this.setExpanded(line.item, !line.isExpanded);
        break;
      default:
        return;
    }
    event.preventDefault();
  }

  private focusItem(index: number): void {
    const key = this.visibleItems[index]?.item.key;
    if (key === undefined) return;
    this.otherSelectedKeys.clear();
    this.rows.get(key)?.element.focus();
    this.showSelection();
  }
}

/** Returns whether a click adds to the selection. */
function addsToSelection(event: MouseEvent): boolean {
  return event.shiftKey || event.ctrlKey || event.metaKey;
}

function findRowKey(target: EventTarget | null): string | null {
  return (target as HTMLElement | null)?.closest<HTMLElement>(".row")?.dataset["key"] ?? null;
}

/** Makes these elements the children of `parent`, in order, moving only those that are out of place. */
function setChildren(parent: HTMLElement, elements: readonly HTMLElement[]): void {
  const elementSet = new Set<Element>(elements);
  for (const child of [...parent.children]) if (!elementSet.has(child)) child.remove();
  let nextChild = parent.firstElementChild;
  for (const element of elements) {
    if (element === nextChild) nextChild = nextChild.nextElementSibling;
    else parent.insertBefore(element, nextChild);
  }
}
