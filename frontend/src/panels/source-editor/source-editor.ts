import { selectParentSyntax } from "@codemirror/commands";
import { nextDiagnostic, openLintPanel, previousDiagnostic, diagnosticCount } from "@codemirror/lint";
import { formatDocument } from "@codemirror/lsp-client";
import { EditorState, type Transaction, type TransactionSpec } from "@codemirror/state";
import { EditorView, keymap } from "@codemirror/view";
import { button, coalesced, h } from "../../dom";
import { icon } from "../../icons";
import type { SourceFile, SourceFileWritten } from "../../protocol";
import { Signal } from "../../signal";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import type { Highlight } from "../description/source-view";
import { CodeActions } from "./code-actions";
import type { Documents, ServerFinding } from "./documents";
import { baseExtensions } from "./extensions";
import { FileTree } from "./file-tree";
import { showFindings } from "./findings";
import { LanguageService } from "./language-service";
import { inspectMarks, marksOf } from "./marks";
import { fitsMessage } from "./message-size";
import { Navigation } from "./navigation";
import { PlaceList } from "./place-list";
import { renameAtCursor } from "./rename";
import { SourceDocument } from "./source-document";
import { messageOf } from "./workspace-edit";
import "../../styles/source-editor.css";

const RESTARTS = 3;
const RESTART_MS = 1000;

/** The editor of the source files: one view, and the documents that it can show. */
export class SourceEditor implements Documents {
  readonly element: HTMLElement;
  readonly view: EditorView;
  /** A document was opened, shown, changed or saved. */
  readonly changed = new Signal();
  shown: SourceDocument | null = null;
  /** Why nothing can be edited; empty if files can, null before the server has answered. */
  whyNot: string | null = null;
  private readonly documents = new Map<string, SourceDocument>();
  private readonly awaited = new Map<string, ((document: SourceDocument | null) => void)[]>();
  private readonly writing = new Map<number, SourceDocument>();
  private readonly creating = new Map<number, { resolve: () => void; reject: (reason: Error) => void }>();
  private readonly found = new Map<string, readonly ServerFinding[]>();
  private readonly service: LanguageService;
  private readonly actions: CodeActions;
  private readonly navigation: Navigation;
  private readonly places = new PlaceList(() => this.view.focus());
  private readonly tree: FileTree;
  private readonly notice = h("div", { class: "editor-notice", role: "alert" });
  private readonly status = h("span", { class: "editor-status", role: "status" });
  private readonly save: HTMLButtonElement;
  private readonly list: HTMLButtonElement;
  private requestedFile = "";
  private isOpen = false;
  private restarts = 0;
  private number = 0;

  /**
   * @param onLine - called with the file and the line that the user clicked.
   */
  constructor(
    private readonly session: Session,
    private readonly onLine: (file: string, line: number) => void,
  ) {
    const words = strings.sourceEditor;
    const { connection } = session;
    this.service = new LanguageService(connection, this);
    this.actions = new CodeActions(this.service.client, this, (uri) => this.found.get(uri) ?? [], (message) => this.tell(message));
    this.navigation = new Navigation(this.service.client, this, this.places, (message) => this.tell(message));
    this.save = button(words.saveHint, () => this.saveAll(), "tool framed", icon("save"), words.save);
    this.list = button(words.findingsHint, () => openLintPanel(this.view), "tool framed", words.findings(0));
    this.tree = new FileTree(connection, (path) => void this.show(path), (path) => void this.createAndShow(path));
    const files = button(words.filesHint, () => this.tree.toggle(), "tool framed", icon("tree"), words.files);
    const format = button(words.formatHint, () => formatDocument(this.view), "tool framed", words.format);
    const actions = button(words.actionsHint, () => this.actions.open(this.view), "tool framed", icon("bulb"), words.actions);
    const bar = h("div", { class: "editor-bar", role: "toolbar", aria: { label: words.label } }, files, this.save, actions, format, this.list, this.status);
    this.tree.shownChanged.on((isShown) => files.setAttribute("aria-expanded", String(isShown)));
    this.view = new EditorView({ dispatchTransactions: (transactions, view) => this.dispatch(transactions, view) });
    this.element = h("div", { class: "source-editor" }, bar, this.notice, h("div", { class: "editor-body" }, this.tree.element, this.view.dom), this.places.element);
    // The page's own keys would change the scene or save the configuration.
    this.element.addEventListener("keydown", (event) => event.key !== "F11" && event.stopPropagation());
    this.changed.on(coalesced(() => this.refresh()));
    this.listen();
    this.refresh();
  }

