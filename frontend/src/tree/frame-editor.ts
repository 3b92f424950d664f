import { button, h } from "../dom";
import { icon } from "../icons";
import type { PropertyValue } from "../protocol.gen";
import { strings } from "../strings";
import type { Editor } from "./editors";
import { TextEditor } from "./text-editor";
import type { TreeItem } from "./tree-item";

/** A frame's name: any text, or one of the known frames from a list. */
export class FrameEditor implements Editor {
  readonly element: HTMLElement;
  private readonly text: TextEditor;
  private list: HTMLElement | null = null;
  private item: TreeItem | null = null;

  constructor(
    private readonly commit: (value: PropertyValue) => void,
    private readonly frames: () => readonly string[],
  ) {
    this.text = new TextEditor({ format: String, parse: (text) => text.trim() || null, commit });
    const open = button(strings.tree.frames, () => this.toggleList(), "drop", icon("chevron"));
    open.tabIndex = -1;
    this.element = h("span", { class: "frame-editor" }, this.text.element, open);
    this.text.element.addEventListener("keydown", (event) => {
      if (event.key === "ArrowDown") {
        this.open();
        event.stopPropagation();
      }
    });
  }

  show(item: TreeItem): void {
    this.item = item;
    this.text.show(item);
  }

  focus(): boolean {
    return this.text.focus();
  }

  private toggleList(): void {
    if (this.list) this.close();
    else this.open();
  }

  private open(): void {
    const options = this.item?.options?.length ? this.item.options : this.frames();
    const entries = options.map((name) => {
      const entry = h("li", { role: "option", tabIndex: -1, data: { frame: name } }, name);
      entry.setAttribute("aria-selected", String(name === this.item?.value));
      return entry;
    });
    this.list = h("ul", { class: "popup", role: "listbox", aria: { label: strings.tree.frames } }, ...entries);
    this.list.addEventListener("click", (event) => this.choose(event.target as HTMLElement));
    this.list.addEventListener("keydown", (event) => this.keyed(event));
    this.list.addEventListener("focusout", (event) => {
      if (!this.list?.contains(event.relatedTarget as Node | null)) this.close();
    });
    const box = this.element.getBoundingClientRect();
    this.list.style.left = `${box.left}px`;
    this.list.style.minWidth = `${box.width}px`;
    document.body.append(this.list);
    const below = window.innerHeight - box.bottom;
    if (below < this.list.offsetHeight + 8 && box.top > below) this.list.style.bottom = `${window.innerHeight - box.top}px`;
    else this.list.style.top = `${box.bottom}px`;
    (entries.find((entry) => entry.dataset["frame"] === this.item?.value) ?? entries[0])?.focus();
  }

  private close(): void {
    const { list } = this;
    this.list = null;
    list?.remove();
  }

  private choose(entry: HTMLElement): void {
    const name = entry.dataset["frame"];
    this.close();
    if (name !== undefined) this.commit(name);
    this.element.closest<HTMLElement>("[role=treeitem]")?.focus();
  }

  private keyed(event: KeyboardEvent): void {
    const entry = event.target as HTMLElement;
    if (event.key === "ArrowDown") (entry.nextElementSibling as HTMLElement | null)?.focus();
    else if (event.key === "ArrowUp") (entry.previousElementSibling as HTMLElement | null)?.focus();
    else if (event.key === "Enter" || event.key === " ") this.choose(entry);
    else if (event.key === "Escape") {
      this.close();
      this.text.focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
