import { LSPClient, LSPPlugin, Workspace, type LSPClientConfig, type WorkspaceFile } from "@codemirror/lsp-client";
import { formatDocument, hoverTooltips, serverCompletion } from "@codemirror/lsp-client";
import { ChangeSet, type Extension, type Text, type TransactionSpec } from "@codemirror/state";
import { EditorView, keymap, ViewPlugin, type ViewUpdate } from "@codemirror/view";
import type { Connection } from "../../connection/connection";
import { Signal } from "../../signal";
import { ACTION_CAPABILITIES } from "./code-actions";
import type { Documents, ServerFinding } from "./documents";
import { languageOf } from "./languages";
import { isWithinMessageSize } from "./message-size";
import { MEANING_CAPABILITIES, createMeanings } from "./meanings";
import { pathOf } from "./server-places";
import { sanitizeHtml } from "./safe-html";
import type { SourceDocument } from "./source-document";

const REQUEST_TIMEOUT_MS = 20_000;
/** A server has this time to start, ms: on a busy computer it takes longer than an answer. */
const START_TIMEOUT_MS = 600_000;
/** Changes are sent this time after the last key, ms. */
const SYNC_DELAY_MS = 120;

/** Error codes of the protocol: the request was cancelled, or its text has changed meanwhile. */
const OUTDATED_CODES: readonly unknown[] = [-32800, -32801];
/** Requests that the next key or movement of the mouse repeats. */
const REPEATED_METHODS = ["textDocument/completion", "textDocument/hover"];

class TimeoutError extends Error {
  constructor() {
    super("Request timed out");
  }
}

/**
 * A client that waits for the start of its server, and treats an outdated answer as an empty one instead of an error.
 */
class PatientClient extends LSPClient {
  // eslint-disable-next-line @typescript-eslint/no-unnecessary-type-parameters -- the type of the overridden method
  override request<Params, Result>(method: string, params: Params): Promise<Result> {
    const response = this.limitTime(super.request<Params, Result>(method, params));
    if (!REPEATED_METHODS.includes(method)) return response;
    return response.catch((error: unknown) => {
      if (isOutdated(error)) return null as Result;
      throw error;
    });
  }

  /** Rejects if an answer takes too long, counted from the start of the server. */
  private limitTime<Result>(response: Promise<Result>): Promise<Result> {
    return new Promise((resolve, reject) => {
      let timer: ReturnType<typeof setTimeout> | undefined;
      const startTimer = (): void => void (timer = setTimeout(() => reject(new TimeoutError()), REQUEST_TIMEOUT_MS));
      this.initializing.then(startTimer, () => undefined); // the answer is rejected, too
      response.then(resolve, reject).finally(() => clearTimeout(timer));
    });
  }
}

function isOutdated(error: unknown): boolean {
  if (error instanceof TimeoutError) return true;
  return typeof error === "object" && error !== null && "code" in error && OUTDATED_CODES.includes(error.code);
}

class DocumentFile implements WorkspaceFile {
  version = 0;
  doc: Text;
  readonly languageId: string;
  /** The changes that the server does not know yet. */
  unsyncedChanges: ChangeSet;

  constructor(
    readonly document: SourceDocument,
    private readonly documents: Documents,
  ) {
    this.doc = document.state.doc;
    this.languageId = languageOf(document.path);
    this.unsyncedChanges = ChangeSet.empty(this.doc.length);
  }

  get uri(): string {
    return this.document.uri;
  }

  getView(): EditorView | null {
    return this.documents.shownDocument === this.document ? this.documents.view : null;
  }
}

/** All open documents; the view shows one of them. */
class DocumentWorkspace extends Workspace {
  files: DocumentFile[] = [];

  constructor(
    client: LSPClient,
    private readonly documents: Documents,
  ) {
    super(client);
  }

  add(document: SourceDocument): void {
    const file = new DocumentFile(document, this.documents);
    this.files.push(file);
    if (this.client.connected) this.client.didOpen(file);
  }

  record(document: SourceDocument, changes: ChangeSet): void {
    const file = this.files.find((candidate) => candidate.document === document);
    if (file) file.unsyncedChanges = file.unsyncedChanges.compose(changes);
  }

  override syncFiles(): { file: DocumentFile; prevDoc: Text; changes: ChangeSet }[] {
    const changedFiles = this.files.filter(({ unsyncedChanges }) => !unsyncedChanges.empty);
    return changedFiles.map((file) => {
      const result = { file, prevDoc: file.doc, changes: file.unsyncedChanges };
      file.doc = file.document.state.doc;
      file.unsyncedChanges = ChangeSet.empty(file.doc.length);
      file.version += 1;
      const view = file.getView();
      if (view) LSPPlugin.get(view)?.clear();
      return result;
    });
  }

