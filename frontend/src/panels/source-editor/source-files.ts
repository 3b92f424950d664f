import type { EditorState, TransactionSpec } from "@codemirror/state";
import type { SourceFile, SourceFileWritten } from "../../protocol";
import { Signal } from "../../signal";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { fileNameOf } from "../place";
import { isWithinMessageSize } from "./message-size";
import { SourceDocument } from "./source-document";

const MAX_RESTARTS = 3;
const RESTART_DELAY_MS = 1000;

/** What the files need of the editor. */
interface FilesHost {
  /** Returns the state of a view of a new document. */
  createState(path: string, uri: string, text: string, isReadOnly: boolean): EditorState;
  change(document: SourceDocument, spec: TransactionSpec): void;
  /** The workspace was opened, for the first time or again. */
  onWorkspaceOpened(folder: string, uri: string): void;
  onAdded(document: SourceDocument): void;
  /** The file of a document was written by the editor, or by another program. */
  onWritten(document: SourceDocument, isOwn: boolean): void;
  onCreated(): void;
  showMessage(message: string): void;
}

/** The documents of the editor, which are read from the server and written there. */
export class SourceFiles {
  /** A document was opened, changed on the disk or written. */
  readonly changed = new Signal();
  /** Why nothing can be edited; empty if files can, null before the server has answered. */
  unavailableReason: string | null = null;
  private readonly documents = new Map<string, SourceDocument>();
  private readonly waitingCallbacks = new Map<string, ((document: SourceDocument | null) => void)[]>();
  private readonly pendingWrites = new Map<number, SourceDocument>();
  /** The files that are opened even if they do not exist. */
  private readonly creatablePaths = new Set<string>();
  private readonly pendingCreations = new Map<number, { resolve: () => void; reject: (reason: Error) => void }>();
  /** The file whose workspace is edited. */
  private mainFile = "";
  private isOpen = false;
  private restartCount = 0;
  private lastRequestNumber = 0;

  constructor(
    private readonly session: Session,
    private readonly host: FilesHost,
  ) {
    this.listen();
  }

  get open(): readonly SourceDocument[] {
    return [...this.documents.values()];
  }

  get unsavedDocuments(): readonly SourceDocument[] {
    return this.open.filter((document) => document.isUnsaved);
  }

  /** Opens a workspace, whose files can then be loaded. */
  openWorkspace(folder: string): void {
    this.mainFile = folder;
    if (!this.isOpen) this.requestWorkspace();
  }

  /** Opens a file, and the workspace if it is the first one; null if it cannot be read. */
  load(path: string): Promise<SourceDocument | null> {
    const document = this.documents.get(path);
    if (document) return Promise.resolve(document);
    if (this.unavailableReason !== "") this.mainFile = path;
    return new Promise((resolve) => {
      const callbacks = this.waitingCallbacks.get(path);
      if (callbacks) callbacks.push(resolve);
      else {
        this.waitingCallbacks.set(path, [resolve]);
        if (this.isOpen) this.session.connection.send({ type: "request_source_file", path });
        else this.requestWorkspace();
      }
    });
  }

  /** Opens a file, or an empty text that creates it when it is saved; null if there can be no such file. */
  loadOrCreate(path: string): Promise<SourceDocument | null> {
    this.creatablePaths.add(path);
    return this.load(path);
  }

  /** Creates an empty file, and rejects with the reason if it cannot be created. */
  create(path: string): Promise<void> {
    return new Promise((resolve, reject) => {
      this.lastRequestNumber += 1;
      this.pendingCreations.set(this.lastRequestNumber, { resolve, reject });
      this.session.connection.send({ type: "create_source_file", number: this.lastRequestNumber, path });
    });
  }

  /** Writes all files that have changed. */
  saveAll(): void {
    const texts = strings.sourceEditor;
    const { connection } = this.session;
    if (connection.state !== "connected") {
      this.host.showMessage(texts.disconnected);
      return;
    }
    for (const document of this.unsavedDocuments) {
      if (document.conflict !== null || document.isWriting) continue;
      const text = document.beginWriting();
      if (!isWithinMessageSize(text)) {
        document.endWriting(null);
        this.host.showMessage(texts.tooLong(fileNameOf(document.path)));
        continue;
      }
      this.lastRequestNumber += 1;
      this.pendingWrites.set(this.lastRequestNumber, document);
      connection.send({ type: "write_source_file", number: this.lastRequestNumber, path: document.path, version: document.version, text });
    }
  }

