import type { LSPClient } from "@codemirror/lsp-client";
import { LSPPlugin } from "@codemirror/lsp-client";
import { showDialog, type EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import type { Documents } from "./language-service";
import { pathOf, positionIn, type ServerRange } from "./server-places";
import type { SourceDocument } from "./source-document";

interface TextEdit {
  readonly range: ServerRange;
  readonly newText: string;
}
interface WorkspaceEdit {
  readonly changes?: Readonly<Record<string, readonly TextEdit[]>> | null;
  readonly documentChanges?: readonly { textDocument: { uri: string }; edits: readonly TextEdit[] }[] | null;
}

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
  const line = view.state.doc.lineAt(head);
  const place = { textDocument: { uri }, position: { line: line.number - 1, character: head - line.from } };
  const named = await client.request<object, { range: ServerRange; placeholder: string } | null>("textDocument/prepareRename", place);
  if (named === null) return words.nothingToRename;
  const newName = await askName(view, named.placeholder);
  if (newName === null || newName === named.placeholder) return "";
  client.sync();
  const edit = await client.request<object, WorkspaceEdit | null>("textDocument/rename", { ...place, newName });
  const count = edit === null ? 0 : await applyEdit(client, edit, documents);
  return count === 0 ? words.nothingToRename : words.renamed(newName, count);
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

/** Applies the edits of all files, and returns the number of files; changes none if one of them cannot be edited. */
async function applyEdit(client: LSPClient, edit: WorkspaceEdit, documents: Documents): Promise<number> {
  const edits = new Map<string, readonly TextEdit[]>(Object.entries(edit.changes ?? {}));
  for (const { textDocument, edits: own } of edit.documentChanges ?? []) edits.set(textDocument.uri, [...(edits.get(textDocument.uri) ?? []), ...own]);
  const before = new Map(documents.open.map((document) => [document.uri, document.state.doc]));
  const changed: [SourceDocument, readonly TextEdit[]][] = [];
  for (const [uri, own] of edits) {
    const path = pathOf(uri);
    const document = path === null ? null : await documents.load(path);
    if (!document || document.whyNot !== "") throw new Error(strings.sourceEditor.notEditable(path ?? uri, document?.whyNot ?? ""));
    if (before.get(uri)?.eq(document.state.doc) === false) throw new Error(strings.sourceEditor.changedMeanwhile);
    changed.push([document, own]);
  }
  for (const [document, own] of changed) {
    const { doc } = document.state;
    const changes = own.map(({ range, newText }) => ({ from: positionIn(doc, range.start), to: positionIn(doc, range.end), insert: newText }));
    documents.change(document, { changes, userEvent: "rename" });
  }
  client.sync();
  return changed.length;
}

function messageOf(error: unknown): string {
  return typeof error === "object" && error !== null && "message" in error ? String(error.message) : String(error);
}