  /** Documents stay open when the view shows another one. */
  override openFile(): void {
    // `add` has opened the document.
  }

  override closeFile(): void {
    // The document may have unsaved changes, on which the findings of other files depend.
  }

  override async requestFile(uri: string): Promise<DocumentFile | null> {
    const path = pathOf(uri);
    const document = path === null ? null : await this.documents.load(path);
    return this.files.find((candidate) => candidate.document === document) ?? null;
  }

  override async displayFile(uri: string): Promise<EditorView | null> {
    const path = pathOf(uri);
    return path !== null && (await this.documents.show(path)) ? this.documents.view : null;
  }

  override updateFile(uri: string, update: TransactionSpec): void {
    const file = this.files.find((candidate) => candidate.uri === uri);
    if (file) this.documents.change(file.document, update);
  }
}

/** The page's language server, to which the messages go through the page's own connection. */
export class LanguageService {
  readonly client: LSPClient;
  /** The server has sent a message for the user. */
  readonly message = new Signal<string>();
  private readonly workspace: DocumentWorkspace;
  private readonly config: LSPClientConfig;
  private receive: (content: string) => void = () => undefined;

  constructor(
    private readonly connection: Connection,
    documents: Documents,
  ) {
    let workspace: DocumentWorkspace | undefined;
    this.config = {
      timeout: START_TIMEOUT_MS,
      sanitizeHTML: sanitizeHtml,
      workspace: (client) => (workspace = new DocumentWorkspace(client, documents)),
      notificationHandlers: {
        "textDocument/publishDiagnostics": (_, { uri, version, diagnostics }: { uri: string; version?: number | null; diagnostics: ServerFinding[] }) => {
          const file = this.workspace.getFile(uri);
          if (file && (version === undefined || version === null || version === file.version)) documents.onFindings(uri, diagnostics);
          return true;
        },
        "window/showMessage": (_, { message }: { message: string }) => {
          this.message.emit(message);
          return true;
        },
      },
      extensions: [
        { clientCapabilities: { textDocument: { publishDiagnostics: { versionSupport: true, codeDescriptionSupport: true } } } },
        { clientCapabilities: { textDocument: { documentSymbol: { hierarchicalDocumentSymbolSupport: true } } } },
        { clientCapabilities: ACTION_CAPABILITIES },
        { clientCapabilities: MEANING_CAPABILITIES },
      ],
    };
    this.client = new PatientClient(this.config);
    if (workspace === undefined) throw new Error("the client has made no workspace");
    this.workspace = workspace;
    connection.on("language_server_output", ({ content }) => this.receive(content));
  }

  /** Begins a session with a new language server. */
  connect(rootUri: string): void {
    const { connection, client } = this;
    if (client.connected) client.disconnect();
    this.config.rootUri = rootUri;
    for (const file of this.workspace.files) {
      file.doc = file.document.state.doc;
      file.unsyncedChanges = ChangeSet.empty(file.doc.length);
    }
    client.connect({
      // Without the text of such a file, the server reads it from the disk.
      send: (content) => isWithinMessageSize(content) && connection.send({ type: "language_server_input", content }),
      subscribe: (handler) => (this.receive = handler),
      unsubscribe: () => (this.receive = () => undefined),
    });
    client.initializing.catch(() => undefined); // requests report the error
  }

  add(document: SourceDocument): void {
    this.workspace.add(document);
  }

  record(document: SourceDocument, changes: ChangeSet): void {
    this.workspace.record(document, changes);
  }

  /** Notifies the server of files that were written, by the editor or another program. */
  onFilesChanged(uris: readonly string[]): void {
    const changes = uris.map((uri) => ({ uri, type: 2 }));
    if (changes.length > 0) this.client.notification("workspace/didChangeWatchedFiles", { changes });
  }

  /** Returns the extension that makes a view of a document use the server. */
  extensionFor(document: { uri: string; path: string }): Extension {
    return [
      this.client.plugin(document.uri, languageOf(document.path)),
      serverCompletion({ override: true }),
      hoverTooltips(),
      createMeanings(this.client, document.uri),
      ViewPlugin.define(() => new Synchronizer(this.client)),
      keymap.of([{ key: "Shift-Alt-f", run: formatDocument, preventDefault: true }]),
    ];
  }
}

/** Sends changes soon after they were made, so that their findings arrive. */
class Synchronizer {
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly client: LSPClient) {}

  update({ docChanged }: ViewUpdate): void {
    if (!docChanged) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.client.sync(), SYNC_DELAY_MS);
  }

  destroy(): void {
    clearTimeout(this.timer);
  }
}
