import { h } from "../../dom";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";
import { shortenPath } from "../place";
import { createExcerpt } from "./navigation";
import type { SourceDocument } from "./source-document";
import type { TextEdit } from "./workspace-edit";

/** A file that a rename changes. */
export interface RenamedFile {
  readonly document: SourceDocument;
  readonly edits: readonly TextEdit[];
}

const MAX_SHOWN_LINES = 400;

/**
 * Shows the lines that a rename changes, and returns whether the user wants it.
 *
 * @param remarks - the server's remarks about the rename, such as mentions that stay as they are.
 */
export function confirmRename(name: string, newName: string, files: readonly RenamedFile[], remarks: readonly string[]): Promise<boolean> {
  const texts = strings.sourceEditor;
  const count = files.reduce((sum, { edits }) => sum + edits.length, 0);
  let remainingLines = MAX_SHOWN_LINES;
  const lists = files.flatMap(({ document, edits }) => {
    const shownEdits = edits.slice(0, remainingLines);
    remainingLines -= shownEdits.length;
    return shownEdits.length === 0 ? [] : [createFileList(document, shownEdits)];
  });
  const linesBox = h("div", { class: "rename-lines", role: "group", tabIndex: 0, aria: { label: texts.changedLines } }, ...lists);
  if (count > MAX_SHOWN_LINES) linesBox.append(h("p", {}, texts.moreLines(count - MAX_SHOWN_LINES)));
  const notes = remarks.map((remark) => h("p", { class: "rename-remark" }, remark));
  return new Promise((resolve) => {
    let isConfirmed = false;
    const confirm = (): undefined => void (isConfirmed = true);
    const dialog = new Dialog(
      texts.renameTitle(name, newName),
      [h("p", {}, texts.renameCount(count, files.length)), linesBox, ...notes],
      [{ label: strings.shell.cancel }, { label: texts.rename, run: confirm, isPrimary: true }],
      "rename-preview",
    );
    dialog.element.addEventListener("close", () => resolve(isConfirmed));
    dialog.open();
  });
}

function createFileList(document: SourceDocument, edits: readonly TextEdit[]): HTMLElement {
  const lines = [...edits].sort((a, b) => a.range.start.line - b.range.start.line || a.range.start.character - b.range.start.character).map(({ range, newText }) => {
    const { line, textBefore, name, textAfter } = createExcerpt(document, range);
    const code = h("code", {}, textBefore, h("del", {}, name), h("ins", {}, newText), textAfter);
    return h("li", {}, h("span", { class: "place-list-line" }, String(line)), code);
  });
  return h("section", {}, h("h3", { title: document.path }, shortenPath(document.path)), h("ul", {}, ...lines));
}
