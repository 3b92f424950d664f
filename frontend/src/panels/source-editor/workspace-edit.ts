import type { LSPClient } from "@codemirror/lsp-client";
import { strings } from "../../strings";
import type { Documents } from "./documents";
import { pathOf, offsetOf, type ServerRange } from "./server-places";
import type { SourceDocument } from "./source-document";

export interface TextEdit {
  readonly range: ServerRange;
  readonly newText: string;
}

interface DocumentEdit {
  readonly kind?: undefined;
  readonly textDocument: { readonly uri: string; readonly version?: number | null };
  readonly edits: readonly TextEdit[];
}

interface CreatedFile {
  readonly kind: "create";
  readonly uri: string;
}

/** Changes of files, as in the protocol of language servers. */
export interface WorkspaceEdit {
  readonly changes?: Readonly<Record<string, readonly TextEdit[]>> | null;
  readonly documentChanges?: readonly (DocumentEdit | CreatedFile)[] | null;
}

/**
 * The edits of each file by its URI, the files to create, and the versions of the edited texts that the edit states.
 */
interface FileEdits {
  readonly edits: ReadonlyMap<string, readonly TextEdit[]>;
  readonly createdFiles: readonly string[];
  readonly versions: ReadonlyMap<string, number>;
}

/** Returns the changes of an edit, by file. */
export function groupByFile(edit: WorkspaceEdit): FileEdits {
  const edits = new Map<string, readonly TextEdit[]>(Object.entries(edit.changes ?? {}));
  const createdFiles: string[] = [];
  const versions = new Map<string, number>();
  for (const change of edit.documentChanges ?? []) {
    if (change.kind === "create") {
      createdFiles.push(change.uri);
      continue;
    }
    const { uri, version = null } = change.textDocument;
    edits.set(uri, [...(edits.get(uri) ?? []), ...change.edits]);
    if (version !== null) versions.set(uri, version);
  }
  return { edits, createdFiles, versions };
}

/**
 * Applies an edit to all of its files, which are not saved yet, and returns them.
 *
 * @throws Error if one of them cannot be edited, or its text is no longer the one that the edit was made for; none is
 * changed then.
 */
export async function applyWorkspaceEdit(client: LSPClient, edit: WorkspaceEdit, documents: Documents, userEvent: string): Promise<SourceDocument[]> {
  const texts = strings.sourceEditor;
  const { edits, createdFiles, versions } = groupByFile(edit);
  client.sync();
  const isOutdated = (uri: string): boolean => versions.has(uri) && client.workspace.getFile(uri)?.version !== versions.get(uri);
  const previousTexts = new Map(documents.open.map((document) => [document.uri, document.state.doc]));
  const changedDocuments: [SourceDocument, readonly TextEdit[]][] = [];
  for (const uri of new Set([...createdFiles, ...edits.keys()])) {
    const path = pathOf(uri);
    if (path !== null && createdFiles.includes(uri)) await documents.create(path);
    const document = path === null ? null : await documents.load(path);
    if (!document || document.readOnlyReason !== "") throw new Error(texts.notEditable(path ?? uri, document?.readOnlyReason ?? ""));
    if (isOutdated(uri) || previousTexts.get(uri)?.eq(document.state.doc) === false) throw new Error(texts.changedMeanwhile);
    changedDocuments.push([document, edits.get(uri) ?? []]);
  }
  for (const [document, edits] of changedDocuments) {
    const { doc } = document.state;
    const changes = edits.map(({ range, newText }) => ({ from: offsetOf(doc, range.start), to: offsetOf(doc, range.end), insert: newText }));
    documents.change(document, { changes, userEvent });
  }
  client.sync();
  return changedDocuments.map(([document]) => document);
}

/** Returns the message of an error, which may be one of the language server. */
export function messageOf(error: unknown): string {
  return typeof error === "object" && error !== null && "message" in error ? String(error.message) : String(error);
}
