import { createButton, h } from "../dom";
import { createIcon } from "../icons";
import type { PropertyValue } from "../protocol";
import { strings } from "../strings";
import { TextEditor } from "./text-editor";
import type { Editor, TreeItem } from "./tree-item";

/** The minimum distance between the list and the lower edge of the window. */
const BOTTOM_MARGIN_PX = 8;

/** Passes the names to choose from to `show`, immediately or when they have arrived. */
export type OfferNames = (item: TreeItem, show: (names: readonly string[]) => void) => void;

/** An editor for the name of a frame or topic: any text, or a name from a list. */
export class NameEditor implements Editor {
  readonly element: HTMLElement;
  private readonly textEditor: TextEditor;
  private list: HTMLElement | null = null;
  private item: TreeItem | null = null;

  constructor(
    private readonly commit: (value: PropertyValue) => void,
    private readonly label: string,
    private readonly offer: OfferNames,
    allowsEmpty = false,
  ) {
    const parse = (text: string): string | null => text.trim() || (allowsEmpty ? "" : null);
    this.textEditor = new TextEditor({ format: String, parse, commit });
    const openButton = createButton(label, () => this.toggleList(), "drop", createIcon("chevron"));
    openButton.tabIndex = -1;
    this.element = h("span", { class: "frame-editor" }, this.textEditor.element, openButton);
    this.textEditor.element.addEventListener("keydown", (event) => {
      if (event.key === "ArrowDown") {
        this.open();
        event.stopPropagation();
      }
    });
  }

  show(item: TreeItem): void {
    this.item = item;
    this.textEditor.show(item);
  }

  focus(): boolean {
    return this.textEditor.focus();
  }

  private toggleList(): void {
    if (this.list) this.close();
    else this.open();
  }

  private open(): void {
    if (this.item) this.offer(this.item, (names) => this.openList(names));
  }

  private openList(options: readonly string[]): void {
    const entries = options.map((name) => {
      const entry = h("li", { role: "option", tabIndex: -1, data: { name } }, name);
      entry.setAttribute("aria-selected", String(name === this.item?.value));
      return entry;
    });
    this.close();
    this.list = h("ul", { class: "popup", role: "listbox", aria: { label: this.label } }, ...entries);
    if (entries.length === 0) this.list.append(h("li", { role: "option", tabIndex: -1 }, strings.tree.noNames));
    this.list.addEventListener("click", (event) => this.choose(event.target as HTMLElement));
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.list.addEventListener("focusout", (event) => {
      if (!this.list?.contains(event.relatedTarget as Node | null)) this.close();
    });
    const editorRect = this.element.getBoundingClientRect();
    this.list.style.left = `${editorRect.left}px`;
    this.list.style.minWidth = `${editorRect.width}px`;
    document.body.append(this.list);
    const spaceBelow = window.innerHeight - editorRect.bottom;
    if (spaceBelow < this.list.offsetHeight + BOTTOM_MARGIN_PX && editorRect.top > spaceBelow) this.list.style.bottom = `${window.innerHeight - editorRect.top}px`;
    else this.list.style.top = `${editorRect.bottom}px`;
    const currentEntry = entries.find((entry) => entry.dataset["name"] === this.item?.value);
    (currentEntry ?? (this.list.firstElementChild as HTMLElement | null))?.focus();
  }

  private close(): void {
    const { list } = this;
    this.list = null;
    list?.remove();
  }

  private choose(entry: HTMLElement): void {
    const name = entry.dataset["name"];
    this.close();
    if (name !== undefined) this.commit(name);
    this.element.closest<HTMLElement>("[role=treeitem]")?.focus();
  }

  private onKeyDown(event: KeyboardEvent): void {
    const entry = event.target as HTMLElement;
    if (event.key === "ArrowDown") (entry.nextElementSibling as HTMLElement | null)?.focus();
    else if (event.key === "ArrowUp") (entry.previousElementSibling as HTMLElement | null)?.focus();
    else if (event.key === "Enter" || event.key === " ") this.choose(entry);
    else if (event.key === "Escape") {
      this.close();
      this.textEditor.focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