  private listen(): void {
    const { connection, description } = this.session;
    connection.on("editor_opened", ({ folder, uri, refusal_reason }) => this.onOpened(folder, uri, refusal_reason));
    connection.on("source_file", (message) => this.onFile(message));
    connection.on("source_file_written", (message) => this.onWritten(message));
    connection.on("hello", () => this.onProgramStarted());
    connection.on("diagnostics", () => this.reopen());
    connection.on("description_changed", () => this.reopen());
    description.arrived.on(() => this.reopen());
    connection.on("language_server_ended", () => {
      this.isOpen = false;
      this.restartCount += 1;
      this.host.showMessage(strings.sourceEditor.ended);
      if (this.restartCount <= MAX_RESTARTS) setTimeout(() => this.reopen(), RESTART_DELAY_MS);
    });
    window.addEventListener("beforeunload", (event) => this.unsavedDocuments.length > 0 && event.preventDefault());
  }

  /** Ends the pending requests to the previous program, which get no answers. */
  private onProgramStarted(): void {
    this.isOpen = false;
    for (const document of this.pendingWrites.values()) document.endWriting(null);
    for (const { reject } of this.pendingCreations.values()) reject(new Error(strings.sourceEditor.disconnected));
    this.pendingWrites.clear();
    this.pendingCreations.clear();
  }

  /** Opens the workspace again, after the program was restarted. */
  private reopen(): void {
    if (!this.isOpen && this.mainFile !== "") this.requestWorkspace();
  }

  private requestWorkspace(): void {
    this.session.connection.send({ type: "open_editor", file: this.mainFile });
  }

  private onOpened(folder: string, uri: string, unavailableReason: string): void {
    this.unavailableReason = unavailableReason;
    this.isOpen = unavailableReason === "";
    if (this.isOpen) {
      for (const path of [...this.documents.keys(), ...this.waitingCallbacks.keys()]) this.session.connection.send({ type: "request_source_file", path });
      this.host.onWorkspaceOpened(folder, uri);
    } else for (const path of [...this.waitingCallbacks.keys()]) this.resolveWaiting(path, null);
    this.changed.emit();
  }

  private onFile({ path, uri, version, text, refusal_reason, is_new: isNew }: SourceFile): void {
    let document = this.documents.get(path);
    if (document?.isNew === true && isNew) document.version = version;
    else if (document) {
      document.readOnlyReason = refusal_reason;
      const spec = text === null ? null : document.onDiskChanged(text, version);
      if (spec) this.host.change(document, spec);
      this.host.onWritten(document, false);
    } else if (text !== null || (isNew && this.creatablePaths.has(path))) {
      const readOnlyReason = isNew ? "" : refusal_reason;
      document = new SourceDocument(path, uri, version, this.host.createState(path, uri, text ?? "", readOnlyReason !== ""));
      [document.readOnlyReason, document.isNew] = [readOnlyReason, isNew];
      this.documents.set(path, document);
      this.host.onAdded(document);
    } else this.host.showMessage(refusal_reason);
    this.resolveWaiting(path, document ?? null);
    this.changed.emit();
  }

  private onWritten({ number, path, version, refusal }: SourceFileWritten): void {
    const [document, createdFile] = [this.pendingWrites.get(number), this.pendingCreations.get(number)];
    this.pendingWrites.delete(number);
    this.pendingCreations.delete(number);
    const wasNew = document?.isNew === true;
    document?.endWriting(refusal === null ? version : null);
    const reason = refusal ? [refusal.message, ...refusal.hints].join(" ") : "";
    if (refusal && createdFile) createdFile.reject(new Error(reason));
    else if (refusal) this.host.showMessage(reason);
    else if (document) {
      this.host.onWritten(document, true);
      if (wasNew) this.host.onCreated();
      this.host.showMessage(strings.sourceEditor.saved(fileNameOf(path)));
    } else {
      this.host.onCreated();
      createdFile?.resolve();
    }
    this.changed.emit();
  }

  private resolveWaiting(path: string, document: SourceDocument | null): void {
    const callbacks = this.waitingCallbacks.get(path) ?? [];
    this.waitingCallbacks.delete(path);
    for (const resolve of callbacks) resolve(document);
  }
}
