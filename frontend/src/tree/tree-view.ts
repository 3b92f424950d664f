import { coalesced, h } from "../dom";
import { Signal } from "../signal";
import type { PageMemory } from "../state/page-memory";
import { ColumnSplitter } from "./column-splitter";
import type { TreeItem } from "./tree-item";
import { TreeRow } from "./tree-row";

interface VisibleItem {
  item: TreeItem;
  depth: number;
  expanded: boolean;
}

/** A property tree with names on the left and values on the right, fully usable by keyboard. */
export class TreeView {
  readonly element: HTMLElement;
  private readonly list: HTMLElement;
  readonly selected = new Signal<TreeItem>();
  /** Redraws before the next paint, reading all items again. */
  readonly refresh = coalesced(() => this.render());
  private readonly rows = new Map<string, TreeRow>();
  private readonly expansion = new Map<string, boolean>();
  private lines: VisibleItem[] = [];
  private selectedKey: string | null = null;
  /** The other selected rows, among those that permit a multiple selection. */
  private readonly others = new Set<string>();
  private scrollTo: string | null = null;
  /**
   * Whether a mouse button is pressed: rows must not move until its release, which would otherwise be on another row
   * and cause no click.
   */
  private isPressed = false;

  constructor(
    label: string,
    private readonly items: () => readonly TreeItem[],
    private readonly frames: () => readonly string[],
  ) {
    this.list = h("div", { class: "tree", role: "tree", aria: { label, multiselectable: "true" } });
    this.element = h("div", { class: "tree-box" }, this.list, new ColumnSplitter().element);
    this.list.addEventListener("mousedown", (event) => this.onMouseDown(event));
    this.list.addEventListener("click", (event) => this.onClick(event));
    this.list.addEventListener("dblclick", (event) => this.onDoubleClick(event));
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.list.addEventListener("focusin", (event) => {
      const key = keyOf(event.target);
      if (key !== null && !this.isSelected(key)) this.select(key);
    });
    this.refresh();
  }

  /** Unfolds the rows of `path`, from the top, and selects and reveals the last one without taking the focus. */
  reveal(path: readonly string[]): void {
    for (const key of path.slice(0, -1)) this.expansion.set(key, true);
    this.selectedKey = path.at(-1) ?? null;
    this.others.clear();
    this.scrollTo = this.selectedKey;
    this.refresh();
  }

  /** Preserves which rows are unfolded and selected across reloads of the page. */
  preserveIn(memory: PageMemory, name: string): void {
    const read = () => ({ expansion: [...this.expansion], selected: this.selectedKey });
    memory.preserve(`tree ${name}`, read, ({ expansion, selected }: ReturnType<typeof read>) => {
      for (const [key, expanded] of expansion) this.expansion.set(key, expanded);
      this.scrollTo = this.selectedKey = selected;
    });
  }

  /** Whether a visible row has a value that follows the scene. */
  get showsLive(): boolean {
    return this.lines.some(({ item }) => item.live);
  }

  /** Updates the values that follow the scene. */
  showLive(): void {
    for (const { item } of this.lines) {
      if (item.live) this.rows.get(item.key)?.editor.show(item);
    }
  }

  /** Resets the user's folding of some rows to the default. */
  resetExpansion(of: (key: string) => boolean): void {
    for (const key of this.expansion.keys()) if (of(key)) this.expansion.delete(key);
    this.refresh();
  }

  /** Unfolds or folds a row and everything below it. */
  expandAll(item: TreeItem, expanded: boolean): void {
    this.expansion.set(item.key, expanded);
    for (const child of item.children?.() ?? []) if (child.children) this.expandAll(child, expanded);
    this.refresh();
  }

  /** The key of the selected row, if the row exists. */
  get selection(): string | null {
    return this.selectedKey !== null && this.rows.has(this.selectedKey) ? this.selectedKey : null;
  }

  /** The keys of all selected rows, from the top. */
  get selections(): string[] {
    return this.lines.map(({ item }) => item.key).filter((key) => this.isSelected(key));
  }

  /** Returns the row that contains an event's target. */
  itemAt(target: EventTarget | null): { item: TreeItem; element: HTMLElement } | null {
    const row = this.rows.get(keyOf(target) ?? "");
    return row ? { item: row.item, element: row.element } : null;
  }

