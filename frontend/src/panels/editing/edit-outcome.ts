import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { DiagnosticItem, EditedFile } from "../../protocol";
import type { EditingState } from "../../state/editing/editing";
import { strings } from "../../strings";
import { shortenPath } from "../place";
import { diffLines } from "./diff-lines";

/** The number of characters shown before and after the difference, in a long line or a low panel. */
const [NEAR_BEFORE, NEAR_AFTER] = [16, 10];
/** Up to this number of characters, a line is shown whole if there is room. */
const LONGEST_WHOLE = 90;

/** The preview of an edit in the files, or the reason for its refusal, with buttons to write and undo it. */
export class EditOutcome {
  readonly element: HTMLElement;
  private readonly text = h("div", { class: "edit-text", role: "status", tabIndex: 0 });
  private readonly apply: HTMLButtonElement;
  private readonly discard: HTMLButtonElement;
  private readonly all: HTMLButtonElement;
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;

  constructor(private readonly editing: EditingState) {
    const texts = strings.editing;
    this.apply = button(texts.applyHint, () => editing.apply(), "tool framed primary", texts.apply);
    this.discard = button(texts.dropHint, () => editing.reset(), "tool framed", texts.drop);
    this.all = button(texts.allHint, () => editing.changeAll(), "tool framed", texts.all);
    this.undo = button(texts.undo, () => editing.undo(), "tool bare", icon("undo"));
    this.redo = button(texts.redo, () => editing.redo(), "tool bare", icon("redo"));
    const bar = h("div", { class: "edit-bar" }, this.apply, this.discard, this.all, h("span", { class: "spacer" }), this.undo, this.redo);
    this.element = h("div", { class: "edit-outcome" }, this.text, bar);
    editing.changed.on(() => this.show());
    editing.draftChanged.on(() => this.show());
    this.show();
  }

  private show(): void {
    const { editing } = this;
    const texts = strings.editing;
    const { preview, refusal, isOpen, writtenFiles } = editing;
    const writtenWords = editing.isWrittenToText ? texts.writtenToText : texts.written;
    this.apply.disabled = !isOpen || (preview?.files.length ?? 0) === 0;
    this.discard.disabled = !isOpen;
    this.all.hidden = !isOpen || preview?.refusal?.code !== "EDIT104" || editing.isChangeOfAll;
    this.undo.disabled = !editing.canUndo;
    this.redo.disabled = !editing.canRedo;
    if (refusal) this.text.replaceChildren(refusalElement(refusal));
    else if (preview?.refusal) this.text.replaceChildren(refusalElement(preview.refusal));
    else if (preview) this.text.replaceChildren(...alsoElement(preview.also), ...preview.files.map(diff));
    else if (isOpen) this.text.replaceChildren(h("p", { class: "hint" }, texts.looking));
    else if (writtenFiles.length > 0) this.text.replaceChildren(h("p", { class: "hint" }, writtenWords(writtenFiles.map((file) => shortenPath(file)).join(", "))));
    else this.text.replaceChildren(h("p", { class: "hint" }, texts.idle));
    this.element.classList.toggle("refused", refusal !== null || (preview?.refusal ?? null) !== null);
  }
}

function alsoElement(names: readonly string[]): HTMLElement[] {
  return names.length === 0 ? [] : [h("p", { class: "edit-also" }, strings.editing.also(names.join(", ")))];
}

function diff({ file, diff: lines }: EditedFile): HTMLElement {
  const kinds: Readonly<Record<string, string>> = { "+": "added", "-": "removed", "@": "at" };
  const rows = diffLines(lines).map(({ sign, before, changed, after }) => {
    const kind = kinds[sign] ?? "around";
    if (kind === "at" || kind === "around") return h("span", { class: kind }, `${sign}${before}\n`);
    const [from, to] = [Math.max(0, before.length - NEAR_BEFORE), Math.min(after.length, NEAR_AFTER)];
    const parts = [distantText(before.slice(0, from)), before.slice(from), h("mark", {}, changed), after.slice(0, to), distantText(after.slice(to))];
    return h("span", { class: kind }, sign, ...parts, "\n");
  });
  const isLong = lines.some((line) => line.length > LONGEST_WHOLE);
  return h("figure", { class: isLong ? "edit-diff long" : "edit-diff" }, h("figcaption", { title: file }, shortenPath(file)), h("pre", {}, ...rows));
}

/** Returns the distant part of a line, which only a high panel with short lines shows. */
function distantText(text: string): HTMLElement | null {
  return text === "" ? null : h("span", { class: "far" }, text);
}

function refusalElement({ message, file, line, notes, hints }: DiagnosticItem): HTMLElement {
  const at = (path: string | null, number: number | null): string => (path === null || number === null ? "" : ` (${shortenPath(path)}:${number})`);
  return h(
    "div",
    { class: "edit-refusal" },
    h("p", {}, h("strong", {}, message), at(file, line)),
    ...hints.map((hint) => h("p", { class: "hint" }, hint)),
    h("ul", {}, ...notes.map((note) => h("li", {}, note.message, at(note.file, note.line)))),
  );
}
