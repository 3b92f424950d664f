import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { DiagnosticItem, EditedFile } from "../../protocol";
import type { EditingState } from "../../state/editing/editing";
import { strings } from "../../strings";
import { shortenPath } from "../place";
import { parseDiff } from "./diff-lines";

/** The number of characters shown before and after the difference, in a long line or a low panel. */
const [CONTEXT_BEFORE, CONTEXT_AFTER] = [16, 10];
/** The maximum number of characters of a line that is shown complete where there is room. */
const MAX_SHORT_LINE = 90;

/** The preview of an edit in the files, or the reason for its refusal, with buttons to write and undo it. */
export class EditOutcome {
  readonly element: HTMLElement;
  private readonly text = h("div", { class: "edit-text", role: "status", tabIndex: 0 });
  private readonly applyButton: HTMLButtonElement;
  private readonly discardButton: HTMLButtonElement;
  private readonly changeAllButton: HTMLButtonElement;
  private readonly undoButton: HTMLButtonElement;
  private readonly redoButton: HTMLButtonElement;

  constructor(private readonly editing: EditingState) {
    const texts = strings.editing;
    this.applyButton = createButton(texts.applyHint, () => editing.apply(), "tool framed primary", texts.apply);
    this.discardButton = createButton(texts.dropHint, () => editing.discardDraft(), "tool framed", texts.drop);
    this.changeAllButton = createButton(texts.allHint, () => editing.changeAll(), "tool framed", texts.all);
    this.undoButton = createButton(texts.undo, () => editing.undo(), "tool bare", createIcon("undo"));
    this.redoButton = createButton(texts.redo, () => editing.redo(), "tool bare", createIcon("redo"));
    const bar = h("div", { class: "edit-bar" }, this.applyButton, this.discardButton, this.changeAllButton, h("span", { class: "spacer" }), this.undoButton, this.redoButton);
    this.element = h("div", { class: "edit-outcome" }, this.text, bar);
    editing.changed.on(() => this.show());
    editing.draftChanged.on(() => this.show());
    this.show();
  }

  private show(): void {
    const { editing } = this;
    const texts = strings.editing;
    const { preview, refusal, isDraftOpen, writtenFiles } = editing;
    const formatWritten = editing.isWrittenToText ? texts.writtenToText : texts.written;
    this.applyButton.disabled = !isDraftOpen || (preview?.files.length ?? 0) === 0;
    this.discardButton.disabled = !isDraftOpen;
    this.changeAllButton.hidden = !isDraftOpen || preview?.refusal?.code !== "EDIT104" || editing.isForAllElements;
    this.undoButton.disabled = !editing.canUndo;
    this.redoButton.disabled = !editing.canRedo;
    if (refusal) this.text.replaceChildren(createRefusal(refusal));
    else if (preview?.refusal) this.text.replaceChildren(createRefusal(preview.refusal));
    else if (preview) this.text.replaceChildren(...createAlsoChangedNote(preview.also), ...preview.files.map(createDiff));
    else if (isDraftOpen) this.text.replaceChildren(h("p", { class: "hint" }, texts.looking));
    else if (writtenFiles.length > 0) this.text.replaceChildren(h("p", { class: "hint" }, formatWritten(writtenFiles.map((file) => shortenPath(file)).join(", "))));
    else this.text.replaceChildren(h("p", { class: "hint" }, texts.idle));
    this.element.classList.toggle("refused", refusal !== null || (preview?.refusal ?? null) !== null);
  }
}

function createAlsoChangedNote(names: readonly string[]): HTMLElement[] {
  return names.length === 0 ? [] : [h("p", { class: "edit-also" }, strings.editing.also(names.join(", ")))];
}

function createDiff({ file, diff: lines }: EditedFile): HTMLElement {
  const kinds: Readonly<Record<string, string>> = { "+": "added", "-": "removed", "@": "at" };
  const rows = parseDiff(lines).map(({ sign, before, difference, after }) => {
    const kind = kinds[sign] ?? "around";
    if (kind === "at" || kind === "around") return h("span", { class: kind }, `${sign}${before}\n`);
    const [start, end] = [Math.max(0, before.length - CONTEXT_BEFORE), Math.min(after.length, CONTEXT_AFTER)];
    const parts = [createDistantText(before.slice(0, start)), before.slice(start), h("mark", {}, difference), after.slice(0, end), createDistantText(after.slice(end))];
    return h("span", { class: kind }, sign, ...parts, "\n");
  });
  const isLong = lines.some((line) => line.length > MAX_SHORT_LINE);
  return h("figure", { class: isLong ? "edit-diff long" : "edit-diff" }, h("figcaption", { title: file }, shortenPath(file)), h("pre", {}, ...rows));
}

/** Returns text far from the difference, which only a tall panel with short lines shows. */
function createDistantText(text: string): HTMLElement | null {
  return text === "" ? null : h("span", { class: "far" }, text);
}

function createRefusal({ message, file, line, notes, hints }: DiagnosticItem): HTMLElement {
  const formatPlace = (path: string | null, number: number | null): string => (path === null || number === null ? "" : ` (${shortenPath(path)}:${number})`);
  return h(
    "div",
    { class: "edit-refusal" },
    h("p", {}, h("strong", {}, message), formatPlace(file, line)),
    ...hints.map((hint) => h("p", { class: "hint" }, hint)),
    h("ul", {}, ...notes.map((note) => h("li", {}, note.message, formatPlace(note.file, note.line)))),
  );
}