  private render(): void {
    const focused = this.lines.findIndex(({ item }) => this.rows.get(item.key)?.element === document.activeElement);
    this.lines = [];
    this.flatten(this.items(), 0);
    const keep = new Set<string>();
    const elements: HTMLElement[] = [];
    for (const { item, depth, expanded } of this.lines) {
      let row = this.rows.get(item.key);
      if (!row?.fits(item, depth)) {
        row = new TreeRow(item, depth, this.frames);
        this.rows.set(item.key, row);
      }
      row.show(item, expanded);
      row.selected = this.isSelected(item.key);
      keep.add(item.key);
      elements.push(row.element);
    }
    for (const key of this.rows.keys()) if (!keep.has(key)) this.rows.delete(key);
    setChildren(this.list, elements);
    const [first] = elements;
    if (first && (this.selectedKey === null || !keep.has(this.selectedKey))) first.tabIndex = 0;
    // If the focused row was removed, the row in its place gets the focus.
    if (focused >= 0 && !this.list.contains(document.activeElement)) {
      this.focusLine(Math.min(focused, this.lines.length - 1));
    }
    this.finishReveal();
  }

  private finishReveal(): void {
    if (this.scrollTo === null) return;
    const row = this.rows.get(this.scrollTo);
    this.scrollTo = null;
    if (row) this.selected.emit(row.item);
    // Scroll last: observers of the selection may have reduced the space for rows.
    row?.element.scrollIntoView({ block: "nearest" });
  }

  private flatten(items: readonly TreeItem[], depth: number): void {
    for (const item of items) {
      const expanded = item.children !== undefined && this.isExpanded(item);
      this.lines.push({ item, depth, expanded });
      if (expanded) this.flatten(item.children(), depth + 1);
    }
  }

  private isExpanded(item: TreeItem): boolean {
    return item.open ?? this.expansion.get(item.key) ?? item.expanded ?? false;
  }

  private setExpanded(item: TreeItem, expanded: boolean): void {
    if (!item.children) return;
    this.expansion.set(item.key, expanded);
    this.refresh();
  }

  private isSelected(key: string): boolean {
    return key === this.selectedKey || this.others.has(key);
  }

  private select(key: string, keep = false): void {
    if (!keep) this.others.clear();
    else if (this.selectedKey !== null && this.isMultiSelectable(this.selectedKey)) this.others.add(this.selectedKey);
    this.others.delete(key);
    const news = key !== this.selectedKey;
    this.selectedKey = key;
    this.showSelection();
    const row = this.rows.get(key);
    if (!row || !news) return;
    this.selected.emit(row.item);
    if (!this.isPressed) row.element.scrollIntoView({ block: "nearest" });
  }

  private showSelection(): void {
    for (const [key, row] of this.rows) row.selected = this.isSelected(key);
  }

  private isMultiSelectable(key: string): boolean {
    return this.rows.get(key)?.item.multiSelectable === true;
  }

  /** Adds a row to the selection, or removes it, on Ctrl+click. */
  private toggle(key: string): void {
    if (key !== this.selectedKey && !this.others.delete(key)) this.select(key, true);
    else if (key === this.selectedKey && this.others.size > 0) {
      const [next = key] = this.others;
      this.others.delete(next);
      this.selectedKey = next;
    }
    this.showSelection();
  }

  /** Selects all rows from the selected one to this one, on Shift+click. */
  private extend(key: string): void {
    const [from, to] = [this.selectedKey, key].map((each) => this.lines.findIndex(({ item }) => item.key === each));
    if (from === undefined || to === undefined || from < 0) return;
    this.others.clear();
    for (const { item } of this.lines.slice(Math.min(from, to), Math.max(from, to) + 1)) {
      if (item.multiSelectable === true && item.key !== this.selectedKey) this.others.add(item.key);
    }
    this.showSelection();
  }

  /** Adds the next row to the selection and focuses it, on Shift and an arrow key. */
  private extendByKey(index: number, step: number): void {
    let at = index + step;
    while (this.lines[at] && this.lines[at]?.item.multiSelectable !== true) at += step;
    const key = this.lines[at]?.item.key;
    if (key === undefined) return;
    this.select(key, true);
    this.rows.get(key)?.element.focus();
  }

