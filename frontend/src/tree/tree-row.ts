import { h } from "../dom";
import { createIcon, LEVEL_ICONS } from "../icons";
import { createEditor } from "./editors";
import type { Editor, TreeItem } from "./tree-item";

/** The elements of a row, which exist while its key is visible. */
export class TreeRow {
  readonly element: HTMLElement;
  readonly editor: Editor;
  private readonly foldToggle = h("span", { class: "twist" }, createIcon("chevron"));
  private readonly icons = h("span", { class: "signs" });
  private readonly title = h("span", { class: "row-title" });
  private readonly badge = h("span", { class: "row-badge" });
  private iconsKey = "";

  constructor(
    public item: TreeItem,
    readonly depth: number,
    getFrames: () => readonly string[],
  ) {
    this.editor = createEditor(item, () => this.item, getFrames);
    const name = h("div", { class: "row-name" }, this.foldToggle, this.icons, this.title, this.badge);
    name.style.paddingLeft = `${6 + depth * 14}px`;
    const value = h("div", { class: "row-value" }, this.editor.element);
    this.element = h("div", { class: "row", role: "treeitem", tabIndex: -1, data: { key: item.key } }, name, value);
    this.element.setAttribute("aria-level", String(depth + 1));
  }

  show(item: TreeItem, isExpanded: boolean): void {
    this.item = item;
    const { classList } = this.element;
    classList.toggle("strong", item.isStrong === true);
    classList.toggle("muted", item.isMuted === true);
    classList.toggle("wide", item.isWide === true);
    classList.toggle("warn", item.level === "warn");
    classList.toggle("error", item.level === "error");
    this.foldToggle.classList.toggle("leaf", !item.children);
    if (item.children) this.element.setAttribute("aria-expanded", String(isExpanded));
    else this.element.removeAttribute("aria-expanded");
    if (this.title.textContent !== item.name) this.title.textContent = item.name;
    const hint = item.hint ?? item.name;
    if (this.title.title !== hint) this.title.title = hint;
    const badge = item.badge ?? "";
    if (this.badge.textContent !== badge) this.badge.textContent = badge;
    this.showIcons(item);
    this.editor.show(item);
  }

  /** Returns whether this row can show `item`: a different kind needs a different editor. */
  canShow(item: TreeItem, depth: number): boolean {
    const isEditable = (treeItem: TreeItem): boolean => treeItem.set !== undefined;
    return this.item.kind === item.kind && this.depth === depth && isEditable(this.item) === isEditable(item);
  }

  set isSelected(selected: boolean) {
    this.element.classList.toggle("selected", selected);
    this.element.setAttribute("aria-selected", String(selected));
    this.element.tabIndex = selected ? 0 : -1;
  }

  private showIcons(item: TreeItem): void {
    const level = item.showsLevelIcon === true && item.level ? item.level : "";
    const key = `${item.icon ?? ""} ${level}`;
    if (key === this.iconsKey) return;
    this.iconsKey = key;
    this.icons.replaceChildren();
    if (item.icon) this.icons.append(createIcon(item.icon));
    if (level) this.icons.append(createIcon(LEVEL_ICONS[level], `level-${level}`));
  }
}
