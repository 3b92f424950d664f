import type { TransactionSpec } from "@codemirror/state";
import type { EditorView } from "@codemirror/view";
import type { ServerRange } from "./server-places";
import type { SourceDocument } from "./source-document";

/** A finding of the language server, as in the protocol. */
export interface ServerFinding {
  readonly range: ServerRange;
  readonly severity?: number;
  readonly code?: number | string;
  readonly message: string;
}

/** The documents of the editor, for the language server. */
export interface Documents {
  readonly open: readonly SourceDocument[];
  readonly view: EditorView;
  readonly shownDocument: SourceDocument | null;
  /** Shows a file, and returns whether it can be shown. */
  show(path: string): Promise<boolean>;
  /** Opens a file without showing it; null if it cannot be read. */
  load(path: string): Promise<SourceDocument | null>;
  /** Creates an empty file, and rejects with the reason if it cannot be created. */
  create(path: string): Promise<void>;
  /** Changes a document, whether it is shown or not. */
  change(document: SourceDocument, spec: TransactionSpec): void;
  /** Receives the findings of a file. */
  onFindings(uri: string, findings: readonly ServerFinding[]): void;
}
