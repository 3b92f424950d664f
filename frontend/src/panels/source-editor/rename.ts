import { showDialog, type EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import type { Documents } from "./documents";
import type { LanguageService } from "./language-service";
import { confirmRename, type RenamedFile } from "./rename-preview";
import { pathOf, serverPositionOf, textOfRange, type ServerRange } from "./server-places";
import { applyWorkspaceEdit, groupByFile, messageOf, type WorkspaceEdit } from "./workspace-edit";

/** The place of a symbol that can be renamed, with its name unless that is the text there. */
type RenameTarget = ServerRange | { readonly range: ServerRange; readonly placeholder: string };

/**
 * Asks for a new name for the symbol at the cursor, shows what changes, and renames the symbol in all files, which are
 * not saved yet.
 */
export function renameAtCursor(view: EditorView, service: LanguageService, documents: Documents, showMessage: (message: string) => void): boolean {
  void rename(view, service, documents).then(showMessage, (error: unknown) => showMessage(messageOf(error)));
  return true;
}

async function rename(view: EditorView, { client, message }: LanguageService, documents: Documents): Promise<string> {
  const texts = strings.sourceEditor;
  const { shownDocument } = documents;
  if (!shownDocument) return "";
  client.sync();
  const request = { textDocument: { uri: shownDocument.uri }, position: serverPositionOf(view.state.doc, view.state.selection.main.head) };
  const target = await client.request<object, RenameTarget | null>("textDocument/prepareRename", request);
  if (target === null) return texts.nothingToRename;
  const oldName = "placeholder" in target ? target.placeholder : textOfRange(view.state.doc, target);
  const newName = await askName(view, oldName);
  if (newName === null || newName === oldName) return "";
  client.sync();
  const remarks: string[] = [];
  const unsubscribe = message.on((remark) => remarks.push(remark));
  const edit = await client.request<object, WorkspaceEdit | null>("textDocument/rename", { ...request, newName }).finally(unsubscribe);
  const files = edit === null ? [] : await listRenamedFiles(edit, documents);
  if (edit === null || files.length === 0) return [texts.nothingToRename, ...remarks].join(" ");
  if (!(await confirmRename(oldName, newName, files, remarks))) return texts.notRenamed;
  const changedDocuments = await applyWorkspaceEdit(client, edit, documents, "rename");
  return texts.renamed(newName, changedDocuments.length);
}

async function listRenamedFiles(edit: WorkspaceEdit, documents: Documents): Promise<RenamedFile[]> {
  const files: RenamedFile[] = [];
  for (const [uri, edits] of groupByFile(edit).edits) {
    const path = pathOf(uri);
    const document = path === null ? null : await documents.load(path);
    if (!document) throw new Error(strings.sourceEditor.notEditable(path ?? uri, ""));
    if (document === documents.shownDocument) files.unshift({ document, edits });
    else files.push({ document, edits });
  }
  return files;
}

async function askName(view: EditorView, name: string): Promise<string | null> {
  const texts = strings.sourceEditor;
  const { close, result } = showDialog(view, {
    label: texts.newName,
    input: { name: "name", value: name, "aria-label": texts.newName },
    focus: true,
    submitLabel: texts.rename,
    class: "cm-lsp-rename-panel",
    top: true,
  });
  const form = await result;
  view.dispatch({ effects: close });
  view.focus();
  const field = form?.elements.namedItem("name");
  return field instanceof HTMLInputElement ? field.value.trim() : null;
}
