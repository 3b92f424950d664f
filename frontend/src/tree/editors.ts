import { h } from "../dom";
import type { PropertyValue } from "../protocol";
import { strings } from "../strings";
import { formatColor, parseColor } from "./colors";
import { NameEditor } from "./name-editor";
import { clamp, formatNumber, parseNumber, chooseStep } from "./numbers";
import { TextEditor } from "./text-editor";
import type { Editor, TreeItem } from "./tree-item";

/** Creates the editor for an item; `getItem` returns the newest item of the row, `getFrames` the frames to offer. */
export function createEditor(item: TreeItem, getItem: () => TreeItem, getFrames: () => readonly string[]): Editor {
  const commit = (value: PropertyValue): void => getItem().set?.(value);
  if (item.kind === "group") return new PlainText();
  if (item.isReadOnly === true || !item.set) return item.kind === "bool" ? new CheckBoxEditor(commit) : new PlainText();
  switch (item.kind) {
    case "bool":
      return new CheckBoxEditor(commit);
    case "enum":
      return new ChoiceEditor(commit);
    case "color":
      return new ColorEditor(commit);
    case "frame":
      return new NameEditor(commit, strings.tree.frames, ({ options }, show) => show(options?.length ? options : getFrames()));
    case "int":
    case "float":
      return createNumberEditor(item.kind === "int", getItem, commit);
    case "topic":
      return new NameEditor(commit, strings.displays.topics, (topicItem, show) => topicItem.requestNames?.(show), true);
    case "string":
      if (item.options?.length) {
        return new NameEditor(commit, strings.suggestions, ({ options }, show) => show(options ?? []), true);
      }
      return new TextEditor({ format: formatValue, parse: (text) => text, commit });
  }
}

function formatValue(value: PropertyValue): string {
  if (typeof value === "number") return formatNumber(value);
  return value === null ? "" : String(value);
}

function createNumberEditor(isInteger: boolean, getItem: () => TreeItem, commit: (value: PropertyValue) => void): Editor {
  const limit = (value: number): number => {
    const { minimum, maximum } = getItem();
    return clamp(isInteger ? Math.round(value) : value, minimum ?? null, maximum ?? null);
  };
  return new TextEditor({
    isNumeric: true,
    format: formatValue,
    parse: (text) => {
      const value = parseNumber(text);
      return value === null ? null : limit(value);
    },
    step: (text, direction) => {
      const value = parseNumber(text);
      if (value === null) return null;
      const step = chooseStep(value, isInteger);
      return limit(Number((value + direction * step).toPrecision(12)));
    },
    commit,
  });
}

class PlainText implements Editor {
  readonly element = h("span", { class: "value-text" });

  show(item: TreeItem): void {
    const text = item.kind === "group" ? String(item.value ?? "") : formatValue(item.value);
    if (this.element.textContent !== text) this.element.textContent = text;
    this.element.title = text;
  }

  focus(): boolean {
    return false;
  }
}

class CheckBoxEditor implements Editor {
  readonly element = h("input", { class: "check" });

  constructor(private readonly commit: (value: PropertyValue) => void) {
    this.element.type = "checkbox";
    this.element.tabIndex = -1;
    this.element.addEventListener("change", () => commit(this.element.checked));
  }

  show(item: TreeItem): void {
    this.element.checked = item.value === true;
    this.element.disabled = item.isReadOnly === true || !item.set;
    this.element.setAttribute("aria-label", item.name);
  }

  focus(): boolean {
    return false;
  }

  toggle(): void {
    if (this.element.disabled) return;
    this.element.checked = !this.element.checked;
    this.commit(this.element.checked);
  }
}

class ChoiceEditor implements Editor {
  readonly element = h("select", { class: "choice" });
  private optionsKey = "";

  constructor(commit: (value: PropertyValue) => void) {
    this.element.tabIndex = -1;
    this.element.addEventListener("change", () => commit(this.element.value));
  }

  show(item: TreeItem): void {
    const value = String(item.value ?? "");
    const options = [...new Set([...(item.options ?? []), value])];
    if (options.join("\n") !== this.optionsKey) {
      this.optionsKey = options.join("\n");
      this.element.replaceChildren(...options.map((option) => new Option(strings.values[option] ?? option, option)));
    }
    this.element.value = value;
    this.element.setAttribute("aria-label", item.name);
  }

  focus(): boolean {
    this.element.focus();
    return true;
  }
}

class ColorEditor implements Editor {
  readonly element: HTMLElement;
  private readonly swatch = h("input", { class: "swatch", title: strings.tree.pickColor });
  private readonly textEditor: TextEditor;

  constructor(commit: (value: PropertyValue) => void) {
    this.textEditor = new TextEditor({ format: (value) => formatColor(String(value)), parse: parseColor, commit });
    this.swatch.type = "color";
    this.swatch.tabIndex = -1;
    this.swatch.addEventListener("input", () => commit(this.swatch.value));
    this.element = h("span", { class: "color-editor" }, this.swatch, this.textEditor.element);
  }

  show(item: TreeItem): void {
    this.swatch.value = String(item.value);
    this.textEditor.show(item);
  }

  focus(): boolean {
    return this.textEditor.focus();
  }
}
