import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { MessageField } from "../../protocol";
import { strings } from "../../strings";

interface FieldRow {
  readonly element: HTMLElement;
  readonly value: HTMLElement;
  readonly children: HTMLElement;
  readonly toggle: HTMLButtonElement | null;
  /** Shows the number of elements that are omitted. */
  readonly omittedNote: HTMLElement;
}

/** A message as a tree that unfolds row by row; a new message changes the values and keeps the unfolded rows. */
export class MessageTree {
  readonly element = h("div", { class: "message-tree" });
  private readonly rows = new Map<string, FieldRow>();
  private readonly openPaths = new Set<string>();
  private fields: readonly MessageField[] = [];

  /** @param onPlotField - called with the path of a numeric field whose plot button is clicked; null for no buttons. */
  constructor(private readonly onPlotField: ((path: string) => void) | null) {}

  show(fields: readonly MessageField[]): void {
    // Short messages are unfolded from the start.
    if (this.fields.length === 0 && fields.length <= 3) for (const { name } of fields) this.openPaths.add(name);
    this.fields = fields;
    this.fillRows(this.element, fields, "", null);
  }

  private fillRows(container: HTMLElement, fields: readonly MessageField[], prefix: string, lastElement: HTMLElement | null): void {
    const rows = fields.map((field) => {
      const path = field.name.startsWith("[") ? `${prefix}${field.name}` : prefix === "" ? field.name : `${prefix}.${field.name}`;
      const row = this.findOrCreateRow(path, field);
      if (row.value.textContent !== field.value) row.value.textContent = field.value;
      const isOpen = this.openPaths.has(path);
      row.toggle?.setAttribute("aria-expanded", String(isOpen));
      row.children.hidden = !isOpen;
      if (isOpen) {
        const omittedText = field.omitted > 0 ? strings.monitor.topics.omitted(field.omitted) : "";
        if (row.omittedNote.textContent !== omittedText) row.omittedNote.textContent = omittedText;
        this.fillRows(row.children, field.children, path, row.omittedNote);
      }
      return row.element;
    });
    if (lastElement) rows.push(lastElement);
    const isUnchanged = rows.length === container.childElementCount && rows.every((row, index) => row === container.children[index]);
    if (!isUnchanged) container.replaceChildren(...rows);
  }

  private findOrCreateRow(path: string, field: MessageField): FieldRow {
    const existing = this.rows.get(path);
    const hasChildren = field.children.length > 0;
    if (existing && (existing.toggle !== null) === hasChildren) return existing;
    const value = h("span", { class: "message-value" });
    const children = h("div", { class: "message-children" });
    const toggle = hasChildren ? createButton(field.name, () => this.toggle(path), "expander", createIcon("chevron")) : null;
    const { onPlotField } = this;
    const isPlottable = onPlotField !== null && !hasChildren && isNumeric(field);
    const head = h(
      "div",
      { class: "message-row", title: field.kind },
      toggle ?? h("span", { class: "expander" }),
      h("span", { class: "message-name" }, field.name),
      value,
      h("span", { class: "note kind" }, field.kind),
      isPlottable ? createButton(strings.monitor.topics.plot, () => onPlotField(path), "tool bare", createIcon("plot")) : null,
    );
    const omittedNote = h("div", { class: "note" });
    const row = { element: h("div", {}, head, children), value, children, toggle, omittedNote };
    this.rows.set(path, row);
    return row;
  }

  private toggle(path: string): void {
    if (!this.openPaths.delete(path)) this.openPaths.add(path);
    this.fillRows(this.element, this.fields, "", null);
  }
}

const NUMERIC_KINDS = /^(u?int(8|16|32|64)|float|double|boolean|octet)$/;

function isNumeric({ kind }: MessageField): boolean {
  return NUMERIC_KINDS.test(kind);
}