  /** Runs a change that reduces the space for rows, after the release of a pressed mouse button and its click. */
  whenReleased(act: () => void): void {
    if (!this.isPressed) act();
    else document.addEventListener("mouseup", () => setTimeout(act), { once: true });
  }

  /**
   * Keeps the focus in place when a press adds to the selection or opens the menu of several rows: moving it would
   * select one row only.
   */
  private onMouseDown(event: MouseEvent): void {
    this.isPressed = true;
    document.addEventListener("mouseup", () => (this.isPressed = false), { once: true });
    const key = keyOf(event.target);
    if (key === null || !this.isMultiSelectable(key)) return;
    if (addsToSelection(event) || (event.button === 2 && this.others.size > 0 && this.isSelected(key))) event.preventDefault();
  }

  private onClick(event: MouseEvent): void {
    const target = event.target as HTMLElement;
    const row = this.rows.get(keyOf(target) ?? "");
    if (!row) return;
    if (addsToSelection(event) && row.item.multiSelectable === true && this.selectedKey !== null && this.isMultiSelectable(this.selectedKey)) {
      if (event.shiftKey) this.extend(row.item.key);
      else this.toggle(row.item.key);
      return;
    }
    this.select(row.item.key);
    if (target.closest(".twist")) this.setExpanded(row.item, !this.isExpanded(row.item));
    if (!target.closest(".row-value")) row.element.focus({ preventScroll: true });
    row.element.scrollIntoView({ block: "nearest" });
  }

  private onDoubleClick(event: MouseEvent): void {
    const target = event.target as HTMLElement;
    const row = this.rows.get(keyOf(target) ?? "");
    if (!row || !target.closest(".row-name") || target.closest(".twist")) return;
    if (row.item.activate) row.item.activate();
    else {
      this.setExpanded(row.item, !this.isExpanded(row.item));
    }
  }

  private onKeyDown(event: KeyboardEvent): void {
    const index = this.lines.findIndex((line) => line.item.key === this.selectedKey);
    const line = this.lines[index];
    const row = line && this.rows.get(line.item.key);
    if (!row || !(event.target as HTMLElement).matches("[role=treeitem], .check")) return;
    switch (event.key) {
      case "ArrowDown":
      case "ArrowUp":
        if (event.shiftKey) this.extendByKey(index, event.key === "ArrowDown" ? 1 : -1);
        else this.focusLine(index + (event.key === "ArrowDown" ? 1 : -1));
        break;
      case "Home":
        this.focusLine(0);
        break;
      case "End":
        this.focusLine(this.lines.length - 1);
        break;
      case "ArrowRight":
        if (line.expanded) this.focusLine(index + 1);
        else this.setExpanded(line.item, true);
        break;
      case "ArrowLeft":
        if (line.expanded) this.setExpanded(line.item, false);
        else this.focusLine(this.lines.findLastIndex((each, i) => i < index && each.depth < line.depth));
        break;
      case " ":
        if (row.editor.toggle) row.editor.toggle();
        else this.setExpanded(line.item, !line.expanded);
        break;
      case "Enter":
      case "F2":
        if (event.key === "Enter" && row.item.activate) row.item.activate();
        else if (!row.editor.focus()) this.setExpanded(line.item, !line.expanded);
        break;
      default:
        return;
    }
    event.preventDefault();
  }

  private focusLine(index: number): void {
    const key = this.lines[index]?.item.key;
    if (key === undefined) return;
    this.others.clear();
    this.rows.get(key)?.element.focus();
    this.showSelection();
  }
}

/** Whether a click adds to the selection. */
function addsToSelection(event: MouseEvent): boolean {
  return event.shiftKey || event.ctrlKey || event.metaKey;
}

function keyOf(target: EventTarget | null): string | null {
  return (target as HTMLElement | null)?.closest<HTMLElement>(".row")?.dataset["key"] ?? null;
}

/** Makes these elements the children of `parent`, in order, moving only those that are out of place. */
function setChildren(parent: HTMLElement, elements: readonly HTMLElement[]): void {
  const wanted = new Set<Element>(elements);
  for (const child of [...parent.children]) if (!wanted.has(child)) child.remove();
  let next = parent.firstElementChild;
  for (const element of elements) {
    if (element === next) next = next.nextElementSibling;
    else parent.insertBefore(element, next);
  }
}