  get open(): readonly SourceDocument[] {
    return [...this.documents.values()];
  }

  get unsaved(): readonly SourceDocument[] {
    return this.open.filter((document) => document.isUnsaved);
  }

  /** Shows a file, and returns whether it can be shown. */
  async show(path: string): Promise<boolean> {
    this.requestedFile = path;
    const document = await this.load(path);
    if (document === null || this.requestedFile !== path) return document !== null;
    if (document !== this.shown) this.display(document);
    return true;
  }

  load(path: string): Promise<SourceDocument | null> {
    const known = this.documents.get(path);
    if (known) return Promise.resolve(known);
    return new Promise((resolve) => {
      const waiting = this.awaited.get(path);
      if (waiting) waiting.push(resolve);
      else {
        this.awaited.set(path, [resolve]);
        if (this.isOpen) this.session.connection.send({ type: "ask_source_file", path });
        else this.openWorkspace(path);
      }
    });
  }

  create(path: string): Promise<void> {
    return new Promise((resolve, reject) => {
      this.number += 1;
      this.creating.set(this.number, { resolve, reject });
      this.session.connection.send({ type: "create_source_file", number: this.number, path });
    });
  }

  change(document: SourceDocument, spec: TransactionSpec): void {
    if (document === this.shown) this.view.dispatch(spec);
    else this.record(document, document.state.update(spec));
  }

  findings(uri: string, findings: readonly ServerFinding[]): void {
    this.found.set(uri, findings);
    if (this.shown?.uri === uri) this.showFindings(this.shown);
    this.changed.emit();
  }

  /** Marks lines of the shown file, and scrolls to one of them. */
  mark(highlights: readonly Highlight[], line: number | null): void {
    const document = this.shown;
    if (!document) return;
    const effects = [marksOf(document, highlights)];
    this.view.dispatch({ effects });
    if (line === null || line < 1) return;
    const at = document.placeNow(document.savedText.line(Math.min(line, document.savedText.lines)).from);
    this.navigation.leave();
    this.view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
  }

  /** Writes all files that have changed. */
  saveAll(): void {
    const words = strings.sourceEditor;
    const { connection } = this.session;
    if (connection.state !== "connected") {
      this.tell(words.disconnected);
      return;
    }
    for (const document of this.unsaved) {
      if (document.conflict !== null || document.isWriting) continue;
      const text = document.beginWriting();
      if (!fitsMessage(text)) {
        document.endWriting(null);
        this.tell(words.tooLong(nameOf(document.path)));
        continue;
      }
      this.number += 1;
      this.writing.set(this.number, document);
      connection.send({ type: "write_source_file", number: this.number, path: document.path, version: document.version, text });
    }
  }

  /** Returns the state of the editor, for tests. */
  inspect(): object {
    const { view, shown } = this;
    return {
      file: shown?.path ?? "",
      text: view.state.doc.toString(),
      marks: inspectMarks(view.state),
      findings: this.found.get(shown?.uri ?? "")?.map(({ code }) => code) ?? [],
      unsaved: this.unsaved.map(({ path }) => path),
      isConflict: shown?.conflict !== null && shown !== null,
      whyNot: this.whyNot,
      cursor: view.state.doc.lineAt(view.state.selection.main.head).number,
    };
  }

