import { LSPPlugin } from "@codemirror/lsp-client";
import { showDialog, type EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import type { Documents } from "./documents";
import { placeOf, type ServerRange } from "./server-places";
import { applyWorkspaceEdit, messageOf, type WorkspaceEdit } from "./workspace-edit";

/** Asks for a new name for the symbol at the cursor, and renames the symbol in all files, which are not saved yet. */
export function renameAtCursor(view: EditorView, documents: Documents, tell: (message: string) => void): boolean {
  const plugin = LSPPlugin.get(view);
  if (!plugin) return false;
  void rename(view, plugin, documents).then(tell, (error: unknown) => tell(messageOf(error)));
  return true;
}

async function rename(view: EditorView, { client, uri }: LSPPlugin, documents: Documents): Promise<string> {
  const words = strings.sourceEditor;
  client.sync();
  const { head } = view.state.selection.main;
  const place = { textDocument: { uri }, position: placeOf(view.state.doc, head) };
  const named = await client.request<object, { range: ServerRange; placeholder: string } | null>("textDocument/prepareRename", place);
  if (named === null) return words.nothingToRename;
  const newName = await askName(view, named.placeholder);
  if (newName === null || newName === named.placeholder) return "";
  client.sync();
  const edit = await client.request<object, WorkspaceEdit | null>("textDocument/rename", { ...place, newName });
  const changed = edit === null ? [] : await applyWorkspaceEdit(client, edit, documents, "rename");
  return changed.length === 0 ? words.nothingToRename : words.renamed(newName, changed.length);
}

async function askName(view: EditorView, name: string): Promise<string | null> {
  const words = strings.sourceEditor;
  const { close, result } = showDialog(view, {
    label: words.newName,
    input: { name: "name", value: name, "aria-label": words.newName },
    focus: true,
    submitLabel: words.rename,
    class: "cm-lsp-rename-panel",
    top: true,
  });
  const form = await result;
  view.dispatch({ effects: close });
  view.focus();
  const field = form?.elements.namedItem("name");
  return field instanceof HTMLInputElement ? field.value.trim() : null;
}
