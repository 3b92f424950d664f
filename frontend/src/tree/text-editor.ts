import { h } from "../dom";
import type { PropertyValue } from "../protocol";
import type { Editor, TreeItem } from "./tree-item";

export interface TextEditorOptions {
  format: (value: PropertyValue) => string;
  /** Returns the value of a text; null if it is invalid, which restores the old value. */
  parse: (text: string) => PropertyValue;
  commit: (value: PropertyValue) => void;
  /** Returns the value after an up or down key. */
  step?: (text: string, direction: 1 | -1) => number | null;
  isNumeric?: boolean;
}

/** A text field whose content becomes a value on Enter or when it loses the focus; Escape restores the old value. */
export class TextEditor implements Editor {
  readonly element: HTMLInputElement;
  private shownText = "";

  constructor(private readonly options: TextEditorOptions) {
    this.element = h("input", { class: options.isNumeric === true ? "field numeric" : "field" });
    this.element.type = "text";
    this.element.tabIndex = -1;
    this.element.spellcheck = false;
    this.element.autocomplete = "off";
    if (options.isNumeric === true) this.element.inputMode = "decimal";
    this.element.addEventListener("focus", () => this.element.select());
    this.element.addEventListener("blur", () => this.commitText());
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
  }

  show(item: TreeItem): void {
    const text = this.options.format(item.value);
    const { element } = this;
    const hasFocus = document.activeElement === element;
    const isEditing = hasFocus && element.value !== this.shownText;
    this.shownText = text;
    if (!isEditing && element.value !== text) {
      const isAllSelected = hasFocus && element.selectionStart === 0 && element.selectionEnd === element.value.length;
      element.value = text;
      // A new value clears the selection, and the user's next key would be added to the text instead of replacing it.
      if (isAllSelected) element.select();
    }
    element.setAttribute("aria-label", item.name);
  }

  focus(): boolean {
    this.element.focus();
    return true;
  }

  private commitText(): void {
    if (this.element.value === this.shownText) return;
    const value = this.options.parse(this.element.value);
    this.element.value = value === null ? this.shownText : this.options.format(value);
    if (value === null) return;
    this.shownText = this.element.value;
    this.options.commit(value);
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (event.key === "Enter") {
      this.commitText();
      focusRow(this.element);
    } else if (event.key === "Escape") {
      this.element.value = this.shownText;
      focusRow(this.element);
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && this.options.step) {
      const value = this.options.step(this.element.value, event.key === "ArrowUp" ? 1 : -1);
      if (value !== null) {
        this.element.value = this.options.format(value);
        this.commitText();
      }
    } else {
      // The tree's own keys must not act while a text is edited.
      event.stopPropagation();
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }
}

/** Returns the focus to the row. */
function focusRow(element: HTMLElement): void {
  element.closest<HTMLElement>("[role=treeitem]")?.focus();
}