  private listen(): void {
    const { connection, description } = this.session;
    connection.on("editor_opened", ({ folder, uri, why_not }) => this.onOpened(folder, uri, why_not));
    connection.on("source_file", (message) => this.onFile(message));
    connection.on("source_file_written", (message) => this.onWritten(message));
    connection.on("hello", () => {
      this.isOpen = false;
      for (const document of this.writing.values()) document.endWriting(null);
      this.writing.clear();
      for (const { reject } of this.creating.values()) reject(new Error(strings.sourceEditor.disconnected));
      this.creating.clear();
    });
    connection.on("diagnostics", () => this.reopen());
    connection.on("description_changed", () => {
      this.reopen();
      const files = this.session.description.of(this.shownDisplay)?.description.files ?? [];
      this.service.filesChanged(this.open.filter(({ path }) => files.includes(path)).map(({ uri }) => uri));
    });
    description.arrived.on(() => this.reopen());
    connection.on("language_server_ended", () => {
      this.isOpen = false;
      this.restarts += 1;
      this.tell(strings.sourceEditor.ended);
      if (this.restarts <= RESTARTS) setTimeout(() => this.reopen(), RESTART_MS);
    });
    window.addEventListener("beforeunload", (event) => this.unsaved.length > 0 && event.preventDefault());
  }

  private get shownDisplay(): string {
    return this.session.focus.current?.display ?? this.session.robot?.display ?? "";
  }

  /** Opens the workspace again, after the program was restarted. */
  private reopen(): void {
    if (!this.isOpen && this.requestedFile !== "") this.openWorkspace(this.requestedFile);
  }

  private openWorkspace(file: string): void {
    this.session.connection.send({ type: "open_editor", file });
  }

  private onOpened(folder: string, uri: string, whyNot: string): void {
    this.whyNot = whyNot;
    this.isOpen = whyNot === "";
    if (this.isOpen) {
      this.service.connect(uri);
      this.tree.setFolder(folder);
      this.status.textContent = "";
      for (const path of [...this.documents.keys(), ...this.awaited.keys()]) this.session.connection.send({ type: "ask_source_file", path });
    } else for (const path of [...this.awaited.keys()]) this.settle(path, null);
    this.changed.emit();
  }

  private onFile({ path, uri, version, text, why_not }: SourceFile): void {
    let document = this.documents.get(path);
    if (document) {
      document.whyNot = why_not;
      const spec = text === null ? null : document.diskChanged(text, version);
      if (spec) this.change(document, spec);
      this.service.filesChanged([uri]);
    } else if (text !== null) {
      const created = new SourceDocument(path, uri, version, this.stateOf(path, uri, text, why_not !== ""));
      created.whyNot = why_not;
      this.documents.set(path, created);
      this.service.add(created);
      document = created;
    } else this.tell(why_not);
    this.settle(path, document ?? null);
    this.changed.emit();
  }

  private onWritten({ number, path, version, refusal }: SourceFileWritten): void {
    const document = this.writing.get(number);
    this.writing.delete(number);
    const created = this.creating.get(number);
    this.creating.delete(number);
    document?.endWriting(refusal === null ? version : null);
    const why = refusal ? [refusal.message, ...refusal.hints].join(" ") : "";
    if (refusal && created) created.reject(new Error(why));
    else if (refusal) this.tell(why);
    else if (document) {
      this.service.client.notification("textDocument/didSave", { textDocument: { uri: document.uri } });
      this.tell(strings.sourceEditor.saved(nameOf(path)));
    } else {
      this.tree.reload();
      created?.resolve();
    }
    this.changed.emit();
  }

  private settle(path: string, document: SourceDocument | null): void {
    const waiting = this.awaited.get(path) ?? [];
    this.awaited.delete(path);
    for (const resolve of waiting) resolve(document);
  }

  private async createAndShow(path: string): Promise<void> {
    try {
      await this.create(path);
      await this.show(path);
    } catch (error) {
      this.tell(messageOf(error));
    }
  }

  private stateOf(path: string, uri: string, doc: string, isReadOnly: boolean): EditorState {
    const keys = keymap.of([
      { key: "Mod-s", run: () => (this.saveAll(), true), preventDefault: true },
      { key: "F2", run: (view) => renameAtCursor(view, this, (message) => this.tell(message)), preventDefault: true },
      { key: "F12", run: (view) => this.navigation.goToDefinition(view), preventDefault: true },
      { key: "Shift-F12", run: (view) => this.navigation.listReferences(view), preventDefault: true },
      { key: "Alt-ArrowLeft", mac: "Ctrl--", run: () => this.navigation.goBack(), preventDefault: true },
      { key: "Alt-ArrowRight", mac: "Ctrl-Shift--", run: () => this.navigation.goForward(), preventDefault: true },
      { key: "Mod-.", run: (view) => this.actions.open(view), preventDefault: true },
      { key: "F8", run: nextDiagnostic, shift: previousDiagnostic, preventDefault: true },
      { key: "Mod-i", run: selectParentSyntax, preventDefault: true },
    ]);
    const clicks = EditorView.domEventHandlers({
      mousedown: (event, view) => {
        const position = event.button === 0 && (event.ctrlKey || event.metaKey) ? view.posAtCoords({ x: event.clientX, y: event.clientY }) : null;
        return position !== null && this.navigation.goToDefinition(view, position);
      },
    });
    const followClicks = EditorView.updateListener.of(({ transactions, state }) => {
      const { main } = state.selection;
      if (main.empty && transactions.some((each) => each.isUserEvent("select.pointer"))) this.onLine(path, state.doc.lineAt(main.head).number);
    });
    return EditorState.create({ doc, extensions: [keys, baseExtensions(path, doc, isReadOnly), this.service.extension({ uri, path }), clicks, followClicks] });
  }

  private display(document: SourceDocument): void {
    this.service.client.sync();
    this.navigation.leave();
    if (this.shown) this.shown.scrolledTo = this.view.elementAtHeight(this.view.scrollDOM.scrollTop).from;
    this.shown = document;
    this.view.setState(document.state);
    this.showFindings(document);
    const at = Math.min(document.scrolledTo, document.state.doc.length);
    this.view.dispatch({ effects: EditorView.scrollIntoView(at, { y: "start" }) });
    this.status.textContent = "";
    this.tree.setCurrent(document.path);
    this.changed.emit();
  }

  private showFindings({ uri, whyNot }: SourceDocument): void {
    const fix = whyNot === "" ? (view: EditorView, range: { from: number; to: number }) => void this.actions.open(view, range) : null;
    this.view.dispatch(showFindings(this.view.state, this.found.get(uri) ?? [], fix));
  }

  private dispatch(transactions: readonly Transaction[], view: EditorView): void {
    view.update(transactions);
    if (this.shown) for (const transaction of transactions) this.record(this.shown, transaction);
  }

  private record(document: SourceDocument, transaction: Transaction): void {
    document.record(transaction);
    if (!transaction.docChanged) return;
    this.service.record(document, transaction.changes);
    this.navigation.record(document, transaction.changes);
    this.changed.emit();
  }

  private tell(message: string): void {
    if (message !== "") this.status.textContent = message;
  }

  private refresh(): void {
    const words = strings.sourceEditor;
    const { unsaved, shown } = this;
    this.save.disabled = unsaved.every(({ conflict }) => conflict !== null);
    this.element.classList.toggle("unsaved", unsaved.length > 0);
    this.save.lastChild?.replaceWith(unsaved.length > 1 ? words.saveMany(unsaved.length) : words.save);
    const count = diagnosticCount(this.view.state);
    this.list.replaceChildren(words.findings(count));
    this.list.disabled = count === 0;
    this.showNotice(shown);
    this.tree.setUnsaved(unsaved.map(({ path }) => path));
  }

  private showNotice(shown: SourceDocument | null): void {
    const words = strings.sourceEditor;
    this.notice.hidden = !shown || (shown.conflict === null && shown.whyNot === "");
    if (!shown || this.notice.hidden) return;
    if (shown.conflict === null) {
      this.notice.replaceChildren(shown.whyNot);
      return;
    }
    const settle = (spec: TransactionSpec | null): void => {
      if (spec) this.change(shown, spec);
      this.changed.emit();
      this.view.focus();
    };
    const keep = (): void => {
      shown.keepMine();
      settle(null);
    };
    const mine = button(words.keepMineHint, keep, "tool framed", words.keepMine);
    const theirs = button(words.takeDiskHint, () => settle(shown.takeDisk()), "tool framed", words.takeDisk);
    this.notice.replaceChildren(h("span", {}, words.conflict), mine, theirs);
  }
}

function nameOf(path: string): string {
  return path.slice(path.lastIndexOf("/") + 1);
}
